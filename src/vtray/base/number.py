"""Numbers that are given: by code, as those of Python or of NumPy, or as texts.

What is none becomes NaN, which no comparison holds for: ``0 < number_of(given) < inf`` is a whole
check.
"""

import math
import operator
import re
from numbers import Integral, Real
from typing import TypeGuard

_TEXT = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")


def is_number(given: object) -> TypeGuard[float]:
    """Tell whether something is a real number, of any type but those of True and False."""
    return isinstance(given, Real) and not isinstance(given, bool)


def number_of(given: object) -> float:
    """Return a number as a float; NaN for what is none. What is beyond a double is infinite."""
    if not is_number(given):
        return math.nan
    try:
        return float(given)
    except OverflowError:
        return math.inf if given > 0 else -math.inf


def is_integer(given: object) -> TypeGuard[int]:
    """Tell whether something is an integer, of any type but those of True and False."""
    return isinstance(given, Integral) and not isinstance(given, bool)


def integer_of(given: object) -> int | None:
    """Return an integer as Python's own, also of what stands for one; None for what is none."""
    if isinstance(given, bool):
        return None
    try:
        return operator.index(given)  # type: ignore[arg-type]
    except TypeError:
        return None


def count_of(given: object) -> int | None:
    """Return how many things something holds; None for what holds none, as an array of a number."""
    try:
        return len(given)  # type: ignore[arg-type]
    except TypeError:
        return None


def number_in(text: str) -> float:
    """Return the number that a text says, such as ``"+2"`` or ``"1.5e-3"``; NaN if it says none.

    Unlike Python, it takes neither ``"nan"`` and ``"inf"`` nor underscores, spaces, and digits of
    other scripts.
    """
    return float(text) if _TEXT.fullmatch(text) else math.nan
