"""What may stand between a point and a lamp that is seen in a cone of directions.

Before any ray is cast to a lamp, its cone as a whole tells whether all rays arrive, or none, or
which few shapes can stop some of them. Whatever rounding could decide, some of them may be stopped.
A cone around the rays from several points tells which shapes touch any of their cones, at least.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, part
from vtray.geometry.bits import lowest_bit
from vtray.geometry.bvh.tree import SIDES, WIDTH, Bvh
from vtray.geometry.dispatch import with_bounded
from vtray.geometry.packets.beam import (
    Beam,
    children_met,
    lower_limit,
    make_beam,
    shape_margin,
    upper_limit,
)
from vtray.geometry.packets.fan import Start
from vtray.geometry.packets.stack import Stack, push_some
from vtray.geometry.rounding import MARGIN, ROUNDING
from vtray.geometry.shapes.columns import Columns
from vtray.geometry.shapes.plane import load_plane, plane_side
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec, dot, magnitude, scale, sub
from vtray.geometry.world import (
    CUT,
    PLANE,
    SPHERE,
    Clip,
    Faded,
    Group,
    Hierarchy,
    Places,
    ToBoxes,
    World,
    group_count,
    hierarchy_of,
    hierarchy_of_places,
    load_group,
    placed_row,
    range_of,
    to_box_space,
)

MOST = 8
"""So many shapes may touch a cone. Among more, its rays meet different ones: they search alone."""

CLOSED = -1
"""In place of how many shapes touch a cone: one stops all rays."""

MANY = -2
"""Likewise: more than ``MOST``."""

SLIGHT = 1e-7
"""More than the error of a sine that is worked out from a cosine near 1."""

PATIENCE = 1024
"""After so many leaves of a hierarchy, it counts as `MANY`. Cones that touch no more than a few
shapes go through fewer: those of a million in a cube lie in fifty rows."""

ASIDE, _TOUCHES, _COVERS = 0, 1, 2
"""How a shape lies to a cone."""


class Touching(NamedTuple):
    """The shapes that touch a cone.

    Attributes
    ----------
    row, slot
        What `load_group` finds the group of each by, and its slot, (``MOST``,).
    """

    row: NDArray[np.int64]
    slot: NDArray[np.int64]


def new_touching() -> Touching:
    """Return the scratch memory of one thread."""
    return Touching(np.zeros(MOST, np.int64), np.zeros(MOST, np.int64))


class Cone(NamedTuple):
    """A cone of rays.

    Attributes
    ----------
    start, extent
        Where they start, and how far from there at the most, if they do not all start there.
    axis
        The unit vector in its middle.
    cosine, sine
        Those of half its angle, which is less than a right one.
    shortest, longest
        How long its rays are at the least and at the most.
    forward
        The unit direction in which the camera looks.
    """

    start: Start
    extent: float
    axis: Vec
    cosine: float
    sine: float
    shortest: float
    longest: float
    forward: Vec


class ConeInBoxes(NamedTuple):
    """A cone in the space of the boxes of a hierarchy.

    Attributes
    ----------
    beam
        What holds it.
    apex, axis, cosine, sine
        Where its rays start, or the middle of that, and its directions as those of a `Cone`.
    margin
        How far rounding, and where rays start, may have moved boxes against it.
    """

    beam: Beam
    apex: Vec
    axis: Vec
    cosine: float
    sine: float
    margin: float


@part
def find_touching(cone: Cone, world: World, touching: Touching, most: int, stack: Stack) -> int:
    """Find the shapes that touch a cone.

    Parameters
    ----------
    cone, world
        The cone, and what it can touch.
    touching
        Out: the shapes.
    most
        More than so many are `MANY`: ``MOST``, or fewer, among balls only; else it is `MANY` then.
    stack
        Scratch memory.

    Returns
    -------
    int
        How many there are, or ``CLOSED`` or ``MANY``.
    """
    if most < MOST and not has_only_balls(world):
        return MANY
    count = 0
    for row in range(group_count(world)):
        group = load_group(world, row)
        count = _find_in_group(cone, world, group, touching, most, count, stack, 0)
        if count < 0:
            return count
    return _find_placed(cone, world, world.places, touching, most, count, stack)


@part
def find_among(cone: Cone, world: World, touching: Touching, count: int, own: Touching) -> int:
    """Find those of so many shapes that touch a cone.

    Return how many there are, or that one stops all rays, with ``CLOSED``; `own` has them then.
    """
    found = 0
    for k in range(count):
        relation = relation_to(cone, world, load_group(world, touching.row[k]), touching.slot[k])
        if relation == _COVERS:
            return CLOSED
        if relation == _TOUCHES:
            own.row[found], own.slot[found] = touching.row[k], touching.slot[k]
            found += 1
    return found


@device
def has_only_balls(world: World) -> bool:
    """Tell whether there are only whole spheres and planes, and none that lets light through.

    What is long is found by boxes, which are those of several things: what is known to touch a cone
    would depend on what stands near it.
    """
    solids = world.solids
    return _are_none(solids.cylinders, solids.cones, solids.clip, world.faded)


@device
def _are_none(
    cylinders: Columns | None, cones: Columns | None, clip: Clip | None, faded: Faded | None
) -> bool:
    return cylinders is None and cones is None and clip is None and faded is None


@device
def are_round(world: World, touching: Touching, count: int) -> bool:
    """Tell whether none of some shapes is anything but a sphere or a plane."""
    others = 0
    for k in range(count):
        others += 1 if load_group(world, touching.row[k]).kind not in (PLANE, SPHERE) else 0
    return others == 0


@device
def _find_in_group(
    cone: Cone,
    world: World,
    group: Group,
    touching: Touching,
    most: int,
    count: int,
    stack: Stack,
    base: int,
) -> int:
    """Find those of a group; return how many there are then."""
    hierarchy = hierarchy_of(group)
    return _search_shapes(
        cone, world, hierarchy, touching, most, count, stack, base, _find_slots, group
    )


@device
def _find_placed(
    cone: Cone,
    world: World,
    places: Places | None,
    touching: Touching,
    most: int,
    count: int,
    stack: Stack,
) -> int:
    """Find those that are placed; return how many there are then."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        hierarchy = hierarchy_of_places(places)
        return _search_places(
            cone, world, hierarchy, touching, most, count, stack, 0, _find_places, places
        )
    return count


