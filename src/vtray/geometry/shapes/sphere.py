"""The sphere: where a ray meets it, what it hides, its normal, and where bundles meet it."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.bundle import (
    Bundle,
    Crossing,
    Passage,
    bundle_width,
    first_crossing,
    spread_ahead,
    spread_beside,
)
from vtray.geometry.circle import PI, angle_of
from vtray.geometry.ray import Ray, Segment
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.shapes.columns import Columns, Place, to_kernels, world_point
from vtray.geometry.shapes.sides import Sides, all_sides
from vtray.geometry.shapes.solid import Chord
from vtray.geometry.shapes.stay import Stay, seen_stay
from vtray.geometry.shapes.surface import Surface
from vtray.geometry.shapes.unrolled import Unrolled, Upright, place_around
from vtray.geometry.vector import Vec, add, cross, dot, magnitude, scale, sub

SIZE = 4
"""Numbers of a sphere in its columns: the centre, and the radius."""


class SphereShape(NamedTuple):
    """A sphere in the kernels' space.

    Attributes
    ----------
    center, radius
        Those of the sphere, which is its own bounding ball.
    error_scale
        What its rounding errors are relative to.
    """

    center: Vec
    radius: float
    error_scale: float


@device
def load_sphere(columns: Columns, slot: int, place: Place) -> SphereShape:
    """Return one of the spheres."""
    center = to_kernels(world_point(columns, SIZE * slot, place), place)
    radius = columns.data[SIZE * slot + 3] * place.scale
    return SphereShape(center, radius, magnitude(center) + radius)


@device
def approach_sphere(from_center: Vec, direction: Vec, radius: float) -> tuple[float, float]:
    """Return where on a ray a sphere's centre is nearest, and the discriminant.

    This is taken from the closest approach, not from ``b*b - c``, so that it stays accurate for a
    small sphere far away. The parameters are those of `intersect_sphere`.

    References
    ----------
    Haines, Gunther, Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection",
    Ray Tracing Gems (2019), chapter 7.
    """
    middle = -dot(from_center, direction)
    approach = add(from_center, scale(middle, direction))
    return middle, radius * radius - dot(approach, approach)


@device
def intersect_sphere(from_center: Vec, direction: Vec, radius: float) -> tuple[float, float]:
    """Return the distances at which a ray enters and leaves a sphere.

    Parameters
    ----------
    from_center
        The ray's origin minus the sphere's centre.
    direction
        The ray's unit direction.
    radius
        The sphere's radius.

    Returns
    -------
    near, far
        Distances along the ray, both ``inf`` for a miss. A sphere of radius 0 is always missed.
    """
    middle, discriminant = approach_sphere(from_center, direction, radius)
    half_chord = math.sqrt(max(discriminant, 0.0))
    near = middle - half_chord if discriminant > 0.0 else math.inf
    far = middle + half_chord if discriminant > 0.0 else math.inf
    return near, far


@device
def sphere_distance(sphere: SphereShape, ray: Ray) -> float:
    """Return the distance to the first point of a sphere that a ray meets, or infinity.

    The ray counts from the image plane on. Where it starts on the sphere, as near as rounding can
    tell, it meets the sphere only where it crosses it elsewhere.
    """
    near, far = _ends_within(sphere, ray)
    error_scale = sphere.error_scale + ray.error_scale
    if near * ray.forward + ray.plane_depth > ROUNDING * (abs(near) + error_scale):
        return near
    if far * ray.forward + ray.plane_depth > ROUNDING * (abs(far) + error_scale):
        return far
    return math.inf


@device
def sphere_stay(sphere: SphereShape, ray: Ray) -> Stay:
    """Return the part of a ray within a sphere, by the rules of `sphere_distance`."""
    near, far = _ends_within(sphere, ray)
    return seen_stay(ray, Chord(near, far, 1.0, 1.0), sphere.error_scale + ray.error_scale)


@device
def _ends_within(sphere: SphereShape, ray: Ray) -> tuple[float, float]:
    """Return where a ray enters and leaves a sphere: minus infinity where it starts inside."""
    from_center = sub(ray.origin, sphere.center)
    near, far = intersect_sphere(from_center, ray.direction, sphere.radius)
    if ray.error_bound > 0.0:
        start = dot(from_center, from_center) - sphere.radius * sphere.radius
        slack = ray.error_bound * (2.0 * sphere.radius + ray.error_bound)
        ahead = -dot(from_center, ray.direction) > 0.0
        near = near if (start > slack) & ahead else -math.inf
        far = far if (start < -slack) | ahead else math.inf
    return near, far


@device
def sphere_chord(
    sphere: SphereShape,
    origin: Vec,
    direction: Vec,
    error_bound: float,  # noqa: ARG001
) -> Chord:
    """Return where a line in a unit direction is within a sphere."""
    near, far = intersect_sphere(sub(origin, sphere.center), direction, sphere.radius)
    return Chord(near, far, 1.0, 1.0)


@device
def sphere_outside(sphere: SphereShape, point: Vec) -> float:
    """Return how far outside a sphere a point is, below 0 inside."""
    from_center = sub(point, sphere.center)
    return math.sqrt(dot(from_center, from_center)) - sphere.radius


@device
def sphere_power(sphere: SphereShape, point: Vec) -> float:
    """Return how deep a point is within a sphere, as a square below 0: its power.

    Where two spheres overlap, that of both is the same on the plane of the circle where they meet.
    """
    from_center = sub(point, sphere.center)
    return dot(from_center, from_center) - sphere.radius * sphere.radius


@device
def sphere_is_aside(sphere: SphereShape, ray: Ray) -> bool:
    """Tell whether the line of a ray passes by a sphere."""
    from_center = sub(ray.origin, sphere.center)
    _, discriminant = approach_sphere(from_center, ray.direction, sphere.radius)
    return not discriminant > 0.0


@device
def sphere_hides(sphere: SphereShape, segment: Segment) -> bool:
    """Tell whether a sphere stands between two points, in front of the image plane."""
    error_bound = ROUNDING * (segment.start_scale + sphere.error_scale)
    end_bound = ROUNDING * (sphere.error_scale + segment.end_scale)
    from_center = sub(segment.start, sphere.center)
    to_end = sub(segment.end, segment.start)
    end_from_center = sub(segment.end, sphere.center)
    if segment.end_plane_depth < 0.0:
        # The way counts up to where it passes through the image plane.
        share = segment.start_plane_depth / (segment.start_plane_depth - segment.end_plane_depth)
        to_end = scale(share, to_end)
        end_from_center = add(from_center, to_end)
        end_bound = error_bound + share * end_bound
    return sphere_blocks(
        from_center, to_end, end_from_center, sphere.radius, error_bound, end_bound
    )


@device
def sphere_blocks(
    from_center: Vec,
    to_end: Vec,
    end_from_center: Vec,
    radius: float,
    error_bound: float,
    end_bound: float,
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
    error_bound, end_bound
        How far rounding may have moved the start, and the end.
    """
    radius2 = radius * radius
    slack = error_bound * (2.0 * radius + error_bound)  # (radius + error_bound)^2 - radius^2
    end_slack = end_bound * (2.0 * radius + end_bound)
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


