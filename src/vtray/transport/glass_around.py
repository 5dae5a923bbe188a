"""Which glass a ray of the camera starts in, and how much light is left on its way out of that.

Where glass is in glass, it is the one that the ray leaves first. Nothing exists behind the image
plane, so glass counts from there on.
"""

import math
from typing import Any, NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.dispatch import with_any
from vtray.geometry.packets.stack import Stack
from vtray.geometry.queries import NOTHING, nearest_in_tree
from vtray.geometry.ray import Ray, ray_point
from vtray.geometry.shapes.stay import Stay, no_stay
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec, dot
from vtray.geometry.world import (
    CUT,
    PLANE,
    Places,
    World,
    group_count,
    hierarchy_of,
    hierarchy_of_places,
    load_group,
    placed_row,
)
from vtray.transport.materials.absorption import transmitted
from vtray.transport.materials.look import EMPTY, GLASS, Looks, is_thin, three_numbers
from vtray.transport.materials.material import Materials, load_look

WHOLE = (1.0, 1.0, 1.0)


class Around(NamedTuple):
    """The glass around the start of a ray.

    Attributes
    ----------
    distance
        Where the ray starts to count: in front of the image plane.
    far
        Where it leaves the glass.
    primitive
        The number of what that is, or ``NOTHING``.
    row
        The row of its material, or ``EMPTY``.
    """

    distance: float
    far: float
    primitive: int
    row: int


class _Asked(NamedTuple):
    """A group or the places of groups, and what their shapes are made of."""

    shapes: Any  # a `Group`, or `Places`
    materials: Materials
    looks: Looks


@device
def leave_glass(
    world: World, materials: Materials, looks: Looks, ray: Ray, distance: float, stack: Stack
) -> tuple[int, Vec]:
    """Return the row of the glass that a ray of the camera starts in, and what that leaves.

    Parameters
    ----------
    world, materials, looks
        The scene.
    ray, distance
        The ray, and how far it goes.
    stack
        Scratch memory.

    Returns
    -------
    row, share
        ``EMPTY`` for none, and the shares of red, green and blue light.
    """
    return _leave_any(world, materials, looks, looks.absorbs, ray, distance, stack)


@device
def _leave_any(
    world: World,
    materials: Materials,
    looks: Looks,
    absorbs: bool | None,
    ray: Ray,
    distance: float,
    stack: Stack,
) -> tuple[int, Vec]:
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if absorbs is not None:
        around = glass_around(world, materials, looks, ray, stack)
        if around.row != EMPTY:
            within = max(distance - around.distance, 0.0)
            return around.row, transmitted(three_numbers(looks, around.row, 1), within)
    return EMPTY, WHOLE


@device
def glass_around(
    world: World, materials: Materials, looks: Looks, ray: Ray, stack: Stack
) -> Around:
    """Return the glass that a ray of the camera starts in."""
    start = -ray.plane_depth / ray.forward if ray.plane_depth < 0.0 else 0.0
    around = Around(start, math.inf, NOTHING, EMPTY)
    for row in range(group_count(world)):
        asked = _Asked(load_group(world, row), materials, looks)
        around = _around_in_group(world, asked, ray, around, stack, 0)
    return _around_placed(world, world.places, materials, looks, ray, around, stack)


@device
def _around_placed(
    world: World,
    places: Places | None,
    materials: Materials,
    looks: Looks,
    ray: Ray,
    around: Around,
    stack: Stack,
) -> Around:
    """Return the glass that is left first: what is known, or some of what is placed."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        hierarchy, asked = hierarchy_of_places(places), _Asked(places, materials, looks)
        return _around_in_places(world, hierarchy, ray, around, stack, 0, _around_places, asked)
    return around


@device
def _around_places(
    world: World,
    asked: _Asked,
    begin: int,
    end: int,
    ray: Ray,
    around: Around,
    stack: Stack,
    base: int,
) -> Around:
    """Return the glass that is left first: what is known, or some of a range of places."""
    places = asked.shapes
    for at in range(begin, end):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            of_group = _Asked(group, asked.materials, asked.looks)
            around = _around_in_group(world, of_group, ray, around, stack, base)
    return around


@device
def _around_in_group(
    world: World, asked: _Asked, ray: Ray, around: Around, stack: Stack, base: int
) -> Around:
    """Return the glass that is left first: what is known, or a shape of a group."""
    hierarchy = hierarchy_of(asked.shapes)
    return _around_in_shapes(world, hierarchy, ray, around, stack, base, _around_slots, asked)


@device
def _around_slots(
    world: World,
    asked: _Asked,
    begin: int,
    end: int,
    ray: Ray,
    around: Around,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> Around:
    """Return the glass that is left first: what is known, or some of a range of slots."""
    group = asked.shapes
    for slot in range(begin, end):
        given = ray, around, group.kind, asked.materials, asked.looks
        around = with_any(world, group, slot, _left_first, given)
    return around


@device
def _left_first(
    shape: Shape,
    verbs: Verbs,
    number: int,
    arguments: tuple[Ray, Around, int, Materials, Looks],
) -> Around:
    """Return the glass that is left first: what is known, or a shape."""
    ray, around, kind, materials, looks = arguments
    look = load_look(materials, looks, number)
    if look.kind != GLASS or is_thin(looks, look):
        return around
    is_plane = kind in (PLANE, CUT + PLANE)
    stay = _stay_behind(shape, verbs, ray, kind) if is_plane else verbs.stay(shape, ray)
    if stay.near > -math.inf or stay.far == -math.inf:
        return around
    is_first = around.row == EMPTY or stay.far < around.far
    if is_first or (stay.far == around.far and number < around.primitive):
        return Around(around.distance, stay.far, number, look.row)
    return around


@device
def _stay_behind(shape: Shape, verbs: Verbs, ray: Ray, kind: int) -> Stay:
    """Return the part of a ray behind a plane, where glass is that is seen from within."""
    far = verbs.distance_to(shape, ray)
    surface = verbs.surface(shape, ray_point(ray, 0.0), 0.0)
    ascent = dot(surface.pole, ray.direction)
    # Away from a plane, rays that do not meet it start behind it; but it may be cut off there.
    never_meets = ascent < 0.0 and far == math.inf and kind == PLANE
    is_behind = never_meets or (ascent > 0.0 and far < math.inf)
    return Stay(-math.inf, far) if is_behind else no_stay()


_around_in_places, _around_in_shapes = device(nearest_in_tree), device(nearest_in_tree)
"""Two ways, as in `queries`."""
