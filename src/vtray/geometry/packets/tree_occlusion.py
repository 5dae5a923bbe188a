"""Through a hierarchy with shadow rays: those of a cluster of points, one beam from the light."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.tree import WIDTH, leaf_range
from vtray.geometry.packets.beam import Beam, beam_margin, children_met, make_beam
from vtray.geometry.packets.occlusion import PointBox, Target, block_by_slot, in_shaft
from vtray.geometry.packets.packet import BLOCKED, ERROR_SCALE, POINT, Packet, load
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import Vec, add, lower, scale, sub, upper
from vtray.geometry.world import Group, ToBoxes, World

SOONER = 16
"""So few points are tested sooner than a shape is found to be outside their shaft."""


class Box(NamedTuple):
    """A box of points relative to a light, and what their rounding errors are relative to."""

    low: Vec
    high: Vec
    error_scale: float


@device
def block_in_tree(
    packet: Packet, world: World, group: Group, target: Target, work: Workspace
) -> None:
    """Mark the points that shapes of a hierarchy hide from a light, cluster by cluster."""
    for k in range(1, work.cluster[0] + 1):
        begin, end = work.cluster[k], work.cluster[k + 1]
        begin = _first_open(packet, begin, end)
        if begin < end:
            _search_cluster(packet, begin, end, world, group, target, work)


@device
def _first_open(packet: Packet, begin: int, end: int) -> int:
    """Return the first point of a range that nothing blocks so far, `end` if there is none."""
    while begin < end and packet[BLOCKED + begin] != 0.0:
        begin += 1
    return begin


@device
def _search_cluster(
    packet: Packet,
    begin: int,
    end: int,
    world: World,
    group: Group,
    target: Target,
    work: Workspace,
) -> None:
    """Search the hierarchy until all points of a cluster are blocked."""
    bvh, stack = world.bvh, work.stack.node
    box = _cluster_box(packet, begin, end, target)
    points = _point_box(box, target)
    beam = _cluster_beam(box, group.to_boxes, target)
    waiting = 1
    stack[0] = group.root
    while waiting > 0:
        waiting -= 1
        node = stack[waiting]
        met = children_met(bvh, node, beam, 0.0, 1.0 + MARGIN)
        place = node * WIDTH
        while met > 0:
            if met & 1:
                child = bvh.child[place]
                if child >= 0:
                    stack[waiting] = child
                    waiting += 1
                else:
                    first, after = leaf_range(child)
                    for slot in range(first, after):
                        if end - begin <= SOONER or in_shaft(world, group, slot, target, points):
                            block_by_slot(packet, begin, end, world, group, slot, target)
                    begin = _first_open(packet, begin, end)
                    if begin == end:
                        return
            met >>= 1
            place += 1


@device
def _cluster_box(packet: Packet, begin: int, end: int, target: Target) -> Box:
    """Return the box of the points of a cluster that nothing blocks so far."""
    low = math.inf, math.inf, math.inf
    high = -math.inf, -math.inf, -math.inf
    error_scale = 0.0
    for lane in range(begin, end):
        if packet[BLOCKED + lane] == 0.0:
            from_light = sub(load(packet, POINT, lane), target.place)
            low, high = lower(low, from_light), upper(high, from_light)
            error_scale = max(error_scale, packet[ERROR_SCALE + lane])
    return Box(low, high, error_scale)


@device
def _point_box(box: Box, target: Target) -> PointBox:
    """Return a box that is relative to a light as it is in space."""
    center = add(target.place, scale(0.5, add(box.low, box.high)))
    return PointBox(center, scale(0.5, sub(box.high, box.low)), box.error_scale)


@device
def _cluster_beam(box: Box, to_boxes: ToBoxes, target: Target) -> Beam:
    """Return the beam from a light to a box of points."""
    ratio, offset = to_boxes.ratio, to_boxes.offset
    apex = add(scale(ratio, target.place), offset)
    margin = beam_margin(apex, offset) + MARGIN * box.error_scale * ratio
    return make_beam(apex, apex, scale(ratio, box.low), scale(ratio, box.high), margin)
