"""Where a point is on the surface of a shape, unrolled onto a plane as a label is from a bottle."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.circle import PI, angle_of
from vtray.geometry.vector import Vec, cross, dot, scale, sub

SLANT = 1e-3
"""Below that sine of the angle to its axis, no direction is told that is up beside it."""


class Upright(NamedTuple):
    """How what is on surfaces is turned.

    Attributes
    ----------
    up, front
        Unit vectors that are square to each other: what is up, and what takes its place on surfaces
        whose axis that is.
    cosine, sine
        Those of the angle by which all is turned around the axis.
    """

    up: Vec
    front: Vec
    cosine: float
    sine: float


class Unrolled(NamedTuple):
    """A place on an unrolled surface.

    Attributes
    ----------
    across, down
        How far it is around the axis, to the right as seen from outside with the axis up, and along
        it from the upper end; on a plane, to the right of its point and below it.
    width, height
        How far that goes until it is where it began, and at all; infinite on a plane.
    is_side
        Whether it is there at all: flat ends are not.
    """

    across: float
    down: float
    width: float
    height: float
    is_side: bool


@device
def axes_around(axis: Vec, upright: Upright) -> tuple[Vec, Vec]:
    """Return two unit vectors that are square to an axis and to each other: upwards, and aside."""
    slant = dot(upright.up, axis)
    is_beside = slant * slant < 1.0 - SLANT * SLANT
    up, front = upright.up, upright.front
    first = (
        up[0] if is_beside else front[0],
        up[1] if is_beside else front[1],
        up[2] if is_beside else front[2],
    )
    first = sub(first, scale(dot(first, axis), axis))
    length = math.sqrt(dot(first, first))
    first = scale(1.0 / length, first) if length > 0.0 else upright.front
    return first, cross(axis, first)


@device
def place_around(offset: Vec, axis: Vec, upright: Upright) -> tuple[float, float]:
    """Return how far an offset leads upwards and aside, by the axes around another one."""
    first, second = axes_around(axis, upright)
    x, y = dot(offset, first), dot(offset, second)
    cosine, sine = upright.cosine, upright.sine
    return cosine * x + sine * y, cosine * y - sine * x


@device
def unrolled_side(
    offset: Vec, axis: Vec, down: float, radius: float, height: float, upright: Upright
) -> Unrolled:
    """Return a place of a surface around an axis.

    Parameters
    ----------
    offset
        From the axis to the point.
    axis
        Its unit direction.
    down
        How far the point is from the upper end, along the surface.
    radius, height
        How wide and how long the surface is.
    upright
        How it is turned.
    """
    x, y = place_around(offset, axis, upright)
    across = radius * (angle_of(x, y) + PI)
    return Unrolled(across, down, 2.0 * PI * radius, height, True)


@device
def not_unrolled() -> Unrolled:
    """Return what stands for a point of a flat end."""
    return Unrolled(0.0, 0.0, 1.0, 1.0, False)
