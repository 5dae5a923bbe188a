"""The chords of rays near each other: all go through a hierarchy as one beam.

Nothing ends a ray: each goes through all that it meets. A shape is asked about all rays at once
whether they pass by it, and then, one by one, about those that do not.
"""

from typing import NamedTuple

import numpy as np

from vtray.base.compiler.compiled import device, part
from vtray.geometry.bits import lowest_bit
from vtray.geometry.dispatch import with_any, with_bounded
from vtray.geometry.faded.chords import End, chord_of
from vtray.geometry.faded.nearby import Tube, touches_ball
from vtray.geometry.packets.fan_rays import NONE, ONE
from vtray.geometry.packets.from_light import FOR_EVER, Box, search_from_light
from vtray.geometry.packets.layer_notes import ROOM, SIDE_BY_SIDE, SideBySide
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.packets.packet import OCTET, join_met
from vtray.geometry.packets.stack import Stack
from vtray.geometry.ray import Ray
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec
from vtray.geometry.world import (
    NO_TREE,
    Faded,
    Group,
    Places,
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


class Band(NamedTuple):
    """Rays that go side by side to a light.

    Attributes
    ----------
    end
        How many there are.
    box
        A box of points, relative to the light, on the ways to which all of them go.
    target
        The light.
    tube
        A tube around all of them.
    beside
        The rays, and their chords.
    """

    end: int
    box: Box
    target: Target
    tube: Tube
    beside: SideBySide


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
def collect_side_by_side(world: World, faded: Faded, band: Band, stack: Stack) -> None:
    """Collect the chords of rays, in no order.

    Parameters
    ----------
    world, faded
        The shapes.
    band
        The rays. Out: their chords.
    stack
        Scratch memory.
    """
    for row in range(faded.begin, faded.end):
        _collect_in_group(band, world, load_group(world, row), stack, 0)
    _collect_placed(band, world, world.places, faded, stack)


@device
def _collect_in_group(band: Band, world: World, group: Group, stack: Stack, base: int) -> None:
    hierarchy = hierarchy_of(group)
    _search_shapes(0, band, world, hierarchy, stack, base, FOR_EVER, _visit_slots, group)


@device
def _collect_placed(
    band: Band, world: World, places: Places | None, faded: Faded, stack: Stack
) -> None:
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        _search_places(0, band, world, faded.places, stack, 0, FOR_EVER, _visit_places, places)


@device
def _visit_places(
    begin: int,
    band: Band,
    world: World,
    places: Places,
    first: int,
    after: int,
    stack: Stack,
    base: int,
) -> int:
    """Collect those of the groups of a range of places; all rays go on."""
    for at in range(first, after):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            _collect_in_group(band, world, group, stack, base)
    return begin


@device
def _visit_slots(
    begin: int,
    band: Band,
    world: World,
    group: Group,
    first: int,
    after: int,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> int:
    """Collect those of a range of slots; all rays go on."""
    for slot in range(first, after):
        met = join_met(group.row, slot)
        if group.root == NO_TREE:
            with_any(world, group, slot, _collect, (band, met))
        elif with_bounded(world.solids, group, slot, touches_ball, band.tube):
            with_bounded(world.solids, group, slot, _collect, (band, met))
    return begin


_search_places, _search_shapes = device(search_from_light), device(search_from_light)
"""Two searches: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def _collect(shape: Shape, verbs: Verbs, number: int, arguments: tuple[Band, int]) -> int:
    """Collect the chords of a shape."""
    band, met = arguments
    beside, chords = band.beside, band.beside.chords
    near = _rays_near(shape, verbs, band.end, beside)
    while near != NONE:
        k = lowest_bit(near)
        near &= near - ONE
        end = End(beside.rays[LENGTH + k], -1, band.target.error_scale)
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
