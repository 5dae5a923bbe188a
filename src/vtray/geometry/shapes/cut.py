"""Shapes that clip planes cut: what a solid, or its surface, and a room have in common.

With a cap, what is left of a solid is a solid with a flat face. Without, it is an open shell: only
the surface is there, as far as it is within the room, light comes in, and the inside is seen.

A shape that is wholly within the room is what it would be without: each verb is then its own.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from vtray.base.compiler.compiled import device, seldom
from vtray.geometry.bundle import Bundle, Crossing, Passage, first_crossing, is_looked_at
from vtray.geometry.ray import Ray, Segment, way_in_front
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.shapes.axis_line import ON_SIDE
from vtray.geometry.shapes.room import (
    BEYOND,
    WITHIN,
    Room,
    all_within,
    any_within,
    enters_one_wall,
    room_chord,
    room_error_scale,
    room_side,
    room_wall,
)
from vtray.geometry.shapes.sides import Sides
from vtray.geometry.shapes.solid import (
    Chord,
    both_chords,
    chord_if,
    chord_that_counts,
    first_met,
)
from vtray.geometry.shapes.stay import Stay, no_stay, seen_stay
from vtray.geometry.shapes.surface import Surface
from vtray.geometry.shapes.unrolled import Unrolled, Upright, not_unrolled
from vtray.geometry.shapes.verbs import Verbs
from vtray.geometry.vector import Vec, add, dot, magnitude, scale

STARTING = 16.0 * ROUNDING
"""A bundle of shadow rays that is within a room for less than that starts on its surface."""


class Solid(NamedTuple):
    """What solids of a kind can do beside their verbs, so that they can be cut.

    Attributes
    ----------
    chord
        Returns where a line in a unit direction is within one, if that is more than rounding.
    outside
        Returns how far outside a point is, below 0 inside.
    power_at
        Returns how deep inside its side a point is, as a square below 0.
    passage
        Returns where the rays of a bundle enter and leave one.
    is_plain
        Whether it has no halves, and looks the same all over.
    """

    chord: Callable[[Any, Vec, Vec, float], Chord]
    outside: Callable[[Any, Vec], float]
    power_at: Callable[[Any, Vec], float]
    passage: Callable[[Any, Bundle], Passage]
    is_plain: bool


class CutShape(NamedTuple):
    """A bounded shape that clip planes may cut, in the kernels' space.

    Attributes
    ----------
    whole
        The shape as it would be without.
    own, solid
        What it can do.
    room
        What clip planes leave.
    relation
        How the shape lies to it.
    is_capped
        Whether the cut is closed.
    center, radius
        The bounding ball of the whole.
    error_scale
        What its rounding errors are relative to, and those of the planes if these cut it.
    """

    whole: Any
    own: Verbs
    solid: Solid
    room: Room
    relation: int
    is_capped: bool
    center: Vec
    radius: float
    error_scale: float


@device
def cut_shape(
    whole: Any,  # noqa: ANN401
    own: Verbs,
    solid: Solid,
    room: Room,
    relation: int,
    is_capped: bool,
) -> CutShape:
    """Return a shape that may be cut; the arguments are those of `CutShape`."""
    error_scale = whole.error_scale
    if relation != WITHIN:
        error_scale += room_error_scale(room)
    return CutShape(
        whole, own, solid, room, relation, is_capped, whole.center, whole.radius, error_scale
    )


@device
def cut_outside(cut: CutShape, point: Vec) -> float:
    """Return how far outside what is left of a capped shape a point is, below 0 inside."""
    return max(cut.solid.outside(cut.whole, point), room_side(cut.room, point))


@device
def _capped_chord(
    cut: CutShape, own: Chord, origin: Vec, direction: Vec, error_bound: float
) -> Chord:
    """Return where a line is within a capped shape, if it comes clearly into it.

    As for the caps of cylinders, rounding would decide otherwise what is seen of one edge-on.

    Parameters
    ----------
    cut, own
        The shape, and where the line is within the whole of it.
    origin, direction
        The line.
    error_bound
        What rounding can explain.
    """
    chord = both_chords(room_chord(cut.room, origin, direction), own)
    middle = add(origin, scale(0.5 * (chord.near + chord.far), direction))
    meets = chord.near < chord.far and room_side(cut.room, middle) < -error_bound
    return chord_if(meets, chord)


@device
def _is_within(cut: CutShape, origin: Vec, direction: Vec, distance: float) -> bool:
    """Tell whether the point of a line at a distance is within the room."""
    return room_side(cut.room, add(origin, scale(distance, direction))) <= 0.0


@device
def cut_distance(cut: CutShape, ray: Ray) -> float:
    """Return the distance to the first point of what is left that a ray meets, or infinity."""
    if cut.relation == WITHIN:
        return cut.own.distance_to(cut.whole, ray)
    if cut.relation == BEYOND:
        return math.inf
    error_scale = cut.error_scale + ray.error_scale
    error_bound, starts_on = ROUNDING * error_scale, ray.error_bound > 0.0
    chord = cut.solid.chord(cut.whole, ray.origin, ray.direction, error_bound)
    if not chord.near < chord.far:
        return math.inf
    if cut.is_capped:
        chord = _capped_chord(cut, chord, ray.origin, ray.direction, error_bound)
        outside = cut_outside(cut, ray.origin) if starts_on else 0.0
        return first_met(chord_that_counts(chord, outside, ray), ray, error_scale)
    outside = cut.solid.outside(cut.whole, ray.origin) if starts_on else 0.0
    chord = chord_that_counts(chord, outside, ray)
    # What is not there is behind all: before the image plane, nothing is seen.
    near, far = chord.near, chord.far
    near = near if _is_within(cut, ray.origin, ray.direction, near) else -math.inf
    far = far if _is_within(cut, ray.origin, ray.direction, far) else -math.inf
    return first_met(Chord(near, far, chord.near_slope, chord.far_slope), ray, error_scale)


@device
def cut_stay(cut: CutShape, ray: Ray) -> Stay:
    """Return the part of a ray within what is left, as a body whose cuts are closed."""
    if cut.relation == WITHIN:
        return cut.own.stay(cut.whole, ray)
    error_scale = cut.error_scale + ray.error_scale
    error_bound = ROUNDING * error_scale
    if cut.relation == BEYOND:
        return no_stay()
    chord = cut.solid.chord(cut.whole, ray.origin, ray.direction, error_bound)
    chord = _capped_chord(cut, chord, ray.origin, ray.direction, error_bound)
    if not chord.near < chord.far:
        return no_stay()
    outside = cut_outside(cut, ray.origin)
    return seen_stay(ray, chord_that_counts(chord, outside, ray), error_scale)


@device
def cut_is_aside(cut: CutShape, ray: Ray) -> bool:
    """Tell whether the line of a ray passes by the whole shape."""
    return cut.own.is_aside(cut.whole, ray)


@device
def cut_hides(cut: CutShape, segment: Segment) -> bool:
    """Tell whether what is left stands between two points, in front of the image plane."""
    if cut.relation == WITHIN:
        return cut.own.hides(cut.whole, segment)
    error_bound = ROUNDING * (segment.start_scale + cut.error_scale)
    end_bound = ROUNDING * (cut.error_scale + segment.end_scale)
    way, end, end_bound = way_in_front(segment, error_bound, end_bound)
    length = math.sqrt(dot(way, way))
    if cut.relation == BEYOND or not length > 0.0:
        return False
    start, direction = segment.start, scale(1.0 / length, way)
    chord = cut.solid.chord(cut.whole, start, direction, error_bound)
    # A line that misses the whole starts and ends outside of it, or on it.
    if not chord.near < chord.far:
        return False
    if cut.is_capped:
        chord = _capped_chord(cut, chord, start, direction, error_bound)
        starts_outside, ends_outside = cut_outside(cut, start), cut_outside(cut, end)
        middle = 0.5 * (chord.near + chord.far)
        meets = (chord.near < chord.far) & (middle > 0.0)
        enters = meets & ((ends_outside < -end_bound) | (middle < length))
        leaves = (ends_outside > end_bound) & ((starts_outside < -error_bound) | meets)
        return enters if starts_outside > error_bound else leaves
    starts_outside = cut.solid.outside(cut.whole, start)
    ends_outside = cut.solid.outside(cut.whole, end)
    middle = 0.5 * (chord.near + chord.far)
    meets = (chord.near < chord.far) & (middle > 0.0)
    enters = meets & ((ends_outside < -end_bound) | (middle < length))
    passes = meets & ((middle < length) | (starts_outside <= error_bound))
    leaves = (ends_outside > end_bound) & ((starts_outside < -error_bound) | passes)
    enters = enters & (starts_outside > error_bound)
    return (enters & _is_within(cut, start, direction, chord.near)) | (
        leaves & _is_within(cut, start, direction, chord.far)
    )


@device
def cut_sides(cut: CutShape, point: Vec, error_scale: float) -> Sides:
    """Return half-spaces in which what is left lies as it is seen from a point.

    From a plane, or from beyond it, what leads away from it meets nothing.
    """
    own = cut.own.sides(cut.whole, point, error_scale)
    if cut.relation == WITHIN:
        return own
    wall = room_wall(cut.room, point)
    error_bound = ROUNDING * (cut.error_scale + error_scale)
    limit = -ON_SIDE * error_bound if cut.is_capped else error_bound
    is_beyond = room_side(cut.room, point) >= limit
    inward = scale(-1.0, wall.normal)
    return Sides(
        own.one,
        own.other,
        (
            inward[0] if is_beyond else own.end[0],
            inward[1] if is_beyond else own.end[1],
            inward[2] if is_beyond else own.end[2],
        ),
    )


@device
def _is_on_cap(cut: CutShape, point: Vec) -> bool:
    """Tell whether a point of what is left is on a cap: nearer to a plane than to the surface."""
    from_side = abs(cut.solid.outside(cut.whole, point))
    is_near = abs(room_side(cut.room, point)) <= from_side
    return is_near & cut.is_capped & (cut.relation != WITHIN)


@seldom
def cut_is_outside(cut: CutShape, point: Vec, normal: Vec) -> bool:
    """Tell whether a point of what is left is looked at from outside, given the normal there."""
    if _is_on_cap(cut, point):
        return dot(normal, room_wall(cut.room, point).normal) > 0.0
    return cut.own.is_outside(cut.whole, point, normal)


@seldom
def cut_surface(cut: CutShape, point: Vec, error_scale: float) -> Surface:
    """Return the surface of what is left at a point."""
    own = cut.own.surface(cut.whole, point, error_scale)
    is_cap = _is_on_cap(cut, point)
    wall = room_wall(cut.room, point).normal
    pole = (
        wall[0] if is_cap else own.pole[0],
        wall[1] if is_cap else own.pole[1],
        wall[2] if is_cap else own.pole[2],
    )
    is_round = own.is_round & (not is_cap)
    return Surface(pole, is_round, cut.error_scale, own.is_second, is_cap)


@device
def cut_power(cut: CutShape, point: Vec) -> float:
    """Return how deep a point is within the whole shape, as a square below 0, if it is cut."""
    if cut.relation == WITHIN:
        return 0.0
    return cut.solid.power_at(cut.whole, point)


@seldom
def cut_crossing(cut: CutShape, bundle: Bundle) -> Crossing:
    """Return from where to where the rays of a bundle first meet what is left."""
    if cut.relation == WITHIN:
        return cut.own.crossing(cut.whole, bundle)
    nothing = Crossing(math.inf, math.inf)
    some = any_within(cut.room, bundle)
    if cut.relation == BEYOND or some.near > some.far:
        return nothing
    enters, leaves, covers = cut.solid.passage(cut.whole, bundle)
    near, far = max(enters.near, some.near), min(leaves.far, some.far)
    # What starts on a plane, as near as rounding can tell, and leads away from it, meets nothing.
    reach = STARTING * (cut.error_scale + magnitude(bundle.origin))
    if near > far or far <= bundle.first + (0.0 if is_looked_at(bundle.sight) else reach):
        return nothing
    every = all_within(cut.room, bundle)
    # Rays that are within the room from before they may enter the shape until they have.
    whole = cut.own.crossing(cut.whole, bundle)
    is_clear = (every.near <= enters.near) & (enters.near > bundle.last)
    if is_clear and whole.far <= every.far:
        return whole
    if not cut.is_capped:
        return Crossing(max(near, bundle.first), math.inf)
    reaches = max(enters.far, every.near)
    ends = min(leaves.near, every.far)
    passage = Passage(Crossing(near, reaches), Crossing(ends, far), covers & (reaches < ends))
    found = first_crossing(passage, bundle)
    if is_looked_at(bundle.sight):
        is_cap = (enters.far <= some.near) & enters_one_wall(cut.room, bundle)
        is_one = cut.solid.is_plain & is_cap & (near > bundle.last)
        return Crossing(found.near, found.far if is_one else math.inf)
    return found


@seldom
def cut_unroll(cut: CutShape, point: Vec, upright: Upright) -> Unrolled:
    """Return where a point of what is left is on the unrolled surface of the whole."""
    if _is_on_cap(cut, point):
        return not_unrolled()
    return cut.own.unroll(cut.whole, point, upright)
