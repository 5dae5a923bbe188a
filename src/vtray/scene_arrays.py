"""The scene as arrays: what the kernels read.

Lengths are divided by a power of two, which changes no digit, so that the largest is about 2**200.
Then no square of a square overflows, not even at points a billion times farther away, and those of
parts 1e130 times smaller do not vanish. The origin moves to the centre of the image plane, so that
a scene far from the world's origin loses no digits. The spheres, which can be many, stay in world
space in memory; each is brought into this space where it is used.
"""

import math
import sys
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.acceleration import Acceleration
from vtray.bvh import Bvh, no_bvh
from vtray.camera import CameraFrame, camera_axes
from vtray.compiled import device
from vtray.directions import unit as unit_vector
from vtray.directions import view_axes
from vtray.scene import Camera, Plane, Scene, Vector
from vtray.sphere_arrays import SphereArrays
from vtray.vector import Vec

Floats = NDArray[np.float64]

FARTHEST_START = 2.0**30
"""Rays start no farther before the image plane than so many times its width and height.

An eye that is farther away sees the scene along rays that differ by less than 1e-9: they start side
by side, where they pass a plane nearby. Started at the eye, rounding would move what they meet, and
lose what is near the image plane: from 1e15 times the size of the scene on, all of it.
"""

LARGEST_RATIO = 2.0**100
"""Spheres so tiny beside all else that this is exceeded are traced without their hierarchy."""


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


class Packed(NamedTuple):
    """The arrays of a scene, and what leads back from them to the scene.

    Attributes
    ----------
    arrays
        What the kernels read.
    unit
        Length in scene units of length 1 in the arrays, a power of two.
    before
        Length in scene units of each ray from the eye to where it starts in the arrays.
    """

    arrays: SceneArrays
    unit: float
    before: float


def pack(scene: Scene, kept: Acceleration) -> Packed:
    """Return the arrays of a scene, whose spheres are ready for tracing."""
    planes = [item for item in scene.objects if isinstance(item, Plane)]
    unit = _unit_length(scene, planes, kept)
    camera = _pack_camera(scene.camera, unit)
    origin = _points([scene.camera.center], unit)[0]
    x, y, z = map(float, origin)
    to_boxes = _pack_to_boxes(kept, (x, y, z), unit)
    arrays = SceneArrays(
        camera,
        SphereArrays(*kept.leaves, 1.0 / unit, (x, y, z)),
        kept.bvh if to_boxes.ratio < LARGEST_RATIO else no_bvh(),
        to_boxes,
        _pack_planes(planes, origin, unit, camera),
        _pack_lights(scene, origin, unit, camera),
        _pack_materials(kept, planes),
    )
    return Packed(arrays, unit, scene.camera.focus - start_distance(scene.camera))


def start_distance(camera: Camera) -> float:
    """Return how far before the image plane rays start, in scene units."""
    across, below = (n * length for n, length in zip(camera.size, camera.resolution, strict=True))
    view = across + below
    return camera.focus if camera.focus <= FARTHEST_START * view else view


def _exponent(value: float) -> int:
    """Return the smallest e with abs(value) < 2**e, very low for 0."""
    return math.frexp(value)[1] if value else -2000


def _unit_length(scene: Scene, planes: list[Plane], kept: Acceleration) -> float:
    """Return the power of two by which the lengths of a scene are divided."""
    camera = scene.camera
    places = [camera.center, *(plane.center for plane in planes)]
    places += [light.location for light in scene.lights]
    coordinates = max(max(abs(p.x), abs(p.y), abs(p.z)) for p in places)
    highest = max(_start_exponent(camera), _exponent(coordinates), _exponent(kept.largest))
    # The unit itself and its inverse must be ordinary doubles.
    return math.ldexp(1.0, max(highest - 200, -1000))


def _start_exponent(camera: Camera) -> int:
    """Return an e with all coordinates below 2**e at which rays start, and not far below."""
    start = start_distance(camera)
    together = camera.projection != "orthographic" and start == camera.focus
    return _exponent(start) if together else max(_exponent(start), _view_exponent(camera))


def _view_exponent(camera: Camera) -> int:
    """Return an e with width and height of the view below 2**e, and the larger not far below."""
    return max(
        _exponent(camera.resolution[0]) + _exponent(camera.size[0]),
        _exponent(camera.resolution[1]) + _exponent(camera.size[1]),
    )


