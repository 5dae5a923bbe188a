"""Rectangle lamps: how they stand, how they are seen from a point, and how bright they make it."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.circle import PI
from vtray.geometry.packets.fan import Start
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.vector import Vec, dot, magnitude, scale, sub
from vtray.transport.lights.spherical_rectangle import (
    SphericalRectangle,
    spherical_rectangle,
    square_integral,
)

SIZE = 11
"""Numbers of a rectangle: unit vectors along its edges and square to it, and half its sides."""


class Rectangles(NamedTuple):
    """How the rectangles among the soft lights stand.

    Attributes
    ----------
    data
        ``SIZE`` numbers for each soft light, 0 for those of other kinds.
    """

    data: NDArray[np.float64]


class SeenRectangle(NamedTuple):
    """A rectangle lamp as it is seen from a point.

    Attributes
    ----------
    shape
        The rectangle, lengths in the unit of the arrays times some number.
    height
        How far its plane is from the point, in the unit of the arrays.
    spread
        1 minus the cosine of half the angle of a cone around it; 1 where it is too near for one.
    share
        What makes the mean cosine of directions to it the share of the lamp.
    """

    shape: SphericalRectangle
    height: float
    spread: float
    share: float


@device
def see_rectangle(
    rectangles: Rectangles | None,
    light: int,
    place: Vec,
    error_scale: float,
    falls_off: bool,
    start: Start,
) -> SeenRectangle | None:
    """Return how one of the soft lights, a rectangle, is seen; None if a scene has no rectangles.

    From its own plane, as near as rounding can tell, it gives no light.

    Parameters
    ----------
    rectangles
        How the rectangles stand.
    light, place, error_scale
        The light, its middle, and what their rounding errors are relative to.
    falls_off
        Whether it gets weaker with distance, as a lamp of a given radiance does.
    start
        The point.
    """
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if rectangles is None:
        return None
    data, at = rectangles.data, SIZE * light
    across = data[at], data[at + 1], data[at + 2]
    up = data[at + 3], data[at + 4], data[at + 5]
    toward = data[at + 6], data[at + 7], data[at + 8]
    way = sub(place, start.point)
    if dot(way, toward) < 0.0:
        toward = scale(-1.0, toward)
    error_bound = ROUNDING * (error_scale + start.error_scale)
    height = max(dot(way, toward), error_bound)
    # Relative to the largest length, so that products neither overflow nor vanish.
    per_length = 1.0 / (magnitude(way) + data[at + 9] + data[at + 10] + height)
    half = per_length * data[at + 9], per_length * data[at + 10]
    x, y, z = per_length * dot(way, across), per_length * dot(way, up), per_length * height
    shape = spherical_rectangle((across, up, toward), (x, y, z), half)
    share = 0.0
    if height > error_bound:
        whole = PI if falls_off else square_integral(_distance(x, y, z, half), half)
        share = shape.solid_angle / whole
    return SeenRectangle(shape, height, _spread(x, y, z, half), share)


@device
def _distance(x: float, y: float, z: float, half: tuple[float, float]) -> float:
    """Return how far a rectangle is, whose middle is at (x, y, z)."""
    beside, above = max(abs(x) - half[0], 0.0), max(abs(y) - half[1], 0.0)
    return math.sqrt(beside * beside + above * above + z * z)


@device
def _spread(x: float, y: float, z: float, half: tuple[float, float]) -> float:
    """Return 1 minus the cosine of half the angle under which the ball around it is seen."""
    radius2 = half[0] * half[0] + half[1] * half[1]
    distance2 = x * x + y * y + z * z
    if distance2 <= radius2:
        return 1.0
    sine2 = radius2 / distance2
    return sine2 / (1.0 + math.sqrt(1.0 - sine2))


@device
def spread_and_share(seen: SeenRectangle | None) -> tuple[float, float]:
    """Return spread and share of a rectangle; zeros if a scene has none."""
    if seen is None:
        return 0.0, 0.0
    return seen.spread, seen.share


@device
def solid_angle_of(seen: SeenRectangle | None) -> float:
    """Return the solid angle under which a rectangle is seen; 0 if a scene has none."""
    if seen is None:
        return 0.0
    return seen.shape.solid_angle


@device
def length_of_ray(seen: SeenRectangle | None, direction: Vec) -> float:
    """Return how far it is to a rectangle in a direction; 0 if a scene has none."""
    if seen is None:
        return 0.0
    return seen.height / dot(direction, seen.shape.toward)
