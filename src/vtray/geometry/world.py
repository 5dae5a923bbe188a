"""The scene as arrays: what the kernels read.

Lengths are divided by a power of two, which changes no digit, so that the largest is about 2**200.
Then no square of a square overflows, not even at points a billion times farther away, and those of
parts 1e130 times smaller do not vanish. The origin moves to the centre of the image plane, so that
a scene far from the world's origin loses no digits. The spheres, which can be many, stay in world
space in memory; each is brought into this space where it is used.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.tree import Bvh
from vtray.geometry.camera_rays import CameraFrame
from vtray.geometry.shapes.sphere_arrays import SphereArrays
from vtray.geometry.vector import Vec

Floats = NDArray[np.float64]


class Planes(NamedTuple):
    """Unit normals, signed distances from the origin and from the eye, magnitudes, all (n,)."""

    x: Floats
    y: Floats
    z: Floats
    offset: Floats
    height: Floats
    magnitude: Floats


class Lights(NamedTuple):
    """Places, distances in front of the image plane, intensities, magnitudes, all (n,).

    The magnitude in world space is what the rounding of a light's place is relative to where it was
    worked out, by hand or by a program, before it came here.
    """

    x: Floats
    y: Floats
    z: Floats
    depth: Floats
    intensity: Floats
    magnitude: Floats
    world_magnitude: Floats


class Materials(NamedTuple):
    """Colours, (n, 3), and Lambert coefficients, (n,).

    They go by the numbers of the primitives; for spheres, one row may stand for all.
    """

    sphere_color: NDArray[np.uint8]
    sphere_lambert: Floats
    plane_color: NDArray[np.uint8]
    plane_lambert: Floats


class ToBoxes(NamedTuple):
    """What leads from the kernels' space to that of the boxes: ``point * ratio + offset``."""

    ratio: float
    offset: Vec


class SceneArrays(NamedTuple):
    """A scene as kernels see it.

    Primitives are numbered: the spheres first, then the planes. At exactly the same distance the
    lower number is hit.
    """

    camera: CameraFrame
    spheres: SphereArrays
    bvh: Bvh
    to_boxes: ToBoxes
    planes: Planes
    lights: Lights
    materials: Materials


@device
def has_bvh(scene: SceneArrays) -> bool:
    """Tell whether the spheres of a scene have a hierarchy."""
    nodes: int = scene.bvh.child.shape[0]
    return nodes > 0
