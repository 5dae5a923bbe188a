"""Values of options that are numbers, and the error for those that are none."""

import argparse
import math
from collections.abc import Callable

from vtray.base.number import number_in


def wrong(expected: str, text: str) -> argparse.ArgumentTypeError:
    """Return the error for the value of an option, to be raised."""
    return argparse.ArgumentTypeError(f"expected {expected}, got {text}")


def between(least: float, most: float, words: str) -> Callable[[str], float]:
    """Return what makes a number of an argument, above 0 and between two limits, as words say."""

    def number(text: str) -> float:
        value = number_in(text)
        if not (least <= value <= most and 0.0 < value < math.inf):
            raise wrong(words, text)
        return value

    return number


positive = between(0.0, math.inf, "a number > 0")
"""Makes a number > 0 of an argument."""


def pair_in(text: str) -> tuple[float, float] | None:
    """Return the two numbers that a text says, with a comma between; None if it does not."""
    first, _, second = text.partition(",")
    pair = number_in(first), number_in(second)
    return None if any(map(math.isnan, pair)) else pair
