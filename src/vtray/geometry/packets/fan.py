"""A fan: shadow rays that spread from one point or from a few, side by side in a scratch array."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.ray import Segment
from vtray.geometry.vector import Vec

FAN = 64
"""Rays of a fan at the most."""

MOST_RAYS = 64 * FAN
"""Rays of all fans that lights share at one hit, at the most."""

END = 0
"""Where a ray ends, a vector."""
END_PLANE_DEPTH = 3 * FAN
"""How far before the image plane that is."""
BLOCKED = 4 * FAN
"""The share of the light along a ray that something stops: 1 where it is not cast."""
DIRECTION = 5 * FAN
"""A unit vector."""
LENGTH = 8 * FAN
"""How long it is."""
WEIGHT = 9 * FAN
"""What the ray counts, if nothing stops it: one number, or three for red, green and blue."""
SINGLES = 12 * FAN
"""Its direction in single precision, two in the place of one number."""
START = 14 * FAN
START_PLANE_DEPTH = 17 * FAN
START_SCALE = 18 * FAN
"""Where the rays of a group start, as in `Start`; see `Bundle`."""
END_SCALE = 19 * FAN
"""What the rounding errors of their ends are relative to."""
SIZE = 20 * FAN

Fan = NDArray[np.float64]
"""The fields of all rays, one after the other, as those of a packet."""


class Start(NamedTuple):
    """Where rays start.

    Attributes
    ----------
    point
        The point.
    plane_depth
        How far before the image plane it is.
    error_scale
        What its rounding error is relative to.
    """

    point: Vec
    plane_depth: float
    error_scale: float


class Spot(NamedTuple):
    """The part of a surface from which the rays of a fan start.

    Attributes
    ----------
    start
        Where they start; if they start apart, a point between, and the largest of their scales.
    extent
        How far from there they start at the most.
    normal
        The unit normal of the surface there, above which they all are.
    tilt
        How far the normals where they start are from that at the most, as vectors.
    sunk
        How far below the plane through the middle, in the direction of their normals, they start at
        the most.
    """

    start: Start
    extent: float
    normal: Vec
    tilt: float
    sunk: float


def new_fan() -> Fan:
    """Return the fan of one thread."""
    return np.zeros(SIZE)


@device
def spot_at(start: Start, normal: Vec) -> Spot:
    """Return the spot of rays that start together."""
    return Spot(start, 0.0, normal, 0.0, 0.0)


@device
def set_direction(fan: Fan, ray: int, direction: Vec) -> None:
    """Set the direction of a ray."""
    fan[DIRECTION + ray] = direction[0]
    fan[DIRECTION + FAN + ray] = direction[1]
    fan[DIRECTION + 2 * FAN + ray] = direction[2]


@device
def load_direction(fan: Fan, ray: int) -> Vec:
    """Return the direction of a ray."""
    return fan[DIRECTION + ray], fan[DIRECTION + FAN + ray], fan[DIRECTION + 2 * FAN + ray]


@device
def load_end(fan: Fan, ray: int) -> Vec:
    """Return where a ray ends."""
    return fan[END + ray], fan[END + FAN + ray], fan[END + 2 * FAN + ray]


@device
def set_start(fan: Fan, k: int, start: Start, end_scale: float) -> None:
    """Set where the rays of a group start, and the scale of the rounding errors of their ends."""
    x, y, z = start.point
    fan[START + k] = x
    fan[START + FAN + k] = y
    fan[START + 2 * FAN + k] = z
    fan[START_PLANE_DEPTH + k] = start.plane_depth
    fan[START_SCALE + k] = start.error_scale
    fan[END_SCALE + k] = end_scale


@device
def load_start(fan: Fan, k: int) -> Vec:
    """Return the point where the rays of a group start."""
    return fan[START + k], fan[START + FAN + k], fan[START + 2 * FAN + k]


@device
def load_origin(fan: Fan, k: int) -> Start:
    """Return where the rays of a group start."""
    return Start(load_start(fan, k), fan[START_PLANE_DEPTH + k], fan[START_SCALE + k])


@device
def fan_segment(fan: Fan, ray: int, k: int) -> Segment:
    """Return the way of a ray, which is one of group `k`."""
    return segment_from(fan, ray, load_origin(fan, k), fan[END_SCALE + k])


@device
def segment_from(fan: Fan, ray: int, start: Start, end_scale: float) -> Segment:
    """Return the way of a ray, given where it starts, and the scale of its end's errors."""
    return Segment(
        start.point,
        load_end(fan, ray),
        start.plane_depth,
        fan[END_PLANE_DEPTH + ray],
        start.error_scale,
        end_scale,
    )


@device
def count_open(fan: Fan, rays: int) -> int:
    """Return how many rays of a fan nothing stops so far."""
    count = 0
    for ray in range(rays):
        count += 1 if fan[BLOCKED + ray] == 0.0 else 0
    return count
