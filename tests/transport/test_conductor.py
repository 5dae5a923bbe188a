"""What metals mirror, beside complex numbers."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vtray.base.compiler.compiled import uncompiled
from vtray.scene.metals import METALS
from vtray.transport.materials.conductor import (
    conductor_share,
    conductor_shares,
    grazing_shares,
)
from vtray.transport.materials.optics import split_at


def expected(cosine: float, index: complex) -> float:
    """Return what Fresnel's equations say, by Snell's law with complex angles."""
    other = cmath.sqrt(1 - (1 - cosine * cosine) / (index * index))
    across = (cosine - index * other) / (cosine + index * other)
    along = (index * cosine - other) / (index * cosine + other)
    return 0.5 * (abs(across) ** 2 + abs(along) ** 2)


@given(st.floats(0.001, 1), st.floats(0.05, 10), st.floats(0.01, 12))
def test_shares_are_those_of_complex_numbers(cosine: float, n: float, k: float) -> None:
    found = uncompiled(conductor_share)(cosine, n, k)
    assert found == pytest.approx(expected(cosine, complex(n, k)), rel=1e-9, abs=1e-12)


@given(st.floats(0.01, 1), st.floats(1.01, 3))
def test_without_extinction_it_is_glass(cosine: float, n: float) -> None:
    sine = math.sqrt(1 - cosine * cosine)
    glass = uncompiled(split_at)((sine, 0.0, -cosine), (0.0, 0.0, 1.0), n).reflected
    assert uncompiled(conductor_share)(cosine, n, 0.0) == pytest.approx(glass, abs=1e-9)


@given(st.floats(-0.1, 1.1), st.sampled_from(sorted(METALS)))
def test_no_metal_mirrors_more_than_all(cosine: float, name: str) -> None:
    shares = uncompiled(conductor_shares)(cosine, *METALS[name])
    assert all(0 < share <= 1 for share in shares)


def test_all_is_mirrored_along_the_surface() -> None:
    assert uncompiled(conductor_share)(0.0, 0.2, 3.0) == 1.0


def test_gold_is_golden_and_copper_red() -> None:
    red, green, blue = uncompiled(conductor_shares)(1.0, *METALS["gold"])
    assert red > 0.9 > green > 0.6 > blue > 0.3
    red, green, blue = uncompiled(conductor_shares)(1.0, *METALS["copper"])
    assert red > 0.85 > green > blue > 0.4
    assert min(uncompiled(conductor_shares)(1.0, *METALS["silver"])) > 0.88


def test_colored_metals_are_white_along_the_surface() -> None:
    shares = uncompiled(grazing_shares)
    assert shares(1.0, (0.9, 0.5, 0.1), (1.0, 1.0, 1.0)) == (0.9, 0.5, 0.1)
    assert shares(0.0, (0.9, 0.5, 0.1), (1.0, 1.0, 1.0)) == pytest.approx((1, 1, 1))
    assert shares(0.5, (0.5, 0.5, 0.0), (1.0, 0.5, 0.0)) == (0.515625, 0.5, 0.0)


# What whole spectra give, in linear sRGB under D65, by the observer of Wyman, Sloan and Shirley
# (Journal of Computer Graphics Techniques 2 (2), 2013); iron is not among them.
SQUARELY = {
    "aluminium": (0.9133, 0.9214, 0.9245),
    "chromium": (0.6349, 0.6620, 0.7046),
    "copper": (0.9530, 0.6388, 0.5380),
    "gold": (0.99, 0.7837, 0.3433),
    "mercury": (0.7815, 0.7796, 0.7784),
    "nickel": (0.659, 0.609, 0.526),
    "rhodium": (0.7967, 0.7647, 0.7425),
    "silver": (0.9713, 0.9601, 0.9153),
    "tungsten": (0.5151, 0.4961, 0.4676),
}


@pytest.mark.parametrize("name", sorted(SQUARELY))
def test_metals_have_the_colours_of_their_spectra(name: str) -> None:
    found = uncompiled(conductor_shares)(1.0, *METALS[name])
    assert found == pytest.approx(SQUARELY[name], abs=0.001)
