"""Morton codes: numbers for points, such that points with near codes are near each other.

A key holds the code of a point and, in its low bits, the point's number, so that sorting the keys
sorts the points.

References
----------
Morton, "A Computer Oriented Geodetic Data Base and a New Technique in File Sequencing", 1966.
"""

from typing import NamedTuple

import numpy as np

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec


class Grid(NamedTuple):
    """A grid of cubes, in which points are numbered along Morton's curve.

    Attributes
    ----------
    low
        The corner of the grid.
    cells
        Cells for each unit of length; 0 if all points are in one place.
    axis_bits, number_bits
        Bits of a key for each coordinate, and for the point's number.
    """

    low: Vec
    cells: float
    axis_bits: int
    number_bits: int


@device
def make_grid(low: Vec, high: Vec, number_bits: int) -> Grid:
    """Return the finest grid over a box whose keys leave room for the numbers."""
    axis_bits = min((64 - number_bits) // 3, 21)
    longest = max(high[0] - low[0], high[1] - low[1], high[2] - low[2])
    # The least doubles would make it infinite, and the cell of the corner infinite times zero.
    cells = min(float(1 << axis_bits) / longest, 1e300) if longest > 0.0 else 0.0
    return Grid(low, cells, axis_bits, number_bits)


@device
def make_key(point: Vec, number: int, grid: Grid) -> np.uint64:
    """Return the key of a point."""
    x = _spread(_cell(point[0] - grid.low[0], grid))
    y = _spread(_cell(point[1] - grid.low[1], grid))
    z = _spread(_cell(point[2] - grid.low[2], grid))
    code = x << np.uint64(2) | y << np.uint64(1) | z
    return code << np.uint64(grid.number_bits) | np.uint64(number)


@device
def key_number(key: np.uint64, grid: Grid) -> int:
    """Return the number of the point that a key belongs to."""
    mask = (np.uint64(1) << np.uint64(grid.number_bits)) - np.uint64(1)
    return np.int64(key & mask)  # type: ignore[return-value]


@device
def in_one_cell(first: np.uint64, last: np.uint64, grid: Grid) -> bool:
    """Tell whether two keys have the same code."""
    changed: np.uint64 = (first ^ last) >> np.uint64(grid.number_bits)
    return changed == np.uint64(0)  # type: ignore[no-any-return]


@device
def _cell(offset: float, grid: Grid) -> np.uint64:
    """Return the cell of a coordinate."""
    last = float((1 << grid.axis_bits) - 1)
    return np.uint64(min(max(offset * grid.cells, 0.0), last))


@device
def _spread(value: np.uint64) -> np.uint64:
    """Return the lowest 21 bits of a number with two zeros between each and the next."""
    value = (value | value << np.uint64(32)) & np.uint64(0x001F00000000FFFF)
    value = (value | value << np.uint64(16)) & np.uint64(0x001F0000FF0000FF)
    value = (value | value << np.uint64(8)) & np.uint64(0x100F00F00F00F00F)
    value = (value | value << np.uint64(4)) & np.uint64(0x10C30C30C30C30C3)
    return (value | value << np.uint64(2)) & np.uint64(0x1249249249249249)
