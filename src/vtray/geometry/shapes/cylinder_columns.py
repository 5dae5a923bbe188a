"""Cylinders as they are given, and in the order of the leaves of their hierarchy."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, input_array, kernel, pinned
from vtray.geometry.bvh.primitives import Boxes, Numbers
from vtray.geometry.shapes.cylinder import SIZE
from vtray.geometry.vector import Vec, add, scale, sub


class CylinderColumns(NamedTuple):
    """The cylinders as they are given.

    Attributes
    ----------
    start, end
        The ends of their axes in world space, (n, 3).
    radius
        (n,), or (1,) if all are the same.
    """

    start: NDArray[np.float64]
    end: NDArray[np.float64]
    radius: NDArray[np.float64]


class GivenCylinders:
    """What the builder is told of cylinders, and how these come into its order.

    Parameters
    ----------
    start, end
        The ends of their axes in world space, (n, 3).
    radius
        (n,), or (1,) if all are the same.
    """

    def __init__(self, start: NDArray[Any], end: NDArray[Any], radius: NDArray[Any]) -> None:
        self.count = len(start)
        self.data = np.empty(SIZE * len(start))
        self._data = pinned(self.data)
        columns = (input_array(column, np.float64) for column in (start, end, radius))
        self._given = pinned(CylinderColumns(*columns))

    def bound(self, begin: int, end: int, boxes: Boxes) -> None:
        """Set boxes to those of a range of cylinders."""
        bound_cylinders(self._given, begin, end, boxes)

    def gather(self, numbers: Numbers, slot: int, boxes: Boxes) -> None:
        """Bring cylinders to their slots, and set boxes to theirs."""
        gather_cylinders(self._given, numbers, slot, self._data, boxes)


@kernel
def bound_cylinders(given: CylinderColumns, begin: int, end: int, boxes: Boxes) -> None:
    """Set the first boxes to those of a range of cylinders."""
    for k in range(end - begin):
        _set_box(given, begin + k, boxes, k)


@kernel
def gather_cylinders(
    given: CylinderColumns, numbers: Numbers, slot: int, data: NDArray[np.float64], boxes: Boxes
) -> None:
    """Copy cylinders to their slots, and set the first boxes to theirs."""
    for k in range(numbers.shape[0]):
        number, place = numbers[k], SIZE * (slot + k)
        for axis in range(3):
            data[place + axis] = given.start[number, axis]
            data[place + 3 + axis] = given.end[number, axis]
        data[place + 6] = radius_of(given.radius, number)
        _set_box(given, number, boxes, k)


@device
def radius_of(column: NDArray[np.float64], number: int) -> float:
    """Return one of some radii, of which there may be one for all."""
    radius: float = column[number if column.shape[0] > 1 else 0]
    return radius


@device
def _set_box(given: CylinderColumns, number: int, boxes: Boxes, k: int) -> None:
    """Set a box to that of a cylinder, which is that of the discs at its ends."""
    start, end = half_point(given.start, number), half_point(given.end, number)
    center, half = add(start, end), sub(end, start)
    radius = radius_of(given.radius, number)
    # In parts of the largest, so that no square overflows.
    largest = max(abs(half[0]), abs(half[1]), abs(half[2]))
    x, y, z = scale(1.0 / largest, half) if largest > 0.0 else (1.0, 1.0, 1.0)
    length2 = x * x + y * y + z * z
    boxes[0, k], boxes[1, k], boxes[2, k] = center
    boxes[3, k] = abs(half[0]) + radius * math.sqrt((y * y + z * z) / length2)
    boxes[4, k] = abs(half[1]) + radius * math.sqrt((x * x + z * z) / length2)
    boxes[5, k] = abs(half[2]) + radius * math.sqrt((x * x + y * y) / length2)


@device
def half_point(points: NDArray[np.float64], k: int) -> Vec:
    """Return half of a point, as sums and differences of whole ones could overflow."""
    return 0.5 * points[k, 0], 0.5 * points[k, 1], 0.5 * points[k, 2]
