"""The camera as kernels see it, and the ray through a place in the image."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, part
from vtray.geometry.circle import cosine_sine_of_turn
from vtray.geometry.packets.packet import (
    COLUMN,
    DIRECTION,
    FORWARD,
    LENS_DOWN,
    LENS_RIGHT,
    ORIGIN,
    ROW,
    Packet,
    Sheaf,
    load,
    start_apart,
    store,
    store_ray,
)
from vtray.geometry.ray import Ray
from vtray.geometry.vector import Vec, add, dot, scale, sub

WHOLE_TURNS = 1024.0
"""Eighths of turns by which no angle becomes another: more than any filter reaches."""

STARTS_HERE = 2.0**-1000
"""The bound on the error of a start that has none: nothing counts that is behind it."""


class LensFrame(NamedTuple):
    """A lens as kernels see it.

    Attributes
    ----------
    radius
        By how much the start of a ray moves from the middle of the lens to its edge.
    slope
        By how much its way, of length 1 along the view, turns towards the middle: the radius of
        the lens divided by the distance of what is sharp.
    corners
        The corners of an opening that is a polygon, of radius 1, one after the other and the first
        again at the end, to the right and downwards, (blades + 1, 2); (0, 2) for a disc.
    """

    radius: float
    slope: float
    corners: NDArray[np.float64]


class TurnFrame(NamedTuple):
    """How the rays of a panorama turn from pixel to pixel.

    Attributes
    ----------
    ahead
        The unit direction of the middle of the picture.
    across, below
        The angles from one pixel to the next across and down, in eighths of a turn.
    first_across, first_below
        Those from the middle of the picture to the middle of the pixel right and below of it.
    """

    ahead: Vec
    across: float
    below: float
    first_across: float
    first_below: float


def turned_by(turn: TurnFrame | None, factor: float) -> TurnFrame | None:
    """Return how rays turn if pixels are so many times as large, or smaller; None for None."""
    if turn is None:
        return None
    return turn._replace(across=factor * turn.across, below=factor * turn.below)


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
    lens
        The lens, None for a pinhole.
    turn
        How rays turn in a panorama, None for others.
    middle_depth
        How far the origin is before the image plane: 0, but for a panorama, which has none, so
        that everything is far before it. Then `forward` is 0.
    unbounded
        True in a panorama, whose rays have all that is in `Ray` in fields of their own, None for
        others.
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
    lens: LensFrame | None = None
    turn: TurnFrame | None = None
    middle_depth: float = 0.0
    unbounded: bool | None = None


@device
def sheaf_of(camera: CameraFrame) -> Sheaf:
    """Return what all rays of a camera have in common."""
    extent = camera.extent + _reach_of(camera.lens)
    return Sheaf(
        camera.eye,
        extent,
        -camera.image_distance,
        extent + camera.image_distance,
        camera.unbounded,
    )


@device
def _reach_of(lens: LensFrame | None) -> float:
    """Return a bound on how far from its middle rays start that go through a lens."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if lens is not None:
        return 2.0 * abs(lens.radius)
    return 0.0


@device
def plane_depth_of(camera: CameraFrame, point: Vec) -> float:
    """Return how far a point is before the image plane."""
    return dot(point, camera.forward) + camera.middle_depth


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
    return _ray_of(camera, camera.turn, column, row)


@device
def _ray_of(camera: CameraFrame, turn: TurnFrame | None, column: float, row: float) -> Ray:
    """Return the ray through a place in the image; `turn` is that of the camera."""
    if turn is not None:
        direction = _turned(camera, turn, column, row)
        return Ray(camera.eye, direction, camera.middle_depth, 0.0, 0.0, STARTS_HERE)
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
def _turned(camera: CameraFrame, turn: TurnFrame, column: float, row: float) -> Vec:
    """Return the unit direction of a panorama through a place in the image."""
    across = (column - camera.width / 2) * turn.across + turn.first_across
    below = (row - camera.height / 2) * turn.below + turn.first_below
    # Whole turns more, so that they are no less than 0 also beside the picture.
    ahead, right = cosine_sine_of_turn(across + WHOLE_TURNS)
    level, down = cosine_sine_of_turn(below + WHOLE_TURNS)
    around = add(scale(ahead, turn.ahead), scale(right, camera.right))
    way = add(scale(level, around), scale(down, camera.down))
    length = math.sqrt(dot(way, way))
    return way[0] / length, way[1] / length, way[2] / length


@device
def sample_ray(camera: CameraFrame, packet: Packet, lane: int) -> Ray:
    """Return the ray through a lane's places in the image and in the lens."""
    ray = camera_ray(camera, packet[COLUMN + lane], packet[ROW + lane])
    return _through_lens(
        camera, camera.lens, ray, packet[LENS_RIGHT + lane], packet[LENS_DOWN + lane]
    )


@device
def _through_lens(
    camera: CameraFrame, lens: LensFrame | None, ray: Ray, right: float, down: float
) -> Ray:
    """Return the ray of a camera that meets another one where that is sharp.

    Parameters
    ----------
    camera, lens
        The camera and its lens; None for a pinhole, through which the ray goes as it is.
    ray
        The ray through the middle of the lens.
    right, down
        Where it goes through the lens, in parts of its radius.
    """
    if lens is not None:
        aside = add(scale(right, camera.right), scale(down, camera.down))
        way = sub(ray.direction, scale(ray.forward * lens.slope, aside))
        length = math.sqrt(dot(way, way))
        direction = way[0] / length, way[1] / length, way[2] / length
        origin = add(ray.origin, scale(lens.radius, aside))
        forward = dot(direction, camera.forward)
        return Ray(origin, direction, ray.plane_depth, forward, ray.error_scale, 0.0)
    return ray


@device
def _enlarged(way: Vec) -> Vec:
    """Return a vector times a power of two, so that its squares do not vanish."""
    largest = max(abs(way[0]), abs(way[1]), abs(way[2]))
    return scale(2.0**900 if largest < 2.0**-400 else 1.0, way)


@part
def cast_rays(packet: Packet, lanes: int, camera: CameraFrame) -> None:
    """Set each lane's ray."""
    _cast_rays(packet, lanes, camera, camera.turn)


@device
def _cast_rays(packet: Packet, lanes: int, camera: CameraFrame, turn: TurnFrame | None) -> None:
    if turn is not None:
        for lane in range(lanes):
            store_ray(packet, lane, camera_ray(camera, packet[COLUMN + lane], packet[ROW + lane]))
        return
    apart = start_apart(sheaf_of(camera))
    for lane in range(lanes):
        ray = sample_ray(camera, packet, lane)
        if apart:
            store(packet, ORIGIN, lane, ray.origin)
        store(packet, DIRECTION, lane, ray.direction)
    # A loop of its own: the compiler vectorises both then.
    for lane in range(lanes):
        packet[FORWARD + lane] = dot(load(packet, DIRECTION, lane), camera.forward)
