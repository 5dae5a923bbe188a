"""Which rays of a fan something stops on their way to a light.

All rays go through a hierarchy together: for each box that waits there is the set of those that may
meet it. Where these are few, each goes on alone. Shapes that have no hierarchy are asked about all
rays. What is found is what a loop over all rays and all shapes would find.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.between import is_occluded_below, is_occluded_by_placed
from vtray.geometry.bits import count_bits, lowest_bit
from vtray.geometry.bvh.tree import SIDES, WIDTH, Bvh, leaf_range
from vtray.geometry.dispatch import with_any, with_bounded
from vtray.geometry.packets.beam import ray_beam, shape_margin
from vtray.geometry.packets.cone import Touching
from vtray.geometry.packets.fan import (
    BLOCKED,
    FAN,
    LENGTH,
    Fan,
    Start,
    fan_segment,
    load_direction,
)
from vtray.geometry.packets.fan_rays import (
    NONE,
    ONE,
    SINGLE_HUGE,
    View,
    balls_seen,
    narrow_directions,
    open_rays,
    rays_along,
    rays_between,
    set_ball,
    view_from,
)
from vtray.geometry.packets.stack import Stack
from vtray.geometry.rounding import MARGIN, ROUNDING
from vtray.geometry.shapes.axis_line import ON_SIDE
from vtray.geometry.shapes.plane import plane_side
from vtray.geometry.shapes.room import room_wall
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec, add, dot, magnitude, scale, sub
from vtray.geometry.world import (
    CUT,
    NO_TREE,
    PLANE,
    SPHERE,
    Clip,
    Group,
    Places,
    World,
    group_count,
    load_group,
    room_of,
)

FEW = 8
"""Fewer rays than these search below a node alone."""

FEW_IN_LEAF = 2
"""Up to so many rays are asked about all shapes of a leaf, and not about their balls first."""


class Bundle(NamedTuple):
    """The rays of a fan.

    Attributes
    ----------
    fan, rays
        The fan, and how many there are.
    start, normal
        Where they start, and the unit normal of the surface there, above which they all are.
    end_scale
        What the rounding errors of their ends are relative to; None if field ``END_SCALE`` says it.
    longest
        No ray is longer.
    """

    fan: Fan
    rays: int
    start: Start
    normal: Vec
    end_scale: float | None
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
    narrow_directions(bundle.fan, bundle.rays)
    for k in range(count):
        group = load_group(world, touching.row[k])
        with_any(world, group, touching.slot[k], _stop_by_shape, (bundle, group.kind))


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
    narrow_directions(bundle.fan, bundle.rays)
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.kind >= CUT and _leads_out(world, world.clip, group, bundle):
            continue
        if group.root == NO_TREE:
            for slot in range(group.begin, group.end):
                with_any(world, group, slot, _stop_by_shape, (bundle, group.kind))
        else:
            _stop_by_tree(bundle, world, group, stack)
    _stop_by_placed(bundle, world, world.places, stack)


@device
def _leads_out(world: World, clip: Clip | None, group: Group, bundle: Bundle) -> bool:
    """Tell whether rays start on a cap and lead out of what clip planes leave of a group."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if clip is not None:  # noqa: SIM102
        if clip.is_capped:
            start, room = bundle.start, room_of(world, clip, group)
            wall = room_wall(room, start.point)
            bound = ROUNDING * (wall.error_scale + start.error_scale)
            is_on = plane_side(wall, start.point) >= -ON_SIDE * bound
            normal, out = bundle.normal, wall.normal
            return is_on & (normal[0] == out[0]) & (normal[1] == out[1]) & (normal[2] == out[2])
    return False


@device
def _stop_by_shape(shape: Shape, verbs: Verbs, number: int, arguments: tuple[Bundle, int]) -> int:
    """Mark the rays that a shape stops."""
    bundle, kind = arguments
    fan, rays, start, _, end_scale, _ = bundle
    if kind not in (SPHERE, PLANE):
        _hidden_rays(shape, verbs, number, (bundle, kind, open_rays(fan, rays)))
        return number
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
    view = view_from(apex, bundle.normal, margin, ratio * bundle.longest)
    few = FEW if magnitude(apex) < SINGLE_HUGE else FAN + 1
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
            unstopped &= ~_stop_by_leaf(bundle, world, group, node, rays, stack)
        elif count_bits(rays) < few:
            while rays != NONE:
                ray = lowest_bit(rays)
                rays &= rays - ONE
                segment = fan_segment(fan, ray, start, bundle.end_scale)
                beam = ray_beam(apex, load_direction(fan, ray), margin)
                length = fan[LENGTH + ray] * ratio
                if is_occluded_below(world, group, node, segment, beam, length, stack, waiting):
                    fan[BLOCKED + ray] = 1.0
                    unstopped &= ~(ONE << np.uint64(ray))
        else:
            waiting = push_near(bundle, world.bvh, node, view, rays, stack, waiting)


