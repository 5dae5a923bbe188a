"""The part of a ray that is within a shape, as far as it counts."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.ray import Ray
from vtray.geometry.shapes.solid import Chord, is_seen


class Stay(NamedTuple):
    """From where to where a ray is within a shape.

    Attributes
    ----------
    near
        Where it enters; minus infinity if it does so where it does not count: behind its start, or
        behind the image plane.
    far
        Where it leaves; infinite if that does not count. Less than `near` if the ray is nowhere
        within the shape.
    """

    near: float
    far: float


@device
def no_stay() -> Stay:
    """Return that of a ray which is nowhere within a shape."""
    return Stay(math.inf, -math.inf)


@device
def seen_stay(ray: Ray, chord: Chord, error_scale: float) -> Stay:
    """Return what of a chord is in front of the image plane, as near as rounding can tell.

    Parameters
    ----------
    ray
        The ray.
    chord
        Where it is within a shape: from minus infinity on where it starts inside, and to infinity
        where it meets nothing, or only leaves what it starts on.
    error_scale
        What the errors of these distances are relative to.
    """
    near, far = chord.near, chord.far
    sees_near = is_seen(near, chord.near_slope, ray, error_scale)
    sees_far = is_seen(far, chord.far_slope, ray, error_scale)
    # Away from the plane, what comes before it does not count, and towards it, what comes after.
    is_backward = ray.forward < 0.0
    starts_behind = is_backward & (near > -math.inf) & (not sees_near)
    ends_behind = (not is_backward) & (not sees_far)
    if (far == math.inf) | starts_behind | ends_behind:
        return no_stay()
    return Stay(near if sees_near else -math.inf, far if sees_far else math.inf)
