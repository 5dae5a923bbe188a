"""Which rays of a fan something stops on their way to a light.

All rays go through a hierarchy together: for each box that waits there is the set of those that may
meet it. Where these are few, each goes on alone. Shapes that have no hierarchy are asked about all
rays. What is found is what a loop over all rays and all shapes would find.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, long_part
from vtray.geometry.between import is_occluded_below, is_occluded_by_placed
from vtray.geometry.bits import count_bits, lowest_bit
from vtray.geometry.bvh.tree import SIDES, WIDTH, Bvh, leaf_range
from vtray.geometry.dispatch import with_any, with_bounded
from vtray.geometry.packets.beam import ray_beam, shape_margin
from vtray.geometry.packets.cone import Touching
from vtray.geometry.packets.fan import (
    BLOCKED,
    END_SCALE,
    FAN,
    LENGTH,
    START_SCALE,
    Fan,
    Spot,
    fan_segment,
    load_direction,
    load_origin,
    load_start,
    segment_from,
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
from vtray.geometry.ray import Segment
from vtray.geometry.rounding import MARGIN, ROUNDING
from vtray.geometry.shapes.axis_line import ON_SIDE
from vtray.geometry.shapes.plane import plane_side
from vtray.geometry.shapes.room import room_wall
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec, dot, magnitude, scale, sub
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
    to_box_space,
)

FEW = 8
"""Fewer rays than these search below a node alone."""

FEW_IN_LEAF = 2
"""Up to so many rays are asked about all shapes of a leaf, and not about their balls first."""

SMALL = 1.0
"""From a box on that is smaller than so many times what they start apart, rays go on alone. They
would all have to look at whatever is near any of them: 30 times as long, in a lattice of a million
spheres that are far smaller than a pixel.
"""

ALL_SLACK = 1.0
"""By so much, for each unit of length, any ray may lead out of a half-space."""


class Bundle(NamedTuple):
    """The rays of a fan.

    Attributes
    ----------
    fan, rays
        The fan, and how many there are.
    shift
        Each ``2**shift`` of them are a group, which starts together.
    spot
        Where they start.
    longest
        No ray is longer.
    """

    fan: Fan
    rays: int
    shift: int
    spot: Spot
    longest: float


@long_part
def stop_rays(bundle: Bundle, world: World, touching: Touching, count: int, stack: Stack) -> None:
    """Mark in field ``BLOCKED`` the rays that something stops.

    Parameters
    ----------
    bundle
        The rays. Those marked already stay so.
    world
        What they can meet.
    touching, count
        The only shapes that can stop any, so many; all may, where that is below 0.
    stack
        Scratch memory.
    """
    narrow_directions(bundle.fan, bundle.rays)
    if count < 0:
        _stop_by_all(bundle, world, stack)
    for k in range(count):
        group = load_group(world, touching.row[k])
        with_any(world, group, touching.slot[k], _stop_by_shape, (bundle, group.kind))


@device
def _stop_by_all(bundle: Bundle, world: World, stack: Stack) -> None:
    """Mark the rays that anything stops, but for those that are marked already."""
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.kind >= CUT and _leads_out(world, world.solids.clip, group, bundle):
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
        if clip.is_capped[group.row % clip.room.shape[0]]:
            start, room = bundle.spot.start, room_of(world, clip, group)
            wall = room_wall(room, start.point)
            bound = ROUNDING * (wall.error_scale + start.error_scale)
            is_on = plane_side(wall, start.point) >= -ON_SIDE * bound
            normal, out = bundle.spot.normal, wall.normal
            is_on = is_on & (bundle.spot.extent == 0.0)
            return is_on & (normal[0] == out[0]) & (normal[1] == out[1]) & (normal[2] == out[2])
    return False


@device
def _stop_by_shape(shape: Shape, verbs: Verbs, number: int, arguments: tuple[Bundle, int]) -> int:
    """Mark the rays that a shape stops."""
    bundle, kind = arguments
    fan, rays = bundle.fan, bundle.rays
    if kind not in (SPHERE, PLANE):
        slack = 0.0 if bundle.spot.extent == 0.0 else ALL_SLACK
        _hidden_rays(shape, verbs, number, (bundle, kind, open_rays(fan, rays), slack))
        return number
    # Loops over rays that start together are vectorised.
    together = 1 << bundle.shift
    for k in range(rays >> bundle.shift):
        start, end_scale, group = load_origin(fan, k), fan[END_SCALE + k], fan[k * together :]
        for ray in range(together):
            segment = segment_from(group, ray, start, end_scale)
            group[BLOCKED + ray] = 1.0 if verbs.hides(shape, segment) else group[BLOCKED + ray]
    return number


@device
def _stop_by_tree(bundle: Bundle, world: World, group: Group, stack: Stack) -> None:
    """Mark the rays that shapes of a group with a hierarchy stop."""
    fan, start, ratio = bundle.fan, bundle.spot.start, group.to_boxes.ratio
    apex = to_box_space(group.to_boxes, start.point)
    margin = shape_margin(group.to_boxes, apex, start.error_scale)
    # Where they start apart, they may be farther away.
    margin += 4.0 * MARGIN * ratio * bundle.spot.extent
    view = view_from(apex, bundle.spot, ratio, margin, bundle.longest)
    few = FEW if magnitude(apex) < SINGLE_HUGE else FAN + 1
    small = np.float32(SMALL * ratio * bundle.spot.extent)
    unstopped = open_rays(fan, bundle.rays)
    stack.node[0], stack.rays[0], stack.enter[0] = group.root, unstopped, np.inf
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = stack.node[waiting]
        rays = stack.rays[waiting] & unstopped
        if rays == NONE:
            continue
        is_small = stack.enter[waiting] < small
        if node < 0 and not is_small:
            unstopped &= ~_stop_by_leaf(bundle, world, group, node, rays, stack)
        elif count_bits(rays) < few or is_small:
            while rays != NONE:
                ray = lowest_bit(rays)
                rays &= rays - ONE
                segment = way_of(bundle, ray)
                own = to_box_space(group.to_boxes, load_start(fan, ray >> bundle.shift))
                beam = ray_beam(own, load_direction(fan, ray), margin)
                length = fan[LENGTH + ray] * ratio
                if is_occluded_below(world, group, node, segment, beam, length, stack, waiting):
                    fan[BLOCKED + ray] = 1.0
                    unstopped &= ~(ONE << np.uint64(ray))
        else:
            waiting = push_near(bundle, world.bvh, node, view, rays, stack, waiting)


@device
def way_of(bundle: Bundle, ray: int) -> Segment:
    """Return the way of a ray."""
    return fan_segment(bundle.fan, ray, ray >> bundle.shift)


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
    top, balls, nodes, sizes, near_rays = base, stack.balls, stack.node, stack.enter, stack.rays
    nearest = np.float32(np.inf)
    seen = balls_seen(bvh, node * SIDES, view, balls)
    while seen != 0:
        k = lowest_bit(seen)
        seen &= seen - 1
        way = balls[k], balls[WIDTH + k], balls[2 * WIDTH + k]
        near = rays & rays_along(bundle.fan, bundle.rays, way, balls[3 * WIDTH + k])
        if near != NONE:
            child, size = bvh.child[node * WIDTH + k], _size_of(bvh, node, k, bundle.spot.extent)
            away = way[0] * way[0] + way[1] * way[1] + way[2] * way[2]
            # The nearest is visited first: what it stops need not look at the others.
            if away < nearest or top == base:
                nodes[top], near_rays[top], sizes[top] = child, near, size
                nearest = away
            else:
                last = top - 1
                nodes[top], near_rays[top], sizes[top] = nodes[last], near_rays[last], sizes[last]
                nodes[last], near_rays[last], sizes[last] = child, near, size
            top += 1
    return top


@device
def _size_of(bvh: Bvh, node: int, k: int, extent: float) -> np.float32:
    """Return the longest side of the box of a child, infinite where that is not asked."""
    size = np.float32(np.inf)
    if extent > 0.0:
        first, high = node * SIDES + k, 3 * WIDTH
        size = np.float32(0.0)
        for side in range(first, first + high, WIDTH):
            size = max(size, bvh.sides[side + high] - bvh.sides[side])
    return size


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
        of_ball = bundle, group.kind, group.to_boxes.ratio, balls, count
        count += with_bounded(world.solids, group, slot, see_ball, of_ball) if is_worth_it else 1
    for k in range(count):
        near = rays & ~stopped
        if is_worth_it:
            way = balls[k], balls[WIDTH + k], balls[2 * WIDTH + k]
            near &= rays_along(bundle.fan, bundle.rays, way, balls[3 * WIDTH + k])
        if near != NONE:
            slot, slack = stack.slot[k], 0.0
            if group.kind != SPHERE and bundle.spot.extent > 0.0:
                slack = with_bounded(world.solids, group, slot, _slack_towards, bundle.spot)
            arguments = bundle, group.kind, near, slack
            stopped |= with_bounded(world.solids, group, slot, _hidden_rays, arguments)
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
    spot = bundle.spot
    way = scale(ratio, sub(shape.center, spot.start.point))
    radius, error_scale = ratio * shape.radius, ratio * (shape.error_scale + spot.start.error_scale)
    margin = MARGIN * error_scale
    apart = margin + ratio * spot.extent
    distance2, wide = dot(way, way), radius + apart
    tangent2 = distance2 - wide * wide
    # A ball around another shape says nothing of where rays start.
    starts_inside = tangent2 <= 0.0 and (kind != SPHERE or _may_start_inside(bundle, shape))
    set_ball(balls, k, way, tangent2, apart, starts_inside)
    lowest = margin + ratio * spot.sunk + spot.tilt * (magnitude(way) + radius)
    return 1 if dot(way, spot.normal) + radius >= -lowest else 0


@device
def _may_start_inside(bundle: Bundle, sphere: Shape) -> bool:
    """Tell whether any ray starts inside a sphere, and not only on it."""
    fan, spot, inside = bundle.fan, bundle.spot, False
    if spot.extent == 0.0:
        return _is_inside(sphere, spot.start.point, spot.start.error_scale)
    for k in range(bundle.rays >> bundle.shift):
        inside |= _is_inside(sphere, load_start(fan, k), fan[START_SCALE + k])
    return inside


@device
def _is_inside(sphere: Shape, point: Vec, error_scale: float) -> bool:
    """Tell whether a point is inside a sphere, clear of rounding."""
    way, bound = sub(sphere.center, point), ROUNDING * (sphere.error_scale + error_scale)
    radius = sphere.radius
    is_inside: bool = dot(way, way) - radius * radius < -bound * (2.0 * radius + bound)
    return is_inside


@device
def _hidden_rays(
    shape: Shape,
    verbs: Verbs,
    number: int,  # noqa: ARG001
    arguments: tuple[Bundle, int, np.uint64, float],
) -> np.uint64:
    """Mark those of some rays that a shape stops, and return them."""
    bundle, kind, rays, slack = arguments
    fan, start, hidden = bundle.fan, bundle.spot.start, NONE
    # Spheres are asked by their balls; for others, asking takes as long as four of the rays.
    if kind not in (SPHERE, PLANE) and slack < ALL_SLACK:
        sides = verbs.sides(shape, start.point, start.error_scale)
        rays &= rays_between(fan, bundle.rays, sides, slack)
    while rays != NONE:
        ray = lowest_bit(rays)
        rays &= rays - ONE
        if verbs.hides(shape, way_of(bundle, ray)):
            fan[BLOCKED + ray] = 1.0
            hidden |= ONE << np.uint64(ray)
    return hidden


@device
def _slack_towards(
    shape: Shape,
    verbs: Verbs,  # noqa: ARG001
    number: int,  # noqa: ARG001
    spot: Spot,
) -> float:
    """Return how far a ray from a spot to a shape may lead out of its `Sides` from the middle.

    That is for each unit of length; ``ALL_SLACK`` if the spot is in the ball around the shape.
    """
    way = sub(shape.center, spot.start.point)
    gap = math.sqrt(dot(way, way)) - shape.radius - 2.0 * spot.extent
    return spot.extent / gap if gap > spot.extent else ALL_SLACK


@device
def _stop_by_placed(bundle: Bundle, world: World, places: Places | None, stack: Stack) -> None:
    """Mark the rays that something that is placed stops."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        for ray in range(bundle.rays):
            if bundle.fan[BLOCKED + ray] == 0.0:
                segment = way_of(bundle, ray)
                hidden = is_occluded_by_placed(world, places, segment, stack)
                bundle.fan[BLOCKED + ray] = 1.0 if hidden else 0.0
