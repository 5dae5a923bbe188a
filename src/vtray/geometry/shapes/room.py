"""Rooms: what clip planes leave of the world, and where lines and bundles are within one.

A room is what some half-spaces have in common. The normal of each of its planes points out of it,
as that of a surface points out of a solid. Without a plane, it is everything.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device, seldom
from vtray.geometry.bundle import Bundle, spread_along
from vtray.geometry.rounding import MARGIN
from vtray.geometry.shapes.axis_line import Span, at_least, both_spans
from vtray.geometry.shapes.columns import Columns, Place
from vtray.geometry.shapes.plane import PlaneShape, load_plane, plane_side
from vtray.geometry.shapes.solid import Chord, both_chords
from vtray.geometry.vector import Vec, dot, magnitude, sub

WITHIN, ACROSS, BEYOND = 0, 1, 2
"""How a shape lies to a room: wholly inside, partly, or wholly outside."""


class Room(NamedTuple):
    """A room, by the planes around it.

    Attributes
    ----------
    planes
        Those of all rooms.
    begin, end
        Its own, from the first to before the last.
    place
        What leads from there to the space at hand.
    first
        The first of its planes there.
    """

    planes: Columns
    begin: int
    end: int
    place: Place
    first: PlaneShape


@device
def load_room(planes: Columns, begin: int, end: int, place: Place) -> Room:
    """Return a room with one plane at least; the arguments are those of `Room`."""
    return Room(planes, begin, end, place, load_plane(planes, begin, place))


@device
def room_side(room: Room, point: Vec) -> float:
    """Return how far a point is beyond the plane that it is farthest beyond, below 0 inside."""
    farthest = plane_side(room.first, point)
    for k in range(room.begin + 1, room.end):
        farthest = max(farthest, plane_side(load_plane(room.planes, k, room.place), point))
    return farthest


@device
def room_wall(room: Room, point: Vec) -> PlaneShape:
    """Return the plane that a point is nearest to from inside, or farthest beyond."""
    wall = room.first
    for k in range(room.begin + 1, room.end):
        plane = load_plane(room.planes, k, room.place)
        if plane_side(plane, point) > plane_side(wall, point):
            wall = plane
    return wall


@device
def room_error_scale(room: Room) -> float:
    """Return what the rounding errors of the planes of a room are relative to."""
    error_scale = room.first.error_scale
    for k in range(room.begin + 1, room.end):
        error_scale = max(error_scale, load_plane(room.planes, k, room.place).error_scale)
    return error_scale


@device
def room_chord(room: Room, origin: Vec, direction: Vec) -> Chord:
    """Return where a line is within a room.

    What is worked out for a plane depends on the line and on the plane alone: all shapes that a
    plane cuts meet a line there at the same distance.
    """
    chord = _plane_chord(room.first, origin, direction)
    for k in range(room.begin + 1, room.end):
        plane = load_plane(room.planes, k, room.place)
        chord = both_chords(_plane_chord(plane, origin, direction), chord)
    return chord


@device
def _plane_chord(plane: PlaneShape, origin: Vec, direction: Vec) -> Chord:
    """Return where a line is on the inner side of a plane."""
    height = dot(sub(plane.point, origin), plane.normal)
    descent = dot(direction, plane.normal)
    distance = height / (descent if descent != 0.0 else 1.0)
    is_beyond = (descent == 0.0) & (height < 0.0)
    near = distance if descent < 0.0 else math.inf if is_beyond else -math.inf
    far = distance if descent > 0.0 else -math.inf if is_beyond else math.inf
    return Chord(near, far, abs(descent), abs(descent))


@device
def any_within(room: Room, bundle: Bundle) -> Span:
    """Return where any ray of a bundle may be within a room."""
    span = Span(-math.inf, math.inf)
    for k in range(room.begin, room.end):
        span = both_spans(span, _span_within(load_plane(room.planes, k, room.place), bundle, 1.0))
    return span


@device
def all_within(room: Room, bundle: Bundle) -> Span:
    """Return where all rays of a bundle are within a room."""
    span = Span(-math.inf, math.inf)
    for k in range(room.begin, room.end):
        span = both_spans(span, _span_within(load_plane(room.planes, k, room.place), bundle, -1.0))
    return span


@device
def enters_one_wall(room: Room, bundle: Bundle) -> bool:
    """Tell whether all rays of a bundle enter a room through one of its planes, the same one."""
    last, others = Span(-math.inf, -math.inf), -math.inf
    for k in range(room.begin, room.end):
        plane = load_plane(room.planes, k, room.place)
        near = _span_within(plane, bundle, 1.0).near
        far = _span_within(plane, bundle, -1.0).near
        if near > last.near:
            others = max(others, last.far)
            last = Span(near, far)
        else:
            others = max(others, far)
    return others <= last.near


@device
def _span_within(plane: PlaneShape, bundle: Bundle, side: float) -> Span:
    """Return where rays of a bundle are on the inner side of a plane: any for 1, all for -1."""
    height = dot(sub(bundle.origin, plane.point), plane.normal)
    along = side * spread_along(bundle, plane.normal)
    rise = dot(bundle.direction, plane.normal)
    # height + t rise <= along (width + t growth)
    return at_least(along * bundle.growth - rise, height - along * bundle.width)


@seldom
def relation_to(
    planes: Columns, begin: int, end: int, place: Place, center: Vec, radius: float
) -> int:
    """Return how a ball lies to a room; where rounding could decide, it is cut.

    All lengths are in world space, or in parts of it by a power of two. So the answer does not
    depend on a camera, and it is the same wherever it is asked for.

    Parameters
    ----------
    planes, begin, end, place
        As in `Room`, with one plane at least, or none.
    center, radius
        The ball.
    """
    relation = WITHIN
    for k in range(begin, end):
        plane = load_plane(planes, k, place)
        from_point = sub(center, plane.point)
        side = dot(from_point, plane.normal)
        margin = MARGIN * (magnitude(from_point) + radius)
        if side - radius > margin:
            return BEYOND
        # Not so for what is not a number, as the ball around a plane has none.
        if not side + radius < -margin:
            relation = ACROSS
    return relation
