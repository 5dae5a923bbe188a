"""Which rays of a fan something stops.

Where they point into nearly the same direction, as to a lamp that is small or far away, they go
through the hierarchies as one beam, which tells of most points that all rays arrive, or none. What
each ray is told is what it would be told alone.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.between import is_occluded
from vtray.geometry.dispatch import Shape, Verbs, with_any
from vtray.geometry.packets.beam import Beam, lower_limit, make_beam, shape_margin, upper_limit
from vtray.geometry.packets.fan import BLOCKED, Fan, Start, count_open, fan_segment, load_end
from vtray.geometry.packets.stack import Stack, push_met
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import add, lower, scale, sub, upper
from vtray.geometry.world import (
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
)

NONE, SOME, MANY = 0, 1, 2
"""Which rays are left: none, those that nothing stops, or more as the search was given up."""

MOST_LEAVES = 4
"""So many leaves a beam may meet. In more, its rays meet different shapes, and are faster alone."""


class Bundle(NamedTuple):
    """The rays of a fan that go through hierarchies together.

    Attributes
    ----------
    fan, rays
        The fan, and how many there are.
    start
        Where they start.
    end_scale
        What the rounding errors of their ends are relative to.
    """

    fan: Fan
    rays: int
    start: Start
    end_scale: float


@device
def find_stopped(
    fan: Fan,
    rays: int,
    is_narrow: bool,
    start: Start,
    end_scale: float,
    world: World,
    stack: Stack,
) -> None:
    """Mark in field ``BLOCKED`` the rays of a fan that something stops.

    Parameters
    ----------
    fan, rays
        The rays, so many. Those marked already are passed over.
    is_narrow
        Whether they are so near each other that they may all meet the same.
    start, end_scale
        Where they start, and what the rounding errors of their ends are relative to.
    world
        What they can meet.
    stack
        Scratch memory.
    """
    if is_narrow:
        bundle = Bundle(fan, rays, start, end_scale)
        if count_open(fan, rays) > 0 and _stop_bundle(bundle, world, stack) != MANY:
            return
    for ray in range(rays):
        if fan[BLOCKED + ray] == 0.0:
            segment = fan_segment(fan, ray, start, end_scale)
            fan[BLOCKED + ray] = 1.0 if is_occluded(world, segment, stack) else 0.0


@device
def _stop_bundle(bundle: Bundle, world: World, stack: Stack) -> int:
    """Mark the rays that something stops; return which of them may be left."""
    for row in range(group_count(world)):
        left = _stop_by_group(bundle, world, load_group(world, row), stack, 0)
        if left != SOME:
            return left
    return _stop_by_placed(bundle, world, world.places, stack)


@device
def _stop_by_group(bundle: Bundle, world: World, group: Group, stack: Stack, base: int) -> int:
    """Mark the rays that shapes of a group stop; return which are left."""
    return _search_shapes(bundle, world, hierarchy_of(group), stack, base, _stop_by_slots, group)


@device
def _stop_by_placed(bundle: Bundle, world: World, places: Places | None, stack: Stack) -> int:
    """Mark the rays that something stops that is placed; return which are left."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        hierarchy = hierarchy_of_places(places)
        return _search_places(bundle, world, hierarchy, stack, 0, _stop_by_places, places)
    return SOME


@device
def _stop_by_places(
    bundle: Bundle, world: World, places: Places, begin: int, end: int, stack: Stack, base: int
) -> int:
    """Mark the rays that the groups of a range of places stop; return which are left."""
    for at in range(begin, end):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            left = _stop_by_group(bundle, world, group, stack, base)
            if left != SOME:
                return left
    return SOME


@device
def _stop_by_slots(
    bundle: Bundle,
    world: World,
    group: Group,
    begin: int,
    end: int,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> int:
    """Mark the rays that the shapes of a range of slots stop; return which are left."""
    for slot in range(begin, end):
        with_any(world, group, slot, _stop_by_shape, bundle)
    return SOME if count_open(bundle.fan, bundle.rays) > 0 else NONE


@device
def _stop_by_shape(shape: Shape, verbs: Verbs, number: int, bundle: Bundle) -> int:
    """Mark the rays that a shape stops."""
    fan, rays, start, end_scale = bundle
    for ray in range(rays):
        segment = fan_segment(fan, ray, start, end_scale)
        fan[BLOCKED + ray] = 1.0 if verbs.hides(shape, segment) else fan[BLOCKED + ray]
    return number


def _search(
    bundle: Bundle,
    world: World,
    hierarchy: Hierarchy,
    stack: Stack,
    base: int,
    visit: Callable[[Bundle, World, Any, int, int, Stack, int], int],
    subject: Any,  # noqa: ANN401
) -> int:
    """Visit the leaves of a hierarchy that may stop rays, the nearest first, until none is left.

    Parameters
    ----------
    bundle, world, hierarchy
        The rays, and the hierarchy.
    stack, base
        Scratch memory, and what waits there already, which stays.
    visit, subject
        What is called for each leaf, and what it is given, beside the range that the leaf names.

    Returns
    -------
    int
        Which rays are left.
    """
    beam = _bundle_beam(bundle, hierarchy.to_boxes)
    near, far = lower_limit(beam, 0.0), upper_limit(beam, 1.0 + MARGIN)
    stack.node[base] = hierarchy.root
    waiting, leaves = base + 1, 0
    while waiting > base:
        waiting -= 1
        child = stack.node[waiting]
        if child >= 0:
            waiting = push_met(world.bvh, child, beam, near, far, stack, waiting)
        else:
            leaves += 1
            if leaves > MOST_LEAVES:
                return MANY
            begin, end = range_of(hierarchy, child)
            left = visit(bundle, world, subject, begin, end, stack, waiting)
            if left != SOME:
                return left
    return SOME


_search_places, _search_shapes = device(_search), device(_search)
"""Two searches: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def _bundle_beam(bundle: Bundle, to_boxes: ToBoxes) -> Beam:
    """Return the beam of those rays of a bundle that nothing stops so far."""
    low = math.inf, math.inf, math.inf
    high = -math.inf, -math.inf, -math.inf
    for ray in range(bundle.rays):
        if bundle.fan[BLOCKED + ray] == 0.0:
            way = sub(load_end(bundle.fan, ray), bundle.start.point)
            low, high = lower(low, way), upper(high, way)
    ratio = to_boxes.ratio
    apex = add(scale(ratio, bundle.start.point), to_boxes.offset)
    margin = shape_margin(to_boxes, apex, bundle.start.error_scale)
    return make_beam(apex, apex, scale(ratio, low), scale(ratio, high), margin)
