"""A fan: shadow rays that spread from one point, and which of them something stops.

Those that point into nearly the same direction go through the hierarchies as one beam.
What each is told is what it would be told alone.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.dispatch import Shape, Verbs, with_any
from vtray.geometry.packets.beam import Beam, lower_limit, make_beam, shape_margin, upper_limit
from vtray.geometry.packets.stack import Stack, push_met
from vtray.geometry.ray import Segment
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import Vec, add, lower, scale, sub, upper
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

FAN = 64
"""Rays of a fan at the most."""

END = 0
"""Where a ray ends, a vector."""
END_PLANE_DEPTH = 3 * FAN
"""How far before the image plane that is."""
WEIGHT = 4 * FAN
"""What the ray counts, if nothing stops it; 0 for a ray that is not cast."""
BLOCKED = 5 * FAN
"""1 where something stops it, else 0."""
SIZE = 6 * FAN

Fan = NDArray[np.float64]
"""The fields of all rays, one after the other, as those of a packet."""


class Start(NamedTuple):
    """Where the rays of a fan start.

    Attributes
    ----------
    point
        The point.
    plane_depth
        How far before the image plane it is.
    error_scale
        What its rounding error is relative to.
    """

    point: Vec
    plane_depth: float
    error_scale: float


class Bundle(NamedTuple):
    """Neighbouring rays of a fan, which go through hierarchies as one beam.

    Attributes
    ----------
    fan, first, rays
        The fan, the first of the rays, and how many there are.
    start
        Where they start.
    end_scale
        What the rounding errors of their ends are relative to.
    """

    fan: Fan
    first: int
    rays: int
    start: Start
    end_scale: float


def new_fan() -> Fan:
    """Return the fan of one thread."""
    return np.zeros(SIZE)


@device
def load_end(fan: Fan, ray: int) -> Vec:
    """Return where a ray ends."""
    return fan[END + ray], fan[END + FAN + ray], fan[END + 2 * FAN + ray]


@device
def fan_segment(fan: Fan, ray: int, start: Start, end_scale: float) -> Segment:
    """Return the way of a ray."""
    return Segment(
        start.point,
        load_end(fan, ray),
        start.plane_depth,
        fan[END_PLANE_DEPTH + ray],
        start.error_scale,
        end_scale,
    )


@device
def find_stopped(
    fan: Fan,
    rays: int,
    together: int,
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
    together
        Rays that go through hierarchies as one beam, a part of all.
    start, end_scale
        Where they start, and what the rounding errors of their ends are relative to.
    world
        What they can meet.
    stack
        Scratch memory.
    """
    for first in range(0, rays, together):
        bundle = Bundle(fan, first & (FAN - 1), together, start, end_scale)
        if _any_open(bundle):
            _stop_bundle(bundle, world, stack)


@device
def _stop_bundle(bundle: Bundle, world: World, stack: Stack) -> None:
    """Mark the rays of an bundle that something stops."""
    for row in range(group_count(world)):
        if not _stop_by_group(bundle, world, load_group(world, row), stack, 0):
            return
    _stop_by_placed(bundle, world, world.places, stack)


@device
def _stop_by_group(bundle: Bundle, world: World, group: Group, stack: Stack, base: int) -> bool:
    """Mark the rays that shapes of a group stop; tell whether any is left."""
    return _search_shapes(bundle, world, hierarchy_of(group), stack, base, _stop_by_slots, group)


@device
def _stop_by_placed(bundle: Bundle, world: World, places: Places | None, stack: Stack) -> None:
    """Mark the rays that something stops that is placed."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        hierarchy = hierarchy_of_places(places)
        _search_places(bundle, world, hierarchy, stack, 0, _stop_by_places, places)


@device
def _stop_by_places(
    bundle: Bundle, world: World, places: Places, begin: int, end: int, stack: Stack, base: int
) -> bool:
    """Mark the rays that the groups of a range of places stop; tell whether any is left."""
    for at in range(begin, end):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            if not _stop_by_group(bundle, world, group, stack, base):
                return False
    return True


@device
def _stop_by_slots(
    bundle: Bundle,
    world: World,
    group: Group,
    begin: int,
    end: int,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> bool:
    """Mark the rays that the shapes of a range of slots stop; tell whether any is left."""
    for slot in range(begin, end):
        with_any(world, group, slot, _stop_by_shape, bundle)
    return _any_open(bundle)


@device
def _stop_by_shape(shape: Shape, verbs: Verbs, number: int, bundle: Bundle) -> int:
    """Mark the rays that a shape stops."""
    fan, first, rays, start, end_scale = bundle
    for ray in range(first, first + rays):
        segment = fan_segment(fan, ray, start, end_scale)
        fan[BLOCKED + ray] = 1.0 if verbs.hides(shape, segment) else fan[BLOCKED + ray]
    return number


@device
def _any_open(bundle: Bundle) -> bool:
    """Tell whether nothing so far stops any of the rays."""
    count = 0
    for ray in range(bundle.first, bundle.first + bundle.rays):
        count += 1 if bundle.fan[BLOCKED + ray] == 0.0 else 0
    return count > 0


def _search(
    bundle: Bundle,
    world: World,
    hierarchy: Hierarchy,
    stack: Stack,
    base: int,
    visit: Callable[[Bundle, World, Any, int, int, Stack, int], bool],
    subject: Any,  # noqa: ANN401
) -> bool:
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
    bool
        Whether any ray is left.
    """
    beam = _bundle_beam(bundle, hierarchy.to_boxes)
    near, far = lower_limit(beam, 0.0), upper_limit(beam, 1.0 + MARGIN)
    stack.node[base] = hierarchy.root
    waiting = base + 1
    while waiting > base:
        waiting -= 1
        child = stack.node[waiting]
        if child >= 0:
            waiting = push_met(world.bvh, child, beam, near, far, stack, waiting)
        else:
            begin, end = range_of(hierarchy, child)
            if not visit(bundle, world, subject, begin, end, stack, waiting):
                return False
    return True


_search_places, _search_shapes = device(_search), device(_search)
"""Two searches: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def _bundle_beam(bundle: Bundle, to_boxes: ToBoxes) -> Beam:
    """Return the beam of those rays of an bundle that nothing stops so far."""
    low = math.inf, math.inf, math.inf
    high = -math.inf, -math.inf, -math.inf
    for ray in range(bundle.first, bundle.first + bundle.rays):
        if bundle.fan[BLOCKED + ray] == 0.0:
            way = sub(load_end(bundle.fan, ray), bundle.start.point)
            low, high = lower(low, way), upper(high, way)
    ratio = to_boxes.ratio
    apex = add(scale(ratio, bundle.start.point), to_boxes.offset)
    margin = shape_margin(to_boxes, apex, bundle.start.error_scale)
    return make_beam(apex, apex, scale(ratio, low), scale(ratio, high), margin)
