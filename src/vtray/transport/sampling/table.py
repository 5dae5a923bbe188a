"""Points by tables: a number from 0 to 1 becomes one that is as often as a table says.

Each of these maps leaves what is near each other near each other, so that points that fill the
interval evenly stay so.

References
----------
Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th edition, 2023, A.4 and A.5.
"""

import math

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device


@device
def find_part(sums: NDArray[np.float64], begin: int, end: int, target: float) -> int:
    """Return the last place from `begin` on whose sum is at most a number.

    Parameters
    ----------
    sums
        Numbers that do not fall from `begin` to `end`.
    begin, end
        The first of them, at most `target`, and the last, larger than that.
    target
        The number.
    """
    while end - begin > 1:
        middle = (begin + end) // 2
        if sums[middle] <= target:
            begin = middle
        else:
            end = middle
    return begin


@device
def part_of(sums: NDArray[np.float64], place: int, target: float) -> float:
    """Return where a number is between the sum at a place and the next, from 0 to 1."""
    part: float = (target - sums[place]) / (sums[place + 1] - sums[place])
    return part


@device
def linear_point(u: float, first: float, last: float) -> float:
    """Return a point from 0 to 1 that is as often as a line says.

    Parameters
    ----------
    u
        The number from 0 to 1.
    first, last
        How often 0 and 1 are beside each other, ≥ 0.
    """
    root = math.sqrt(first * first + u * (last * last - first * first))
    ends = first + root
    return min(u * (first + last) / ends, 1.0) if ends > 0.0 else u
