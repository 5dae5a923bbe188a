"""Sines, angles, exponentials and lengths against the decimal module, digit by digit."""

import math
import random
from decimal import Decimal, localcontext

import numpy as np
import pytest

from vtray.base.exact_math import (
    angle,
    cosine,
    exponential,
    hypotenuse,
    power,
    power_of_2,
    sine,
    small_cosine,
    small_sine,
    tangent,
)

PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494")
DRAW = random.Random(5)


def true_sine(radians: Decimal) -> Decimal:
    """Return a sine to forty digits, term by term."""
    term = total = radians
    for n in range(1, 200, 2):
        term *= -radians * radians / ((n + 1) * (n + 2))
        total += term
    return total


def true_sines(degrees: float) -> tuple[Decimal, Decimal]:
    """Return sine and cosine of an angle in degrees."""
    rest = Decimal(degrees) % 360
    return true_sine(rest * PI / 180), true_sine((rest + 90) * PI / 180)


def test_sines_of_degrees() -> None:
    angles = [DRAW.uniform(-400, 400) for _ in range(300)] + [1e-300, 1e-9, 1e9 + 0.1, 563_242.5]
    for degrees in angles:
        with localcontext(prec=50):
            a, b = true_sines(degrees)
            assert abs(Decimal(sine(degrees)) - a) < Decimal(2.0**-51)
            assert abs(Decimal(cosine(degrees)) - b) < Decimal(2.0**-51)


def test_sines_that_are_known() -> None:
    for turn in (-720, 0, 360):
        known = {0: 0, 30: 0.5, 90: 1, 150: 0.5, 180: 0, 210: -0.5, 270: -1, 330: -0.5}
        for degrees, value in known.items():
            assert sine(degrees + turn) == cosine(degrees + turn - 90) == value
    assert sine(60) == cosine(30) == math.sqrt(3) / 2
    assert sine(-60) == cosine(150) == -math.sqrt(3) / 2


def test_tangents() -> None:
    angles = [DRAW.uniform(-90, 90) for _ in range(200)] + [1e-300, 90 - 1e-13, 89.99, 1e-5]
    for degrees in angles:
        with localcontext(prec=50):
            a, b = true_sines(degrees)
            assert abs(Decimal(tangent(degrees)) * b / a - 1) < Decimal(2.0**-50)
    assert tangent(0) == 0


def test_angles() -> None:
    degrees = np.array([DRAW.uniform(-180, 180) for _ in range(300)] + [179.999999, -90.0, 1e-7])
    for length in (1.0, 1e-300, 1e300):
        across, along = (np.array([f(x) * length for x in degrees]) for f in (sine, cosine))
        found = angle(along, across)
        np.testing.assert_allclose(found, np.arctan2(across, along), rtol=2e-15)


def test_angles_along_the_axes() -> None:
    along = np.array([0.0, 2.0, -2.0, -2.0, 0.0, 0.0, -1.0])
    across = np.array([0.0, 0.0, 0.0, -0.0, 3.0, -3.0, 1e-250])
    known = [0.0, 0.0, math.pi, -math.pi, math.pi / 2, -math.pi / 2, math.pi]
    np.testing.assert_allclose(angle(along, across), known, rtol=1e-15)


def test_series_of_numbers_and_of_arrays() -> None:
    for function, end, bits, true in [
        (small_sine, math.pi / 4, 52, true_sine),
        (small_cosine, math.pi / 4, 52, lambda x: true_sine(x + PI / 2)),
        (exponential, 8.0, 45, Decimal.exp),
    ]:
        places = [DRAW.uniform(-end, end) for _ in range(200)] + [end, -end, 1e-9]
        values = [function(x) for x in places]
        assert function(np.array(places)).tolist() == values
        for x, value in zip(places, values, strict=True):
            with localcontext(prec=50):
                assert abs(Decimal(value) / true(Decimal(x)) - 1) < Decimal(2.0**-bits)
    assert small_sine(0.0) == 0
    assert small_cosine(0.0) == exponential(0.0) == 1


def test_hypotenuse_is_rounded_once() -> None:
    for spread in (0, 3, 9, 100, 300):
        for _ in range(100):
            parts = [DRAW.uniform(-1, 1) * 10 ** DRAW.uniform(-spread, spread) for _ in range(3)]
            with localcontext(prec=700):
                root = sum(Decimal(part) ** 2 for part in parts).sqrt()
                assert hypotenuse(*parts) == float(root)


@pytest.mark.parametrize(
    ("parts", "length"),
    [
        ((0.0, -0.0), 0.0),
        ((3, 4), 5.0),
        ((5e-324, 0.0), 5e-324),
        ((3 * 2.0**-1070, 4 * 2.0**-1070), 5 * 2.0**-1070),
        ((3 * 2.0**1020, 4 * 2.0**1020), 5 * 2.0**1020),
        ((1.7e308, 1.7e308), math.inf),
        ((math.inf, 1.0), math.inf),
        # Just below, at and just above the middle of two doubles.
        ((2.0**53, 2.0**27, 0.5), 2.0**53),
        ((2.0**53, 2.0**27, 1.0), 2.0**53),
        ((2.0**53, 2.0**27, 1.5), 2.0**53 + 2),
    ],
)
def test_hypotenuse_at_the_edges(parts: tuple[float, ...], length: float) -> None:
    assert hypotenuse(*parts) == length


def test_powers_of_2() -> None:
    for x in (-1000, -3, -1, 0, 1, 2.0, 10, 1000):
        assert power_of_2(x) == math.ldexp(1.0, int(x))
    for x in [DRAW.uniform(-1000, 1000) for _ in range(100)] + [0.5, -0.5, 1.5, 1e-17, 0.1]:
        with localcontext(prec=50):
            true = Decimal(2) ** Decimal(x)
            assert abs(Decimal(power_of_2(x)) / true - 1) < Decimal(2.0**-45)


def test_powers() -> None:
    bases = [DRAW.random() for _ in range(100)] + [2.0 ** -DRAW.uniform(0, 60) for _ in range(200)]
    bases += [2.0**-60, 0.5, math.nextafter(1.0, 0.0)]
    for exponent in (0.1, 1 / 2.4, 1.0, 2.2, 2.4, 4.0):
        found = power(np.array(bases), exponent)
        for base, value in zip(bases, found.tolist(), strict=True):
            with localcontext(prec=50):
                true = Decimal(base) ** Decimal(exponent)
                assert abs(Decimal(value) / true - 1) < Decimal(2.0**-43)
        known = power(np.array([0.0, 1.0, -1.0, 2.0**-61]), exponent)
        assert known.tolist() == [0.0, 1.0, 0.0, 0.0]