@device
def push_near(
    bundle: Bundle,
    bvh: Bvh,
    node: int,
    view: View,
    rays: np.uint64,
    stack: Stack,
    base: int,
) -> int:
    """Push the children of a node that some of its rays may meet; return the stack's new height."""
    top, balls = base, stack.balls
    nearest = np.float32(np.inf)
    seen = balls_seen(bvh, node * SIDES, view, balls)
    while seen != 0:
        k = lowest_bit(seen)
        seen &= seen - 1
        way = balls[k], balls[WIDTH + k], balls[2 * WIDTH + k]
        near = rays & rays_along(bundle.fan, bundle.rays, way, balls[3 * WIDTH + k])
        if near != NONE:
            child = bvh.child[node * WIDTH + k]
            away = way[0] * way[0] + way[1] * way[1] + way[2] * way[2]
            # The nearest is visited first: what it stops need not look at the others.
            if away < nearest or top == base:
                stack.node[top], stack.rays[top] = child, near
                nearest = away
            else:
                stack.node[top], stack.rays[top] = stack.node[top - 1], stack.rays[top - 1]
                stack.node[top - 1], stack.rays[top - 1] = child, near
            top += 1
    return top


@device
def _stop_by_leaf(
    bundle: Bundle,
    world: World,
    group: Group,
    leaf: int,
    rays: np.uint64,
    stack: Stack,
) -> np.uint64:
    """Mark those of some rays that shapes of a leaf stop, and return them."""
    balls, count, stopped = stack.balls, 0, NONE
    begin, end = leaf_range(leaf)
    is_worth_it = count_bits(rays) > FEW_IN_LEAF
    for slot in range(begin, end):
        stack.slot[count] = slot
        arguments = bundle, group.kind, group.to_boxes.ratio, balls, count
        count += with_bounded(world, group, slot, see_ball, arguments) if is_worth_it else 1
    for k in range(count):
        near = rays & ~stopped
        if is_worth_it:
            way = balls[k], balls[WIDTH + k], balls[2 * WIDTH + k]
            near &= rays_along(bundle.fan, bundle.rays, way, balls[3 * WIDTH + k])
        if near != NONE:
            stopped |= with_bounded(
                world, group, stack.slot[k], _hidden_rays, (bundle, group.kind, near)
            )
    return stopped


@device
def see_ball(
    shape: Shape,
    verbs: Verbs,  # noqa: ARG001
    number: int,  # noqa: ARG001
    arguments: tuple[Bundle, int, float, NDArray[np.float32], int],
) -> int:
    """Set the ball around a shape; return 1 if any of it is above the horizon, else 0."""
    bundle, kind, ratio, balls, k = arguments
    start = bundle.start
    way = scale(ratio, sub(shape.center, start.point))
    radius, error_scale = ratio * shape.radius, ratio * (shape.error_scale + start.error_scale)
    margin, bound = MARGIN * error_scale, ROUNDING * error_scale
    distance2, wide = dot(way, way), radius + margin
    # A ball around another shape says nothing of where rays start.
    starts_on = distance2 - radius * radius >= -bound * (2.0 * radius + bound)
    starts_inside = (kind != SPHERE) | (not starts_on)
    set_ball(balls, k, way, distance2 - wide * wide, margin, starts_inside)
    return 1 if dot(way, bundle.normal) + radius >= -margin else 0


@device
def _hidden_rays(
    shape: Shape,
    verbs: Verbs,
    number: int,  # noqa: ARG001
    arguments: tuple[Bundle, int, np.uint64],
) -> np.uint64:
    """Mark those of some rays that a shape stops, and return them."""
    bundle, kind, rays = arguments
    fan, start, hidden = bundle.fan, bundle.start, NONE
    # Spheres are asked by their balls; for others, asking takes as long as four of the rays.
    if kind not in (SPHERE, PLANE):
        rays &= rays_between(fan, bundle.rays, verbs.sides(shape, start.point, start.error_scale))
    while rays != NONE:
        ray = lowest_bit(rays)
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
