"""What counts as a number, and what does not."""

import math
from fractions import Fraction

import numpy as np
import pytest

from vtray.base.number import integer_of, is_integer, number_in, number_of


@pytest.mark.parametrize(
    "given", [3, 3.0, np.int64(3), np.uint8(3), np.float32(3), np.float64(3), Fraction(3)]
)
def test_numbers(given: object) -> None:
    found = number_of(given)
    assert (found, type(found)) == (3.0, float)


@pytest.mark.parametrize("given", [True, np.True_, "3", None, 3j, np.complex64(3), [3], math.nan])
def test_what_is_none(given: object) -> None:
    assert math.isnan(number_of(given))


def test_numbers_beyond_a_double() -> None:
    assert (number_of(10**400), number_of(-(10**400))) == (math.inf, -math.inf)


def test_integers() -> None:
    assert all(map(is_integer, [3, np.int64(3), np.uint8(3)]))
    assert not any(map(is_integer, [True, np.True_, 3.0, np.float32(3), "3", None]))


@pytest.mark.parametrize("given", [3, np.int64(3), np.uint8(3), np.array(3)])
def test_what_stands_for_an_integer(given: object) -> None:
    assert integer_of(given) == 3


@pytest.mark.parametrize("given", [True, 3.0, "3", None, np.array([1, 2]), np.array(3.0)])
def test_what_stands_for_no_integer(given: object) -> None:
    assert integer_of(given) is None


@pytest.mark.parametrize("text", ["2", "+2", "2.", "2.0", "+.2e1", "20E-1"])
def test_numbers_in_texts(text: str) -> None:
    assert number_in(text) == 2.0


@pytest.mark.parametrize("text", ["", "x", "nan", "inf", "1_0", " 2", "2\n", "٣", ".", "1e", "0x2"])
def test_texts_that_are_none(text: str) -> None:
    assert math.isnan(number_in(text))
