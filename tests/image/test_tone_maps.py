"""Each tone map against the formula of its source, and what all have in common."""

from decimal import Decimal, localcontext
from typing import get_args

import numpy as np
import pytest

from vtray.image.tone_maps.agx import agx
from vtray.image.tone_maps.filmic import filmic
from vtray.image.tone_maps.table import TONE_MAPS
from vtray.image.toned import MOST
from vtray.scene.colors.tone_map_names import ToneMapName

RANDOM = np.random.default_rng(4)
COLORS = 2.0 ** RANDOM.uniform(-16, 8, (300, 3))
GREY = np.concatenate([[0.0], 2.0 ** np.linspace(-16, 8, 20_001), [MOST]])


def true_agx(color: np.ndarray) -> list[Decimal]:
    """Return AgX as its source writes it: matrices by columns, and powers of x one by one."""
    inset = (
        ("0.842479062253094", "0.0423282422610123", "0.0423756549057051"),
        ("0.0784335999999992", "0.878468636469772", "0.0784336"),
        ("0.0792237451477643", "0.0791661274605434", "0.879142973793104"),
    )
    outset = (
        ("1.19687900512017", "-0.0528968517574562", "-0.0529716355144438"),
        ("-0.0980208811401368", "1.15190312990417", "-0.0980434501171241"),
        ("-0.0990297440797205", "-0.0989611768448433", "1.15107367264116"),
    )

    def times(columns: tuple, vector: list[Decimal]) -> list[Decimal]:
        return [sum(Decimal(columns[k][row]) * vector[k] for k in range(3)) for row in range(3)]

    least, most = Decimal("-12.47393"), Decimal("4.026069")
    values = times(inset, [Decimal(float(channel)) for channel in color])
    stops = [min(max(v.ln() / Decimal(2).ln(), least), most) for v in values]
    shares = [(stop - least) / (most - least) for stop in stops]
    curve = [
        Decimal("15.5") * x**6
        - Decimal("40.14") * x**5
        + Decimal("31.96") * x**4
        - Decimal("6.868") * x**3
        + Decimal("0.4298") * x**2
        + Decimal("0.1191") * x
        - Decimal("0.00232")
        for x in shares
    ]
    return [min(max(v, Decimal(0)), Decimal(1)) ** Decimal("2.2") for v in times(outset, curve)]


def test_agx_is_that_of_its_source() -> None:
    for color, found in zip(COLORS, agx(COLORS).tolist(), strict=True):
        with localcontext(prec=40):
            for value, true in zip(found, true_agx(color), strict=True):
                assert abs(Decimal(value) - true) < Decimal(2.0**-38)


def test_filmic_is_that_of_its_source() -> None:
    a, b, c, d, e = 2.51, 0.03, 2.43, 0.59, 0.14
    for x, found in zip(COLORS.ravel(), filmic(COLORS).ravel(), strict=True):
        assert found == pytest.approx(
            min((x * (a * x + b)) / (x * (c * x + d) + e), 1.0), rel=1e-15
        )
    # By hand: 0.1 (0.251 + 0.03) / (0.1 (0.243 + 0.59) + 0.14), and 2.54 / 3.16.
    known = filmic(np.array([0.1, 1.0, 7.23, 7.25]))
    assert known[:2] == pytest.approx([0.0281 / 0.2233, 2.54 / 3.16])
    assert known[2] < known[3] == 1.0


def test_srgb_cuts_off() -> None:
    assert TONE_MAPS["srgb"](np.array([0.0, 0.3, 1.0, 1.1, MOST])).tolist() == [0, 0.3, 1, 1, 1]


def test_all_names_have_a_curve() -> None:
    assert ("linear", *TONE_MAPS) == get_args(ToneMapName)


@pytest.mark.parametrize("name", TONE_MAPS)
def test_curves_rise_from_black_to_white(name: ToneMapName) -> None:
    found = TONE_MAPS[name](np.repeat(GREY[:, None], 3, axis=1))
    assert (found[0] == 0.0).all()
    assert (found[-1] > 0.996).all()
    assert ((found >= 0.0) & (found <= 1.0)).all()
    # The matrices of AgX have rows whose sums are off from 1 by up to 0.0002.
    steps, apart = (-2e-6, 6e-4) if name == "agx" else (0.0, 0.0)
    assert (np.diff(found, axis=0) >= steps).all()
    assert np.ptp(found, axis=1).max() <= apart


@pytest.mark.parametrize("name", TONE_MAPS)
def test_curves_take_any_shape(name: ToneMapName) -> None:
    light = COLORS.reshape(10, 30, 3)
    whole = TONE_MAPS[name](light)
    assert whole.shape == light.shape
    # To the last bit: a vectorised loop and its rest give the same.
    for row in range(10):
        for column in (0, 1, 29):
            one = TONE_MAPS[name](light[row, column : column + 1])
            assert np.array_equal(one[0], whole[row, column])
