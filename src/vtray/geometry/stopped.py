"""Which rays of a fan something stops on their way to a light.

All rays go through a hierarchy together: for each box that waits there is the set of those that may
meet it. Where these are few, each goes on alone. Shapes that have no hierarchy are asked about all
rays. What is found is what a loop over all rays and all shapes would find.
"""

from typing import NamedTuple

import numpy as np

from vtray.base.compiler.compiled import device
from vtray.geometry.between import is_occluded_below, is_occluded_by_placed
from vtray.geometry.bvh.tree import EMPTY, WIDTH, Bvh, child_box, leaf_range
from vtray.geometry.dispatch import Shape, Verbs, with_any, with_bounded
from vtray.geometry.packets.beam import ray_beam, shape_margin
from vtray.geometry.packets.cone import Touching
from vtray.geometry.packets.fan import (
    BLOCKED,
    LENGTH,
    Fan,
    Start,
    fan_segment,
    load_direction,
)
from vtray.geometry.packets.fan_rays import (
    NONE,
    ONE,
    count_bits,
    first_bit,
    narrow_directions,
    open_rays,
    rays_near,
)
from vtray.geometry.packets.stack import Stack
from vtray.geometry.rounding import MARGIN, ROUNDING
from vtray.geometry.vector import Vec, add, dot, scale, sub
from vtray.geometry.world import (
    NO_TREE,
    SPHERE,
    Group,
    Places,
    World,
    group_count,
    load_group,
)

FEW = 8
"""Fewer rays than these search below a node alone."""


class Bundle(NamedTuple):
    """The rays of a fan.

    Attributes
    ----------
    fan, rays
        The fan, and how many there are.
    start, normal
        Where they start, and the unit normal of the surface there, above which they all are.
    end_scale
        What the rounding errors of their ends are relative to.
    longest
        No ray is longer.
    """

    fan: Fan
    rays: int
    start: Start
    normal: Vec
    end_scale: float
    longest: float


@device
def stop_by_touching(bundle: Bundle, world: World, touching: Touching, count: int) -> None:
    """Mark in field ``BLOCKED`` the rays that some shapes stop.

    Parameters
    ----------
    bundle
        The rays. Those marked already stay so.
    world, touching, count
        The shapes, so many.
    """
    for k in range(count):
        group = load_group(world, touching.row[k])
        with_any(world, group, touching.slot[k], _stop_by_shape, bundle)


@device
def stop_by_all(bundle: Bundle, world: World, stack: Stack) -> None:
    """Mark in field ``BLOCKED`` the rays that anything stops.

    Parameters
    ----------
    bundle
        The rays. Those marked already are passed over.
    world
        What they can meet.
    stack
        Scratch memory.
    """
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.root == NO_TREE:
            for slot in range(group.begin, group.end):
                with_any(world, group, slot, _stop_by_shape, bundle)
        else:
            _stop_by_tree(bundle, world, group, stack)
    _stop_by_placed(bundle, world, world.places, stack)


@device
def _stop_by_shape(shape: Shape, verbs: Verbs, number: int, bundle: Bundle) -> int:
    """Mark the rays that a shape stops."""
    fan, rays, start, _, end_scale, _ = bundle
    for ray in range(rays):
        segment = fan_segment(fan, ray, start, end_scale)
        fan[BLOCKED + ray] = 1.0 if verbs.hides(shape, segment) else fan[BLOCKED + ray]
    return number


