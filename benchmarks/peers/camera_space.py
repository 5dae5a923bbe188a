"""A scene as other renderers want it: seen from the eye."""

import math
from collections.abc import Iterator
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vtray import Direction, Plane, Scene, Sphere, Vector
from vtray.geometry.vector import Vec, dot, scale, sub
from vtray.scene.placing.directions import camera_axes

CHUNK = 1 << 16


class Spheres(Protocol):
    """Spheres as a scene has them by the million: an array of each, or one value for all."""

    center: NDArray[np.floating]
    radius: ArrayLike
    color: ArrayLike
    lambert: float


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

    def formatted(self, line: str) -> Iterator[str]:
        """Write a line for each sphere, many at a time.

        Parameters
        ----------
        line
            Its text, with places for the centre, the radius and the reflectance from 0 to 1.
        """
        for start in range(0, len(self.spheres), CHUNK):
            part = slice(start, start + CHUNK)
            color = self.color[part] * (self.lambert / 255)
            numbers = np.hstack([self.spheres[part], color])
            yield line * len(numbers) % tuple(numbers.ravel().tolist())


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


def view_from_eye(scene: Scene, brightness: float) -> View:
    """Turn a scene to where its camera is.

    Parameters
    ----------
    scene
        The scene. All of it must lie before the image plane: other renderers have none.
    brightness
        What to multiply all intensities with. Other renderers have no exposure: 255 divided by
        the largest value of `vtray.Image.linear` makes their pictures as bright as vtray's.
    """
    camera = scene.camera
    forward = _unit(_triple(camera.normal))
    right, down = camera_axes(forward)
    eye = sub(_triple(camera.center), scale(camera.focus, forward))

    def turn(vector: Vec) -> Vec:
        return dot(vector, right), -dot(vector, down), dot(vector, forward)

    def surface(item: Sphere | Plane) -> Surface:
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
    one_by_one = [item for item in scene.objects if isinstance(item, Sphere | Plane)]
    surfaces = [surface(item) for item in one_by_one]
    many = [item for item in scene.objects if not isinstance(item, Sphere | Plane)]
    axes = np.array([right, scale(-1, down), forward])
    clouds = [_cloud(spheres, axes, np.array(eye)) for spheres in many]
    return View(int(width), int(height), *pixel, lights, surfaces, clouds)


def _cloud(given: Spheres, axes: NDArray[np.float64], eye: NDArray[np.float64]) -> Cloud:
    """Turn spheres to where the camera is."""
    count = len(given.center)
    spheres = np.empty((count, 4), np.float32)
    spheres[:, 3] = given.radius
    for start in range(0, count, CHUNK):
        part = slice(start, start + CHUNK)
        spheres[part, :3] = (given.center[part] - eye) @ axes.T
    color = np.broadcast_to(np.asarray(given.color, np.uint8), (count, 3))
    return Cloud(spheres, color, float(given.lambert))


def _towards_eye(normal: Vec, point: Vec) -> Vec:
    """Return the normal of a plane on the side of the eye, which is at the origin."""
    return sub((0.0, 0.0, 0.0), normal) if dot(normal, point) > 0 else normal


def _triple(vector: Vector | Direction) -> Vec:
    return vector.x, vector.y, vector.z


def _unit(vector: Vec) -> Vec:
    return scale(1 / math.hypot(*vector), vector)
