"""The parts of the rays of a fan within faded shapes: all rays go through a hierarchy together.

As in `stopped`, for each box that waits there is the set of rays that may meet it. But nothing ends
a ray: each goes through all that it meets.
"""

import math

import numpy as np

from vtray.base.compiler.compiled import device
from vtray.geometry.bits import lowest_bit
from vtray.geometry.bvh.tree import WIDTH, leaf_range
from vtray.geometry.dispatch import with_any, with_bounded
from vtray.geometry.faded.chords import Key, add_chord
from vtray.geometry.faded.layers import ray_along
from vtray.geometry.packets.beam import shape_margin
from vtray.geometry.packets.fan_rays import (
    NONE,
    ONE,
    SINGLE_HUGE,
    open_rays,
    rays_along,
    view_from,
)
from vtray.geometry.packets.layer_notes import Chords
from vtray.geometry.packets.packet import join_met
from vtray.geometry.packets.stack import Stack
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.stopped import Bundle, push_near, see_ball, way_of
from vtray.geometry.vector import magnitude
from vtray.geometry.world import NO_TREE, Faded, Group, World, load_group, to_box_space


@device
def can_go_together(bundle: Bundle, world: World, faded: Faded) -> bool:
    """Tell whether the rays of a fan can be asked at once: not about what is placed, or huge."""
    for row in range(faded.begin, faded.end):
        apex = to_box_space(load_group(world, row).to_boxes, bundle.spot.start.point)
        if not magnitude(apex) < SINGLE_HUGE:
            return False
    return faded.places.begin == faded.places.end


@device
def collect_fan(bundle: Bundle, world: World, faded: Faded, chords: Chords, stack: Stack) -> None:
    """Collect the chords of all rays of a fan that nothing stops, the nearest of them.

    Parameters
    ----------
    bundle
        The rays, whose directions in single precision are set.
    world, faded
        The shapes.
    chords
        Out: the chords. A list that is full may lack some.
    stack
        Scratch memory.
    """
    for ray in range(bundle.rays):
        chords.found[ray] = 0
    rays = open_rays(bundle.fan, bundle.rays)
    if rays == NONE:
        return
    for row in range(faded.begin, faded.end):
        group = load_group(world, row)
        if group.root == NO_TREE:
            for slot in range(group.begin, group.end):
                arguments = bundle, rays, join_met(row, slot), chords
                with_any(world, group, slot, _collect_rays, arguments)
        else:
            _collect_in_group(bundle, world, group, rays, chords, stack)


@device
def _collect_in_group(
    bundle: Bundle, world: World, group: Group, rays: np.uint64, chords: Chords, stack: Stack
) -> None:
    """Collect those of a group with a hierarchy."""
    start, ratio = bundle.spot.start, group.to_boxes.ratio
    apex = to_box_space(group.to_boxes, start.point)
    margin = shape_margin(group.to_boxes, apex, start.error_scale)
    view = view_from(apex, bundle.spot, ratio, margin, bundle.longest)
    stack.node[0] = group.root
    stack.rays[0] = rays
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node, near = stack.node[waiting], stack.rays[waiting]
        if node < 0:
            _collect_in_leaf(bundle, world, group, node, near, chords, stack)
        else:
            waiting = push_near(bundle, world.bvh, node, view, near, stack, waiting)


@device
def _collect_in_leaf(
    bundle: Bundle,
    world: World,
    group: Group,
    leaf: int,
    rays: np.uint64,
    chords: Chords,
    stack: Stack,
) -> None:
    """Collect those of a leaf."""
    balls, count = stack.balls, 0
    begin, end = leaf_range(leaf)
    for slot in range(begin, end):
        stack.slot[count] = slot
        arguments = bundle, group.kind, group.to_boxes.ratio, balls, count
        count += with_bounded(world.solids, group, slot, see_ball, arguments)
    for k in range(count):
        way = balls[k], balls[WIDTH + k], balls[2 * WIDTH + k]
        near = rays & rays_along(bundle.fan, bundle.rays, way, balls[3 * WIDTH + k])
        if near != NONE:
            slot = stack.slot[k]
            arguments_of_rays = bundle, near, join_met(group.row, slot), chords
            with_bounded(world.solids, group, slot, _collect_rays, arguments_of_rays)


@device
def _collect_rays(
    shape: Shape, verbs: Verbs, number: int, arguments: tuple[Bundle, np.uint64, int, Chords]
) -> int:
    """Collect the chords of a shape for some rays."""
    bundle, rays, met, chords = arguments
    while rays != NONE:
        k = lowest_bit(rays)
        rays &= rays - ONE
        ray, end = ray_along(way_of(bundle, k))
        add_chord(shape, verbs, number, ray, end, Key(-math.inf, -1), met, chords, k)
    return number
