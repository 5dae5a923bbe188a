"""What stands between two points: one way at a time, from anywhere.

What is found is what a loop over all shapes would find; the hierarchies only leave out.
"""

from collections.abc import Callable
from typing import Any

from vtray.base.compiler.compiled import device, part
from vtray.geometry.bits import lowest_bit
from vtray.geometry.bvh.boxes import fetch_node
from vtray.geometry.bvh.tree import WIDTH
from vtray.geometry.dispatch import with_any
from vtray.geometry.packets.beam import (
    Beam,
    children_met,
    lower_limit,
    ray_beam,
    shape_margin,
    upper_limit,
)
from vtray.geometry.packets.stack import Stack
from vtray.geometry.queries import NOTHING
from vtray.geometry.ray import Segment
from vtray.geometry.rounding import MARGIN
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import scale, sub
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


@part
def first_between(world: World, segment: Segment, stack: Stack) -> int:
    """Return the lowest number of what stands between two points, or ``NOTHING``."""
    return _between(world, segment, stack, False)


@device
def is_occluded(world: World, segment: Segment, stack: Stack) -> bool:
    """Tell whether anything stands between two points; the first that is found is enough."""
    return _between(world, segment, stack, True) != NOTHING


@device
def _between(world: World, segment: Segment, stack: Stack, is_any: bool) -> int:
    """Return the number of what stands between two points: the lowest, or any, or ``NOTHING``."""
    first = NOTHING
    for row in range(group_count(world)):
        first = _first_of_group(world, load_group(world, row), segment, first, stack, 0, is_any)
        if is_any and first != NOTHING:
            return first
    return _first_placed(world, world.places, segment, first, stack, is_any)


@device
def _first_of_group(
    world: World,
    group: Group,
    segment: Segment,
    first: int,
    stack: Stack,
    base: int,
    is_any: bool,
) -> int:
    """Return the lower of a number and those of the shapes of a group that stand between."""
    hierarchy = hierarchy_of(group)
    beam = _segment_beam(segment, hierarchy.to_boxes)
    return _first_in_shapes(
        world, hierarchy, segment, beam, 1.0, first, stack, base, is_any, _first_of_slots, group
    )


@device
def is_occluded_below(
    world: World,
    group: Group,
    node: int,
    segment: Segment,
    beam: Beam,
    length: float,
    stack: Stack,
    base: int,
) -> bool:
    """Tell whether any shape below a node of a group's hierarchy stands between two points.

    Parameters
    ----------
    world, group, node
        The group, and the node.
    segment
        The way between the points.
    beam, length
        The same as a ray in the space of the group's boxes, up to this multiple of its direction.
    stack, base
        Scratch memory, and what waits there already, which stays.
    """
    hierarchy = Hierarchy(node, group.begin, group.end, group.to_boxes)
    first = _first_in_shapes(
        world, hierarchy, segment, beam, length, NOTHING, stack, base, True, _first_of_slots, group
    )
    return first != NOTHING


@device
def is_occluded_by_placed(world: World, places: Places, segment: Segment, stack: Stack) -> bool:
    """Tell whether anything that is placed stands between two points."""
    return _first_placed(world, places, segment, NOTHING, stack, True) != NOTHING


@device
def _first_placed(
    world: World,
    places: Places | None,
    segment: Segment,
    first: int,
    stack: Stack,
    is_any: bool,
) -> int:
    """Return the lower of a number and those of what is placed and stands between."""
    if places is not None:
        hierarchy = hierarchy_of_places(places)
        beam = _segment_beam(segment, hierarchy.to_boxes)
        return _first_in_places(
            world, hierarchy, segment, beam, 1.0, first, stack, 0, is_any, _first_of_places, places
        )
    return first


@device
def _first_of_places(
    world: World,
    places: Places,
    begin: int,
    end: int,
    segment: Segment,
    first: int,
    stack: Stack,
    base: int,
    is_any: bool,
) -> int:
    """Return the lower of a number and those of the groups of a range of places."""
    for at in range(begin, end):
        item = places.item[at]
        for row in range(places.rows[item], places.rows[item + 1]):
            group = load_group(world, placed_row(world, at, row))
            first = _first_of_group(world, group, segment, first, stack, base, is_any)
            if is_any and first != NOTHING:
                return first
    return first


@device
def _first_of_slots(
    world: World,
    group: Group,
    begin: int,
    end: int,
    segment: Segment,
    first: int,
    stack: Stack,  # noqa: ARG001
    base: int,  # noqa: ARG001
    is_any: bool,
) -> int:
    """Return the lower of a number and those of the shapes in a range that stand between."""
    for slot in range(begin, end):
        hides, number = with_any(world, group, slot, _hides, segment)
        if hides and (first == NOTHING or number < first):
            first = number
            if is_any:
                return first
    return first


@device
def _hides(shape: Shape, verbs: Verbs, number: int, segment: Segment) -> tuple[bool, int]:
    """Tell whether a shape stands between two points; return the shape's number."""
    return verbs.hides(shape, segment), number


def _first_in_tree(
    world: World,
    hierarchy: Hierarchy,
    segment: Segment,
    beam: Beam,
    length: float,
    first: int,
    stack: Stack,
    base: int,
    is_any: bool,
    first_of: Callable[[World, Any, int, int, Segment, int, Stack, int, bool], int],
    subject: Any,  # noqa: ANN401
) -> int:
    """Return the lower of a number and those in the leaves of a hierarchy.

    The beam is the segment, up to `length` times its direction.
    """
    bvh = world.bvh
    near, far = lower_limit(beam, 0.0), upper_limit(beam, length * (1.0 + MARGIN))
    stack.node[base] = hierarchy.root
    waiting = base + 1
    while waiting > base:
        waiting -= 1
        node = stack.node[waiting]
        if node < 0:
            begin, after = range_of(hierarchy, node)
            first = first_of(world, subject, begin, after, segment, first, stack, waiting, is_any)
            if is_any and first != NOTHING:
                return first
            continue
        # In any order: the nearest first, by `push_met`, is a quarter slower in packed spheres.
        met = children_met(bvh, node, beam, near, far, stack.entered)
        while met != 0:
            child = bvh.child[node * WIDTH + lowest_bit(met)]
            met &= met - 1
            fetch_node(bvh, child)
            stack.node[waiting] = child
            waiting += 1
    return first


_first_in_places, _first_in_shapes = device(_first_in_tree), device(_first_in_tree)
"""Two ways: one through what is placed, one through what stands at a place. They are
two, as the compiler takes what calls itself for recursion, whatever it is given."""


@device
def _segment_beam(segment: Segment, to_boxes: ToBoxes) -> Beam:
    """Return the way between two points as a beam in the boxes' space, from its end."""
    # From the light: its place is the more exact of the two.
    end = to_box_space(to_boxes, segment.end)
    way = scale(to_boxes.ratio, sub(segment.start, segment.end))
    return ray_beam(end, way, shape_margin(to_boxes, end, segment.start_scale))
