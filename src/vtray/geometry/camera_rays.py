"""The camera: its axes, and the ray through a pixel."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, add, dot, scale


class CameraFrame(NamedTuple):
    """A camera as kernels see it; the origin is the centre of the image plane.

    Attributes
    ----------
    eye
        Where the rays start: ``-focus * forward``; where they start side by side, that of the
        middle.
    right, down, forward
        The unit axes x', y', z' of the camera.
    focus
        The distance from there to the image plane.
    pixel
        From one pixel to the next across and down, and the distance from the eye, in a unit of
        their own: they only make directions, and must not vanish beside things that are huge.
    shift
        By how much the start of the ray moves from one pixel to the next, across and down.
    extent
        How far from the eye rays start at the most.
    width, height
        The size of the image in pixels.
    """

    eye: Vec
    right: Vec
    down: Vec
    forward: Vec
    focus: float
    pixel: Vec
    shift: tuple[float, float]
    extent: float
    width: int
    height: int


@device
def is_shifted(camera: CameraFrame) -> bool:
    """Tell whether rays start side by side, as in an orthographic view, not all at one place."""
    return camera.extent > 0.0


@device
def camera_ray(camera: CameraFrame, column: float, row: float) -> tuple[Vec, Vec]:
    """Return where the ray through a place in the image starts, minus the eye, and its direction.

    Parameters
    ----------
    camera
        The camera.
    column, row
        The place in pixels, from the left and from the top; that of a pixel itself are integers.

    Returns
    -------
    offset, direction
        The offset is 0 in perspective; the direction has length 1.
    """
    across = column - camera.width / 2
    below = row - camera.height / 2
    in_plane = add(
        scale(across * camera.pixel[0], camera.right), scale(below * camera.pixel[1], camera.down)
    )
    ray = _enlarged(add(in_plane, scale(camera.pixel[2], camera.forward)))
    length = math.sqrt(dot(ray, ray))
    offset = add(
        scale(across * camera.shift[0], camera.right), scale(below * camera.shift[1], camera.down)
    )
    return offset, (ray[0] / length, ray[1] / length, ray[2] / length)


@device
def _enlarged(ray: Vec) -> Vec:
    """Return a vector times a power of two, so that its squares do not vanish."""
    largest = max(abs(ray[0]), abs(ray[1]), abs(ray[2]))
    return scale(2.0**900 if largest < 2.0**-400 else 1.0, ray)
