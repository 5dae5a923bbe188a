"""Whether the light of a lamp may have an edge within a patch of a surface.

Between a patch and a lamp rays cross: at a share s of the way they are as far apart as the patch is
wide times 1 - s, and the lamp is times s. What stands there throws a half-shadow on the patch, and
that is an edge where the patch is wide beside it.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from vtray.base.compiler.compiled import device, part
from vtray.geometry.bundle import Bundle
from vtray.geometry.dispatch import with_any
from vtray.geometry.packets.beam import lower_limit, upper_limit
from vtray.geometry.packets.cone import (
    ASIDE,
    PATIENCE,
    Cone,
    Touching,
    cone_in_boxes,
    push_touched,
    relation_to,
)
from vtray.geometry.packets.stack import Stack
from vtray.geometry.rounding import MARGIN
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec
from vtray.geometry.world import (
    Group,
    Hierarchy,
    Places,
    World,
    group_count,
    hierarchy_of,
    hierarchy_of_places,
    load_group,
    placed_row,
    range_of,
)

NOTHING, EDGE, ALL = 0, 1, 2
"""What is found to stand between: nothing that throws an edge, something that does, or what keeps
all light away."""

SHARP = 0.25
"""A half-shadow is an edge if it is narrower than the patch divided by this number. The mean of the
light on others differs from that in the middle by less than 6 of 255."""


class LampView(NamedTuple):
    """The rays between a patch and a lamp.

    Attributes
    ----------
    bundle
        The rays.
    within
        The same, where what they meet counts from beyond the surface on which they start.
    normal
        The normal of that surface.
    owner
        The number of what it belongs to.
    reach, radius, length
        How far the patch reaches, how large the lamp is, and how far away.
    all_in_front, in_front
        How far all and any of these rays are in front of the image plane.
    thickest
        The radius of the thickest solid, 0 if none is wide enough to hide the lamp from all of the
        patch.
    cone
        What holds them: what does not touch it does nothing.
    """

    bundle: Bundle
    within: Bundle
    normal: Vec
    owner: int
    reach: float
    radius: float
    length: float
    all_in_front: float
    in_front: float
    thickest: float
    cone: Cone


@part
def has_edge(world: World, view: LampView, touching: Touching, count: int, stack: Stack) -> bool:
    """Tell whether something throws an edge, and nothing keeps all light away.

    The answer is the same given the shapes and without: balls that throw an edge, or keep light
    away, begin no deeper than the boxes around them, and boxes are looked at up to that depth.

    Parameters
    ----------
    world, view
        What can stand between, and the rays.
    touching, count
        The only shapes that touch the cone of the rays, so many, none but spheres and planes; all
        may, where that is below 0.
    stack
        Scratch memory.
    """
    found = NOTHING
    if count >= 0:
        for k in range(count):
            group = load_group(world, touching.row[k])
            found = max(found, _found_at(world, group, touching.slot[k], view))
        return found == EDGE
    for row in range(group_count(world)):
        found = _find_in_group(world, load_group(world, row), view, found, stack, 0)
    return _find_in_placed(world, world.places, view, found, stack) == EDGE


@device
def _is_settled(view: LampView, found: int) -> bool:
    """Tell whether nothing that is found later changes the answer."""
    return found == ALL or (found == EDGE and view.thickest == 0.0)


@device
def _find_in_group(
    world: World, group: Group, view: LampView, found: int, stack: Stack, base: int
) -> int:
    hierarchy = hierarchy_of(group)
    return _find_in_shapes(world, hierarchy, view, found, stack, base, _find_in_slots, group)


@device
def _find_in_placed(
    world: World, places: Places | None, view: LampView, found: int, stack: Stack
) -> int:
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        hierarchy = hierarchy_of_places(places)
        return _find_in_places(world, hierarchy, view, found, stack, 0, _find_at_places, places)
    return found


@device
def _find_at_places(
    world: World,
    places: Places,
    begin: int,
    end: int,
    view: LampView,
    found: int,
    stack: Stack,
    base: int,
) -> int:
    for at in range(begin, end):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            found = _find_in_group(world, group, view, found, stack, base)
    return found


@device
def _find_in_slots(
    world: World,
    group: Group,
    begin: int,
    end: int,
    view: LampView,
    found: int,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> int:
    for slot in range(begin, end):
        found = max(found, _found_at(world, group, slot, view))
    return found


@device
def _found_at(world: World, group: Group, slot: int, view: LampView) -> int:
    """Return what the shape of a slot does to the light of the lamp."""
    if relation_to(view.cone, world, group, slot) == ASIDE:
        return NOTHING
    found: int = with_any(world, group, slot, _found_of, view)
    return found


@device
def _found_of(shape: Shape, verbs: Verbs, number: int, view: LampView) -> int:
    """Return what a shape does to the light of the lamp."""
    is_own = number == view.owner
    if is_own and verbs.is_outside(shape, view.bundle.origin, view.normal):
        return NOTHING
    near, far = verbs.crossing(shape, view.within if is_own else view.bundle)
    if far < view.all_in_front and view.thickest > 0.0:
        return ALL
    apart, around = view.reach * (view.length - near), view.radius * near
    return EDGE if near < view.in_front and apart > SHARP * around else NOTHING


def _find_in_tree(
    world: World,
    hierarchy: Hierarchy,
    view: LampView,
    found: int,
    stack: Stack,
    base: int,
    find_in: Callable[[World, Any, int, int, LampView, int, Stack, int], int],
    subject: Any,  # noqa: ANN401
) -> int:
    """Return the most of what is found in the leaves of a hierarchy that the rays may meet.

    After `PATIENCE` leaves, something in it counts as an edge.
    """
    seen = cone_in_boxes(view.cone, hierarchy.to_boxes)
    ratio = hierarchy.to_boxes.ratio
    near = lower_limit(seen.beam, 0.0)
    far = upper_limit(seen.beam, view.cone.longest * ratio * (1.0 + MARGIN))
    hides = _end_of_hiding(view) * ratio * (1.0 + MARGIN)
    counts = max(hides, _end_of_edges(view) * ratio * (1.0 + MARGIN))
    stack.node[base] = hierarchy.root
    waiting, leaves = base + 1, 0
    while waiting > base and not _is_settled(view, found):
        waiting -= 1
        child = stack.node[waiting]
        deepest = counts if found == NOTHING else hides
        if child >= 0:
            waiting = push_touched(world.bvh, child, seen, near, far, deepest, stack, waiting)
        elif leaves == PATIENCE:
            return EDGE
        else:
            leaves += 1
            begin, end = range_of(hierarchy, child)
            found = max(found, find_in(world, subject, begin, end, view, found, stack, waiting))
    return found


@device
def _end_of_edges(view: LampView) -> float:
    """Return the distance from the patch from which on all half-shadows are wide."""
    return view.length * view.reach / (view.reach + SHARP * view.radius)


@device
def _end_of_hiding(view: LampView) -> float:
    """Return the distance from the patch from which on nothing is as wide as the rays.

    Twice the radius: what is slanted to the rays begins before they are as wide.
    """
    room = 2.0 * view.thickest - view.reach
    if room <= 0.0:
        return 0.0
    growth = view.radius - view.reach
    return view.length if growth <= room else view.length * room / growth


_find_in_places, _find_in_shapes = device(_find_in_tree), device(_find_in_tree)
"""Two ways: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""
