"""Spheres as they are given, and in the order of the leaves of their hierarchy."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, input_array, kernel, pinned
from vtray.geometry.bvh.primitives import Boxes, Numbers
from vtray.geometry.vector import Vec


class SphereColumns(NamedTuple):
    """The spheres as they are given.

    Of two kinds of numbers, so that nobody waits for kernels of the other kind: one array holds the
    centres, and the other none.

    Attributes
    ----------
    center
        World space, (n, 3), or (0, 3) if they are single.
    single
        The same of numbers of single precision, (0, 3) or (n, 3).
    radius
        (n,), or (1,) if all are the same.
    """

    center: NDArray[np.float64]
    single: NDArray[np.float32]
    radius: NDArray[np.float64]


class GivenSpheres:
    """What the builder is told of spheres, and how these come into its order.

    Parameters
    ----------
    center
        World space, (n, 3), float32 or float64; copied only if it must be.
    radius
        (n,), or (1,) if all are the same.
    """

    def __init__(self, center: NDArray[Any], radius: NDArray[Any]) -> None:
        single = center.dtype == np.float32
        self.count = len(center)
        self.data = np.empty(4 * len(center))
        self._data = pinned(self.data)
        self._given = pinned(
            SphereColumns(
                input_array(center[:0] if single else center, np.float64),
                input_array(center if single else center[:0], np.float32),
                input_array(radius, np.float64),
            )
        )

    def bound(self, begin: int, end: int, boxes: Boxes) -> None:
        """Set boxes to those of a range of spheres."""
        bound_spheres(self._given, begin, end, boxes)

    def gather(self, numbers: Numbers, slot: int, boxes: Boxes) -> None:
        """Bring spheres to their slots, and set boxes to theirs."""
        gather_spheres(self._given, numbers, slot, self._data, boxes)


@kernel
def bound_spheres(given: SphereColumns, begin: int, end: int, boxes: Boxes) -> None:
    """Set the first boxes to those of a range of spheres."""
    for k in range(end - begin):
        boxes[0, k], boxes[1, k], boxes[2, k] = _center(given, begin + k)
    step = 0 if given.radius.shape[0] == 1 else 1
    for k in range(end - begin):
        radius = given.radius[(begin + k) * step]
        boxes[3, k], boxes[4, k], boxes[5, k] = radius, radius, radius


@kernel
def gather_spheres(
    given: SphereColumns, numbers: Numbers, slot: int, data: NDArray[np.float64], boxes: Boxes
) -> None:
    """Copy spheres to their slots, and set the first boxes to theirs."""
    # Two loops: most loads of the first miss all caches, and the less else there is to do, the more
    # of them the processor has under way at a time.
    step = 0 if given.radius.shape[0] == 1 else 1
    for k in range(numbers.shape[0]):
        place, center = 4 * (slot + k), _center(given, numbers[k])
        data[place], data[place + 1], data[place + 2] = center
        data[place + 3] = given.radius[numbers[k] * step]
    for k in range(numbers.shape[0]):
        place = 4 * (slot + k)
        boxes[0, k], boxes[1, k], boxes[2, k] = data[place], data[place + 1], data[place + 2]
        radius = data[place + 3]
        boxes[3, k], boxes[4, k], boxes[5, k] = radius, radius, radius


@device
def _center(given: SphereColumns, number: int) -> Vec:
    """Return the centre of a sphere in world space."""
    center, single = given.center, given.single
    if single.shape[0] > 0:
        return float(single[number, 0]), float(single[number, 1]), float(single[number, 2])
    return center[number, 0], center[number, 1], center[number, 2]
