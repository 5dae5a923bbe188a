"""A scene as other renderers want it: seen from the eye."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from cube import LAMBERT, Cube
from numpy.typing import NDArray

from vtray import Direction, Scene, Sphere, Vector
from vtray.camera import camera_axes
from vtray.scene import Object
from vtray.vector import Vec, dot, scale, sub

CHUNK = 1 << 16


class Surface(NamedTuple):
    """An object.

    Attributes
    ----------
    center
        The centre of a sphere, any point of a plane.
    shape
        The radius of a sphere, or the unit normal of a plane on the side of the eye.
    color
        Reflectance from 0 to 1: the colour times the Lambert coefficient.
    """

    center: Vec
    shape: float | Vec
    color: Vec


class Cloud(NamedTuple):
    """Spheres by the million.

    Attributes
    ----------
    spheres
        Centre and radius of each, (n, 4).
    color
        The colour of each, (n, 3), from 0 to 255.
    lambert
        The Lambert coefficient of all.
    """

    spheres: NDArray[np.float32]
    color: NDArray[np.uint8]
    lambert: float


class View(NamedTuple):
    """A scene in camera space: the eye at the origin, x to the right, y up, z forward.

    These axes are left-handed, as are those of POV-Ray and Tachyon.

    Attributes
    ----------
    width, height
        Size of the image in pixels.
    pixel_width, pixel_height
        Size of a pixel at distance 1 from the eye.
    lights
        Where each light is, and its intensity.
    surfaces
        The objects.
    clouds
        Spheres that are given as arrays.
    """

    width: int
    height: int
    pixel_width: float
    pixel_height: float
    lights: list[tuple[Vec, float]]
    surfaces: list[Surface]
    clouds: list[Cloud]


def view_from_eye(scene: Scene, brightness: float, cubes: Sequence[Cube] = ()) -> View:
    """Turn a scene to where its camera is.

    Parameters
    ----------
    scene
        The scene. All of it must lie before the image plane: other renderers have none.
    brightness
        What to multiply all intensities with. Other renderers have no exposure: 255 divided by
        the largest value of `vtray.Image.linear` makes their pictures as bright as vtray's.
    cubes
        Spheres of the scene that are given as arrays.
    """
    camera = scene.camera
    forward = _unit(_triple(camera.normal))
    right, down = camera_axes(forward)
    eye = sub(_triple(camera.center), scale(camera.focus, forward))

    def turn(vector: Vec) -> Vec:
        return dot(vector, right), -dot(vector, down), dot(vector, forward)

    def surface(item: Object) -> Surface:
        center = turn(sub(_triple(item.center), eye))
        color = scale(item.lambert / 255, (item.color.r, item.color.g, item.color.b))
        if isinstance(item, Sphere):
            return Surface(center, item.radius, color)
        return Surface(center, _towards_eye(turn(_unit(_triple(item.normal))), center), color)

    lights = [
        (turn(sub(_triple(light.location), eye)), light.intensity * brightness)
        for light in scene.lights
    ]
    (width, height), (pixel_width, pixel_height) = camera.size, camera.resolution
    pixel = pixel_width / camera.focus, pixel_height / camera.focus
    surfaces = [surface(item) for item in scene.objects]
    axes = np.array([right, scale(-1, down), forward])
    clouds = [_cloud(cube, axes, np.array(eye)) for cube in cubes]
    return View(int(width), int(height), *pixel, lights, surfaces, clouds)


def _cloud(cube: Cube, axes: NDArray[np.float64], eye: NDArray[np.float64]) -> Cloud:
    """Turn spheres to where the camera is."""
    spheres = np.empty((len(cube.center), 4), np.float32)
    spheres[:, 3] = cube.radius
    for start in range(0, len(spheres), CHUNK):
        part = slice(start, start + CHUNK)
        spheres[part, :3] = (cube.center[part] - eye) @ axes.T
    return Cloud(spheres, cube.color, LAMBERT)


def _towards_eye(normal: Vec, point: Vec) -> Vec:
    """Return the normal of a plane on the side of the eye, which is at the origin."""
    return sub((0.0, 0.0, 0.0), normal) if dot(normal, point) > 0 else normal


def _triple(vector: Vector | Direction) -> Vec:
    return vector.x, vector.y, vector.z


def _unit(vector: Vec) -> Vec:
    return scale(1 / math.hypot(*vector), vector)