@device
def _stop_by_tree(bundle: Bundle, world: World, group: Group, stack: Stack) -> None:
    """Mark the rays that shapes of a group with a hierarchy stop."""
    fan, start = bundle.fan, bundle.start
    ratio, offset = group.to_boxes.ratio, group.to_boxes.offset
    apex = add(scale(ratio, start.point), offset)
    margin = shape_margin(group.to_boxes, apex, start.error_scale)
    narrow_directions(fan, bundle.rays)
    unstopped = open_rays(fan, bundle.rays)
    stack.node[0] = group.root
    stack.rays[0] = unstopped
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = stack.node[waiting]
        rays = stack.rays[waiting] & unstopped
        if rays == NONE:
            continue
        if node < 0:
            begin, end = leaf_range(node)
            for slot in range(begin, end):
                arguments = bundle, group.kind, ratio, rays
                hidden = with_bounded(world, group, slot, _hidden_rays, arguments)
                rays &= ~hidden
                unstopped &= ~hidden
        elif count_bits(rays) < FEW:
            while rays != NONE:
                ray = first_bit(rays)
                rays &= rays - ONE
                segment = fan_segment(fan, ray, start, bundle.end_scale)
                beam = ray_beam(apex, load_direction(fan, ray), margin)
                length = fan[LENGTH + ray] * ratio
                if is_occluded_below(world, group, node, segment, beam, length, stack, waiting):
                    fan[BLOCKED + ray] = 1.0
                    unstopped &= ~(ONE << np.uint64(ray))
        else:
            waiting = _push_near(
                bundle, world.bvh, node, apex, margin, ratio * bundle.longest, rays, stack, waiting
            )


@device
def _push_near(
    bundle: Bundle,
    bvh: Bvh,
    node: int,
    apex: Vec,
    margin: float,
    longest: float,
    rays: np.uint64,
    stack: Stack,
    base: int,
) -> int:
    """Push the children of a node that some of its rays may meet; return the stack's new height."""
    top = base
    for k in range(WIDTH):
        child = bvh.child[node * WIDTH + k]
        if child != EMPTY:
            low, high = child_box(bvh, node, k)
            way = sub(scale(0.5, add(low, high)), apex)
            half = scale(0.5, sub(high, low))
            if dot(way, bundle.normal) + _reach_along(half, bundle.normal) < -margin:
                continue
            # No box reaches farther than 8: the square is that of a radius wider by the margin.
            radius2 = dot(half, half) + margin * (16.0 + margin)
            distance2 = dot(way, way)
            if distance2 > 2.0 * (longest * longest + radius2):
                continue
            near = rays & rays_near(bundle.fan, bundle.rays, way, distance2 - radius2, margin, True)
            if near != NONE:
                stack.node[top] = child
                stack.rays[top] = near
                top += 1
    return top


@device
def _reach_along(half: Vec, direction: Vec) -> float:
    """Return how far a box reaches from its middle in a direction, given half its extents."""
    x, y, z = direction
    return half[0] * abs(x) + half[1] * abs(y) + half[2] * abs(z)


@device
def _hidden_rays(
    shape: Shape,
    verbs: Verbs,
    number: int,  # noqa: ARG001
    arguments: tuple[Bundle, int, float, np.uint64],
) -> np.uint64:
    """Mark those of some rays that a shape stops, and return them."""
    bundle, kind, ratio, rays = arguments
    fan, start = bundle.fan, bundle.start
    way = scale(ratio, sub(shape.center, start.point))
    radius, error_scale = ratio * shape.radius, ratio * (shape.error_scale + start.error_scale)
    margin = MARGIN * error_scale
    if dot(way, bundle.normal) + radius < -margin:
        return NONE
    distance2, wide = dot(way, way), radius + margin
    tangent2, starts_inside = distance2 - wide * wide, True
    if kind == SPHERE and tangent2 <= 0.0:
        bound = ROUNDING * error_scale
        starts_inside = distance2 - radius * radius < -bound * (2.0 * radius + bound)
    rays &= rays_near(fan, bundle.rays, way, tangent2, margin, starts_inside)
    hidden = NONE
    while rays != NONE:
        ray = first_bit(rays)
        rays &= rays - ONE
        if verbs.hides(shape, fan_segment(fan, ray, start, bundle.end_scale)):
            fan[BLOCKED + ray] = 1.0
            hidden |= ONE << np.uint64(ray)
    return hidden


@device
def _stop_by_placed(bundle: Bundle, world: World, places: Places | None, stack: Stack) -> None:
    """Mark the rays that something that is placed stops."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        for ray in range(bundle.rays):
            if bundle.fan[BLOCKED + ray] == 0.0:
                segment = fan_segment(bundle.fan, ray, bundle.start, bundle.end_scale)
                hidden = is_occluded_by_placed(world, places, segment, stack)
                bundle.fan[BLOCKED + ray] = 1.0 if hidden else 0.0
