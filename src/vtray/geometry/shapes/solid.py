"""What solids have in common: where a line is within one, and what of that a ray meets."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.ray import Ray
from vtray.geometry.rounding import ROUNDING


class Chord(NamedTuple):
    """Where a line is within something, in units of its direction; empty if not near < far.

    Attributes
    ----------
    near, far
        From where to where.
    near_slope, far_slope
        The sines of the angles at which it meets the surface there: an error of the distance is
        one of the surface, divided by that.
    """

    near: float
    far: float
    near_slope: float
    far_slope: float


@device
def chord_if(meets: bool, chord: Chord) -> Chord:
    """Return a chord, or an empty one."""
    return Chord(
        chord.near if meets else math.inf,
        chord.far if meets else -math.inf,
        chord.near_slope,
        chord.far_slope,
    )


@device
def both_chords(one: Chord, other: Chord) -> Chord:
    """Return where a line is within two things."""
    return Chord(
        max(one.near, other.near),
        min(one.far, other.far),
        one.near_slope if one.near >= other.near else other.near_slope,
        one.far_slope if one.far <= other.far else other.far_slope,
    )


@device
def is_seen(distance: float, slope: float, ray: Ray, error_scale: float) -> bool:
    """Tell whether what a ray meets at a distance lies before the image plane, clear of rounding.

    A surface that the ray meets at a small angle magnifies the error of the distance.
    """
    plane_depth = distance * ray.forward + ray.plane_depth
    return plane_depth * slope > ROUNDING * (abs(distance) + error_scale)


@device
def chord_that_counts(chord: Chord, outside: float, ray: Ray) -> Chord:
    """Return the chord of a solid without the surface on which a ray starts.

    Parameters
    ----------
    chord
        Where the ray is within the solid.
    outside
        How far outside it the ray starts, below 0 inside.
    ray
        The ray. One that starts on the solid, as near as rounding can tell, meets it only where it
        crosses it elsewhere.
    """
    if ray.error_bound > 0.0:
        ahead = chord.near + chord.far > 0.0
        near = chord.near if (outside > ray.error_bound) & ahead else -math.inf
        far = chord.far if (outside < -ray.error_bound) | ahead else math.inf
        return Chord(near, far, chord.near_slope, chord.far_slope)
    return chord


@device
def first_met(chord: Chord, ray: Ray, error_scale: float) -> float:
    """Return the first end of a chord that is seen, or infinity."""
    sees_near = is_seen(chord.near, chord.near_slope, ray, error_scale)
    sees_far = is_seen(chord.far, chord.far_slope, ray, error_scale)
    return chord.near if sees_near else chord.far if sees_far else math.inf
