"""Which rays of a fan something stops on their way to a light.

Shapes that have no hierarchy are asked about all rays at once; through hierarchies each ray goes
alone. What is found is what a loop over all rays and all shapes would find.
"""

from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.between import is_occluded_by, is_occluded_by_placed
from vtray.geometry.dispatch import Shape, Verbs, with_any
from vtray.geometry.packets.beam import ray_beam, shape_margin
from vtray.geometry.packets.cone import Touching
from vtray.geometry.packets.fan import (
    BLOCKED,
    LENGTH,
    Fan,
    Start,
    fan_segment,
    load_direction,
)
from vtray.geometry.packets.stack import Stack
from vtray.geometry.vector import add, scale
from vtray.geometry.world import NO_TREE, Group, Places, World, group_count, load_group


class Bundle(NamedTuple):
    """The rays of a fan.

    Attributes
    ----------
    fan, rays
        The fan, and how many there are.
    start
        Where they start.
    end_scale
        What the rounding errors of their ends are relative to.
    """

    fan: Fan
    rays: int
    start: Start
    end_scale: float


@device
def stop_by_touching(bundle: Bundle, world: World, touching: Touching, count: int) -> None:
    """Mark in field ``BLOCKED`` the rays that some shapes stop.

    Parameters
    ----------
    bundle
        The rays. Those marked already stay so.
    world, touching, count
        The shapes, so many.
    """
    for k in range(count):
        group = load_group(world, touching.row[k])
        with_any(world, group, touching.slot[k], _stop_by_shape, bundle)


@device
def stop_by_all(bundle: Bundle, world: World, stack: Stack) -> None:
    """Mark in field ``BLOCKED`` the rays that anything stops.

    Parameters
    ----------
    bundle
        The rays. Those marked already are passed over.
    world
        What they can meet.
    stack
        Scratch memory.
    """
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.root == NO_TREE:
            for slot in range(group.begin, group.end):
                with_any(world, group, slot, _stop_by_shape, bundle)
        else:
            _stop_by_tree(bundle, world, group, stack)
    _stop_by_placed(bundle, world, world.places, stack)


@device
def _stop_by_shape(shape: Shape, verbs: Verbs, number: int, bundle: Bundle) -> int:
    """Mark the rays that a shape stops."""
    fan, rays, start, end_scale = bundle
    for ray in range(rays):
        segment = fan_segment(fan, ray, start, end_scale)
        fan[BLOCKED + ray] = 1.0 if verbs.hides(shape, segment) else fan[BLOCKED + ray]
    return number


@device
def _stop_by_tree(bundle: Bundle, world: World, group: Group, stack: Stack) -> None:
    """Mark the rays that shapes of a group with a hierarchy stop, ray by ray."""
    fan, start = bundle.fan, bundle.start
    ratio, offset = group.to_boxes.ratio, group.to_boxes.offset
    apex = add(scale(ratio, start.point), offset)
    margin = shape_margin(group.to_boxes, apex, start.error_scale)
    for ray in range(bundle.rays):
        if fan[BLOCKED + ray] == 0.0:
            segment = fan_segment(fan, ray, start, bundle.end_scale)
            beam = ray_beam(apex, load_direction(fan, ray), margin)
            length = fan[LENGTH + ray] * ratio
            hidden = is_occluded_by(world, group, segment, beam, length, stack)
            fan[BLOCKED + ray] = 1.0 if hidden else 0.0


@device
def _stop_by_placed(bundle: Bundle, world: World, places: Places | None, stack: Stack) -> None:
    """Mark the rays that something that is placed stops."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        for ray in range(bundle.rays):
            if bundle.fan[BLOCKED + ray] == 0.0:
                segment = fan_segment(bundle.fan, ray, bundle.start, bundle.end_scale)
                hidden = is_occluded_by_placed(world, places, segment, stack)
                bundle.fan[BLOCKED + ray] = 1.0 if hidden else 0.0
