"""Through a hierarchy with shadow rays: those of a cluster of points, one beam from the light."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.from_light import FOR_EVER, Box, search_from_light
from vtray.geometry.packets.occlusion import PointBox, Target, block_by_slots
from vtray.geometry.packets.packet import ERROR_SCALE, POINT, Packet, load
from vtray.geometry.packets.patch import is_open, widest_reach
from vtray.geometry.packets.stack import Stack
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import CORNER
from vtray.geometry.vector import add, lower, scale, sub, upper
from vtray.geometry.world import (
    Group,
    Hierarchy,
    Places,
    World,
    hierarchy_of,
    hierarchy_of_places,
    load_group,
    placed_row,
)

PATIENCE = 256
"""After so many leaves, points of a cluster are taken to be far apart, and go on one by one."""


class Cluster(NamedTuple):
    """A cluster of points whose shadow rays go to a light together.

    Attributes
    ----------
    packet, end
        The packet, and the first of its points that no longer belongs to it.
    box
        The box of its points, relative to the light.
    points
        The same in space.
    target
        The light.
    """

    packet: Packet
    end: int
    box: Box
    points: PointBox
    target: Target


@device
def block_in_group(
    packet: Packet, world: World, group: Group, target: Target, work: Workspace
) -> None:
    """Mark the points that shapes of a group with a hierarchy hide from a light."""
    _search_all(packet, world, target, work, _block_by_group, group)


@device
def block_by_placed(
    packet: Packet, world: World, places: Places, target: Target, work: Workspace
) -> None:
    """Mark the points that something that is placed hides from a light."""
    _search_all(packet, world, target, work, _block_by_all, places)


@device
def _search_all(
    packet: Packet,
    world: World,
    target: Target,
    work: Workspace,
    block: Callable[[int, Cluster, World, Any, Stack, int], int],
    subject: Any,  # noqa: ANN401
) -> None:
    """Mark what something hides from a light, cluster by cluster."""
    for k in range(1, work.cluster[0] + 1):
        begin, end = work.cluster[k], work.cluster[k + 1]
        begin = _first_open(packet, begin, end, target.is_wide)
        if begin < end:
            block(begin, _new_cluster(packet, begin, end, target), world, subject, work.stack, 0)


@device
def _new_cluster(packet: Packet, begin: int, end: int, target: Target) -> Cluster:
    """Return the cluster of those points of a range that nothing blocks so far."""
    box = _cluster_box(packet, begin, end, target)
    return Cluster(packet, end, box, _point_box(box, target), target)


@device
def _first_open(packet: Packet, begin: int, end: int, is_wide: bool | None) -> int:
    """Return the first point of a range that nothing blocks so far, `end` if there is none."""
    while begin < end and not is_open(packet, begin, is_wide):
        begin += 1
    return begin


@device
def _block_by_group(
    begin: int, cluster: Cluster, world: World, group: Group, stack: Stack, base: int
) -> int:
    """Mark the points of a cluster that a group hides; return the first that is left."""
    hierarchy = hierarchy_of(group)
    return _search_shapes(
        begin, cluster, world, hierarchy, stack, base, _go_through_shapes, _block_by_leaf, group
    )


@device
def _block_by_leaf(
    begin: int,
    cluster: Cluster,
    world: World,
    group: Group,
    first: int,
    after: int,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> int:
    """Mark the points of a cluster that shapes of a range of slots hide."""
    packet, end, target = cluster.packet, cluster.end, cluster.target
    solids = world.solids
    block_by_slots(packet, begin, end, cluster.points, solids, group, first, after, target)
    return _first_open(packet, begin, end, target.is_wide)


@device
def _block_by_all(
    begin: int, cluster: Cluster, world: World, places: Places, stack: Stack, base: int
) -> int:
    """Mark the points of a cluster that something placed hides; return the first that is left."""
    hierarchy = hierarchy_of_places(places)
    return _search_places(
        begin, cluster, world, hierarchy, stack, base, _go_through_places, _block_by_places, places
    )


@device
def _block_by_places(
    begin: int,
    cluster: Cluster,
    world: World,
    places: Places,
    first: int,
    after: int,
    stack: Stack,
    base: int,
) -> int:
    """Mark the points of a cluster that the groups of a range of places hide."""
    for at in range(first, after):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            begin = _block_by_group(begin, cluster, world, group, stack, base)
            if begin == cluster.end:
                return begin
    return begin


def _search_with(
    begin: int,
    cluster: Cluster,
    world: World,
    hierarchy: Hierarchy,
    stack: Stack,
    base: int,
    search: Callable[[int, Cluster, World, Hierarchy, Stack, int, int, Any, Any], int],
    visit: Callable[[int, Cluster, World, Any, int, int, Stack, int], int],
    subject: Any,  # noqa: ANN401
) -> int:
    """Search with a cluster, and if that is given up, with one of its points after the other."""
    packet, is_wide = cluster.packet, cluster.target.is_wide
    part, at = cluster, begin
    patience = PATIENCE if cluster.end - begin > 1 else FOR_EVER
    while at < cluster.end:
        left = search(at, part, world, hierarchy, stack, base, patience, visit, subject)
        at = _first_open(packet, part.end if left >= 0 else -1 - left, cluster.end, is_wide)
        if at < cluster.end:
            part, patience = _new_cluster(packet, at, at + 1, cluster.target), FOR_EVER
    return _first_open(packet, begin, cluster.end, is_wide)


_go_through_places, _go_through_shapes = device(search_from_light), device(search_from_light)
_search_places, _search_shapes = device(_search_with), device(_search_with)
"""Two searches: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def _cluster_box(packet: Packet, begin: int, end: int, target: Target) -> Box:
    """Return the box of the points of a cluster that nothing blocks so far."""
    low = math.inf, math.inf, math.inf
    high = -math.inf, -math.inf, -math.inf
    error_scale = 0.0
    for lane in range(begin, end):
        if is_open(packet, lane, target.is_wide):
            from_light = sub(load(packet, POINT, lane), target.place)
            low, high = lower(low, from_light), upper(high, from_light)
            error_scale = max(error_scale, packet[ERROR_SCALE + lane])
    return _widened(packet, begin, end, Box(low, high, error_scale), target.is_wide)


@device
def _widened(packet: Packet, begin: int, end: int, box: Box, is_wide: bool | None) -> Box:
    """Return a box of points widened by their patches, if these are asked for."""
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            most = CORNER * widest_reach(packet, begin, end, is_wide)
            reach = most, most, most
            return Box(sub(box.low, reach), add(box.high, reach), box.error_scale)
    return box


@device
def _point_box(box: Box, target: Target) -> PointBox:
    """Return a box that is relative to a light as it is in space."""
    center = add(target.place, scale(0.5, add(box.low, box.high)))
    return PointBox(center, scale(0.5, sub(box.high, box.low)), box.error_scale)
