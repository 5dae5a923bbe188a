"""Through a hierarchy with the rays of a part of a packet, as one beam."""

from collections.abc import Callable
from typing import Any

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.beam import Beam, lower_limit, make_beam, shape_margin, upper_limit
from vtray.geometry.packets.nearest import nearest_slots
from vtray.geometry.packets.packet import Packet, Sheaf
from vtray.geometry.packets.ray_bounds import farthest_of, part_directions, part_starts
from vtray.geometry.packets.stack import push_met
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import CORNER, Footprint, growth_of, width_at
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import add, sub
from vtray.geometry.world import (
    Group,
    Hierarchy,
    Places,
    ToBoxes,
    World,
    hierarchy_of,
    hierarchy_of_places,
    load_group,
    placed_row,
    range_of,
    to_box_space,
)

Rays = tuple[Packet, int, int, Sheaf, Footprint | None]
"""A packet, the first of the octets that form the beam and how many there are, and what their rays
have in common."""


@device
def nearest_in_group(
    packet: Packet,
    first: int,
    count: int,
    sheaf: Sheaf,
    footprint: Footprint | None,
    world: World,
    group: Group,
    work: Workspace,
    base: int,
) -> None:
    """Let the shapes of a group take lanes in which they are nearer.

    Parameters
    ----------
    packet, sheaf, footprint
        The rays.
    first, count
        The first of the octets that form the beam, and how many there are.
    world, group
        The shapes.
    work
        Scratch memory.
    base
        What waits on the stack already.
    """
    rays = packet, first, count, sheaf, footprint
    _search_shapes(rays, world, hierarchy_of(group), work, base, _nearest_of_leaf, group)


@device
def _nearest_of_leaf(
    rays: Rays,
    world: World,
    group: Group,
    begin: int,
    end: int,
    work: Workspace,
    base: int,  # noqa: ARG001
) -> None:
    """Let the shapes of a range of slots take lanes in which they are nearer."""
    packet, first, count, sheaf, footprint = rays
    solids, cones = world.solids, work.cones
    nearest_slots(packet, first, count, sheaf, footprint, solids, group, begin, end, cones)


@device
def nearest_placed(
    packet: Packet,
    first: int,
    count: int,
    sheaf: Sheaf,
    footprint: Footprint | None,
    world: World,
    places: Places,
    work: Workspace,
) -> None:
    """Let what is placed take lanes in which it is nearer; the parameters are those of a group."""
    rays = packet, first, count, sheaf, footprint
    hierarchy = hierarchy_of_places(places)
    _search_places(rays, world, hierarchy, work, 0, _nearest_of_places, places)


@device
def _nearest_of_places(
    rays: Rays, world: World, places: Places, begin: int, end: int, work: Workspace, base: int
) -> None:
    """Let the groups of a range of places take lanes in which they are nearer."""
    packet, first, count, sheaf, footprint = rays
    for at in range(begin, end):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            nearest_in_group(packet, first, count, sheaf, footprint, world, group, work, base)


def _search(
    rays: Rays,
    world: World,
    hierarchy: Hierarchy,
    work: Workspace,
    base: int,
    visit: Callable[[Rays, World, Any, int, int, Workspace, int], None],
    subject: Any,  # noqa: ANN401
) -> None:
    """Visit the leaves of a hierarchy that a beam may meet, the nearest boxes first.

    Parameters
    ----------
    rays, world, hierarchy, work
        As in `nearest_in_group`.
    base
        What waits on the stack already, which stays there.
    visit, subject
        What is called for each leaf, and what it is given, beside the range that the leaf names.
    """
    _, first, count, sheaf, footprint = rays
    bvh, ratio, stack = world.bvh, hierarchy.to_boxes.ratio, work.stack
    beam = _part_beam(first, count, sheaf, footprint, hierarchy.to_boxes, work)
    # The rays of a footprint may be steeper than those in their middle.
    before = -sheaf.plane_depth * (1.0 - MARGIN) / (1.0 + growth_of(footprint))
    start = lower_limit(beam, before * ratio)
    far = upper_limit(beam, farthest_of(work.cones, first, count) * ratio)
    stack.node[base] = hierarchy.root
    stack.enter[base] = start
    waiting = base + 1
    while waiting > base:
        waiting -= 1
        if stack.enter[waiting] > far:
            continue
        child = stack.node[waiting]
        if child >= 0:
            waiting = push_met(bvh, child, beam, start, far, stack, waiting)
        else:
            begin, end = range_of(hierarchy, child)
            visit(rays, world, subject, begin, end, work, waiting)
            far = upper_limit(beam, farthest_of(work.cones, first, count) * ratio)


_search_places, _search_shapes = device(_search), device(_search)
"""Two searches: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def _part_beam(
    first: int,
    count: int,
    sheaf: Sheaf,
    footprint: Footprint | None,
    to_boxes: ToBoxes,
    work: Workspace,
) -> Beam:
    """Return the beam of a part's rays and their footprints."""
    low, high = part_directions(work.cones, first, count)
    near, far = part_starts(work.cones, first, count, sheaf)
    apex = to_box_space(to_boxes, sheaf.origin)
    margin = shape_margin(to_boxes, apex, sheaf.error_scale)
    margin += CORNER * width_at(footprint, 0.0) * to_boxes.ratio
    growth = CORNER * growth_of(footprint)
    wider = growth, growth, growth
    start, end = to_box_space(to_boxes, near), to_box_space(to_boxes, far)
    return make_beam(start, end, sub(low, wider), add(high, wider), margin)
