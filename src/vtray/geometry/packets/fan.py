"""A fan: shadow rays that spread from one point, and which of them something stops.

Eight of them that point into nearly the same direction go through the hierarchies as one beam.
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
from vtray.geometry.packets.packet import OCTET
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


class Octet(NamedTuple):
    """Eight neighbouring rays of a fan.

    Attributes
    ----------
    fan, first
        The fan, and the first of the rays.
    start
        Where they start.
    end_scale
        What the rounding errors of their ends are relative to.
    """

    fan: Fan
    first: int
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
def find_stopped(
    fan: Fan, rays: int, start: Start, end_scale: float, world: World, stack: Stack
) -> None:
    """Mark in field ``BLOCKED`` the rays of a fan that something stops.

    Parameters
    ----------
    fan, rays
        The rays, so many, a multiple of eight. Those marked already are passed over.
    start, end_scale
        Where they start, and what the rounding errors of their ends are relative to.
    world
        What they can meet.
    stack
        Scratch memory.
    """
    for first in range(0, rays, OCTET):
        octet = Octet(fan, first & (FAN - 1), start, end_scale)
        if _any_open(octet):
            _stop_octet(octet, world, stack)


@device
def _stop_octet(octet: Octet, world: World, stack: Stack) -> None:
    """Mark the rays of an octet that something stops."""
    for row in range(group_count(world)):
        if not _stop_by_group(octet, world, load_group(world, row), stack, 0):
            return
    _stop_by_placed(octet, world, world.places, stack)


@device
def _stop_by_group(octet: Octet, world: World, group: Group, stack: Stack, base: int) -> bool:
    """Mark the rays that shapes of a group stop; tell whether any is left."""
    return _search_shapes(octet, world, hierarchy_of(group), stack, base, _stop_by_slots, group)


@device
def _stop_by_placed(octet: Octet, world: World, places: Places | None, stack: Stack) -> None:
    """Mark the rays that something stops that is placed."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        hierarchy = hierarchy_of_places(places)
        _search_places(octet, world, hierarchy, stack, 0, _stop_by_places, places)


@device
def _stop_by_places(
    octet: Octet, world: World, places: Places, begin: int, end: int, stack: Stack, base: int
) -> bool:
    """Mark the rays that the groups of a range of places stop; tell whether any is left."""
    for at in range(begin, end):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            if not _stop_by_group(octet, world, group, stack, base):
                return False
    return True


@device
def _stop_by_slots(
    octet: Octet,
    world: World,
    group: Group,
    begin: int,
    end: int,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> bool:
    """Mark the rays that the shapes of a range of slots stop; tell whether any is left."""
    for slot in range(begin, end):
        with_any(world, group, slot, _stop_by_shape, octet)
    return _any_open(octet)


@device
def _stop_by_shape(shape: Shape, verbs: Verbs, number: int, octet: Octet) -> int:
    """Mark the rays that a shape stops."""
    fan, first, start, end_scale = octet
    for ray in range(first, first + OCTET):
        segment = Segment(
            start.point,
            load_end(fan, ray),
            start.plane_depth,
            fan[END_PLANE_DEPTH + ray],
            start.error_scale,
            end_scale,
        )
        fan[BLOCKED + ray] = 1.0 if verbs.hides(shape, segment) else fan[BLOCKED + ray]
    return number


@device
def _any_open(octet: Octet) -> bool:
    """Tell whether nothing so far stops any of the rays."""
    count = 0
    for ray in range(octet.first, octet.first + OCTET):
        count += 1 if octet.fan[BLOCKED + ray] == 0.0 else 0
    return count > 0


def _search(
    octet: Octet,
    world: World,
    hierarchy: Hierarchy,
    stack: Stack,
    base: int,
    visit: Callable[[Octet, World, Any, int, int, Stack, int], bool],
    subject: Any,  # noqa: ANN401
) -> bool:
    """Visit the leaves of a hierarchy that may stop rays, the nearest first, until none is left.

    Parameters
    ----------
    octet, world, hierarchy
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
    beam = _octet_beam(octet, hierarchy.to_boxes)
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
            if not visit(octet, world, subject, begin, end, stack, waiting):
                return False
    return True


_search_places, _search_shapes = device(_search), device(_search)
"""Two searches: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def _octet_beam(octet: Octet, to_boxes: ToBoxes) -> Beam:
    """Return the beam of those rays of an octet that nothing stops so far."""
    low = math.inf, math.inf, math.inf
    high = -math.inf, -math.inf, -math.inf
    for ray in range(octet.first, octet.first + OCTET):
        if octet.fan[BLOCKED + ray] == 0.0:
            way = sub(load_end(octet.fan, ray), octet.start.point)
            low, high = lower(low, way), upper(high, way)
    ratio = to_boxes.ratio
    apex = add(scale(ratio, octet.start.point), to_boxes.offset)
    margin = shape_margin(to_boxes, apex, octet.start.error_scale)
    return make_beam(apex, apex, scale(ratio, low), scale(ratio, high), margin)
