"""Whether faded shapes are near a ray: then what is seen beside it may be something else."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from vtray.base.compiler.compiled import device, part
from vtray.geometry.dispatch import with_bounded
from vtray.geometry.packets.beam import Beam, lower_limit, make_beam, shape_margin, upper_limit
from vtray.geometry.packets.stack import Stack, push_met
from vtray.geometry.ray import CORNER
from vtray.geometry.rounding import MARGIN
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec, add, dot, scale, sub
from vtray.geometry.world import (
    PLANE,
    Faded,
    Group,
    Hierarchy,
    Places,
    ToBoxes,
    World,
    hierarchy_of,
    load_group,
    placed_row,
    range_of,
    to_box_space,
)


class Tube(NamedTuple):
    """All that is beside a ray.

    Attributes
    ----------
    origin, direction
        The ray, with a unit direction.
    width, growth
        How far beside its start the tube reaches, and by how much more with each unit of length.
    length
        How long it is.
    error_scale
        What the rounding error of its start is relative to.
    """

    origin: Vec
    direction: Vec
    width: float
    growth: float
    length: float
    error_scale: float


@part
def touches_faded(world: World, faded: Faded, tube: Tube, stack: Stack) -> bool:
    """Tell whether a faded shape may reach into a tube; a faded plane always may."""
    for row in range(faded.begin, faded.end):
        if _touches_group(world, load_group(world, row), tube, stack, 0):
            return True
    return _touches_placed(world, world.places, faded, tube, stack)


@device
def _touches_group(world: World, group: Group, tube: Tube, stack: Stack, base: int) -> bool:
    if group.kind == PLANE:
        return group.begin < group.end
    return _touches_shapes(world, hierarchy_of(group), tube, stack, base, _touches_slots, group)


@device
def _touches_placed(
    world: World, places: Places | None, faded: Faded, tube: Tube, stack: Stack
) -> bool:
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        return _touches_places(world, faded.places, tube, stack, 0, _touches_at, places)
    return False


@device
def _touches_at(
    world: World, places: Places, begin: int, end: int, tube: Tube, stack: Stack, base: int
) -> bool:
    """Tell whether the groups of a range of places do."""
    for at in range(begin, end):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            if _touches_group(
                world, load_group(world, placed_row(world, at, row)), tube, stack, base
            ):
                return True
    return False


@device
def _touches_slots(
    world: World,
    group: Group,
    begin: int,
    end: int,
    tube: Tube,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
) -> bool:
    """Tell whether shapes of a range of slots do, by their balls."""
    for slot in range(begin, end):
        if with_bounded(world.solids, group, slot, touches_ball, tube):
            return True
    return False


@device
def touches_ball(
    shape: Shape,
    verbs: Verbs,  # noqa: ARG001
    number: int,  # noqa: ARG001
    tube: Tube,
) -> bool:
    """Tell whether the ball around a shape may reach into a tube."""
    way = sub(shape.center, tube.origin)
    ahead = dot(way, tube.direction)
    approach = sub(way, scale(ahead, tube.direction))
    reach = shape.radius + MARGIN * (shape.error_scale + tube.error_scale)
    wide = tube.width + tube.growth * max(ahead + reach, 0.0)
    is_beside: bool = math.sqrt(dot(approach, approach)) <= reach + CORNER * wide
    return is_beside and ahead + reach >= 0.0 and ahead - reach <= tube.length


def _touches_tree(
    world: World,
    hierarchy: Hierarchy,
    tube: Tube,
    stack: Stack,
    base: int,
    touches: Callable[[World, Any, int, int, Tube, Stack, int], bool],
    subject: Any,  # noqa: ANN401
) -> bool:
    """Tell whether something in the leaves of a hierarchy does."""
    beam, ratio = _tube_beam(tube, hierarchy.to_boxes), hierarchy.to_boxes.ratio
    near, far = lower_limit(beam, 0.0), upper_limit(beam, tube.length * ratio * (1.0 + MARGIN))
    stack.node[base] = hierarchy.root
    waiting = base + 1
    while waiting > base:
        waiting -= 1
        child = stack.node[waiting]
        if child >= 0:
            waiting = push_met(world.bvh, child, beam, near, far, stack, waiting)
        else:
            begin, end = range_of(hierarchy, child)
            if touches(world, subject, begin, end, tube, stack, waiting):
                return True
    return False


_touches_places, _touches_shapes = device(_touches_tree), device(_touches_tree)
"""Two ways: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def _tube_beam(tube: Tube, to_boxes: ToBoxes) -> Beam:
    """Return a beam that holds a tube, in the boxes' space; its directions have length 1."""
    ratio, growth, direction = to_boxes.ratio, CORNER * tube.growth, tube.direction
    start = to_box_space(to_boxes, tube.origin)
    margin = shape_margin(to_boxes, start, tube.error_scale) + CORNER * tube.width * ratio
    wider = growth, growth, growth
    return make_beam(start, start, sub(direction, wider), add(direction, wider), margin)
