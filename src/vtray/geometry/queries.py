"""What one ray meets first, and what stands between two points: one ray at a time, from anywhere.

What is found is what a loop over all shapes would find; the hierarchies only leave out.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.tree import WIDTH, leaf_range
from vtray.geometry.dispatch import Shape, Verbs, with_any
from vtray.geometry.packets.beam import Beam, beam_margin, children_met, make_beam
from vtray.geometry.packets.stack import Stack, push_met
from vtray.geometry.ray import Ray, Segment
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import add, scale, sub
from vtray.geometry.world import (
    NO_TREE,
    Group,
    ToBoxes,
    World,
    group_count,
    load_group,
)

NOTHING = -1
"""In place of a primitive: nothing is hit, nothing stands between."""


class Hit(NamedTuple):
    """What a ray meets first.

    Attributes
    ----------
    distance
        Along the ray, infinite for nothing.
    primitive
        Its number, or ``NOTHING``.
    group, slot
        The row of its group, and its slot in the columns of its kind.
    """

    distance: float
    primitive: int
    group: int
    slot: int


@device
def nearest_hit(world: World, ray: Ray, stack: Stack) -> Hit:
    """Return what a ray meets first."""
    hit = Hit(math.inf, NOTHING, 0, 0)
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.root == NO_TREE:
            hit = _nearest_slots(world, group, group.begin, group.end, ray, hit)
        else:
            hit = _nearest_in_tree(world, group, ray, hit, stack)
    return hit


@device
def _nearest_slots(world: World, group: Group, begin: int, end: int, ray: Ray, hit: Hit) -> Hit:
    """Return the nearer of a hit and those of the shapes of a range of slots."""
    for slot in range(begin, end):
        distance, number = with_any(world, group, slot, _meet, ray)
        if distance < hit.distance or (distance == hit.distance and number < hit.primitive):
            hit = Hit(distance, number, group.row, slot)
    return hit


@device
def _meet(shape: Shape, verbs: Verbs, number: int, ray: Ray) -> tuple[float, int]:
    """Return the distance at which a ray meets a shape, and the shape's number."""
    return verbs.distance_to(shape, ray), number


@device
def _nearest_in_tree(world: World, group: Group, ray: Ray, hit: Hit, stack: Stack) -> Hit:
    """Return the nearer of a hit and those of the shapes of a hierarchy."""
    ratio = group.to_boxes.ratio
    beam = _ray_beam(group.to_boxes, ray)
    start = max(-ray.depth, 0.0) * ratio * (1.0 - MARGIN)
    stack.node[0] = group.root
    stack.enter[0] = 0.0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        far = hit.distance * ratio * (1.0 + MARGIN)
        if stack.enter[waiting] > far:
            continue
        child = stack.node[waiting]
        if child >= 0:
            waiting = push_met(world.bvh, child, beam, start, far, stack, waiting)
        else:
            begin, end = leaf_range(child)
            hit = _nearest_slots(world, group, begin, end, ray, hit)
    return hit


@device
def _ray_beam(to_boxes: ToBoxes, ray: Ray) -> Beam:
    """Return a ray as a beam in the boxes' space."""
    ratio, offset = to_boxes.ratio, to_boxes.offset
    start = add(scale(ratio, ray.origin), offset)
    margin = beam_margin(start, offset) + MARGIN * ray.error_scale * ratio
    return make_beam(start, start, ray.direction, ray.direction, margin)


@device
def first_between(world: World, segment: Segment, stack: Stack) -> int:
    """Return the lowest number of what stands between two points, or ``NOTHING``."""
    first = NOTHING
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.root == NO_TREE:
            first = _first_of_slots(world, group, group.begin, group.end, segment, first)
        else:
            first = _first_in_tree(world, group, segment, first, stack)
    return first


@device
def _first_of_slots(
    world: World, group: Group, begin: int, end: int, segment: Segment, first: int
) -> int:
    """Return the lower of a number and those of the shapes in a range that stand between."""
    for slot in range(begin, end):
        hides, number = with_any(world, group, slot, _hides, segment)
        if hides and (first == NOTHING or number < first):
            first = number
    return first


@device
def _hides(shape: Shape, verbs: Verbs, number: int, segment: Segment) -> tuple[bool, int]:
    """Tell whether a shape stands between two points; return the shape's number."""
    return verbs.hides(shape, segment), number


@device
def _first_in_tree(world: World, group: Group, segment: Segment, first: int, stack: Stack) -> int:
    """Return the lower of a number and those of the shapes of a hierarchy that stand between."""
    bvh, (ratio, offset) = world.bvh, group.to_boxes
    # From the light: its place is the more exact of the two.
    end = add(scale(ratio, segment.end), offset)
    way = scale(ratio, sub(segment.start, segment.end))
    margin = beam_margin(end, offset) + MARGIN * segment.start_scale * ratio
    beam = make_beam(end, end, way, way, margin)
    stack.node[0] = group.root
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = stack.node[waiting]
        met = children_met(bvh, node, beam, 0.0, 1.0 + MARGIN)
        place = node * WIDTH
        while met > 0:
            if met & 1:
                child = bvh.child[place]
                if child >= 0:
                    stack.node[waiting] = child
                    waiting += 1
                else:
                    begin, after = leaf_range(child)
                    first = _first_of_slots(world, group, begin, after, segment, first)
            met >>= 1
            place += 1
    return first
