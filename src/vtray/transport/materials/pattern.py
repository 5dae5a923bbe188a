"""Patterns: surfaces that have two colours in turn."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.shapes.unrolled import Unrolled, Upright
from vtray.geometry.vector import Vec

PLAIN, CHECKER, AROUND, ALONG = range(4)
"""The kinds: none, squares, and stripes around the axis of a shape or along it."""

NUMBERS = 15
"""Numbers of each: the size of its squares; what is up, and in front; the cosine and the sine of
how far it is turned; and two colours as light, negative for that of the object."""

COLORS = 9
"""Where the colours begin."""


class Patterns(NamedTuple):
    """The patterns of surfaces, by the ranges of `Materials`.

    Attributes
    ----------
    row, step, which
        As of `Looks`.
    kind
        The pattern of each material, (materials,).
    numbers
        What else is known of it, (materials, ``NUMBERS``).
    """

    row: NDArray[np.int64]
    step: NDArray[np.int64]
    which: NDArray[np.int64]
    kind: NDArray[np.int64]
    numbers: NDArray[np.float64]


@device
def upright_of(patterns: Patterns, row: int) -> Upright:
    """Return how a pattern is turned."""
    numbers = patterns.numbers
    return Upright(
        (numbers[row, 1], numbers[row, 2], numbers[row, 3]),
        (numbers[row, 4], numbers[row, 5], numbers[row, 6]),
        numbers[row, 7],
        numbers[row, 8],
    )


@device
def pattern_color(patterns: Patterns, row: int, place: Unrolled, own: Vec) -> Vec:
    """Return the colour of a place, as light, given that of the object."""
    kind, size = patterns.kind[row], patterns.numbers[row, 0]
    across = down = 0.0
    if kind != AROUND:
        across = _cell(place.across, place.width, size, 2.0)
    if kind != ALONG:
        down = _cell(place.down, place.height, size, 1.0)
    cell = across + down
    is_second = place.is_side and cell - 2.0 * math.floor(0.5 * cell) == 1.0
    first = COLORS + 3 if is_second else COLORS
    numbers = patterns.numbers
    red, green, blue = numbers[row, first], numbers[row, first + 1], numbers[row, first + 2]
    return (red, green, blue) if place.is_side and red >= 0.0 else own


@device
def _cell(along: float, length: float, size: float, times: float) -> float:
    """Return the number of the cell in which a place is, 0 or 1 where it is even or odd.

    Parameters
    ----------
    along
        How far it is along the surface.
    length
        That of the surface: cells of that size are stretched until they fill it.
    size
        Of a cell.
    times
        Of how many cells there is a multiple.
    """
    if length < math.inf:
        cells = times * max(math.floor(length / (times * size) + 0.5), 1.0)
        size = length / cells
        along = min(along, length * (1.0 - 2.0**-50))
    number = math.floor(along / size)
    return number - 2.0 * math.floor(0.5 * number)
