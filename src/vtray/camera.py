"""The camera: its axes, and the ray through a pixel."""

import math
from typing import NamedTuple

from vtray.compiled import device
from vtray.vector import Vec, add, dot, scale, sub


class CameraFrame(NamedTuple):
    """A camera as kernels see it; the origin is the centre of the image plane.

    Attributes
    ----------
    eye
        Where the rays start: ``-focus * forward``.
    right, down, forward
        The unit axes x', y', z' of the camera.
    focus
        The distance from the eye to the image plane.
    pixel
        Width and height of one pixel, and the distance from the eye to it, in a unit of their own:
        they only make directions, and must not vanish beside things that are huge.
    width, height
        The size of the image in pixels.
    """

    eye: Vec
    right: Vec
    down: Vec
    forward: Vec
    focus: float
    pixel: Vec
    width: int
    height: int


def camera_axes(forward: Vec) -> tuple[Vec, Vec]:
    """Return the axes right and down for a camera that looks along the unit vector `forward`.

    They are (1, 0, 0) and (0, 1, 0), turned by the smallest rotation that takes (0, 0, 1) to
    `forward`; for (0, 0, -1) by 180 degrees about (0, 1, 0).

    References
    ----------
    Rodrigues' rotation formula, with ``1 / (1 + z)`` written as ``(1 - z) / (x*x + y*y)`` in the
    back half, where ``1 + z`` would lose digits.
    """
    x, y, z = forward
    if z >= 0.0:
        turn = 1.0 / (1.0 + z)
        return (1.0 - x * x * turn, -x * y * turn, -x), (-x * y * turn, 1.0 - y * y * turn, -y)
    side = math.hypot(x, y)
    if side == 0.0:
        return (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    a, b, turn = x / side, y / side, 1.0 - z
    return (1.0 - a * a * turn, -a * b * turn, -x), (-a * b * turn, 1.0 - b * b * turn, -y)


@device
def camera_ray(camera: CameraFrame, column: int, row: int) -> Vec:
    """Return the unit direction of the ray from the eye through a pixel."""
    across = (column - camera.width / 2) * camera.pixel[0]
    below = (row - camera.height / 2) * camera.pixel[1]
    in_plane = add(scale(across, camera.right), scale(below, camera.down))
    ray = add(in_plane, scale(camera.pixel[2], camera.forward))
    length = math.sqrt(dot(ray, ray))
    return ray[0] / length, ray[1] / length, ray[2] / length


@device
def left_side(camera: CameraFrame, column: int) -> Vec:
    """Return a normal of the plane in which the rays of a column lie, pointing left.

    It is not made of rays: at the edge of a very wide view, the parts of their directions that are
    needed here have lost their digits.
    """
    return _side(camera, (column - camera.width / 2) * camera.pixel[0], camera.right)


@device
def top_side(camera: CameraFrame, row: int) -> Vec:
    """Return a normal of the plane in which the rays of a row lie, pointing up."""
    return _side(camera, (row - camera.height / 2) * camera.pixel[1], camera.down)


@device
def _side(camera: CameraFrame, offset: float, axis: Vec) -> Vec:
    """Return what is square to ``offset * axis + distance * forward`` and to the third axis."""
    distance = camera.pixel[2]
    # Its squares must not vanish, so its length is from 1 to 2 unless nothing is left of it.
    longest = max(abs(offset), distance, 1e-300)
    return sub(scale(offset / longest, camera.forward), scale(distance / longest, axis))
