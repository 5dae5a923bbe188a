"""From the rectangle lamps of a scene to the numbers that kernels read of them."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from vtray.base.exact_math import hypotenuse
from vtray.scene.light_types import RectangleLight
from vtray.scene.placing.directions import Vec, along, cross, dot, unit
from vtray.scene.vectors import Vector
from vtray.transport.lights.rectangle import SIZE, Rectangles

Floats = NDArray[np.float64]

SHORTEST = 2.0**-260
"""Half of the shortest edge, in units: a point beside all else, of which products can be had."""


def pack_rectangle(light: RectangleLight, length: float) -> Floats:
    """Return the numbers of a rectangle, (SIZE,); `length` is that of a unit."""
    one, other = light.edges
    across = unit(one)
    # Twice: the first time may leave a part along the other edge that rounding made.
    up = unit(Vector(*_square_to(across, unit(other))))
    up = unit(Vector(*_square_to(across, up)))
    half = [max(0.5 * _length(edge, length), SHORTEST) for edge in light.edges]
    return np.array([*across, *up, *cross(across, up), *half])


def join_rectangles(count: int, rectangles: Mapping[int, Floats]) -> Rectangles:
    """Return the rectangles among so many lights, by their number."""
    data = np.zeros((count, SIZE))
    for k, numbers in rectangles.items():
        data[k] = numbers
    return Rectangles(data.reshape(-1))


def _square_to(axis: Vec, vector: Vec) -> Vec:
    """Return what of a vector is square to a unit vector."""
    return along(vector, -dot(vector, axis), axis)


def _length(edge: Vector, unit_length: float) -> float:
    """Return the length of an edge in units."""
    return hypotenuse(edge.x / unit_length, edge.y / unit_length, edge.z / unit_length)
