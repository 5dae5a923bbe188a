"""The scene as arrays: what the kernels read.

Lengths are divided by a power of two, which changes no digit, so that the largest is about 2**200.
Then no square of a square overflows, not even at points a billion times farther away, and those of
parts 1e130 times smaller do not vanish. The origin moves to the centre of the image plane, so that
a scene far from the world's origin loses no digits. Spheres behind the image plane are left out.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.camera import CameraFrame, camera_axes
from vtray.rounding import ROUNDING
from vtray.scene import Camera, Direction, Plane, Scene, Sphere, Vector
from vtray.vector import Vec

Floats = NDArray[np.float64]


class Spheres(NamedTuple):
    """Centres, radii, and the magnitudes that rounding errors are relative to, all (n,)."""

    x: Floats
    y: Floats
    z: Floats
    radius: Floats
    magnitude: Floats


class Planes(NamedTuple):
    """Unit normals, signed distances from the origin and from the eye, magnitudes, all (n,)."""

    x: Floats
    y: Floats
    z: Floats
    offset: Floats
    height: Floats
    magnitude: Floats


class Lights(NamedTuple):
    """Places, distances in front of the image plane, intensities, magnitudes, all (n,)."""

    x: Floats
    y: Floats
    z: Floats
    depth: Floats
    intensity: Floats
    magnitude: Floats


class Materials(NamedTuple):
    """Colours from 0 to 255 and Lambert coefficients of the primitives, all (n,)."""

    red: Floats
    green: Floats
    blue: Floats
    lambert: Floats


class SceneArrays(NamedTuple):
    """A scene as kernels see it.

    Primitives are numbered: the spheres first, then the planes. At exactly the same distance the
    lower number is hit.
    """

    camera: CameraFrame
    spheres: Spheres
    planes: Planes
    lights: Lights
    materials: Materials


class Packed(NamedTuple):
    """The arrays of a scene, and what leads back from them to the scene.

    Attributes
    ----------
    arrays
        What the kernels read.
    unit
        Length in scene units of length 1 in the arrays, a power of two.
    objects
        The place in ``scene.objects`` of each primitive, (n,).
    """

    arrays: SceneArrays
    unit: float
    objects: NDArray[np.int64]


def pack(scene: Scene) -> Packed:
    """Return the arrays of a scene."""
    spheres = [(k, item) for k, item in enumerate(scene.objects) if isinstance(item, Sphere)]
    planes = [(k, item) for k, item in enumerate(scene.objects) if isinstance(item, Plane)]
    unit = _unit_length(scene)
    camera = _pack_camera(scene.camera, unit)
    origin = _points([scene.camera.center], unit)[0]

    sphere_arrays = _pack_spheres([item for _, item in spheres], origin, unit)
    seen = _in_front(sphere_arrays, camera)
    kept = [spheres[k] for k in np.flatnonzero(seen)]
    items = [item for _, item in kept + planes]
    colors = np.array([(c.color.r, c.color.g, c.color.b) for c in items], float).reshape(-1, 3)
    arrays = SceneArrays(
        camera,
        Spheres(*(column[seen] for column in sphere_arrays)),
        _pack_planes([item for _, item in planes], origin, unit, camera),
        _pack_lights(scene, origin, unit, camera),
        Materials(*_columns(colors), np.array([item.lambert for item in items], float)),
    )
    return Packed(arrays, unit, np.array([k for k, _ in kept + planes], np.int64))


def unit_vector(vector: Direction) -> Vec:
    """Return a vector of any length, not all zero, scaled to length 1."""
    # A power of two first: squares of tiny and of huge numbers would be lost.
    exponent = max(_exponent(vector.x), _exponent(vector.y), _exponent(vector.z))
    x, y, z = (math.ldexp(value, -exponent) for value in (vector.x, vector.y, vector.z))
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def _exponent(value: float) -> int:
    """Return the smallest e with abs(value) < 2**e, very low for 0."""
    return math.frexp(value)[1] if value else -2000


def _unit_length(scene: Scene) -> float:
    """Return the power of two by which the lengths of a scene are divided."""
    camera = scene.camera
    places = [camera.center, *(item.center for item in scene.objects)]
    places += [light.location for light in scene.lights]
    coordinates = max(max(abs(p.x), abs(p.y), abs(p.z)) for p in places)
    radii = (item.radius for item in scene.objects if isinstance(item, Sphere))
    highest = max(
        _camera_exponent(camera), _exponent(coordinates), _exponent(max(radii, default=0.0))
    )
    # The unit itself and its inverse must be ordinary doubles.
    return math.ldexp(1.0, max(highest - 200, -1000))


def _camera_exponent(camera: Camera) -> int:
    """Return an e with all lengths of a camera below 2**e, and the largest not far below."""
    return max(
        _exponent(camera.focus),
        _exponent(camera.resolution[0]) + _exponent(camera.size[0]),
        _exponent(camera.resolution[1]) + _exponent(camera.size[1]),
    )


def _pack_camera(camera: Camera, unit: float) -> CameraFrame:
    """Return the camera's frame, lengths in units."""
    forward = unit_vector(camera.normal)
    right, down = camera_axes(forward)
    focus = camera.focus / unit
    own = -_camera_exponent(camera)
    width, height = camera.resolution
    return CameraFrame(
        eye=(-focus * forward[0], -focus * forward[1], -focus * forward[2]),
        right=right,
        down=down,
        forward=forward,
        focus=focus,
        pixel=(math.ldexp(width, own), math.ldexp(height, own), math.ldexp(camera.focus, own)),
        width=int(camera.size[0]),
        height=int(camera.size[1]),
    )


def _pack_spheres(spheres: list[Sphere], origin: Floats, unit: float) -> Spheres:
    """Return the arrays of all spheres."""
    centers = _points([sphere.center for sphere in spheres], unit) - origin
    radius = np.array([sphere.radius for sphere in spheres], float) / unit
    return Spheres(*_columns(centers), radius, np.abs(centers).sum(axis=1) + radius)


def _in_front(spheres: Spheres, camera: CameraFrame) -> NDArray[np.bool_]:
    """Tell which spheres reach in front of the image plane, or so near that rounding decides."""
    nearest = _dot(spheres[:3], camera.forward) + spheres.radius
    return nearest >= -ROUNDING * (spheres.magnitude + camera.focus)


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
    return Lights(
        x,
        y,
        z,
        depth=_dot((x, y, z), camera.forward),
        intensity=np.array([light.intensity for light in scene.lights], float),
        magnitude=np.abs(points).sum(axis=1),
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
