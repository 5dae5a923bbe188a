"""The exponential of kernels, and Beer's law."""

import math
from decimal import Decimal, getcontext

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vtray.base.compiler.compiled import uncompiled
from vtray.transport.materials.absorption import exponential, transmitted

ONE = Decimal(1)


@given(st.floats(-800, 0))
def test_exponential_is_right_to_a_unit_in_the_last_place(x: float) -> None:
    getcontext().prec = 40
    expected = Decimal(x).exp()
    found = uncompiled(exponential)(x)
    unit = Decimal(math.ulp(max(found, 2.0**-1022)))
    assert abs(Decimal(found) - expected) <= unit


@pytest.mark.parametrize(
    ("x", "expected"),
    [(0.0, 1.0), (-0.0, 1.0), (-math.inf, 0.0), (-1e300, 0.0), (-5e-324, 1.0), (-746.0, 0.0)],
)
def test_ends(x: float, expected: float) -> None:
    assert uncompiled(exponential)(x) == expected


def test_exponential_falls() -> None:
    found = [uncompiled(exponential)(float(x)) for x in np.linspace(-30, 0, 2001)]
    assert np.all(np.diff(found) > 0)


@given(st.floats(0, 10), st.floats(0, 10), st.floats(0, 10))
def test_lengths_add_up(absorption: float, one: float, other: float) -> None:
    """What passes two lengths is what passes them one after the other."""
    left = uncompiled(transmitted)
    channels = absorption, 0.0, 2 * absorption
    both = np.multiply(left(channels, one), left(channels, other))
    assert left(channels, one + other) == pytest.approx(both, rel=1e-13)


def test_infinite_lengths() -> None:
    """What does not absorb lets all pass, however far it goes."""
    assert uncompiled(transmitted)((0.0, 1e-300, 3.0), math.inf) == (1.0, 0.0, 0.0)
