"""Skies whose colour changes with the direction: maps of their light, as of the globe.

A map has nodes in rows from straight above to straight below, and in columns all around, as seen
from within from left to right; between nodes its light is interpolated. The outermost rows are
those next to them once more, and so is the last column the first.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, add, scale

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


RED, GREEN, BLUE = 0.2126, 0.7152, 0.0722
"""What the channels count for brightness: the luminance of ITU-R BT.709."""


class Brightness(NamedTuple):
    """Tables by which rays to skies are chosen where these are brighter than on average.

    How much brighter is interpolated between nodes as light is. A cell lies between four nodes.

    Attributes
    ----------
    share
        The share of rays that are chosen by it, 0 for a sky without a table, (skies,).
    level
        The brightness from which on a node counts, (skies,).
    total
        The last number of `rows`: times 2 pi over the columns the integral over all directions,
        (skies,).
    first_row, first_cell
        The places of the tables of each sky in those of all, (skies,).
    band
        For each row of cells, the part that it takes of an axis from 1 to -1 over its angle in
        radians: nearly the sine of its angle from the axis, (rows,).
    rows
        The sum of what cells count, times what their row takes of the axis, over all rows before
        each, and at last over all.
    cells
        For each row, the sums of what the cells before each count, and at last of all.
    """

    share: Floats
    level: Floats
    total: Floats
    first_row: Integers
    first_cell: Integers
    band: Floats
    rows: Floats
    cells: Floats


class Skies(NamedTuple):
    """Skies whose colour changes with the direction.

    Attributes
    ----------
    axes
        Three unit vectors of each: away from the middle of its map, to the left of it, and up,
        (skies, 9).
    columns, rows
        The columns and rows of each picture that maps are made of, (skies,). Of nodes there are
        one column more and two rows more.
    first
        The number of the first node of each, (skies,).
    light
        Red, green and blue of all nodes, 1 for the radiance of the light, (nodes, 3).
    bright
        The tables of those that are far brighter in places than on average.
    """

    axes: Floats
    columns: Integers
    rows: Integers
    first: Integers
    light: NDArray[np.float32]
    bright: Brightness


@device
def sky_axis(skies: Skies, sky: int, k: int) -> Vec:
    """Return one of the three axes of a sky."""
    axes = skies.axes
    return axes[sky, 3 * k], axes[sky, 3 * k + 1], axes[sky, 3 * k + 2]


@device
def light_at(skies: Skies, sky: int, across: float, down: float) -> Vec:
    """Return red, green and blue of a sky at a place of its map.

    Parameters
    ----------
    skies, sky
        The sky.
    across, down
        The place, counted in columns and rows of nodes from the first of them.
    """
    columns = skies.columns[sky]
    column = min(int(across), columns - 1)
    row = min(int(down), skies.rows[sky])
    x, y = across - column, down - row
    node = node_at(skies, sky, row, column)
    above = _between(skies, node, node + 1, x)
    below = _between(skies, node + columns + 1, node + columns + 2, x)
    return add(scale(1.0 - y, above), scale(y, below))


@device
def node_at(skies: Skies, sky: int, row: int, column: int) -> int:
    """Return the number of a node of a sky."""
    node: int = skies.first[sky] + row * (skies.columns[sky] + 1) + column
    return node


@device
def count_of(skies: Skies, bright: Brightness, sky: int, node: int) -> float:
    """Return how much brighter a node is than the level of its sky, at least 0."""
    red, green, blue = _light_of(skies, node)
    more: float = RED * red + GREEN * green + BLUE * blue - bright.level[sky]
    return max(more, 0.0)


@device
def _between(skies: Skies, left: int, right: int, x: float) -> Vec:
    """Return the light between two nodes."""
    return add(scale(1.0 - x, _light_of(skies, left)), scale(x, _light_of(skies, right)))


@device
def _light_of(skies: Skies, node: int) -> Vec:
    """Return the light of a node."""
    light = skies.light
    return np.float64(light[node, 0]), np.float64(light[node, 1]), np.float64(light[node, 2])
