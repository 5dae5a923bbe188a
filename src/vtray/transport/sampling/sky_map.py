"""Where directions are on the map of a sky, and which there are at its places.

References
----------
Remez, 1934, as for the sines: the polynomial of the arctangent is that of least error.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.circle import cosine_sine_of_turn
from vtray.geometry.vector import Vec, add, dot, scale
from vtray.transport.lights.sky import Skies, light_at, sky_axis


class MapPlace(NamedTuple):
    """A place on the map of a sky.

    Attributes
    ----------
    across, down
        As `light_at` takes them.
    aside
        The sine of the angle from straight above.
    """

    across: float
    down: float
    aside: float


@device
def map_place(skies: Skies, sky: int, direction: Vec) -> MapPlace:
    """Return where a direction, a unit vector, is on the map of a sky."""
    behind = dot(direction, sky_axis(skies, sky, 0))
    left = dot(direction, sky_axis(skies, sky, 1))
    height = dot(direction, sky_axis(skies, sky, 2))
    aside = math.sqrt(behind * behind + left * left)
    # The light of a column of the picture is that in its middle.
    across = eighths_of_turn(left, behind) * (0.125 * skies.columns[sky]) - 0.5
    across = across + skies.columns[sky] if across < 0.0 else across
    down = eighths_of_turn(aside, height) * (0.25 * skies.rows[sky]) + 0.5
    return MapPlace(across, down, aside)


@device
def light_towards(skies: Skies, sky: int, direction: Vec) -> Vec:
    """Return red, green and blue of a sky in a direction, a unit vector."""
    place = map_place(skies, sky, direction)
    return light_at(skies, sky, place.across, place.down)


@device
def direction_at(skies: Skies, sky: int, across: float, down: float) -> Vec:
    """Return the direction, a unit vector, at a place of the map of a sky."""
    around, outwards = cosine_sine_of_turn(8.0 * (across + 0.5) / skies.columns[sky])
    height, aside = cosine_sine_of_turn(4.0 * (down - 0.5) / skies.rows[sky])
    level = add(
        scale(aside * around, sky_axis(skies, sky, 0)),
        scale(aside * outwards, sky_axis(skies, sky, 1)),
    )
    return add(level, scale(height, sky_axis(skies, sky, 2)))


@device
def eighths_of_turn(y: float, x: float) -> float:
    """Return the angle from the first axis to (x, y), in eighths of a turn, from 0 to 8.

    It is within 1e-9 of the true one; that of (0, 0) is 0.
    """
    wide, high = abs(x), abs(y)
    larger = max(wide, high)
    eighths = _eighths_of_tangent(min(wide, high) / (larger if larger > 0.0 else 1.0))
    eighths = 2.0 - eighths if high > wide else eighths
    eighths = 4.0 - eighths if x < 0.0 else eighths
    return 8.0 - eighths if y < 0.0 else eighths


@device
def _eighths_of_tangent(tangent: float) -> float:
    """Return the angle of a tangent from 0 to 1, in eighths of a turn."""
    t = tangent * tangent
    angle = 0.0011937434456338798
    angle = angle * t - 0.008142105223994398
    angle = angle * t + 0.026060522778550133
    angle = angle * t - 0.05358830933266417
    angle = angle * t + 0.08328745982786434
    angle = angle * t - 0.11094833303524455
    angle = angle * t + 0.14042115096647326
    angle = angle * t - 0.1817477152084893
    angle = angle * t + 0.2546368292338939
    angle = angle * t - 0.4244127837720484
    angle = angle * t + 1.2732395404984007
    return tangent * angle
