"""Lights that are no points, and how they are seen from a point of a surface."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.fan import Start
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.vector import Vec, dot, scale, sub
from vtray.transport.lights.sky import Skies

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

SUN, SPHERE, AROUND = 0, 1, 2
"""The kinds: far away in a cone of directions, a sphere, and light from all sides."""

NO_SKY = -1
"""Stands for the number of a sky, where a light is none whose colour changes."""

ALL_AROUND = 2.0
"""The spread of light from all directions."""


class SoftLights(NamedTuple):
    """Lights that are no points, all (n,) but for the last two.

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
    sky
        Their number among the skies whose colour changes with the direction, ``NO_SKY`` for others.
    row
        The first row of their components in `Lights.intensity` and `Lights.color`.
    far
        How long rays are that end nowhere: much longer than all in the scene.
    skies
        The skies whose colour changes with the direction; None where there are none, so that no
        code is compiled for them.
    """

    kind: Integers
    x: Floats
    y: Floats
    z: Floats
    size: Floats
    error_scale: Floats
    sky: Integers
    row: Integers
    far: float
    skies: Skies | None


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
    sky
        As in `SoftLights`.
    """

    kind: int
    place: Vec
    size: float
    axis: Vec
    spread: float
    share: float
    sky: int


@device
def soft_count(soft: SoftLights) -> int:
    """Return how many there are."""
    count: int = soft.kind.shape[0]
    return count


@device
def component_count(soft: SoftLights, light: int) -> int:
    """Return how many numbers say what a light adds: 3 for one whose colour changes, else 1."""
    return 1 if soft.sky[light] == NO_SKY else 3


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
        share = 1.0 / (1.0 - 0.5 * size)
        return Aim(SUN, scale(soft.far, place), soft.far, place, size, share, NO_SKY)
    if kind == SPHERE:
        way = sub(place, start.point)
        distance2 = dot(way, way)
        outside = size + ROUNDING * (soft.error_scale[light] + start.error_scale)
        if distance2 > outside * outside:
            sine2 = size * size / distance2
            spread = sine2 / (1.0 + math.sqrt(1.0 - sine2))
            axis = scale(1.0 / math.sqrt(distance2), way)
            return Aim(SPHERE, place, size, axis, spread, 1.0 / (1.0 - 0.5 * spread), NO_SKY)
        # Inside, its light comes from all sides.
        return Aim(SPHERE, place, size, normal, ALL_AROUND, 1.0, NO_SKY)
    return Aim(AROUND, place, size, normal, ALL_AROUND, 1.0, soft.sky[light])
