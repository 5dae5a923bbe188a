"""The sphere: where a ray meets it, and whether it blocks a shadow ray."""

import math

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, add, cross, dot, scale


@device
def intersect_sphere(eye_from_center: Vec, direction: Vec, radius: float) -> tuple[float, float]:
    """Return the distances at which a ray enters and leaves a sphere.

    The discriminant is taken from the closest approach, not from ``b*b - c``, so that it stays
    accurate for a small sphere far away.

    Parameters
    ----------
    eye_from_center
        The ray's origin minus the sphere's centre.
    direction
        The ray's unit direction.
    radius
        The sphere's radius.

    Returns
    -------
    near, far
        Distances along the ray, both ``inf`` for a miss. A sphere of radius 0 is always missed.

    References
    ----------
    Haines, Gunther, Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection",
    Ray Tracing Gems (2019), chapter 7.
    """
    middle = -dot(eye_from_center, direction)
    approach = add(eye_from_center, scale(middle, direction))
    discriminant = radius * radius - dot(approach, approach)
    half_chord = math.sqrt(max(discriminant, 0.0))
    near = middle - half_chord if discriminant > 0.0 else math.inf
    far = middle + half_chord if discriminant > 0.0 else math.inf
    return near, far


@device
def sphere_blocks(
    from_center: Vec,
    to_end: Vec,
    end_from_center: Vec,
    radius: float,
    reach: float,
    end_reach: float,
) -> bool:
    """Tell whether a sphere's surface lies between a point and the end of its shadow ray.

    No square root and no division. A start or an end that rounding could have moved across the
    surface is on it: the surface then blocks only where the ray crosses it elsewhere.

    Parameters
    ----------
    from_center
        The shadow ray's start minus the sphere's centre.
    to_end
        The shadow ray's end minus its start.
    end_from_center
        The shadow ray's end minus the sphere's centre.
    radius
        The sphere's radius.
    reach
        How far rounding may have moved the start.
    end_reach
        How far rounding may have moved the end.
    """
    radius2 = radius * radius
    slack = reach * (2.0 * radius + reach)  # (radius + reach)^2 - radius^2
    end_slack = end_reach * (2.0 * radius + end_reach)
    start = dot(from_center, from_center) - radius2
    end = dot(end_from_center, end_from_center) - radius2
    toward = -dot(from_center, to_end)
    length2 = dot(to_end, to_end)
    moment = cross(from_center, to_end)
    enters = (
        (toward > 0.0)
        & (dot(moment, moment) < radius2 * length2)
        & ((end < -end_slack) | (toward < length2))
    )
    leaves = (end > end_slack) & ((start < -slack) | (toward > 0.0))
    return enters if start > slack else leaves
