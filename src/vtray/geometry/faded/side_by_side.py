"""The chords of rays near each other: all go through a hierarchy as one beam.

Nothing ends a ray: each goes through all that it meets. A shape is asked about all rays at once
whether they pass by it, and then, one by one, about those that do not.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from vtray.base.compiler.compiled import device, part
from vtray.geometry.bvh.boxes import fetch_node
from vtray.geometry.bvh.tree import WIDTH, leaf_range
from vtray.geometry.dispatch import with_any, with_bounded
from vtray.geometry.faded.chords import End, chord_of
from vtray.geometry.faded.nearby import Tube, touches_ball
from vtray.geometry.packets.beam import (
    Beam,
    children_met,
    lower_limit,
    make_beam,
    shape_margin,
    upper_limit,
)
from vtray.geometry.packets.fan_rays import NONE, ONE, first_bit
from vtray.geometry.packets.layer_notes import ROOM, SIDE_BY_SIDE, SideBySide
from vtray.geometry.packets.packet import OCTET, join_met
from vtray.geometry.packets.stack import Stack
from vtray.geometry.ray import Ray
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec, add, scale
from vtray.geometry.world import (
    NO_TREE,
    Faded,
    Group,
    Hierarchy,
    Places,
    ToBoxes,
    World,
    hierarchy_of,
    load_group,
    placed_row,
)

ORIGIN, DIRECTION = 0, 3 * SIDE_BY_SIDE
"""Where a ray starts, and its unit direction."""

PLANE_DEPTH, FORWARD, ERROR_SCALE, ERROR_BOUND = (k * SIDE_BY_SIDE for k in range(6, 10))
"""As in `Ray`."""

LENGTH = 10 * SIDE_BY_SIDE
"""How long it is."""

FULL = ROOM + 1
"""In place of how many chords a ray has that has more than there is room for."""


class Sweep(NamedTuple):
    """Where rays go, all of them: from a box of starts along a box of ways.

    Attributes
    ----------
    start_low, start_high
        The least and the greatest coordinates of where they start.
    low, high
        Those of their ways.
    near, far
        From how many of their ways on they count, and up to how many.
    end_scale, error_scale
        What the rounding errors of their ends, and of the rays, are relative to.
    """

    start_low: Vec
    start_high: Vec
    low: Vec
    high: Vec
    near: float
    far: float
    end_scale: float
    error_scale: float


@device
def set_ray(beside: SideBySide, k: int, ray: Ray, end: End) -> None:
    """Set one of the rays."""
    rays = beside.rays
    for axis in range(3):
        rays[ORIGIN + axis * SIDE_BY_SIDE + k] = ray.origin[axis]
        rays[DIRECTION + axis * SIDE_BY_SIDE + k] = ray.direction[axis]
    rays[PLANE_DEPTH + k] = ray.plane_depth
    rays[FORWARD + k] = ray.forward
    rays[ERROR_SCALE + k] = ray.error_scale
    rays[ERROR_BOUND + k] = ray.error_bound
    rays[LENGTH + k] = end.distance
    beside.chords.found[k] = 0


@device
def load_direction(beside: SideBySide, k: int) -> Vec:
    """Return the direction of one of the rays."""
    return _load(beside, DIRECTION, k)


@device
def _load_ray(beside: SideBySide, k: int) -> Ray:
    """Return one of the rays."""
    rays = beside.rays
    return Ray(
        _load(beside, ORIGIN, k),
        _load(beside, DIRECTION, k),
        rays[PLANE_DEPTH + k],
        rays[FORWARD + k],
        rays[ERROR_SCALE + k],
        rays[ERROR_BOUND + k],
    )


@device
def _load(beside: SideBySide, field: int, k: int) -> Vec:
    """Return a vector of one of the rays."""
    rays = beside.rays
    return (
        rays[field + k],
        rays[field + SIDE_BY_SIDE + k],
        rays[field + 2 * SIDE_BY_SIDE + k],
    )


@part
def collect_side_by_side(
    world: World,
    faded: Faded,
    sweep: Sweep,
    tube: Tube,
    rays: int,
    beside: SideBySide,
    stack: Stack,
) -> None:
    """Collect the chords of rays, in no order.

    Parameters
    ----------
    world, faded
        The shapes.
    sweep, tube
        Where the rays go, as a box of ways, and as a tube around all of them.
    rays
        How many there are.
    beside
        The rays. Out: their chords.
    stack
        Scratch memory.
    """
    for row in range(faded.begin, faded.end):
        _collect_in_group(world, load_group(world, row), sweep, tube, rays, beside, stack, 0)
    _collect_placed(world, world.places, faded, sweep, tube, rays, beside, stack)


@device
def _collect_in_group(
    world: World,
    group: Group,
    sweep: Sweep,
    tube: Tube,
    rays: int,
    beside: SideBySide,
    stack: Stack,
    base: int,
) -> None:
    _search_shapes(
        world, hierarchy_of(group), sweep, tube, rays, beside, stack, base, _visit_slots, group
    )


@device
def _collect_placed(
    world: World,
    places: Places | None,
    faded: Faded,
    sweep: Sweep,
    tube: Tube,
    rays: int,
    beside: SideBySide,
    stack: Stack,
) -> None:
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        _search_places(
            world, faded.places, sweep, tube, rays, beside, stack, 0, _visit_places, places
        )


@device
def _visit_places(
    world: World,
    places: Places,
    begin: int,
    after: int,
    sweep: Sweep,
    tube: Tube,
    rays: int,
    beside: SideBySide,
    stack: Stack,
    base: int,
) -> None:
    """Collect those of the groups of a range of places."""
    for at in range(begin, after):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            _collect_in_group(world, group, sweep, tube, rays, beside, stack, base)


@device
def _visit_slots(
    world: World,
    group: Group,
    begin: int,
    after: int,
    sweep: Sweep,
    tube: Tube,
    rays: int,
    beside: SideBySide,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> None:
    """Collect those of a range of slots."""
    for slot in range(begin, after):
        met = join_met(group.row, slot)
        arguments = sweep.end_scale, tube, rays, met, beside
        if group.root == NO_TREE:
            with_any(world, group, slot, _collect, arguments)
        elif with_bounded(world, group, slot, touches_ball, tube):
            with_bounded(world, group, slot, _collect, arguments)


@device
def _collect(
    shape: Shape, verbs: Verbs, number: int, arguments: tuple[float, Tube, int, int, SideBySide]
) -> int:
    """Collect the chords of a shape."""
    end_scale, _, rays, met, beside = arguments
    chords = beside.chords
    near = _rays_near(shape, verbs, rays, beside)
    while near != NONE:
        k = first_bit(near)
        near &= near - ONE
        end = End(beside.rays[LENGTH + k], -1, end_scale)
        stay = chord_of(shape, verbs, number, _load_ray(beside, k), end)
        if stay.near <= stay.far:
            count = chords.found[k]
            if count < ROOM:
                place = k * ROOM + count
                chords.near[place] = stay.near
                chords.far[place] = stay.far
                chords.number[place] = number
                chords.met[place] = met
            chords.found[k] = min(count + 1, FULL)
    return number


@device
def _rays_near(shape: Shape, verbs: Verbs, rays: int, beside: SideBySide) -> np.uint64:
    """Return the rays that do not pass by a shape: a bit for each."""
    found = NONE
    # Whole octets: what follows the last ray is left out at the end.
    for k in range((rays + OCTET - 1) // OCTET * OCTET):
        is_aside = verbs.is_aside(shape, _load_ray(beside, k))
        found |= (NONE if is_aside else ONE) << np.uint64(k)
    return found & ((ONE << np.uint64(rays)) - ONE)


def _search(
    world: World,
    hierarchy: Hierarchy,
    sweep: Sweep,
    tube: Tube,
    rays: int,
    beside: SideBySide,
    stack: Stack,
    base: int,
    visit: Callable[[World, Any, int, int, Sweep, Tube, int, SideBySide, Stack, int], None],
    subject: Any,  # noqa: ANN401
) -> None:
    """Visit the leaves of a hierarchy that rays may meet.

    Parameters
    ----------
    world, hierarchy
        The hierarchy.
    sweep, tube, rays, beside
        The rays.
    stack, base
        Scratch memory, and what waits there already, which stays.
    visit, subject
        What is called for each leaf, and what it is given, beside the range that the leaf names.
    """
    if hierarchy.root == NO_TREE:
        visit(
            world, subject, hierarchy.begin, hierarchy.end, sweep, tube, rays, beside, stack, base
        )
        return
    bvh, nodes = world.bvh, stack.node
    beam = _beam_of(sweep, hierarchy.to_boxes)
    near, far = lower_limit(beam, sweep.near), upper_limit(beam, sweep.far)
    nodes[base] = hierarchy.root
    waiting = base + 1
    while waiting > base:
        waiting -= 1
        node = nodes[waiting]
        met = children_met(bvh, node, beam, near, far, stack.entered)
        place = node * WIDTH
        while met > 0:
            if met & 1:
                child = bvh.child[place]
                if child >= 0:
                    fetch_node(bvh, child)
                    nodes[waiting] = child
                    waiting += 1
                else:
                    begin, after = leaf_range(child)
                    visit(world, subject, begin, after, sweep, tube, rays, beside, stack, waiting)
            met >>= 1
            place += 1


_search_places, _search_shapes = device(_search), device(_search)
"""Two searches: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def _beam_of(sweep: Sweep, to_boxes: ToBoxes) -> Beam:
    """Return the beam of all rays, in the boxes' space."""
    ratio, offset = to_boxes.ratio, to_boxes.offset
    start = add(scale(ratio, sweep.start_low), offset)
    end = add(scale(ratio, sweep.start_high), offset)
    margin = shape_margin(to_boxes, start, sweep.error_scale)
    return make_beam(start, end, scale(ratio, sweep.low), scale(ratio, sweep.high), margin)