def _pack_camera(camera: Camera, unit: float) -> CameraFrame:
    """Return the camera's frame, lengths in units."""
    forward = unit_vector(camera.normal)
    if camera.up is None:
        right, down = camera_axes(forward)
    else:
        right, down = view_axes(forward, unit_vector(camera.up))
    start = start_distance(camera)
    focus = start / unit
    width, height = camera.resolution
    if camera.projection == "orthographic":
        share, pixel = 1.0, (0.0, 0.0, 1.0)
    else:
        # How much of the way from the eye to the image plane lies before the start of the rays.
        share = 1.0 - start / camera.focus
        pixel = _pack_pixel(camera)
    shift = share * width / unit, share * height / unit
    extent = camera.size[0] * shift[0] + camera.size[1] * shift[1]
    return CameraFrame(
        eye=(-focus * forward[0], -focus * forward[1], -focus * forward[2]),
        right=right,
        down=down,
        forward=forward,
        focus=focus,
        pixel=pixel,
        shift=shift,
        extent=extent,
        width=int(camera.size[0]),
        height=int(camera.size[1]),
    )


def _pack_pixel(camera: Camera) -> Vec:
    """Return a pixel's width and height and the focus, in a unit in which they make directions."""
    # Far above 1, so that what is far smaller keeps its digits.
    own = 500 - max(_view_exponent(camera), _exponent(camera.focus))
    width, height = (math.ldexp(length, own) for length in camera.resolution)
    # Not 0: there is a ray in the middle, however near the eye is.
    return width, height, max(math.ldexp(camera.focus, own), sys.float_info.min)


def _pack_to_boxes(kept: Acceleration, origin: Vec, unit: float) -> ToBoxes:
    """Return what leads to the space of the boxes."""
    ratio = kept.frame.scale * unit
    (x, y, z), (a, b, c) = origin, kept.frame.origin
    return ToBoxes(ratio, (x * ratio - a, y * ratio - b, z * ratio - c))


def _pack_materials(kept: Acceleration, planes: list[Plane]) -> Materials:
    """Return the materials of all primitives."""
    colors = [(plane.color.r, plane.color.g, plane.color.b) for plane in planes]
    return Materials(
        kept.source.color,
        kept.source.lambert,
        np.array(colors, np.uint8).reshape(-1, 3),
        np.array([plane.lambert for plane in planes], float),
    )


def _pack_planes(planes: list[Plane], origin: Floats, unit: float, camera: CameraFrame) -> Planes:
    """Return the arrays of all planes."""
    points = _points([plane.center for plane in planes], unit) - origin
    normals = np.array([unit_vector(plane.normal) for plane in planes], np.float64).reshape(-1, 3)
    x, y, z = _columns(normals)
    from_eye = points - np.array(camera.eye)
    return Planes(
        x,
        y,
        z,
        offset=_dot(points.T, (x, y, z)),
        height=_dot(from_eye.T, (x, y, z)),
        magnitude=np.abs(points).sum(axis=1),
    )


def _pack_lights(scene: Scene, origin: Floats, unit: float, camera: CameraFrame) -> Lights:
    """Return the arrays of all lights."""
    points = _points([light.location for light in scene.lights], unit) - origin
    x, y, z = _columns(points)
    magnitude = np.abs(points).sum(axis=1)
    return Lights(
        x,
        y,
        z,
        depth=_dot((x, y, z), camera.forward),
        intensity=np.array([light.intensity for light in scene.lights], float),
        magnitude=magnitude,
        world_magnitude=magnitude + np.abs(origin).sum(),
    )


def _points(places: list[Vector], unit: float) -> Floats:
    """Return places as an (n, 3) array, lengths in units."""
    return np.array([(p.x, p.y, p.z) for p in places], float).reshape(-1, 3) / unit


def _columns(rows: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the columns of an (n, 3) array, each contiguous."""
    columns = np.ascontiguousarray(rows.T)
    return columns[0], columns[1], columns[2]


def _dot(a: Sequence[Floats] | Floats, b: Sequence[Floats] | Vec) -> Floats:
    """Return the scalar products of vectors, each given as its three coordinates."""
    products: Floats = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return products
