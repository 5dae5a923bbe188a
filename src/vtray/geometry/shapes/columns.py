"""The numbers that shapes are made of, and where they stand."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, add, scale, sub


class Columns(NamedTuple):
    """All shapes of one kind, in the order of the leaves of their hierarchies.

    The place of a shape in this order is its slot; its number is that in the scene.

    Attributes
    ----------
    data
        The numbers of each shape, side by side, lengths and places in world space, (size * n,).
    number
        The number of each shape, (n,).
    """

    data: NDArray[np.float64]
    number: NDArray[np.int32]


class Place(NamedTuple):
    """Where shapes stand: what leads from their columns to the kernels' space.

    Attributes
    ----------
    shift
        By how much they are moved, in world space.
    scale, origin
        From there to the kernels' space: ``world * scale - origin``.
    """

    shift: Vec
    scale: float
    origin: Vec


@device
def world_point(columns: Columns, first: int, place: Place) -> Vec:
    """Return the point that begins at a place of the columns, in world space."""
    data = columns.data
    return add((data[first], data[first + 1], data[first + 2]), place.shift)


@device
def to_kernels(point: Vec, place: Place) -> Vec:
    """Return a point of world space in the kernels' space."""
    return sub(scale(place.scale, point), place.origin)
