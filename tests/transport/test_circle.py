"""Sines and cosines for kernels against the decimal module, digit by digit."""

import math
import random
from decimal import Decimal, localcontext

from vtray.base.compiler.compiled import uncompiled
from vtray.transport.sampling.circle import cosine_sine

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
