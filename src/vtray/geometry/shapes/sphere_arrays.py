"""The spheres as kernels see them: in world space in memory, in the kernels' space where used."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, magnitude, scale, sub


class SphereArrays(NamedTuple):
    """The spheres in the order of the leaves of the hierarchy.

    The place of a sphere in this order is its slot; its number is that in the scene.

    Attributes
    ----------
    data
        x, y, z of the centre and the radius of each sphere, side by side, in world space, (4 * n,).
    number
        The number of each sphere, (n,).
    scale, origin
        What leads to the kernels' space: ``world * scale - origin``.
    """

    data: NDArray[np.float64]
    number: NDArray[np.int32]
    scale: float
    origin: Vec


@device
def sphere_count(spheres: SphereArrays) -> int:
    """Return how many spheres there are."""
    count: int = spheres.number.shape[0]
    return count


@device
def sphere_center(spheres: SphereArrays, slot: int) -> Vec:
    """Return a sphere's centre in the kernels' space."""
    data = spheres.data
    center = data[4 * slot], data[4 * slot + 1], data[4 * slot + 2]
    return sub(scale(spheres.scale, center), spheres.origin)


@device
def sphere_radius(spheres: SphereArrays, slot: int) -> float:
    """Return a sphere's radius in the kernels' space."""
    radius: float = spheres.data[4 * slot + 3] * spheres.scale
    return radius


@device
def sphere_magnitude(center: Vec, radius: float) -> float:
    """Return what the rounding errors of a sphere are relative to."""
    return magnitude(center) + radius
