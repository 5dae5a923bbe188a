"""Patterns: surfaces that have two colours in turn, or show a picture."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.shapes.unrolled import Unrolled, Upright
from vtray.geometry.vector import Vec, add, scale

PLAIN, CHECKER, AROUND, ALONG, IMAGE = range(5)
"""The kinds: none, squares, stripes around the axis of a shape or along it, and a picture."""

NUMBERS = 15
"""Numbers of each: the size of squares or of a picture, negative if not said; what is up, and in
front; the cosine and the sine of how far it is turned; and two colours as light, negative for that
of the object."""

COLORS = 9
"""Where the colours begin."""

MOST = 2.0**52
"""Beyond so many cells, numbers have no places after the point, and there is no pattern."""


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
    place
        Of a picture, the number of its first pixel, its columns and its rows, (materials, 3).
    pixels
        The pixels of all pictures: red, green, blue and how opaque they are, (pixels, 4).
    light
        The light of the numbers of colours, (256,).
    """

    row: NDArray[np.int64]
    step: NDArray[np.int64]
    which: NDArray[np.int64]
    kind: NDArray[np.int64]
    numbers: NDArray[np.float64]
    place: NDArray[np.int64]
    pixels: NDArray[np.uint8]
    light: NDArray[np.float64]


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
    if kind == IMAGE:
        return _image_color(patterns, row, place, own) if place.is_side else own
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
        size = length / (times * _whole(length / (times * size)))
        along = min(along, length * (1.0 - 2.0**-50))
    number = along / size
    number = math.floor(number) if abs(number) < MOST else 0.0
    return number - 2.0 * math.floor(0.5 * number)


@device
def _whole(times: float) -> float:
    """Return the whole number that is nearest, at least 1."""
    return max(math.floor(min(times + 0.5, MOST)), 1.0)


@device
def _image_color(patterns: Patterns, row: int, place: Unrolled, own: Vec) -> Vec:
    """Return the colour of a place of a picture, as light, in front of that of the object."""
    size, columns, rows = patterns.numbers[row, 0], patterns.place[row, 1], patterns.place[row, 2]
    x, left, right = _between(place.across, place.width, size, columns, True)
    y, above, below = _between(place.down, place.height, size * rows / columns, rows, False)
    first = patterns.place[row, 0]
    upper = _mixed(patterns, first + above * columns, left, right, x)
    lower = _mixed(patterns, first + below * columns, left, right, x)
    color = add(scale(1.0 - y, upper[0]), scale(y, lower[0]))
    opacity = (1.0 - y) * upper[1] + y * lower[1]
    return add(color, scale(1.0 - opacity, own))


@device
def _between(
    along: float, length: float, size: float, count: int, is_round: bool
) -> tuple[float, int, int]:
    """Return between which rows of pixels a place is, and how far it is to the second.

    Parameters
    ----------
    along
        How far it is along the surface.
    length
        That of the surface.
    size
        That of the picture; if negative, the surface has it once, or where it goes on for ever,
        with that size but for the sign.
    count
        How many rows there are.
    is_round
        Whether the surface ends where it begins.
    """
    repeats, size_there = is_round, abs(size)
    if length < math.inf:
        times = _whole(length / size) if size > 0.0 else 1.0
        repeats |= times > 1.0
        size_there = length / times
        along = min(along, length * (1.0 - 2.0**-50))
    else:
        repeats = True
    part = along / size_there
    part = part - math.floor(part) if abs(part) < MOST else 0.0
    place = min(part, 1.0 - 2.0**-53) * count - 0.5
    before = math.floor(place)
    if repeats:
        after = before + 1 if before + 1 < count else 0
        return place - before, before if before >= 0 else count - 1, after
    return place - before, max(before, 0), min(before + 1, count - 1)


@device
def _mixed(patterns: Patterns, row: int, left: int, right: int, x: float) -> tuple[Vec, float]:
    """Return the light between two pixels of a row, and how opaque they are there."""
    one, other = row + left, row + right
    near, far = _opacity(patterns, one), _opacity(patterns, other)
    color = add(
        scale((1.0 - x) * near, _light_of(patterns, one)),
        scale(x * far, _light_of(patterns, other)),
    )
    return color, (1.0 - x) * near + x * far


@device
def _opacity(patterns: Patterns, pixel: int) -> float:
    """Return how opaque a pixel is, up to 1."""
    opacity: float = patterns.pixels[pixel, 3] / 255.0
    return opacity


@device
def _light_of(patterns: Patterns, pixel: int) -> Vec:
    """Return the light of a pixel, 255 for white."""
    light, pixels = patterns.light, patterns.pixels
    return light[pixels[pixel, 0]], light[pixels[pixel, 1]], light[pixels[pixel, 2]]
