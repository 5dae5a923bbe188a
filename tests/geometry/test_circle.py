"""Sines, cosines and angles for kernels against the decimal module, digit by digit."""

import math
import random
from decimal import Decimal, localcontext

from vtray.base.compiler.compiled import uncompiled
from vtray.geometry.circle import angle_of, cosine_sine

PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494")
DRAW = random.Random(7)
EIGHTHS = [
    *(k / 512 for k in range(-512, 513)),
    *(DRAW.uniform(-1, 1) for _ in range(1000)),
    *(sign * 10 ** DRAW.uniform(-300, 0) for _ in range(100) for sign in (-1, 1)),
    math.nextafter(1, 0),
    5e-324,
]


def true_sines(radians: Decimal) -> tuple[Decimal, Decimal]:
    """Return cosine and sine to forty digits, term by term."""
    sums = [Decimal(0), Decimal(0)]
    term = Decimal(1)
    for n in range(40):
        sums[n % 2] += term if n % 4 < 2 else -term
        term *= radians / (n + 1)
    return sums[0], sums[1]


def test_against_the_series() -> None:
    for eighths in EIGHTHS:
        cosine, sine = cosine_sine(eighths)
        with localcontext(prec=50):
            true_cosine, true_sine = true_sines(PI / 4 * Decimal(eighths))
            assert abs(Decimal(cosine) - true_cosine) < Decimal("2e-16")
            assert abs(Decimal(sine) - true_sine) < Decimal("2e-16")
            # Small sines keep their digits.
            least = Decimal(2.0**-51) * abs(true_sine) + Decimal(2.0**-1074)
            assert abs(Decimal(sine) - true_sine) <= least


def test_symmetric_and_exact_in_the_middle() -> None:
    assert cosine_sine(0.0) == (1, 0)
    for eighths in EIGHTHS:
        cosine, sine = cosine_sine(eighths)
        assert cosine_sine(-eighths) == (cosine, -sine)


def test_compiled_equals_plain_python() -> None:
    for eighths in EIGHTHS:
        assert cosine_sine(eighths) == uncompiled(cosine_sine)(eighths)


def test_angles_against_the_series() -> None:
    ways = [
        (1.0, 0.0),
        (1.0, 1.0),
        (0.0, 3.0),
        (0.0, -2.0),
        (-1.0, 1e-100),
        (-4.0, -4.0),
        (7.0, 5e-300),
    ]
    for _ in range(2000):
        along, across = (DRAW.uniform(-1, 1) * 10 ** DRAW.uniform(-20, 20) for _ in range(2))
        ways.append((along, across))
    for along, across in ways:
        angle = angle_of(along, across)
        assert abs(angle) <= math.pi * (1 + 2e-15)
        with localcontext(prec=60):
            # What is left of the vector's angle when it is turned back by this one.
            cosine, sine = true_sines(Decimal(angle))
            x, y = Decimal(along), Decimal(across)
            rest = (cosine * y - sine * x) / (x * x + y * y).sqrt()
            assert cosine * x + sine * y > 0
            assert abs(rest) <= Decimal("2e-15") * abs(Decimal(angle))


def test_angles_along_the_axis() -> None:
    assert (angle_of(2.0, 0.0), angle_of(0.0, 0.0), angle_of(-2.0, 0.0)) == (0, 0, math.pi)
    assert angle_of(3.0, 4.0) == -angle_of(3.0, -4.0) == uncompiled(angle_of)(3.0, 4.0)
