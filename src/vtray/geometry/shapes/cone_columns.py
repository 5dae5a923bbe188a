"""Cones as they are given, and in the order of the leaves of their hierarchy."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, input_array, kernel, pinned
from vtray.geometry.bvh.primitives import Boxes, Numbers
from vtray.geometry.shapes.cone import SIZE
from vtray.geometry.shapes.cylinder_columns import half_point, radius_of
from vtray.geometry.vector import add, lower, scale, sub, upper


class ConeColumns(NamedTuple):
    """The cones as they are given.

    Attributes
    ----------
    start, end
        The ends of their axes in world space, (n, 3).
    radius, radius_end
        Those at their starts and at their ends, (n,), or (1,) if all are the same.
    """

    start: NDArray[np.float64]
    end: NDArray[np.float64]
    radius: NDArray[np.float64]
    radius_end: NDArray[np.float64]


class GivenCones:
    """What the builder is told of cones, and how these come into its order.

    Parameters
    ----------
    start, end
        The ends of their axes in world space, (n, 3).
    radius, radius_end
        Those at their starts and at their ends, (n,), or (1,) if all are the same.
    """

    def __init__(
        self,
        start: NDArray[Any],
        end: NDArray[Any],
        radius: NDArray[Any],
        radius_end: NDArray[Any],
    ) -> None:
        self.count = len(start)
        self.data = np.empty(SIZE * len(start))
        self._data = pinned(self.data)
        columns = (input_array(column, np.float64) for column in (start, end, radius, radius_end))
        self._given = pinned(ConeColumns(*columns))

    def bound(self, begin: int, end: int, boxes: Boxes) -> None:
        """Set boxes to those of a range of cones."""
        bound_cones(self._given, begin, end, boxes)

    def gather(self, numbers: Numbers, slot: int, boxes: Boxes) -> None:
        """Bring cones to their slots, and set boxes to theirs."""
        gather_cones(self._given, numbers, slot, self._data, boxes)


@kernel
def bound_cones(given: ConeColumns, begin: int, end: int, boxes: Boxes) -> None:
    """Set the first boxes to those of a range of cones."""
    for k in range(end - begin):
        _set_box(given, begin + k, boxes, k)


@kernel
def gather_cones(
    given: ConeColumns, numbers: Numbers, slot: int, data: NDArray[np.float64], boxes: Boxes
) -> None:
    """Copy cones to their slots, and set the first boxes to theirs."""
    for k in range(numbers.shape[0]):
        number, place = numbers[k], SIZE * (slot + k)
        for axis in range(3):
            data[place + axis] = given.start[number, axis]
            data[place + 3 + axis] = given.end[number, axis]
        data[place + 6] = radius_of(given.radius, number)
        data[place + 7] = radius_of(given.radius_end, number)
        _set_box(given, number, boxes, k)


@device
def _set_box(given: ConeColumns, number: int, boxes: Boxes, k: int) -> None:
    """Set a box to that of a cone, which is that of the discs at its ends."""
    start, end = half_point(given.start, number), half_point(given.end, number)
    way = sub(end, start)
    # In parts of the largest, so that no square overflows.
    largest = max(abs(way[0]), abs(way[1]), abs(way[2]))
    x, y, z = scale(1.0 / largest, way) if largest > 0.0 else (1.0, 1.0, 1.0)
    length2 = x * x + y * y + z * z
    disc = (
        math.sqrt((y * y + z * z) / length2),
        math.sqrt((x * x + z * z) / length2),
        math.sqrt((x * x + y * y) / length2),
    )
    first = scale(0.5 * radius_of(given.radius, number), disc)
    last = scale(0.5 * radius_of(given.radius_end, number), disc)
    low, high = lower(sub(start, first), sub(end, last)), upper(add(start, first), add(end, last))
    boxes[0, k], boxes[1, k], boxes[2, k] = add(low, high)
    boxes[3, k], boxes[4, k], boxes[5, k] = sub(high, low)
