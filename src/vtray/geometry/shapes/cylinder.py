"""The cylinder with flat caps: where a ray meets it, what it hides, its normal, its bundles.

A cylinder is what an endless one and the slab between two planes have in common. A line is within
each from one distance to another, and so within both from the larger of the first to the smaller of
the second.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.bundle import (
    Bundle,
    Crossing,
    Passage,
    bundle_width,
    spread_along,
    spread_beside,
)
from vtray.geometry.ray import Ray, Segment, way_in_front
from vtray.geometry.rounding import MARGIN, ROUNDING
from vtray.geometry.shapes.axis_line import (
    Line,
    Span,
    at_least,
    axial_crossing,
    axial_passage,
    both_spans,
    cap_span,
    is_second_half,
    line_beside,
    move_along,
    passes_by,
    side_or_cap,
    sides_around,
)
from vtray.geometry.shapes.columns import Columns, Place, to_kernels, world_point
from vtray.geometry.shapes.sides import Sides
from vtray.geometry.shapes.solid import Chord, chord_if, chord_that_counts, first_met
from vtray.geometry.shapes.stay import Stay, no_stay, seen_stay
from vtray.geometry.shapes.surface import Surface
from vtray.geometry.shapes.unrolled import (
    Unrolled,
    Upright,
    not_unrolled,
    unrolled_side,
)
from vtray.geometry.vector import Vec, add, dot, magnitude, scale, sub

SIZE = 7
"""Numbers of a cylinder in its columns: the two ends of its axis, and the radius."""


class CylinderShape(NamedTuple):
    """A cylinder in the kernels' space.

    Attributes
    ----------
    start
        Where its axis starts.
    axis
        The unit direction to the end, 0 for a cylinder without length.
    length
        How far the end is.
    side_radius
        How far its side is from the axis.
    center, radius
        Its bounding ball.
    error_scale
        What its rounding errors are relative to.
    """

    start: Vec
    axis: Vec
    length: float
    side_radius: float
    center: Vec
    radius: float
    error_scale: float


@device
def load_cylinder(columns: Columns, slot: int, place: Place) -> CylinderShape:
    """Return one of the cylinders."""
    first = SIZE * slot
    world_start = world_point(columns, first, place)
    world_end = world_point(columns, first + 3, place)
    # Scaled first: the difference could overflow.
    way = sub(scale(place.scale, world_end), scale(place.scale, world_start))
    length2 = dot(way, way)
    length = math.sqrt(length2)
    divisor = length if length2 > 0.0 else 1.0
    axis = way[0] / divisor, way[1] / divisor, way[2] / divisor
    start = to_kernels(world_start, place)
    side_radius = columns.data[first + 6] * place.scale
    return CylinderShape(
        start,
        axis,
        length if length2 > 0.0 else 0.0,
        side_radius,
        add(start, scale(0.5, way)),
        math.sqrt(side_radius * side_radius + 0.25 * length2),
        magnitude(start) + length + side_radius,
    )


@device
def side_span(line: Line, side_radius: float) -> Span:
    """Return where a line is within the endless cylinder.

    As for a sphere, the discriminant is taken from the closest approach.
    """
    square = dot(line.aside, line.aside)
    is_slanted = square > 0.0
    middle = -dot(line.beside, line.aside) / square if is_slanted else 0.0
    approach = add(line.beside, scale(middle, line.aside))
    discriminant = side_radius * side_radius - dot(approach, approach)
    meets = discriminant > 0.0
    half = math.sqrt(max(discriminant, 0.0) / square) if is_slanted else math.inf
    return Span(middle - half if meets else math.inf, middle + half if meets else -math.inf)


@device
def signed_distance(cylinder: CylinderShape, line: Line) -> float:
    """Return how far outside a cylinder a line starts, below 0 inside; a bound beyond its edges."""
    aside = math.sqrt(dot(line.beside, line.beside)) - cylinder.side_radius
    return max(aside, -line.height, line.height - cylinder.length)


@device
def enters_clearly(cylinder: CylinderShape, line: Line, span: Span, error_bound: float) -> bool:
    """Tell whether a line comes farther into a cylinder than rounding can explain.

    Outlines and caps seen edge-on are straight: rounding would decide pixel by pixel of a whole
    row of them what is hit.
    """
    middle = move_along(line, 0.5 * (span.near + span.far))
    inner = max(cylinder.side_radius - error_bound, 0.0)
    within = dot(middle.beside, middle.beside) < inner * inner
    above, below = middle.height > error_bound, middle.height < cylinder.length - error_bound
    return (span.near < span.far) & within & above & below


@device
def cylinder_chord(
    cylinder: CylinderShape, origin: Vec, direction: Vec, error_bound: float
) -> Chord:
    """Return where a line is within a cylinder, if it comes clearly into it."""
    line = line_beside(cylinder, origin, direction)
    side = side_span(line, cylinder.side_radius)
    caps = cap_span(line, 0.0, cylinder.length)
    span = both_spans(side, caps)
    slope, steepness = abs(line.rise), math.sqrt(dot(line.aside, line.aside))
    near_slope = slope if caps.near >= side.near else steepness
    far_slope = slope if caps.far <= side.far else steepness
    meets = enters_clearly(cylinder, line, span, error_bound)
    return chord_if(meets, Chord(span.near, span.far, near_slope, far_slope))


@device
def cylinder_outside(cylinder: CylinderShape, point: Vec) -> float:
    """Return how far outside a cylinder a point is, as `signed_distance`."""
    return signed_distance(cylinder, line_beside(cylinder, point, cylinder.axis))


@device
def cylinder_power(cylinder: CylinderShape, point: Vec) -> float:
    """Return how deep a point is within the side of a cylinder, as a square below 0."""
    line = line_beside(cylinder, point, cylinder.axis)
    return dot(line.beside, line.beside) - cylinder.side_radius * cylinder.side_radius


@device
def cylinder_distance(cylinder: CylinderShape, ray: Ray) -> float:
    """Return the distance to the first point of a cylinder that a ray meets, or infinity.

    The ray counts from the image plane on. Where it starts on the cylinder, as near as rounding can
    tell, it meets the cylinder only where it crosses it elsewhere.
    """
    error_scale = cylinder.error_scale + ray.error_scale
    chord = cylinder_chord(cylinder, ray.origin, ray.direction, ROUNDING * error_scale)
    outside = cylinder_outside(cylinder, ray.origin)
    return first_met(chord_that_counts(chord, outside, ray), ray, error_scale)


@device
def cylinder_stay(cylinder: CylinderShape, ray: Ray) -> Stay:
    """Return the part of a ray within a cylinder, by the rules of `cylinder_distance`."""
    error_scale = cylinder.error_scale + ray.error_scale
    chord = cylinder_chord(cylinder, ray.origin, ray.direction, ROUNDING * error_scale)
    if not chord.near < chord.far:
        return no_stay()
    outside = cylinder_outside(cylinder, ray.origin)
    return seen_stay(ray, chord_that_counts(chord, outside, ray), error_scale)


@device
def cylinder_is_aside(cylinder: CylinderShape, ray: Ray) -> bool:  # noqa: ARG001
    """Return False: what tells that costs as much as `cylinder_distance`."""
    return False


@device
def cylinder_hides(cylinder: CylinderShape, segment: Segment) -> bool:
    """Tell whether a cylinder stands between two points, in front of the image plane."""
    error_bound = ROUNDING * (segment.start_scale + cylinder.error_scale)
    end_bound = ROUNDING * (cylinder.error_scale + segment.end_scale)
    way, end, end_bound = way_in_front(segment, error_bound, end_bound)
    line = line_beside(cylinder, segment.start, way)
    if passes_by(line, cylinder.side_radius, MARGIN * (segment.start_scale + cylinder.error_scale)):
        return False
    span = both_spans(side_span(line, cylinder.side_radius), cap_span(line, 0.0, cylinder.length))
    start_outside = signed_distance(cylinder, line)
    end_outside = signed_distance(cylinder, line_beside(cylinder, end, way))
    middle = 0.5 * (span.near + span.far)
    meets = enters_clearly(cylinder, line, span, error_bound) & (middle > 0.0)
    enters = meets & ((end_outside < -end_bound) | (middle < 1.0))
    leaves = (end_outside > end_bound) & ((start_outside < -error_bound) | meets)
    return enters if start_outside > error_bound else leaves


@device
def cylinder_sides(cylinder: CylinderShape, point: Vec, error_scale: float) -> Sides:
    """Return the half-spaces in which a cylinder lies as it is seen from a point."""
    return sides_around(cylinder, cylinder.side_radius, point, error_scale)


@device
def cylinder_pole(cylinder: CylinderShape, point: Vec) -> tuple[Vec, bool]:
    """Return the point of the axis that the side is round at a point, or the normal of its cap.

    Returns
    -------
    pole, is_round
        As in `Surface`: the side is round, and the caps are not.
    """
    line = line_beside(cylinder, point, cylinder.axis)
    from_side = abs(math.sqrt(dot(line.beside, line.beside)) - cylinder.side_radius)
    from_cap = min(abs(line.height), abs(cylinder.length - line.height))
    foot = add(cylinder.start, scale(line.height, cylinder.axis))
    is_round = from_side <= from_cap
    return side_or_cap(cylinder, line.height, foot, is_round), is_round


@device
def cylinder_surface(cylinder: CylinderShape, point: Vec, error_scale: float) -> Surface:
    """Return the surface of a cylinder at a point."""
    pole, is_round = cylinder_pole(cylinder, point)
    is_second = is_second_half(cylinder, point, error_scale)
    return Surface(pole, is_round, cylinder.error_scale, is_second, False)


@device
def cylinder_is_outside(cylinder: CylinderShape, point: Vec, normal: Vec) -> bool:
    """Tell whether a point of a cylinder is looked at from outside, given the normal there."""
    is_outside: bool = dot(normal, sub(point, cylinder.center)) > 0.0
    return is_outside


@device
def cylinder_crossing(cylinder: CylinderShape, bundle: Bundle) -> Crossing:
    """Return from where to where the rays of a bundle first meet a cylinder.

    As long as a bundle is no wider than some width, none of its rays is inside before it would be
    inside a cylinder that is so much larger to all sides, and all are where they would be inside
    one that is so much smaller.
    """
    line = line_beside(cylinder, bundle.origin, bundle.direction)
    any_inside = _any_inside(cylinder, line, bundle)
    return axial_crossing(cylinder, line, bundle, any_inside, _spans)


@device
def cylinder_passage(cylinder: CylinderShape, bundle: Bundle) -> Passage:
    """Return where the rays of a bundle enter and leave a cylinder."""
    line = line_beside(cylinder, bundle.origin, bundle.direction)
    any_inside = _any_inside(cylinder, line, bundle)
    return axial_passage(cylinder, line, bundle, any_inside, _spans).passage


@device
def _spans(cylinder: CylinderShape, line: Line, wide: float, along: float) -> tuple[Span, Span]:
    """Return where a line is within the side and the caps of a larger cylinder."""
    side = side_span(line, max(cylinder.side_radius + wide, 0.0))
    return side, cap_span(line, -along, cylinder.length + along)


@device
def _any_inside(cylinder: CylinderShape, line: Line, bundle: Bundle) -> Span:
    """Return where any ray of a bundle may be inside a cylinder."""
    square = dot(line.aside, line.aside)
    slope = bundle.growth * bundle.stretch
    to_center = dot(sub(cylinder.center, bundle.origin), bundle.direction)
    # Counted from where it is nearest to the axis, as far as that is near, the sum has most digits.
    closest = -dot(line.beside, line.aside) / square if square > 0.0 else 0.0
    low = max(to_center - cylinder.radius, 0.0)
    high = max(to_center + cylinder.radius, low)
    end = -bundle.width / bundle.growth if bundle.growth < 0.0 else math.inf
    at = min(max(closest, low), high, end)
    beside = add(line.beside, scale(at, line.aside))
    reach = cylinder.side_radius + bundle.stretch * bundle_width(bundle, at)
    # |beside + s aside| <= reach + s slope
    first = square - slope * slope
    half = dot(beside, line.aside) - slope * reach
    rest = dot(beside, beside) - reach * reach
    discriminant = half * half - first * rest
    root = math.sqrt(max(discriminant, 0.0))
    is_bounded = first > 0.0
    divisor = first if is_bounded else 1.0
    near = at + (-half - root) / divisor if is_bounded else -math.inf
    far = at + (-half + root) / divisor if is_bounded else math.inf
    is_empty = is_bounded & (discriminant < 0.0)
    side = Span(math.inf if is_empty else near, -math.inf if is_empty else far)
    along = spread_along(bundle, cylinder.axis)
    wide, growth = along * bundle.width, along * bundle.growth
    above = at_least(line.rise + growth, -line.height - wide)
    below = at_least(growth - line.rise, line.height - cylinder.length - wide)
    span = both_spans(side, both_spans(above, below))
    # Beside the axis, the bundle may be narrower than its longest offset.
    gap2 = dot(beside, beside)
    gap = math.sqrt(gap2)
    across = spread_beside(bundle, beside, gap)
    width = max(bundle_width(bundle, span.near), bundle_width(bundle, span.far))
    misses = (at == closest) & (gap - width * across > cylinder.side_radius)
    # Along the axis, it may pass by as well.
    widest = bundle.stretch * max(bundle_width(bundle, low), bundle_width(bundle, high))
    nearest = gap - math.sqrt(square) * (high - low) - widest
    misses = misses | ((not is_bounded) & (nearest > cylinder.side_radius))
    misses = misses | (span.near > span.far)
    misses = misses | (cylinder.side_radius <= 0.0) | (cylinder.length <= 0.0)
    return Span(math.inf if misses else span.near, -math.inf if misses else span.far)


@device
def cylinder_unroll(cylinder: CylinderShape, point: Vec, upright: Upright) -> Unrolled:
    """Return where a point is on the unrolled side of a cylinder, from its end on."""
    pole, is_round = cylinder_pole(cylinder, point)
    if not is_round:
        return not_unrolled()
    axis, length = cylinder.axis, cylinder.length
    down = length - dot(sub(pole, cylinder.start), axis)
    return unrolled_side(sub(point, pole), axis, down, cylinder.side_radius, length, upright)
