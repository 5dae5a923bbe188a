"""Lights that are no points, and how they are seen from a point of a surface."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.base.compiler.unseen import apart
from vtray.geometry.packets.cone import Cone
from vtray.geometry.packets.fan import Spot, Start
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.vector import Vec, dot, scale, sub
from vtray.transport.lights.rectangle import (
    Rectangles,
    SeenRectangle,
    see_rectangle,
    spread_and_share,
)
from vtray.transport.lights.sky import Skies

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

SUN, SPHERE, AROUND, RECTANGLE = 0, 1, 2, 3
"""The kinds: far away in a cone of directions, a sphere, light from all sides, and a rectangle."""

NO_SKY = -1
"""Stands for the number of a sky, where a light is none whose colour changes."""

ALL_AROUND = 2.0
"""The spread of light from all directions."""


CLEARLY = 1e-9
"""By so much a cone is above the horizon, or below it, if no rounding can change that."""


@apart
class SoftLights(NamedTuple):
    """Lights that are no points; columns are (n,).

    Attributes
    ----------
    kind
        Their kind.
    x, y, z
        Where they are; for a sun, the unit direction towards its middle.
    size
        The radius of a sphere; half the edges of a rectangle together; for a sun 1 minus the cosine
        of half its angle; for light from all sides how far away something can be that stops it.
    error_scale
        What the rounding of the ends of rays to them is relative to, beside their starts.
    falls_off
        Whether they get weaker with distance, as a lamp of a given radiance does.
    sky
        Their number among the skies whose colour changes with the direction, ``NO_SKY`` for others.
    row
        The first row of their components in `Lights.intensity` and `Lights.color`.
    far
        How long rays are that end nowhere: much longer than all in the scene.
    rectangles
        How the rectangles stand.
    skies
        The skies whose colour changes with the direction. Both are None where a scene has neither,
        so that no code is compiled for them: it is compiled together, as it takes a tenth longer.
    """

    kind: Integers
    x: Floats
    y: Floats
    z: Floats
    size: Floats
    error_scale: Floats
    falls_off: NDArray[np.bool_]
    sky: Integers
    row: Integers
    far: float
    rectangles: Rectangles | None
    skies: Skies | None


class Aim(NamedTuple):
    """A light as it is seen from a point.

    Attributes
    ----------
    kind, place, size, error_scale
        As in `SoftLights`.
    axis
        The unit direction to its middle, or the normal of the surface for a rectangle and for light
        from all sides.
    spread
        1 minus the cosine of half the angle under which it is seen.
    share
        What a ray counts where it is square to the surface.
    whole
        What all of a cone brings that is square to it.
    seen
        A rectangle as it is seen; None if the scene has none.
    sky
        As in `SoftLights`.
    """

    kind: int
    place: Vec
    size: float
    error_scale: float
    axis: Vec
    spread: float
    share: float
    whole: float
    seen: SeenRectangle | None
    sky: int


@device
def soft_count(soft: SoftLights) -> int:
    """Return how many there are."""
    count: int = soft.kind.shape[0]
    return count


@device
def component_count(soft: SoftLights, light: int) -> int:
    """Return how many numbers say what a light adds: 3 for one whose colour changes, else 1."""
    # Where there are no such skies, the compiler knows the number.
    if soft.skies is None:
        return 1
    return 1 if soft.sky[light] == NO_SKY else 3


@device
def aim_at(soft: SoftLights, light: int, start: Start, normal: Vec) -> Aim:
    """Return a light as it is seen from where rays start on a surface.

    On the surface of a sphere, as near as rounding can tell, is inside: a ball that has a lamp of
    its own size shines.
    """
    kind, size = soft.kind[light], soft.size[light]
    place = soft.x[light], soft.y[light], soft.z[light]
    error_scale, falls_off = soft.error_scale[light], soft.falls_off[light]
    seen = see_rectangle(soft.rectangles, light, place, error_scale, falls_off, start)
    if kind == SUN:
        # The mean of the cosine over a cone around the normal is 1 - spread / 2.
        share = 1.0 / (1.0 - 0.5 * size)
        far = scale(soft.far, place)
        return Aim(SUN, far, soft.far, error_scale, place, size, share, 1.0, seen, NO_SKY)
    if kind == SPHERE:
        way = sub(place, start.point)
        distance2 = dot(way, way)
        outside = size + ROUNDING * (error_scale + start.error_scale)
        if distance2 > outside * outside:
            sine2 = size * size / distance2
            spread = sine2 / (1.0 + math.sqrt(1.0 - sine2))
            axis = scale(1.0 / math.sqrt(distance2), way)
            # The solid angle of the cone is 2 pi spread.
            share = 2.0 * spread if falls_off else 1.0 / (1.0 - 0.5 * spread)
            whole = share * (1.0 - 0.5 * spread) if falls_off else 1.0
            return Aim(SPHERE, place, size, error_scale, axis, spread, share, whole, seen, NO_SKY)
        # Inside, its light comes from all sides.
        return Aim(SPHERE, place, size, error_scale, normal, ALL_AROUND, 1.0, 1.0, seen, NO_SKY)
    if kind == RECTANGLE:
        spread, share = spread_and_share(seen)
        return Aim(RECTANGLE, place, size, error_scale, normal, spread, share, 0.0, seen, NO_SKY)
    sky = soft.sky[light]
    return Aim(AROUND, place, size, error_scale, normal, ALL_AROUND, 1.0, 1.0, seen, sky)


@device
def is_cone(aim: Aim) -> bool:
    """Tell whether a light is seen as a cone of less than half of all directions."""
    return is_round(aim) and aim.spread < 1.0


@device
def is_round(aim: Aim) -> bool:
    """Tell whether a light is a sun or a sphere."""
    return aim.kind in (SUN, SPHERE)


@device
def is_everywhere(aim: Aim) -> bool:
    """Tell whether a light is one from all sides that nothing stops: all of it always arrives."""
    is_around: bool = aim.kind == AROUND and aim.size == 0.0
    return is_around


@device
def middle_share(aim: Aim, normal: Vec) -> float:
    """Return the share of a cone above the horizon that nothing stops: that of its middle."""
    return aim.whole * dot(normal, aim.axis)


@device
def unhindered_share(aim: Aim, start: Start, normal: Vec) -> float:
    """Return about what share of a light arrives at a point where nothing is in the way.

    Of light from all sides and of cones above the horizon it is known. Of what may be partly below
    it is half of the most that a ray could bring; so no ray brings more than twice the mean that is
    expected, and where it is 0, no ray brings anything.
    """
    if aim.spread == ALL_AROUND:
        return 1.0
    axis, whole = aim.axis, aim.whole
    if aim.kind == RECTANGLE:
        # As the ball around it; where that is all around, the cosine may be anything.
        if aim.spread == 1.0 or aim.share == 0.0:
            return aim.share
        way = sub(aim.place, start.point)
        axis, whole = scale(1.0 / math.sqrt(dot(way, way)), way), aim.share
    rise, sine = dot(normal, axis), _sine(aim)
    return whole * (rise if rise > sine else max(0.5 * (rise + sine), 0.0))


@device
def is_above(aim: Aim, normal: Vec) -> bool:
    """Tell whether all of a cone is above the horizon of a surface."""
    return is_cone(aim) and dot(normal, aim.axis) > _sine(aim) + CLEARLY


@device
def is_below(aim: Aim, normal: Vec) -> bool:
    """Tell whether all of a cone is below the horizon of a surface."""
    return is_cone(aim) and dot(normal, aim.axis) < -_sine(aim) - CLEARLY


@device
def _sine(aim: Aim) -> float:
    """Return the sine of half the angle of a cone."""
    return math.sqrt(aim.spread * (2.0 - aim.spread))


@device
def cone_from(aim: Aim, spot: Spot, forward: Vec) -> Cone:
    """Return a cone around the rays from a spot to a light that is seen as a cone.

    Where there is none, as the spot reaches into the light, its cosine is 0.

    Parameters
    ----------
    aim, spot
        The light as it is seen from the middle of the spot, and the spot.
    forward
        The unit direction in which the camera looks.
    """
    cone, extent = cone_of(aim, spot.start, forward), spot.extent
    if extent == 0.0:
        return cone
    longest, cosine, sine = cone.longest + extent, cone.cosine, cone.sine
    if aim.kind == SPHERE:
        # Moved to start in the middle, the rays end in a larger ball.
        sine = (aim.size + extent) / cone.longest * (1.0 + CLEARLY)
        cosine = math.sqrt(max(1.0 - sine * sine, 0.0))
    return Cone(spot.start, extent, aim.axis, cosine, sine, 0.0, longest, forward)


@device
def cone_of(aim: Aim, start: Start, forward: Vec) -> Cone:
    """Return the cone of the rays to a light that is seen as one.

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
    return Cone(start, 0.0, aim.axis, 1.0 - aim.spread, _sine(aim), shortest, longest, forward)


@device
def longest_ray(aim: Aim, start: Start) -> float:
    """Return how long a ray to a light is at the most."""
    if aim.kind in (SPHERE, RECTANGLE):
        way = sub(aim.place, start.point)
        return math.sqrt(dot(way, way)) + aim.size
    return aim.size
