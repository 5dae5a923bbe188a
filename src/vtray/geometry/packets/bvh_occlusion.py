"""Through the hierarchy with shadow rays: those of a group of points, one beam from the light."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.tree import WIDTH, leaf_range
from vtray.geometry.packets.beam import Beam, beam_margin, children_met, make_beam
from vtray.geometry.packets.occlusion import block_by_sphere
from vtray.geometry.packets.packet import BLOCKED, MAGNITUDE, POINT, Packet, load
from vtray.geometry.packets.shaft import MARGIN, outside_shaft
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.shapes.sphere_arrays import sphere_center, sphere_magnitude, sphere_radius
from vtray.geometry.vector import Vec, add, lower, pick, scale, sub, upper
from vtray.geometry.world import SceneArrays

FEW = 16
"""So few points are tested sooner than a sphere is found to be outside their shaft."""


class Box(NamedTuple):
    """A box of points, relative to a light, and their largest magnitude."""

    low: Vec
    high: Vec
    magnitude: float


@device
def block_in_bvh(packet: Packet, scene: SceneArrays, light: int, work: Workspace) -> None:
    """Mark the points that spheres hide from a light, group by group."""
    for k in range(1, work.group[0] + 1):
        begin, end = work.group[k], work.group[k + 1]
        begin = _first_open(packet, begin, end)
        if begin < end:
            _search_group(packet, begin, end, scene, light, work)


@device
def _first_open(packet: Packet, begin: int, end: int) -> int:
    """Return the first point of a range that nothing blocks so far, `end` if there is none."""
    while begin < end and packet[BLOCKED + begin] != 0.0:
        begin += 1
    return begin


@device
def _search_group(
    packet: Packet, begin: int, end: int, scene: SceneArrays, light: int, work: Workspace
) -> None:
    """Search the hierarchy until all points of a group are blocked."""
    bvh, stack = scene.bvh, work.stack
    box = _group_box(packet, begin, end, scene, light)
    beam = _group_beam(box, scene, light)
    waiting = 1
    stack[0] = 0
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
                        if end - begin <= FEW or _in_shaft(scene, slot, light, box):
                            block_by_sphere(
                                packet, begin, end, scene.spheres, slot, scene.lights, light
                            )
                    begin = _first_open(packet, begin, end)
                    if begin == end:
                        return
            met >>= 1
            place += 1


@device
def _group_box(packet: Packet, begin: int, end: int, scene: SceneArrays, light: int) -> Box:
    """Return the box of the points of a group that nothing blocks so far."""
    place = pick(scene.lights, light)
    low = math.inf, math.inf, math.inf
    high = -math.inf, -math.inf, -math.inf
    magnitude = 0.0
    for lane in range(begin, end):
        if packet[BLOCKED + lane] == 0.0:
            from_light = sub(load(packet, POINT, lane), place)
            low, high = lower(low, from_light), upper(high, from_light)
            magnitude = max(magnitude, packet[MAGNITUDE + lane])
    return Box(low, high, magnitude)


@device
def _group_beam(box: Box, scene: SceneArrays, light: int) -> Beam:
    """Return the beam from a light to a box of points."""
    ratio, offset = scene.to_boxes.ratio, scene.to_boxes.offset
    apex = add(scale(ratio, pick(scene.lights, light)), offset)
    margin = beam_margin(apex, offset) + MARGIN * box.magnitude * ratio
    return make_beam(apex, apex, scale(ratio, box.low), scale(ratio, box.high), margin)


@device
def _in_shaft(scene: SceneArrays, slot: int, light: int, box: Box) -> bool:
    """Tell whether a sphere may stand between any point of a box and a light."""
    center, radius = sphere_center(scene.spheres, slot), sphere_radius(scene.spheres, slot)
    magnitude = box.magnitude + scene.lights.magnitude[light]
    radius += MARGIN * (sphere_magnitude(center, radius) + magnitude)
    tip = pick(scene.lights, light)
    middle = add(tip, scale(0.5, add(box.low, box.high)))
    return not outside_shaft(center, radius, tip, middle, scale(0.5, sub(box.high, box.low)))
