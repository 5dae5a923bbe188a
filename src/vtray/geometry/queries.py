"""What one ray meets first: one ray at a time, from anywhere.

What is found is what a loop over all shapes would find; the hierarchies only leave out.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

from vtray.base.compiler.compiled import device
from vtray.geometry.dispatch import with_any
from vtray.geometry.packets.beam import Beam, lower_limit, ray_beam, shape_margin, upper_limit
from vtray.geometry.packets.stack import Stack, push_met
from vtray.geometry.ray import Ray, ray_point
from vtray.geometry.rounding import MARGIN
from vtray.geometry.shapes.verbs import Shape, Verbs
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
    to_box_space,
)

NOTHING = -1
"""In place of a primitive: nothing is hit, nothing stands between."""


class Hit(NamedTuple):
    """What a ray meets first.

    Attributes
    ----------
    distance
        Along the ray, infinite for nothing.
    power_at
        That of the point, as in `Verbs`.
    primitive
        Its number, or ``NOTHING``.
    group, slot
        The row of its group, and its slot in the columns of its kind.
    """

    distance: float
    power_at: float
    primitive: int
    group: int
    slot: int


Found = TypeVar("Found", bound=Any)
"""A hit, or what else has a distance."""


@device
def nearest_hit(world: World, ray: Ray, stack: Stack) -> Hit:
    """Return what a ray meets first."""
    hit = Hit(math.inf, 0.0, NOTHING, 0, 0)
    for row in range(group_count(world)):
        hit = _nearest_of_group(world, load_group(world, row), ray, hit, stack, 0)
    return _nearest_placed(world, world.places, ray, hit, stack)


@device
def nearer_of(world: World, ray: Ray, hit: Hit, row: int, slot: int) -> Hit:
    """Return the nearer of a hit and that of one shape, in a slot of the group in a row."""
    found: Hit = with_any(world, load_group(world, row), slot, _nearer, (ray, hit, row, slot))
    return found


@device
def _nearest_of_group(
    world: World, group: Group, ray: Ray, hit: Hit, stack: Stack, base: int
) -> Hit:
    """Return the nearer of a hit and those of the shapes of a group."""
    hierarchy = hierarchy_of(group)
    return _nearest_in_shapes(world, hierarchy, ray, hit, stack, base, _nearest_slots, group)


@device
def _nearest_placed(world: World, places: Places | None, ray: Ray, hit: Hit, stack: Stack) -> Hit:
    """Return the nearer of a hit and those of all that is placed."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        hierarchy = hierarchy_of_places(places)
        return _nearest_in_places(world, hierarchy, ray, hit, stack, 0, _nearest_places, places)
    return hit


@device
def _nearest_places(
    world: World,
    places: Places,
    begin: int,
    end: int,
    ray: Ray,
    hit: Hit,
    stack: Stack,
    base: int,
) -> Hit:
    """Return the nearer of a hit and those of the groups of a range of places."""
    for at in range(begin, end):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            hit = _nearest_of_group(world, group, ray, hit, stack, base)
    return hit


@device
def _nearest_slots(
    world: World,
    group: Group,
    begin: int,
    end: int,
    ray: Ray,
    hit: Hit,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> Hit:
    """Return the nearer of a hit and those of the shapes of a range of slots."""
    for slot in range(begin, end):
        hit = with_any(world, group, slot, _nearer, (ray, hit, group.row, slot))
    return hit


@device
def _nearer(shape: Shape, verbs: Verbs, number: int, arguments: tuple[Ray, Hit, int, int]) -> Hit:
    """Return the nearer of a hit and that of a shape."""
    ray, hit, row, slot = arguments
    if verbs.is_aside(shape, ray):
        return hit
    distance = verbs.distance_to(shape, ray)
    if distance > hit.distance:
        return hit
    power = verbs.power_at(shape, ray_point(ray, distance))
    is_first = power < hit.power_at or (power == hit.power_at and number < hit.primitive)
    if distance < hit.distance or (distance == hit.distance and is_first):
        return Hit(distance, power, number, row, slot)
    return hit


def nearest_in_tree(
    world: World,
    hierarchy: Hierarchy,
    ray: Ray,
    hit: Found,
    stack: Stack,
    base: int,
    nearest_of: Callable[[World, Any, int, int, Ray, Found, Stack, int], Found],
    subject: Any,  # noqa: ANN401
) -> Found:
    """Return the nearer of a hit and those in the leaves of a hierarchy.

    Parameters
    ----------
    world, hierarchy
        The hierarchy.
    ray, hit
        The ray, and what it meets so far, in boxes no farther away than its ``distance``.
    stack, base
        Scratch memory, and what waits there already, which stays.
    nearest_of, subject
        What is asked for each leaf, and what it is given, beside the range that the leaf names.
    """
    ratio = hierarchy.to_boxes.ratio
    beam = beam_of_ray(hierarchy.to_boxes, ray)
    start = lower_limit(beam, max(-ray.plane_depth, 0.0) * ratio * (1.0 - MARGIN))
    far = upper_limit(beam, hit.distance * ratio * (1.0 + MARGIN))
    stack.node[base] = hierarchy.root
    stack.enter[base] = start
    waiting = base + 1
    while waiting > base:
        waiting -= 1
        if stack.enter[waiting] > far:
            continue
        child = stack.node[waiting]
        if child >= 0:
            waiting = push_met(world.bvh, child, beam, start, far, stack, waiting)
        else:
            begin, end = range_of(hierarchy, child)
            hit = nearest_of(world, subject, begin, end, ray, hit, stack, waiting)
            far = upper_limit(beam, hit.distance * ratio * (1.0 + MARGIN))
    return hit


_nearest_in_places, _nearest_in_shapes = device(nearest_in_tree), device(nearest_in_tree)
"""Two ways: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def beam_of_ray(to_boxes: ToBoxes, ray: Ray) -> Beam:
    """Return a ray as a beam in the boxes' space."""
    start = to_box_space(to_boxes, ray.origin)
    margin = shape_margin(to_boxes, start, ray.error_scale)
    return ray_beam(start, ray.direction, margin)