@device
def _find_places(
    cone: Cone,
    world: World,
    places: Places,
    begin: int,
    end: int,
    touching: Touching,
    most: int,
    count: int,
    stack: Stack,
    base: int,
) -> int:
    """Find those of the groups of a range of places; return how many there are then."""
    for at in range(begin, end):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            count = _find_in_group(cone, world, group, touching, most, count, stack, base)
            if count < 0:
                return count
    return count


@device
def _find_slots(
    cone: Cone,
    world: World,
    group: Group,
    begin: int,
    end: int,
    touching: Touching,
    most: int,
    count: int,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> int:
    """Find those of a range of slots; return how many there are then."""
    for slot in range(begin, end):
        relation = relation_to(cone, world, group, slot)
        if relation == _COVERS:
            return CLOSED
        if relation == _TOUCHES:
            if count == most:
                return MANY
            touching.row[count] = group.row
            touching.slot[count] = slot
            count += 1
    return count


@device
def relation_to(cone: Cone, world: World, group: Group, slot: int) -> int:
    """Tell how a cone and a shape lie to each other."""
    if group.kind == PLANE:
        plane = load_plane(world.planes, slot, group.place)
        side = plane_side(plane, cone.start.point)
        error_scale = cone.start.error_scale + plane.error_scale
        return _relation_to_plane(cone, side, dot(plane.normal, cone.axis), error_scale)
    relation: int = with_bounded(world.solids, group, slot, _relation_to_shape, (cone, group.kind))
    return relation


@device
def _relation_to_plane(cone: Cone, side: float, rise: float, error_scale: float) -> int:
    """Tell whether a plane may stop rays of a cone.

    Parameters
    ----------
    cone
        The cone.
    side, error_scale
        How far its start is from the plane, and what the rounding error of that is relative to.
    rise
        The plane's normal times the axis.
    """
    away = rise if side > 0.0 else -rise
    across = math.sqrt(max(1.0 - away * away, 0.0)) + SLIGHT
    least = away * cone.cosine - across * cone.sine - SLIGHT
    reaches = least * cone.longest + abs(side) <= MARGIN * error_scale + cone.extent
    if cone.extent > 0.0:
        # Of rays that start on both sides, some may go either way.
        return _TOUCHES if reaches or abs(side) <= MARGIN * error_scale + cone.extent else ASIDE
    starts_on = abs(side) <= ROUNDING * error_scale
    return _TOUCHES if reaches and not starts_on else ASIDE


@device
def _relation_to_shape(
    shape: Shape,
    verbs: Verbs,
    number: int,  # noqa: ARG001
    arguments: tuple[Cone, int],
) -> int:
    """Tell how a cone and a shape that is none of planes lie to each other, by its ball."""
    cone, kind = arguments
    start, axis = cone.start, cone.axis
    way = sub(shape.center, start.point)
    margin = MARGIN * (shape.error_scale + start.error_scale) + cone.extent
    ahead, distance2 = dot(way, axis), dot(way, way)
    approach = sub(way, scale(ahead, axis))
    aside = math.sqrt(dot(approach, approach))
    # How far the centre is from the nearest and from the farthest side of the cone.
    near, far = aside * cone.cosine - ahead * cone.sine, aside * cone.cosine + ahead * cone.sine
    if near > shape.radius + margin or ahead > cone.longest + shape.radius + margin:
        return ASIDE
    if cone.extent > 0.0:
        return _TOUCHES
    if kind >= CUT:
        sides = verbs.sides(shape, start.point, start.error_scale)
        return ASIDE if _is_beyond(cone, sides.end) else _TOUCHES
    if kind != SPHERE:
        return _TOUCHES
    outside = distance2 - shape.radius * shape.radius
    bound = ROUNDING * (shape.error_scale + start.error_scale)
    # Rays that start outside, or on it, and lead away from its centre do not meet a sphere.
    nearest = ahead * cone.cosine + aside * cone.sine
    if outside >= -bound * (2.0 * shape.radius + bound) and nearest < -margin:
        return ASIDE
    reach = math.sqrt(distance2) + shape.radius + margin
    is_before = start.plane_depth + dot(way, cone.forward) > shape.radius + margin
    is_between = outside > 4.0 * margin * (shape.radius + margin) and reach < cone.shortest
    is_ahead = ahead * cone.cosine > aside * cone.sine
    covers = is_before and is_between and is_ahead and far < shape.radius - margin
    return _COVERS if covers else _TOUCHES


@device
def _is_beyond(cone: Cone, inward: Vec) -> bool:
    """Tell whether all rays of a cone lead out of a half-space, given its inner normal or 0."""
    ahead = dot(cone.axis, inward)
    across = math.sqrt(max(1.0 - ahead * ahead, 0.0))
    return ahead * cone.cosine + across * cone.sine < -SLIGHT


def _search(
    cone: Cone,
    world: World,
    hierarchy: Hierarchy,
    touching: Touching,
    most: int,
    count: int,
    stack: Stack,
    base: int,
    visit: Callable[[Cone, World, Any, int, int, Touching, int, int, Stack, int], int],
    subject: Any,  # noqa: ANN401
) -> int:
    """Visit the leaves of a hierarchy that touch a cone, the nearest first.

    Parameters
    ----------
    cone, world, hierarchy
        The cone, and the hierarchy.
    touching, most, count
        The shapes found so far, how many there may be, and how many there are.
    stack, base
        Scratch memory, and what waits there already, which stays.
    visit, subject
        What is called for each leaf, and what it is given, beside the range that the leaf names.

    Returns
    -------
    int
        As of `find_touching`.
    """
    seen = cone_in_boxes(cone, hierarchy.to_boxes)
    end = cone.longest * hierarchy.to_boxes.ratio * (1.0 + MARGIN)
    near, far = lower_limit(seen.beam, 0.0), upper_limit(seen.beam, end)
    stack.node[base] = hierarchy.root
    waiting, leaves = base + 1, 0
    while waiting > base:
        waiting -= 1
        child = stack.node[waiting]
        if child >= 0:
            waiting = push_touched(world.bvh, child, seen, near, far, math.inf, stack, waiting)
        elif leaves == PATIENCE:
            return MANY
        else:
            leaves += 1
            begin, after = range_of(hierarchy, child)
            count = visit(cone, world, subject, begin, after, touching, most, count, stack, waiting)
            if count < 0:
                return count
    return count


_search_places, _search_shapes = device(_search), device(_search)
"""Two searches: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def cone_in_boxes(cone: Cone, to_boxes: ToBoxes) -> ConeInBoxes:
    """Return a cone in the boxes' space."""
    apex = to_box_space(to_boxes, cone.start.point)
    x, y, z = cone.axis
    low = _least(x, cone), _least(y, cone), _least(z, cone)
    high = -_least(-x, cone), -_least(-y, cone), -_least(-z, cone)
    margin = shape_margin(to_boxes, apex, cone.start.error_scale) + to_boxes.ratio * cone.extent
    beam = make_beam(apex, apex, low, high, margin)
    return ConeInBoxes(beam, apex, cone.axis, cone.cosine, cone.sine, margin)


@device
def push_touched(
    bvh: Bvh,
    node: int,
    cone: ConeInBoxes,
    start: np.float32,
    end: np.float32,
    deepest: float,
    stack: Stack,
    base: int,
) -> int:
    """Push the children that a cone may touch, the nearest last; return the stack's new height.

    Its beam has corners that it has not, and where directions go to both sides of an axis, a side
    without end. What is as a whole deeper in it than `deepest`, along its axis, is left out.
    """
    met = children_met(bvh, node, cone.beam, start, end, stack.entered)
    left, touched = met, met
    while left != 0:
        k = lowest_bit(left)
        if not _touches_box(bvh, node * SIDES + k, cone, deepest):
            touched ^= left & -left
        left &= left - 1
    return push_some(bvh, node, touched, stack, base)


@device
def _touches_box(bvh: Bvh, first: int, cone: ConeInBoxes, deepest: float) -> bool:
    """Tell whether a cone may touch a box up to a depth, given by where the sides of it begin.

    The plane is asked that touches the cone on the side of the box's middle.
    """
    low, high = first, first + 3 * WIDTH
    x_low, x_high = float(bvh.sides[low]), float(bvh.sides[high])
    y_low, y_high = float(bvh.sides[low + WIDTH]), float(bvh.sides[high + WIDTH])
    z_low, z_high = float(bvh.sides[low + 2 * WIDTH]), float(bvh.sides[high + 2 * WIDTH])
    half = 0.5 * (x_high - x_low), 0.5 * (y_high - y_low), 0.5 * (z_high - z_low)
    middle = 0.5 * (x_high + x_low), 0.5 * (y_high + y_low), 0.5 * (z_high + z_low)
    way = sub(middle, cone.apex)
    ahead = dot(way, cone.axis)
    approach = sub(way, scale(ahead, cone.axis))
    aside = math.sqrt(dot(approach, approach))
    size = magnitude(way) + magnitude(half)
    margin = cone.margin + SLIGHT * size
    if ahead > deepest + _reach_along(half, cone.axis) + margin:
        return False
    if aside <= SLIGHT * size:
        return True
    out = sub(scale(cone.cosine / aside, approach), scale(cone.sine, cone.axis))
    return aside * cone.cosine - ahead * cone.sine <= _reach_along(half, out) + margin


@device
def _reach_along(half: Vec, direction: Vec) -> float:
    """Return how far a box reaches from its middle along a direction."""
    x, y, z = direction
    return abs(x) * half[0] + abs(y) * half[1] + abs(z) * half[2]


@device
def _least(component: float, cone: Cone) -> float:
    """Return a bound on a component of all directions of a cone, given that of its axis."""
    across = math.sqrt(max(1.0 - component * component, 0.0))
    return component * cone.cosine - (across + SLIGHT) * cone.sine - SLIGHT
