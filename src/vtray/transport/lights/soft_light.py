"""Lights that are no points, and how they are seen from a point of a surface."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.cone import Cone
from vtray.geometry.packets.fan import Start
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.vector import Vec, dot, scale, sub

Floats = NDArray[np.float64]

SUN, SPHERE, AROUND = 0, 1, 2
"""The kinds: far away in a cone of directions, a sphere, and light from all sides."""

ALL_AROUND = 2.0
"""The spread of light from all directions."""


CLEARLY = 1e-9
"""By so much a cone is above the horizon, or below it, if no rounding can change that."""


class SoftLights(NamedTuple):
    """Lights that are no points, all (n,) but for the last.

    Attributes
    ----------
    kind
        Their kind.
    x, y, z
        Where they are; for a sun, the unit direction towards its middle.
    size
        The radius of a sphere; for a sun 1 minus the cosine of half its angle; for light from all
        sides how far away something can be that stops it.
    error_scale
        What the rounding of the ends of rays to them is relative to, beside their starts.
    far
        How long rays are that end nowhere: much longer than all in the scene.
    """

    kind: NDArray[np.int64]
    x: Floats
    y: Floats
    z: Floats
    size: Floats
    error_scale: Floats
    far: float


class Aim(NamedTuple):
    """A light as it is seen from a point.

    Attributes
    ----------
    kind, place, size
        As in `SoftLights`.
    axis
        The unit direction to its middle, or the normal of the surface for light from all sides.
    spread
        1 minus the cosine of half the angle under which it is seen.
    share
        What makes the mean weight 1 on a surface that faces it squarely.
    """

    kind: int
    place: Vec
    size: float
    axis: Vec
    spread: float
    share: float


@device
def soft_count(soft: SoftLights) -> int:
    """Return how many there are."""
    count: int = soft.kind.shape[0]
    return count


@device
def aim_at(soft: SoftLights, light: int, start: Start, normal: Vec) -> Aim:
    """Return a light as it is seen from where rays start on a surface.

    On the surface of a sphere, as near as rounding can tell, is inside: a ball that has a lamp of
    its own size shines.
    """
    kind, size = soft.kind[light], soft.size[light]
    place = soft.x[light], soft.y[light], soft.z[light]
    if kind == SUN:
        # The mean of the cosine over a cone around the normal is 1 - spread / 2.
        return Aim(SUN, scale(soft.far, place), soft.far, place, size, 1.0 / (1.0 - 0.5 * size))
    if kind == SPHERE:
        way = sub(place, start.point)
        distance2 = dot(way, way)
        outside = size + ROUNDING * (soft.error_scale[light] + start.error_scale)
        if distance2 > outside * outside:
            sine2 = size * size / distance2
            spread = sine2 / (1.0 + math.sqrt(1.0 - sine2))
            axis = scale(1.0 / math.sqrt(distance2), way)
            return Aim(SPHERE, place, size, axis, spread, 1.0 / (1.0 - 0.5 * spread))
        # Inside, its light comes from all sides.
        return Aim(SPHERE, place, size, normal, ALL_AROUND, 1.0)
    return Aim(AROUND, place, size, normal, ALL_AROUND, 1.0)


@device
def is_above(aim: Aim, normal: Vec) -> bool:
    """Tell whether all of a cone is above the horizon of a surface."""
    is_cone = aim.spread < 1.0
    return is_cone and dot(normal, aim.axis) > _sine(aim) + CLEARLY


@device
def is_below(aim: Aim, normal: Vec) -> bool:
    """Tell whether all of a cone is below the horizon of a surface."""
    is_cone = aim.spread < 1.0
    return is_cone and dot(normal, aim.axis) < -_sine(aim) - CLEARLY


@device
def _sine(aim: Aim) -> float:
    """Return the sine of half the angle of a cone."""
    return math.sqrt(aim.spread * (2.0 - aim.spread))


@device
def cone_of(aim: Aim, start: Start, forward: Vec) -> Cone:
    """Return the cone of the rays to a light that is not all around.

    Parameters
    ----------
    aim, start
        The light, and where the rays start.
    forward
        The unit direction in which the camera looks.
    """
    shortest = longest = aim.size
    if aim.kind == SPHERE:
        way = sub(aim.place, start.point)
        longest = math.sqrt(dot(way, way))
        shortest = longest - aim.size
    return Cone(start, aim.axis, 1.0 - aim.spread, _sine(aim), shortest, longest, forward)


@device
def longest_ray(aim: Aim, start: Start) -> float:
    """Return how long a ray to a light is at the most."""
    if aim.kind == SPHERE:
        way = sub(aim.place, start.point)
        return math.sqrt(dot(way, way)) + aim.size
    return aim.size
