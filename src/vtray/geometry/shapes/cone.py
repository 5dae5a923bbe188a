"""The cone with flat caps, which may be cut off: where a ray meets it, what it hides, its bundles.

A cone is what an endless one and the slab between two planes have in common. Its side is a line
turned around the axis: a point at a height h and r from the axis is ``cosine * r - (room + sine *
h)`` outside of it, where cosine and sine are those of the angle between axis and side. All these
stay small however flat or pointed a cone is, as the slope of its side would not.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.bundle import Bundle, Crossing, Passage, bundle_width, spread_along
from vtray.geometry.ray import Ray, Segment, way_in_front
from vtray.geometry.rounding import ROUNDING
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
from vtray.geometry.vector import Vec, add, cross, dot, magnitude, scale, sub

SIZE = 8
"""Numbers of a cone in its columns: the two ends of its axis, and the radii there."""


class ConeShape(NamedTuple):
    """A cone in the kernels' space.

    Attributes
    ----------
    start
        Where its axis starts.
    axis
        The unit direction to the end, 0 for a cone without length.
    length
        How far the end is.
    room
        How far the start is from its side.
    cosine, sine
        Those of the angle between axis and side; the sine is above 0 if it becomes wider.
    center, radius
        Its bounding ball.
    error_scale
        What its rounding errors are relative to.
    """

    start: Vec
    axis: Vec
    length: float
    room: float
    cosine: float
    sine: float
    center: Vec
    radius: float
    error_scale: float


class SideSpan(NamedTuple):
    """Where a line is within the side of a cone.

    Attributes
    ----------
    span
        From where to where.
    slant
        The sine of the angle between line and side where they meet, but for how far round the cone
        that is: times the room there, and the length of the line's unit.
    """

    span: Span
    slant: float


@device
def load_cone(columns: Columns, slot: int, place: Place) -> ConeShape:
    """Return one of the cones."""
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
    first_radius = columns.data[first + 6] * place.scale
    last_radius = columns.data[first + 7] * place.scale
    widening = last_radius - first_radius
    side2 = length2 + widening * widening
    side = math.sqrt(side2) if side2 > 0.0 else 1.0
    cosine = length / side
    widest = max(first_radius, last_radius)
    return ConeShape(
        start,
        axis,
        length if length2 > 0.0 else 0.0,
        cosine * first_radius,
        cosine,
        widening / side,
        add(start, scale(0.5, way)),
        math.sqrt(widest * widest + 0.25 * length2),
        magnitude(start) + length + widest,
    )


@device
def side_span(cone: ConeShape, line: Line, caps: Span, wide: float, growth: float) -> SideSpan:
    """Return where a line is within the side of a cone, which is endless beyond its caps.

    As for a sphere, all is taken from the closest approach to the axis, here between the caps:
    what is small near the tip is then worked out from what is small. The discriminant of the
    quadratic equation is written as the difference of two squares, ``|p|**2 - |q|**2``: of the
    part of the slant that the line would have if it met the axis, and that which it has round it.

    Parameters
    ----------
    cone, line
        The cone, and the line.
    caps
        Where the line is between the caps.
    wide, growth
        By how much the cone is larger at the start of the line, and how that grows.
    """
    square = dot(line.aside, line.aside)
    closest = -dot(line.beside, line.aside) / square if square > 0.0 else 0.0
    between = min(max(closest, caps.near), caps.far)
    at = between if caps.near < caps.far else 0.0
    near_axis = move_along(line, at)
    aside, beside = scale(cone.cosine, line.aside), scale(cone.cosine, near_axis.beside)
    room = cone.room + cone.sine * near_axis.height + (wide + at * growth)
    change = cone.sine * line.rise + growth
    # |beside + s aside| <= room + s change
    first = dot(aside, aside) - change * change
    half = dot(aside, beside) - room * change
    rest = dot(beside, beside) - room * room
    slant, turn = sub(scale(room, aside), scale(change, beside)), cross(aside, beside)
    slant2 = dot(slant, slant)
    discriminant = slant2 - dot(turn, turn)
    root = math.sqrt(max(discriminant, 0.0))
    # Neither is a difference of nearly equal numbers.
    sum_ = -(half + root) if half >= 0.0 else root - half
    endless = math.inf if sum_ > 0.0 else -math.inf
    one = sum_ / (first if first != 0.0 else 1.0) if first != 0.0 else endless
    other = rest / (sum_ if sum_ != 0.0 else 1.0) if sum_ != 0.0 else 0.0
    lower = one if half >= 0.0 else other
    upper = other if half >= 0.0 else one
    # A line that is steeper than the side leaves it only once, and never on the way it widens.
    is_steep = first < 0.0
    near = -math.inf if is_steep & (change < 0.0) else lower
    far = math.inf if is_steep & (change > 0.0) else upper
    # The equation holds for the cone beyond the tip as well.
    is_here = room * first - change * half > 0.0
    meets = is_steep | ((discriminant > 0.0) & is_here)
    is_along = (square == 0.0) & (change == 0.0)
    is_within = is_along & (rest < 0.0) & (room > 0.0)
    near = -math.inf if is_within else at + near if meets else math.inf
    far = math.inf if is_within else at + far if meets else -math.inf
    return SideSpan(Span(near, far), math.sqrt(slant2))


@device
def signed_distance(cone: ConeShape, line: Line) -> float:
    """Return how far outside a cone a line starts, below 0 inside; a bound beyond its edges."""
    away = cone.cosine * math.sqrt(dot(line.beside, line.beside))
    outside = away - (cone.room + cone.sine * line.height)
    return max(outside, -line.height, line.height - cone.length)


@device
def enters_clearly(cone: ConeShape, line: Line, span: Span, error_bound: float) -> bool:
    """Tell whether a line comes farther into a cone than rounding can explain.

    As for cylinders, outlines and caps seen edge-on are straight.
    """
    middle = move_along(line, 0.5 * (span.near + span.far))
    return (span.near < span.far) & (signed_distance(cone, middle) < -error_bound)


@device
def slant_at(cone: ConeShape, line: Line, side: SideSpan, distance: float) -> float:
    """Return what the error of a distance is divided by at which a line meets the side."""
    room = cone.room + cone.sine * (line.height + distance * line.rise)
    # At the tip, whatever leads there leads in.
    is_tip = (side.slant <= 0.0) | (not room > 0.0)
    return 1.0 if is_tip else side.slant / room


@device
def cone_chord(cone: ConeShape, origin: Vec, direction: Vec, error_bound: float) -> Chord:
    """Return where a line is within a cone, if it comes clearly into it."""
    line = line_beside(cone, origin, direction)
    caps = cap_span(line, 0.0, cone.length)
    side = side_span(cone, line, caps, 0.0, 0.0)
    span = both_spans(side.span, caps)
    slope = abs(line.rise)
    near_slope = slope if caps.near >= side.span.near else slant_at(cone, line, side, span.near)
    far_slope = slope if caps.far <= side.span.far else slant_at(cone, line, side, span.far)
    meets = enters_clearly(cone, line, span, error_bound)
    return chord_if(meets, Chord(span.near, span.far, near_slope, far_slope))


@device
def cone_outside(cone: ConeShape, point: Vec) -> float:
    """Return how far outside a cone a point is, as `signed_distance`."""
    return signed_distance(cone, line_beside(cone, point, cone.axis))


@device
def cone_power(cone: ConeShape, point: Vec) -> float:
    """Return how deep a point is within the side of a cone, as a square below 0."""
    line = line_beside(cone, point, cone.axis)
    room = cone.room + cone.sine * line.height
    return cone.cosine * cone.cosine * dot(line.beside, line.beside) - room * room


@device
def cone_distance(cone: ConeShape, ray: Ray) -> float:
    """Return the distance to the first point of a cone that a ray meets, or infinity.

    The ray counts from the image plane on. Where it starts on the cone, as near as rounding can
    tell, it meets the cone only where it crosses it elsewhere.
    """
    error_scale = cone.error_scale + ray.error_scale
    chord = cone_chord(cone, ray.origin, ray.direction, ROUNDING * error_scale)
    outside = cone_outside(cone, ray.origin)
    return first_met(chord_that_counts(chord, outside, ray), ray, error_scale)


@device
def cone_stay(cone: ConeShape, ray: Ray) -> Stay:
    """Return the part of a ray within a cone, by the rules of `cone_distance`."""
    error_scale = cone.error_scale + ray.error_scale
    chord = cone_chord(cone, ray.origin, ray.direction, ROUNDING * error_scale)
    if not chord.near < chord.far:
        return no_stay()
    outside = cone_outside(cone, ray.origin)
    return seen_stay(ray, chord_that_counts(chord, outside, ray), error_scale)


@device
def cone_is_aside(cone: ConeShape, ray: Ray) -> bool:  # noqa: ARG001
    """Return False: what tells that costs as much as `cone_distance`."""
    return False


@device
def cone_hides(cone: ConeShape, segment: Segment) -> bool:
    """Tell whether a cone stands between two points, in front of the image plane."""
    error_bound = ROUNDING * (segment.start_scale + cone.error_scale)
    end_bound = ROUNDING * (cone.error_scale + segment.end_scale)
    way, end, end_bound = way_in_front(segment, error_bound, end_bound)
    line = line_beside(cone, segment.start, way)
    caps = cap_span(line, 0.0, cone.length)
    span = both_spans(side_span(cone, line, caps, 0.0, 0.0).span, caps)
    start_outside = signed_distance(cone, line)
    end_outside = signed_distance(cone, line_beside(cone, end, way))
    middle = 0.5 * (span.near + span.far)
    meets = enters_clearly(cone, line, span, error_bound) & (middle > 0.0)
    enters = meets & ((end_outside < -end_bound) | (middle < 1.0))
    leaves = (end_outside > end_bound) & ((start_outside < -error_bound) | meets)
    return enters if start_outside > error_bound else leaves


@device
def cone_sides(cone: ConeShape, point: Vec, error_scale: float) -> Sides:
    """Return the half-spaces in which a cone lies as it is seen from a point."""
    divisor = cone.cosine if cone.cosine > 0.0 else 1.0
    widest = max(cone.room, cone.room + cone.length * cone.sine) / divisor
    return sides_around(cone, widest, point, error_scale)


@device
def cone_pole(cone: ConeShape, point: Vec) -> tuple[Vec, bool]:
    """Return the point of the axis that the side is round at a point, or the normal of its cap.

    The sphere around that point of the axis touches the side in a circle.

    Returns
    -------
    pole, is_round
        As in `Surface`: the side is round, and the caps are not.
    """
    line = line_beside(cone, point, cone.axis)
    away = math.sqrt(dot(line.beside, line.beside))
    from_side = abs(cone.cosine * away - (cone.room + cone.sine * line.height))
    from_cap = min(abs(line.height), abs(cone.length - line.height))
    beyond = away * cone.sine / (cone.cosine if cone.cosine > 0.0 else 1.0)
    foot = add(cone.start, scale(line.height + beyond, cone.axis))
    is_round = from_side <= from_cap
    return side_or_cap(cone, line.height, foot, is_round), is_round


@device
def cone_surface(cone: ConeShape, point: Vec, error_scale: float) -> Surface:
    """Return the surface of a cone at a point."""
    pole, is_round = cone_pole(cone, point)
    is_second = is_second_half(cone, point, error_scale)
    return Surface(pole, is_round, cone.error_scale, is_second, False)


@device
def cone_is_outside(cone: ConeShape, point: Vec, normal: Vec) -> bool:
    """Tell whether a point of a cone is looked at from outside, given the normal there."""
    is_outside: bool = dot(normal, sub(point, cone.center)) > 0.0
    return is_outside


@device
def cone_crossing(cone: ConeShape, bundle: Bundle) -> Crossing:
    """Return from where to where the rays of a bundle first meet a cone."""
    line = line_beside(cone, bundle.origin, bundle.direction)
    return axial_crossing(cone, line, bundle, _any_inside(cone, line, bundle), _spans)


@device
def cone_passage(cone: ConeShape, bundle: Bundle) -> Passage:
    """Return where the rays of a bundle enter and leave a cone."""
    line = line_beside(cone, bundle.origin, bundle.direction)
    any_inside = _any_inside(cone, line, bundle)
    return axial_passage(cone, line, bundle, any_inside, _spans).passage


@device
def _spans(cone: ConeShape, line: Line, wide: float, along: float) -> tuple[Span, Span]:
    """Return where a line is within the side and the caps of a larger cone."""
    caps = cap_span(line, -along, cone.length + along)
    return side_span(cone, line, caps, wide, 0.0).span, caps


@device
def _any_inside(cone: ConeShape, line: Line, bundle: Bundle) -> Span:
    """Return where any ray of a bundle may be inside a cone."""
    to_center = dot(sub(cone.center, bundle.origin), bundle.direction)
    reach = cone.radius + bundle.stretch * bundle.width
    # Rays that come together count as never nearer than where they may first meet it.
    grows = bundle.growth >= 0.0
    width = bundle.width if grows else bundle_width(bundle, max(to_center - reach, 0.0))
    growth = bundle.growth if grows else 0.0
    along = spread_along(bundle, cone.axis)
    above = at_least(line.rise + along * growth, -line.height - along * width)
    below = at_least(along * growth - line.rise, line.height - cone.length - along * width)
    caps = both_spans(above, below)
    wide, wider = bundle.stretch * width, bundle.stretch * growth
    span = both_spans(side_span(cone, line, caps, wide, wider).span, caps)
    is_nothing = (cone.length <= 0.0) | ((cone.room <= 0.0) & (cone.sine <= 0.0))
    misses = is_nothing | (span.near > span.far)
    return Span(math.inf if misses else span.near, -math.inf if misses else span.far)


@device
def cone_unroll(cone: ConeShape, point: Vec, upright: Upright) -> Unrolled:
    """Return where a point is on the unrolled side of a cone, from its end on."""
    _, is_round = cone_pole(cone, point)
    if not (is_round and cone.cosine > 0.0):
        return not_unrolled()
    line = line_beside(cone, point, cone.axis)
    first = cone.room / cone.cosine
    last = first + cone.sine * cone.length / cone.cosine
    length = cone.length / cone.cosine
    down = length - line.height / cone.cosine
    return unrolled_side(line.beside, cone.axis, down, max(first, last), length, upright)
