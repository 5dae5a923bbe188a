"""Values between others: cameras, clip planes and opacities of some pictures, and of all between.

Each moves evenly from one to the next, and starts and stops smoothly. What lies on the way between
two on a circle or a scale is found by halving, again and again, which needs nothing but square
roots, and gives the same on every machine.
"""

import math
from bisect import bisect_right
from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import Generic, TypeVar

from vtray.base.errors import SceneError
from vtray.base.number import is_integer, number_of
from vtray.scene.checks.scene_words import show

Value = TypeVar("Value")

BEFORE = "{before}"
"""What stands in messages for the name of the keyframe before."""

HALVINGS = 40
"""How often what lies between two is halved: to a millionth of a millionth."""


class ApartError(Exception):
    """There is no way from one value to another; says why, with `BEFORE`."""


class Keyframes(Generic[Value]):
    """The values that something has in a movie, by those of some of its pictures.

    Parameters
    ----------
    name
        What it is called in messages.
    values
        Values by the numbers of pictures, from 0. Before the first and after the last, nothing
        moves; between two, it starts and stops smoothly.
    between
        Gives what lies at a share of the way from one value to another, from 0 to 1.

    Raises
    ------
    SceneError
        There is none, a number is none, or there is no way from one to the next.
    """

    def __init__(
        self,
        name: str,
        values: Mapping[float, Value],
        between: Callable[[Value, Value, float], Value],
    ) -> None:
        self._numbers = numbers_of(name, values)
        self._values = [values[number] for number in sorted(values, key=number_of)]
        self._between = between
        for (k, one), (n, other) in pairwise(zip(self._numbers, self._values, strict=True)):
            try:
                between(one, other, 0.5)
            except ApartError as error:
                words = str(error).replace(BEFORE, f"{name}[{k}]")
                raise SceneError(f"{name}[{n}]: {words}") from None

    def __call__(self, number: int) -> Value:
        """Return the value in a picture."""
        k = bisect_right(self._numbers, number)
        if k == 0 or k == len(self._numbers):
            return self._values[max(k - 1, 0)]
        first, last = self._numbers[k - 1], self._numbers[k]
        share = (number - first) / (last - first)
        smooth = share * share * (3 - 2 * share)
        return self._between(self._values[k - 1], self._values[k], smooth)


def numbers_of(name: str, values: Mapping[float, object]) -> list[float]:
    """Return the numbers of pictures that have a value, in their order; see `Keyframes`."""
    what = "cameras" if name == "camera" else "values"
    if not values:
        raise SceneError(f"{name}: expected {what} by the numbers of pictures, got none")
    for number in values:
        if not 0 <= number_of(number) < math.inf:
            raise SceneError(f"{name}: expected numbers of pictures from 0, got {show(number)}")
    return sorted(int(n) if is_integer(n) else number_of(n) for n in values)


def part_way(
    one: Value, other: Value, share: float, middle: Callable[[Value, Value], Value]
) -> Value:
    """Return what lies at a share of the way between two, by what lies in the middle of two."""
    for _ in range(HALVINGS):
        half = middle(one, other)
        share *= 2.0
        if share < 1.0:
            other = half
        else:
            one, share = half, share - 1.0
    return one


def straight(one: float, other: float, share: float) -> float:
    """Return the number at a share of the way between two, which it reaches exactly."""
    return other if share >= 1.0 else one + (other - one) * share
