"""The parts of a ray within faded shapes, the nearest first."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.dispatch import with_any
from vtray.geometry.packets.beam import lower_limit, upper_limit
from vtray.geometry.packets.layer_notes import ALONE, MOST, Chords
from vtray.geometry.packets.packet import join_met
from vtray.geometry.packets.stack import Stack, push_met
from vtray.geometry.queries import beam_of_ray
from vtray.geometry.ray import Ray
from vtray.geometry.rounding import MARGIN, ROUNDING
from vtray.geometry.shapes.stay import Stay, no_stay
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.world import (
    Faded,
    Group,
    Hierarchy,
    Places,
    World,
    hierarchy_of,
    load_group,
    placed_row,
    range_of,
)


class End(NamedTuple):
    """Where a ray ends.

    Attributes
    ----------
    distance
        How far.
    number
        That of the primitive on which it ends, which decides between equal distances; -1 where it
        ends at a light.
    error_scale
        What the rounding error of its end is relative to, beside a shape on which that may be; 0
        where it ends on a primitive, or nowhere.
    """

    distance: float
    number: int
    error_scale: float


class Key(NamedTuple):
    """A place in the order of chords."""

    near: float
    number: int


@device
def collect_chords(
    world: World, faded: Faded, ray: Ray, end: End, after: Key, chords: Chords, stack: Stack
) -> int:
    """Collect the chords of a ray that come after a place in their order, the nearest of them.

    Parameters
    ----------
    world, faded
        The shapes.
    ray, end
        The ray. Where it starts on a surface, its error bound is above 0; which bound it is depends
        on the shape.
    after
        The place.
    chords
        Out: the chords.
    stack
        Scratch memory.

    Returns
    -------
    int
        How many there are; ``MOST`` if there may be more.
    """
    chords.found[ALONE] = 0
    for row in range(faded.begin, faded.end):
        _collect_in_group(world, load_group(world, row), ray, end, after, chords, stack, 0)
    _collect_placed(world, world.places, faded, ray, end, after, chords, stack)
    count: int = chords.found[ALONE]
    return count


@device
def _collect_in_group(
    world: World,
    group: Group,
    ray: Ray,
    end: End,
    after: Key,
    chords: Chords,
    stack: Stack,
    base: int,
) -> None:
    hierarchy = hierarchy_of(group)
    _collect_in_shapes(world, hierarchy, ray, end, after, chords, stack, base, _visit_slots, group)


@device
def _collect_placed(
    world: World,
    places: Places | None,
    faded: Faded,
    ray: Ray,
    end: End,
    after: Key,
    chords: Chords,
    stack: Stack,
) -> None:
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        hierarchy = faded.places
        _collect_in_places(
            world, hierarchy, ray, end, after, chords, stack, 0, _visit_places, places
        )


@device
def _visit_places(
    world: World,
    places: Places,
    begin: int,
    after_last: int,
    ray: Ray,
    end: End,
    after: Key,
    chords: Chords,
    stack: Stack,
    base: int,
) -> None:
    """Collect those of the groups of a range of places."""
    for at in range(begin, after_last):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            _collect_in_group(world, group, ray, end, after, chords, stack, base)


@device
def _visit_slots(
    world: World,
    group: Group,
    begin: int,
    after_last: int,
    ray: Ray,
    end: End,
    after: Key,
    chords: Chords,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> None:
    """Collect those of a range of slots."""
    for slot in range(begin, after_last):
        met = join_met(group.row, slot)
        with_any(world, group, slot, _collect, (ray, end, after, met, chords))


@device
def _collect(
    shape: Shape, verbs: Verbs, number: int, arguments: tuple[Ray, End, Key, int, Chords]
) -> int:
    """Put the chord of a shape in its place among the nearest, if the ray has one."""
    ray, end, after, met, chords = arguments
    if not verbs.is_aside(shape, ray):
        add_chord(shape, verbs, number, ray, end, after, met, chords, ALONE)
    return number


@device
def add_chord(
    shape: Shape,
    verbs: Verbs,
    number: int,
    ray: Ray,
    end: End,
    after: Key,
    met: int,
    chords: Chords,
    row: int,
) -> None:
    """Put the chord of a shape in its place in a list, if the ray has one.

    Parameters
    ----------
    shape, verbs, number, met
        The shape.
    ray, end, after
        As for `collect_chords`.
    chords, row
        The list.
    """
    near, far = chord_of(shape, verbs, number, ray, end)
    is_after = near > after.near or (near == after.near and number > after.number)
    if near <= far and is_after:
        _insert(chords, row, near, far, number, met)


@device
def chord_of(shape: Shape, verbs: Verbs, number: int, ray: Ray, end: End) -> Stay:
    """Return the chord of a shape up to the end of a ray; infinite to minus infinite for none."""
    near, far = verbs.stay(shape, _with_bound(ray, shape.error_scale))
    bound = ROUNDING * (shape.error_scale + end.error_scale) if end.error_scale > 0.0 else 0.0
    last = end.distance - bound
    is_before = near < last or (near == last and number < end.number)
    if near <= far and is_before:
        return Stay(near, far if far < last else math.inf)
    return no_stay()


@device
def _with_bound(ray: Ray, error_scale: float) -> Ray:
    """Return a ray with the bound of how far it may start from a surface of such an error."""
    bound = ROUNDING * (ray.error_scale + error_scale) if ray.error_bound > 0.0 else 0.0
    return Ray(ray.origin, ray.direction, ray.plane_depth, ray.forward, ray.error_scale, bound)


@device
def _insert(chords: Chords, row: int, near: float, far: float, number: int, met: int) -> None:
    """Put a chord in its place in a list; where there is no room, the last one goes."""
    begin, count = row * MOST, chords.found[row]
    if count == MOST:
        count -= 1
        if not _is_less(near, number, chords, begin + count):
            return
    put_in_place(chords, begin, begin + count, near, far, number, met)
    chords.found[row] = count + 1


@device
def put_in_place(
    chords: Chords, begin: int, end: int, near: float, far: float, number: int, met: int
) -> None:
    """Put a chord among sorted ones, from `begin` to before `end`; what comes after it moves on."""
    place = end
    while place > begin and _is_less(near, number, chords, place - 1):
        chords.near[place] = chords.near[place - 1]
        chords.far[place] = chords.far[place - 1]
        chords.number[place] = chords.number[place - 1]
        chords.met[place] = chords.met[place - 1]
        place -= 1
    chords.near[place] = near
    chords.far[place] = far
    chords.number[place] = number
    chords.met[place] = met


@device
def _is_less(near: float, number: int, chords: Chords, place: int) -> bool:
    """Tell whether a chord comes before that in a place."""
    other: float = chords.near[place]
    return near < other or (near == other and number < chords.number[place])


def _collect_in_tree(
    world: World,
    hierarchy: Hierarchy,
    ray: Ray,
    end: End,
    after: Key,
    chords: Chords,
    stack: Stack,
    base: int,
    visit: Callable[[World, Any, int, int, Ray, End, Key, Chords, Stack, int], None],
    subject: Any,  # noqa: ANN401
) -> None:
    """Visit the leaves of a hierarchy that a ray may meet, as far as more is looked for.

    Parameters
    ----------
    world, hierarchy
        The hierarchy.
    ray, end, after, chords
        As for `collect_chords`.
    stack, base
        Scratch memory, and what waits there already, which stays.
    visit, subject
        What is called for each leaf, and what it is given, beside the range that the leaf names.
    """
    ratio = hierarchy.to_boxes.ratio
    beam = beam_of_ray(hierarchy.to_boxes, ray)
    # Boxes that end before the place have only chords that come before it.
    begins = max(-ray.plane_depth, after.near, 0.0)
    start = lower_limit(beam, begins * ratio * (1.0 - MARGIN))
    stack.node[base] = hierarchy.root
    stack.enter[base] = start
    waiting = base + 1
    while waiting > base:
        waiting -= 1
        needed = (
            chords.near[ALONE * MOST + MOST - 1] if chords.found[ALONE] == MOST else end.distance
        )
        # Chords that begin before the start are there; what is farther than they comes later.
        far = upper_limit(beam, max(needed, 0.0) * ratio * (1.0 + MARGIN))
        if stack.enter[waiting] > far:
            continue
        child = stack.node[waiting]
        if child >= 0:
            waiting = push_met(world.bvh, child, beam, start, far, stack, waiting)
        else:
            begin, after_last = range_of(hierarchy, child)
            visit(world, subject, begin, after_last, ray, end, after, chords, stack, waiting)


_collect_in_places, _collect_in_shapes = device(_collect_in_tree), device(_collect_in_tree)
"""Two ways: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""