@device
def sphere_sides(sphere: SphereShape, point: Vec, error_scale: float) -> Sides:  # noqa: ARG001
    """Return half-spaces that hold all directions: the ball around it says as much."""
    return all_sides()


@device
def sphere_is_outside(sphere: SphereShape, point: Vec, normal: Vec) -> bool:
    """Tell whether a point of a sphere is looked at from outside, given the normal there."""
    is_outside: bool = dot(normal, sub(point, sphere.center)) > 0.0
    return is_outside


@device
def sphere_crossing(sphere: SphereShape, bundle: Bundle) -> Crossing:
    """Return from where to where the rays of a bundle first meet a sphere."""
    return first_crossing(sphere_passage(sphere, bundle), bundle)


@device
def sphere_passage(sphere: SphereShape, bundle: Bundle) -> Passage:
    """Return where the rays of a bundle enter and leave a sphere.

    At the distance t an offset e is at least ``gap - along(e)`` beside the centre, where `gap` is
    that of the middle ray, and ``|t - middle| - ahead(e)`` before or behind it; by Pythagoras, no
    ray is inside before one distance, and all of them are from another on.
    """
    to_center = sub(sphere.center, bundle.origin)
    middle = dot(to_center, bundle.direction)
    beside = sub(to_center, scale(middle, bundle.direction))
    gap = math.sqrt(dot(beside, beside))
    along, ahead = spread_beside(bundle, beside, gap), spread_ahead(bundle)
    radius = sphere.radius
    widths = (
        bundle_width(bundle, middle - radius - bundle.width * ahead),
        bundle_width(bundle, middle),
        bundle_width(bundle, middle + radius),
    )
    # The edge of the bundle beside the sphere is a line of this slope.
    slope = bundle.growth * along
    touches = gap - widths[1] * along <= radius * math.sqrt(1.0 + slope * slope)
    covers = _all_inside(bundle, gap, along, widths[1], radius) > 0.0
    before, behind = max(widths[0], widths[1]), max(widths[1], widths[2])
    any_chord = _any_chord(gap, along, ahead, before, radius)
    all_chord = _all_chord(bundle, gap, along, ahead, before, radius)
    enters = Crossing(middle - any_chord, middle - all_chord)
    if bundle.is_cut & (behind > before):
        any_chord = _any_chord(gap, along, ahead, behind, radius)
        all_chord = _all_chord(bundle, gap, along, ahead, behind, radius)
    last = middle + any_chord if touches & (radius > 0.0) else -math.inf
    return Passage(enters, Crossing(middle + all_chord, last), covers)


