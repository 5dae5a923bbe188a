"""The camera as kernels see it, and the ray through a place in the image."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    COLUMN,
    DIRECTION,
    FORWARD,
    ORIGIN,
    ROW,
    Packet,
    Sheaf,
    load,
    start_apart,
    store,
)
from vtray.geometry.ray import Ray
from vtray.geometry.vector import Vec, add, dot, scale


class CameraFrame(NamedTuple):
    """A camera as kernels see it; the origin is the centre of the image plane.

    Attributes
    ----------
    eye
        Where the rays start: ``-image_distance * forward``; where they start side by side, that
        of the middle.
    right, down, forward
        The unit axes x', y', z' of the camera.
    image_distance
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
    image_distance: float
    pixel: Vec
    shift: tuple[float, float]
    extent: float
    width: int
    height: int


@device
def sheaf_of(camera: CameraFrame) -> Sheaf:
    """Return what all rays of a camera have in common."""
    return Sheaf(
        camera.eye,
        camera.extent,
        -camera.image_distance,
        camera.extent + camera.image_distance,
        None,
    )


@device
def camera_ray(camera: CameraFrame, column: float, row: float) -> Ray:
    """Return the ray through a place in the image.

    Parameters
    ----------
    camera
        The camera.
    column, row
        The place in pixels, from the left and from the top; that of a pixel itself are integers.
    """
    across = column - camera.width / 2
    below = row - camera.height / 2
    in_plane = add(
        scale(across * camera.pixel[0], camera.right), scale(below * camera.pixel[1], camera.down)
    )
    way = _enlarged(add(in_plane, scale(camera.pixel[2], camera.forward)))
    length = math.sqrt(dot(way, way))
    direction = way[0] / length, way[1] / length, way[2] / length
    offset = add(
        scale(across * camera.shift[0], camera.right), scale(below * camera.shift[1], camera.down)
    )
    sheaf = sheaf_of(camera)
    origin = add(camera.eye, offset) if start_apart(sheaf) else camera.eye
    forward = dot(direction, camera.forward)
    return Ray(origin, direction, sheaf.plane_depth, forward, sheaf.error_scale, 0.0)


@device
def _enlarged(way: Vec) -> Vec:
    """Return a vector times a power of two, so that its squares do not vanish."""
    largest = max(abs(way[0]), abs(way[1]), abs(way[2]))
    return scale(2.0**900 if largest < 2.0**-400 else 1.0, way)


@device
def cast_rays(packet: Packet, lanes: int, camera: CameraFrame) -> None:
    """Set each lane's ray."""
    apart = start_apart(sheaf_of(camera))
    for lane in range(lanes):
        ray = camera_ray(camera, packet[COLUMN + lane], packet[ROW + lane])
        if apart:
            store(packet, ORIGIN, lane, ray.origin)
        store(packet, DIRECTION, lane, ray.direction)
    # A loop of its own: the compiler vectorises both then.
    for lane in range(lanes):
        packet[FORWARD + lane] = dot(load(packet, DIRECTION, lane), camera.forward)
