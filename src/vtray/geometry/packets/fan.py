"""A fan: shadow rays that spread from one point, side by side in one scratch array."""

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
END_SCALE = 14 * FAN
"""What the rounding error of its end is relative to, where rays go to several lights."""
SIZE = 15 * FAN

Fan = NDArray[np.float64]
"""The fields of all rays, one after the other, as those of a packet."""


class Start(NamedTuple):
    """Where the rays of a fan start.

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


def new_fan() -> Fan:
    """Return the fan of one thread."""
    return np.zeros(SIZE)


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
def fan_segment(fan: Fan, ray: int, start: Start, end_scale: float | None) -> Segment:
    """Return the way of a ray; `end_scale` is that of all ends, or None if each has its own."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if end_scale is None:
        return _segment(fan, ray, start, fan[END_SCALE + ray])
    return _segment(fan, ray, start, end_scale)


@device
def _segment(fan: Fan, ray: int, start: Start, end_scale: float) -> Segment:
    """Return the way of a ray whose end has this scale of rounding errors."""
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
