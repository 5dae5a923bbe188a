"""Through a hierarchy from a light: one beam to a box of points."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol, TypeVar

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.boxes import fetch_node
from vtray.geometry.bvh.tree import WIDTH, leaf_range
from vtray.geometry.packets.beam import (
    Beam,
    children_met,
    lower_limit,
    make_beam,
    shape_margin,
    upper_limit,
)
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.packets.stack import Stack
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import Vec, scale
from vtray.geometry.world import NO_TREE, Hierarchy, ToBoxes, World, to_box_space

FOR_EVER = 2**62
"""The patience of a search that is never given up."""


class Box(NamedTuple):
    """A box of points relative to a light, and what their rounding errors are relative to."""

    low: Vec
    high: Vec
    error_scale: float


class Points(Protocol):
    """Points whose shadow rays go to a light together."""

    @property
    def end(self) -> int:
        """The first point that no longer belongs to them."""

    @property
    def box(self) -> Box:
        """The box of all points."""

    @property
    def target(self) -> Target:
        """The light."""


AnyPoints = TypeVar("AnyPoints", bound=Points)


def search_from_light(
    begin: int,
    points: AnyPoints,
    world: World,
    hierarchy: Hierarchy,
    stack: Stack,
    base: int,
    patience: int,
    visit: Callable[[int, AnyPoints, World, Any, int, int, Stack, int], int],
    subject: Any,  # noqa: ANN401
) -> int:
    """Visit the leaves of a hierarchy that may be between points and a light, until none is left.

    Parameters
    ----------
    begin, points
        The points, and the first of them that is left.
    world, hierarchy
        The hierarchy.
    stack, base
        Scratch memory, and what waits there already, which stays.
    patience
        After how many leaves the search is given up.
    visit, subject
        What is called for each leaf, and what it is given, beside the range that the leaf names. It
        returns the first point that is left then.

    Returns
    -------
    int
        The first point that is left, their end if there is none; if it was given up, ``-1`` less
        that point.
    """
    if hierarchy.root == NO_TREE:
        first, after = hierarchy.begin, hierarchy.end
        return visit(begin, points, world, subject, first, after, stack, base)
    bvh, nodes = world.bvh, stack.node
    beam = _box_beam(points.box, hierarchy.to_boxes, points.target)
    near, far = lower_limit(beam, 0.0), upper_limit(beam, 1.0 + MARGIN)
    nodes[base] = hierarchy.root
    waiting, leaves = base + 1, 0
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
                elif leaves == patience:
                    return -1 - begin
                else:
                    leaves += 1
                    first, after = leaf_range(child)
                    begin = visit(begin, points, world, subject, first, after, stack, waiting)
                    if begin == points.end:
                        return begin
            met >>= 1
            place += 1
    return begin


@device
def _box_beam(box: Box, to_boxes: ToBoxes, target: Target) -> Beam:
    """Return the beam from a light to a box of points."""
    ratio, apex = to_boxes.ratio, to_box_space(to_boxes, target.place)
    margin = shape_margin(to_boxes, apex, box.error_scale)
    return make_beam(apex, apex, scale(ratio, box.low), scale(ratio, box.high), margin)
