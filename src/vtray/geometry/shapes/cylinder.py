"""The cylinder with flat caps: where a ray meets it, what it hides, its normal and its outline.

A cylinder is what an endless one and the slab between two planes have in common. A line is within
each from one distance to another, and so within both from the larger of the first to the smaller of
the second.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.ray import Footprint, Ray, Segment, width_at
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.shapes.columns import Columns, Place, to_kernels, world_point
from vtray.geometry.shapes.surface import Surface
from vtray.geometry.vector import Vec, add, dot, magnitude, scale, sub

SIZE = 7
"""Numbers of a cylinder in its columns: the two ends of its axis, and the radius."""

SLIGHT = 2.0**-60
"""So small a share of a slope that the end of any cylinder comes first."""


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


class Line(NamedTuple):
    """A line beside a cylinder: its way along the axis, and that around it.

    Attributes
    ----------
    height, rise
        How far along the axis it starts, and how that grows.
    beside, aside
        How far from the axis it starts, and how that grows, as vectors square to the axis.
    """

    height: float
    rise: float
    beside: Vec
    aside: Vec


class Span(NamedTuple):
    """From where to where a line is within something, in its own unit; empty if not near < far."""

    near: float
    far: float


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
def line_beside(cylinder: CylinderShape, origin: Vec, way: Vec) -> Line:
    """Return a line through a point in a direction as the cylinder sees it."""
    from_start = sub(origin, cylinder.start)
    height, rise = dot(from_start, cylinder.axis), dot(way, cylinder.axis)
    return Line(
        height,
        rise,
        sub(from_start, scale(height, cylinder.axis)),
        sub(way, scale(rise, cylinder.axis)),
    )


@device
def move_along(line: Line, distance: float) -> Line:
    """Return a line that starts so much later."""
    return Line(
        line.height + distance * line.rise,
        line.rise,
        add(line.beside, scale(distance, line.aside)),
        line.aside,
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
def cap_span(line: Line, low: float, high: float) -> Span:
    """Return where a line is between two heights."""
    rises = line.rise != 0.0
    divisor = line.rise if rises else 1.0
    first, last = (low - line.height) / divisor, (high - line.height) / divisor
    between = (line.height > low) & (line.height < high)
    near = min(first, last) if rises else -math.inf
    far = max(first, last) if rises else math.inf
    return Span(near if rises | between else math.inf, far if rises | between else -math.inf)


@device
def both_spans(one: Span, other: Span) -> Span:
    """Return where a line is within two things."""
    return Span(max(one.near, other.near), min(one.far, other.far))


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
def cylinder_distance(cylinder: CylinderShape, ray: Ray) -> float:
    """Return the distance to the first point of a cylinder that a ray meets, or infinity.

    The ray counts from the image plane on. Where it starts on the cylinder, as near as rounding can
    tell, it meets the cylinder only where it crosses it elsewhere.
    """
    line = line_beside(cylinder, ray.origin, ray.direction)
    side = side_span(line, cylinder.side_radius)
    caps = cap_span(line, 0.0, cylinder.length)
    span = both_spans(side, caps)
    # A surface that the ray meets at a small angle magnifies the error of the distance.
    slope, steepness = abs(line.rise), math.sqrt(dot(line.aside, line.aside))
    near_slope = slope if caps.near >= side.near else steepness
    far_slope = slope if caps.far <= side.far else steepness
    near, far = span.near, span.far
    error_scale = cylinder.error_scale + ray.error_scale
    meets = enters_clearly(cylinder, line, span, ROUNDING * error_scale)
    if ray.error_bound > 0.0:
        outside = signed_distance(cylinder, line)
        ahead = near + far > 0.0
        near = near if (outside > ray.error_bound) & ahead else -math.inf
        far = far if (outside < -ray.error_bound) | ahead else math.inf
    near_plane_depth = near * ray.forward + ray.plane_depth
    far_plane_depth = far * ray.forward + ray.plane_depth
    sees_near = meets & (near_plane_depth * near_slope > ROUNDING * (abs(near) + error_scale))
    sees_far = meets & (far_plane_depth * far_slope > ROUNDING * (abs(far) + error_scale))
    return near if sees_near else far if sees_far else math.inf


@device
def cylinder_is_aside(cylinder: CylinderShape, ray: Ray) -> bool:  # noqa: ARG001
    """Return False: what tells that costs as much as `cylinder_distance`."""
    return False


@device
def cylinder_hides(cylinder: CylinderShape, segment: Segment) -> bool:
    """Tell whether a cylinder stands between two points, in front of the image plane."""
    error_bound = ROUNDING * (segment.start_scale + cylinder.error_scale)
    end_bound = ROUNDING * (cylinder.error_scale + segment.end_scale)
    to_end = sub(segment.end, segment.start)
    end = segment.end
    if segment.end_plane_depth < 0.0:
        # The way counts up to where it passes through the image plane.
        share = segment.start_plane_depth / (segment.start_plane_depth - segment.end_plane_depth)
        to_end = scale(share, to_end)
        end = add(segment.start, to_end)
        end_bound = error_bound + share * end_bound
    line = line_beside(cylinder, segment.start, to_end)
    span = both_spans(side_span(line, cylinder.side_radius), cap_span(line, 0.0, cylinder.length))
    start_outside = signed_distance(cylinder, line)
    end_outside = signed_distance(cylinder, line_beside(cylinder, end, to_end))
    middle = 0.5 * (span.near + span.far)
    meets = enters_clearly(cylinder, line, span, error_bound) & (middle > 0.0)
    enters = meets & ((end_outside < -end_bound) | (middle < 1.0))
    leaves = (end_outside > end_bound) & ((start_outside < -error_bound) | meets)
    return enters if start_outside > error_bound else leaves


@device
def cylinder_pole(cylinder: CylinderShape, point: Vec) -> tuple[Vec, bool]:
    """Return the point of the axis that a point of the side is round, or the normal of its cap.

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
    axis = cylinder.axis
    return (
        foot[0] if is_round else axis[0],
        foot[1] if is_round else axis[1],
        foot[2] if is_round else axis[2],
    ), is_round