@device
def _any_chord(gap: float, along: float, ahead: float, width: float, radius: float) -> float:
    """Return half the length within which any ray of a bundle may be inside a sphere."""
    least = max(gap - width * along, 0.0)
    return math.sqrt(max(radius * radius - least * least, 0.0)) + width * ahead


@device
def _all_chord(
    bundle: Bundle, gap: float, along: float, ahead: float, width: float, radius: float
) -> float:
    """Return half a length within which all rays of a bundle are inside a sphere; 0 if none is."""
    inside, own = max(_all_inside(bundle, gap, along, width, radius), 0.0), width * ahead
    return max(math.sqrt(own * own + inside) - own, 0.0)


@device
def _all_inside(bundle: Bundle, gap: float, along: float, width: float, radius: float) -> float:
    """Return by how much all rays are inside where the middle one is nearest, as a square."""
    offset = width * bundle.stretch
    return radius * radius - (gap * gap + 2.0 * gap * width * along + offset * offset)


@device
def sphere_surface(sphere: SphereShape, point: Vec, error_scale: float) -> Surface:  # noqa: ARG001
    """Return the surface of a sphere, which is the same everywhere."""
    return Surface(sphere.center, True, sphere.error_scale, False, False)


@device
def sphere_unroll(sphere: SphereShape, point: Vec, upright: Upright) -> Unrolled:
    """Return where a point is on the map of a sphere, by its longitude and latitude."""
    offset = sub(point, sphere.center)
    x, y = place_around(offset, upright.up, upright)
    across = sphere.radius * (angle_of(x, y) + PI)
    height = dot(offset, upright.up)
    down = sphere.radius * angle_of(height, math.sqrt(x * x + y * y))
    return Unrolled(across, down, 2.0 * PI * sphere.radius, PI * sphere.radius, True)