@device
def cylinder_surface(cylinder: CylinderShape, point: Vec, error_scale: float) -> Surface:
    """Return the surface of a cylinder at a point."""
    pole, is_round = cylinder_pole(cylinder, point)
    is_second = is_second_half(cylinder, point, error_scale)
    return Surface(pole, is_round, cylinder.error_scale, is_second)


@device
def is_second_half(cylinder: CylinderShape, point: Vec, error_scale: float) -> bool:
    """Tell whether a point is nearer to the end of the axis, by more than rounding can explain.

    Parameters
    ----------
    cylinder
        The cylinder.
    point
        The point.
    error_scale
        What its rounding error is relative to, beside the cylinder.
    """
    height = dot(sub(point, cylinder.start), cylinder.axis)
    error_bound = ROUNDING * (cylinder.error_scale + error_scale)
    return height - 0.5 * cylinder.length > error_bound


@device
def cylinder_outline(cylinder: CylinderShape, ray: Ray, footprint: Footprint) -> float:
    """Return the distance at which a ray passes an outline or an edge, or infinity if none is near.

    That is the case where it would meet the cylinder if that were a little larger, but not if it
    were a little smaller; where it passes the edge of the cap that it looks at; and where it passes
    that at which the image plane cuts the cylinder open.
    """
    line = line_beside(cylinder, ray.origin, ray.direction)
    passing = _passing_distance(cylinder, line, ray, footprint)
    width = width_at(footprint, max(passing, 0.0))
    larger, smaller = _larger_span(cylinder, line, width), _larger_span(cylinder, line, -width)
    caps = cap_span(line, 0.0, cylinder.length)
    span = both_spans(side_span(line, cylinder.side_radius), caps)
    is_hit = span.near < span.far
    # Within a cylinder that is cut open, its far end is seen.
    is_open = is_hit & (span.near * ray.forward + ray.plane_depth <= 0.0)
    at_edge = is_hit & _is_at_edge(cylinder, line, footprint, caps.far if is_open else caps.near)
    plane = -ray.plane_depth / ray.forward
    from_cut = abs(signed_distance(cylinder, move_along(line, plane)))
    at_cut = from_cut <= width_at(footprint, max(plane, 0.0))
    is_near = (larger.near < larger.far) & (at_edge | at_cut | (smaller.near >= smaller.far))
    # No nearer than the pixel is wide enough for it.
    nearer = _larger_span(cylinder, line, width_at(footprint, max(larger.near, 0.0)))
    beside = min(max(passing, larger.near), larger.far)
    entry = nearer.near if nearer.near < nearer.far else beside
    distance = span.near if is_hit else entry
    return distance if is_near & (larger.far > -ray.plane_depth) else math.inf


@device
def _larger_span(cylinder: CylinderShape, line: Line, width: float) -> Span:
    """Return where a line would be within a cylinder that is larger to all sides."""
    side_radius = max(cylinder.side_radius + width, 0.0)
    caps = cap_span(line, -width, cylinder.length + width)
    return both_spans(side_span(line, side_radius), caps)


@device
def _passing_distance(cylinder: CylinderShape, line: Line, ray: Ray, footprint: Footprint) -> float:
    """Return the distance at which the fewest widths of a pixel are between a ray and the axis."""
    square = dot(line.aside, line.aside)
    middle = -dot(line.beside, line.aside) / square if square > 0.0 else 0.0
    # Farther away the axis may be farther from the ray, but pixels are wider, too.
    approach = add(line.beside, scale(middle, line.aside))
    slope2 = max(square - footprint.growth * footprint.growth, SLIGHT * square)
    shift = footprint.growth * math.sqrt(dot(approach, approach))
    shift = shift / math.sqrt(square * slope2) if square > 0.0 else 0.0
    height = min(max(line.height + (middle + shift) * line.rise, 0.0), cylinder.length)
    foot = add(cylinder.start, scale(height, cylinder.axis))
    return dot(sub(foot, ray.origin), ray.direction)


@device
def _is_at_edge(cylinder: CylinderShape, line: Line, footprint: Footprint, distance: float) -> bool:
    """Tell whether a ray is near the edge of a cap whose plane it meets at a distance."""
    crossing = distance if line.rise != 0.0 else 0.0
    place = add(line.beside, scale(crossing, line.aside))
    from_edge = abs(math.sqrt(dot(place, place)) - cylinder.side_radius)
    width = width_at(footprint, max(crossing, 0.0))
    return (line.rise != 0.0) & (from_edge * abs(line.rise) <= width)
