"""Which points of a packet have something between them and a light."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    BLOCKED,
    DEPTH,
    ERROR_SCALE,
    LANES,
    OCTET,
    POINT,
    Packet,
    load,
)
from vtray.geometry.packets.shaft import outside_shaft
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import Segment
from vtray.geometry.rounding import MARGIN, ROUNDING
from vtray.geometry.shapes.columns import Columns
from vtray.geometry.shapes.cylinder import cylinder_hides, load_cylinder
from vtray.geometry.shapes.plane import PlaneShape, end_side, hides_side, load_plane, plane_side
from vtray.geometry.shapes.sphere import load_sphere, sphere_hides
from vtray.geometry.vector import Vec, add, lower, magnitude, scale, sub, upper
from vtray.geometry.world import PLANE, SPHERE, Group, World, group_count, load_group

Flags = NDArray[np.bool_]


class Target(NamedTuple):
    """Where the shadow rays of a packet end: a point that light comes from.

    Attributes
    ----------
    place
        The point.
    depth
        Its distance in front of the image plane.
    error_scale
        What its rounding error is relative to, beside what stands in the way.
    """

    place: Vec
    depth: float
    error_scale: float


class Bounds(NamedTuple):
    """A box around points, and what their rounding errors are relative to at the most."""

    center: Vec
    half: Vec
    error_scale: float


@device
def bound_points(packet: Packet, hits: int) -> Bounds:
    """Return the bounds of a packet's points."""
    low = load(packet, POINT, 0)
    high = low
    error_scale = 0.0
    for lane in range(hits):
        point = load(packet, POINT, lane)
        low, high = lower(low, point), upper(high, point)
        error_scale = max(error_scale, packet[ERROR_SCALE + lane])
    return Bounds(scale(0.5, add(low, high)), scale(0.5, sub(high, low)), error_scale)


@device
def find_sides(packet: Packet, hits: int, world: World, work: Workspace) -> None:
    """Find on which sides of each plane a packet's points lie."""
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.kind == PLANE:
            for slot in range(group.begin, group.end):
                plane = load_plane(world.planes, slot, group.place)
                _find_side(packet, hits, plane, slot, work)


@device
def _find_side(packet: Packet, hits: int, plane: PlaneShape, slot: int, work: Workspace) -> None:
    """Find on which sides of a plane a packet's points lie."""
    above = 0
    below = 0
    for lane in range(hits):
        side = plane_side(plane, load(packet, POINT, lane))
        error_bound = ROUNDING * (packet[ERROR_SCALE + lane] + plane.error_scale)
        above += 1 if side > error_bound else 0
        below += 1 if side < -error_bound else 0
    work.above[slot] = above > 0
    work.below[slot] = below > 0


@device
def block_by_planes(
    packet: Packet, hits: int, world: World, group: Group, target: Target, work: Workspace
) -> None:
    """Mark the points that planes hide from a light."""
    for slot in range(group.begin, group.end):
        plane = load_plane(world.planes, slot, group.place)
        end = end_side(plane, target.place, target.error_scale)
        if (end < 0.0 and work.above[slot]) or (end > 0.0 and work.below[slot]):
            _block_lanes(packet, 0, hits, target, (plane, end), hides_side)


@device
def block_by_few(
    packet: Packet,
    hits: int,
    bounds: Bounds,
    world: World,
    group: Group,
    target: Target,
    near: Flags,
) -> None:
    """Mark the points that shapes of a group without a hierarchy hide from a light."""
    for slot in range(group.begin, group.end):
        near[slot] = in_shaft(world, group, slot, target, bounds)
    for slot in range(group.begin, group.end):
        if near[slot]:
            block_by_slot(packet, 0, hits, world, group, slot, target)


@device
def block_by_slot(
    packet: Packet, begin: int, end: int, world: World, group: Group, slot: int, target: Target
) -> None:
    """Mark the points of a range that a shape of a group hides from a light."""
    if group.kind == SPHERE:
        sphere = load_sphere(world.spheres, slot, group.place)
        _block_octets(packet, begin, end, target, sphere, sphere_hides)
    else:
        _block_by_cylinder(packet, begin, end, world.cylinders, group, slot, target)


@device
def _block_by_cylinder(
    packet: Packet,
    begin: int,
    end: int,
    cylinders: Columns | None,
    group: Group,
    slot: int,
    target: Target,
) -> None:
    """Mark the points of a range that a cylinder hides from a light."""
    if cylinders is None:
        return
    cylinder = load_cylinder(cylinders, slot, group.place)
    _block_octets(packet, begin, end, target, cylinder, cylinder_hides)


@device
def in_shaft(world: World, group: Group, slot: int, target: Target, bounds: Bounds) -> bool:
    """Tell whether a shape of a group may stand between any point of a box and a light."""
    if group.kind != SPHERE:
        return _cylinder_in_shaft(world.cylinders, group, slot, target, bounds)
    sphere = load_sphere(world.spheres, slot, group.place)
    return _ball_in_shaft(sphere.center, sphere.radius, sphere.error_scale, target, bounds)


@device
def _cylinder_in_shaft(
    cylinders: Columns | None, group: Group, slot: int, target: Target, bounds: Bounds
) -> bool:
    """Tell whether a cylinder may stand between any point of a box and a light."""
    if cylinders is None:
        return False
    cylinder = load_cylinder(cylinders, slot, group.place)
    return _ball_in_shaft(cylinder.center, cylinder.radius, cylinder.error_scale, target, bounds)


@device
def _ball_in_shaft(
    center: Vec, radius: float, error_scale: float, target: Target, bounds: Bounds
) -> bool:
    """Tell whether a ball may stand between any point of a box and a light."""
    margin = error_scale + bounds.error_scale + magnitude(target.place)
    wider = radius + MARGIN * margin
    return not outside_shaft(center, wider, target.place, bounds.center, bounds.half)


@device
def _block_octets(
    packet: Packet,
    begin: int,
    end: int,
    target: Target,
    shape: Any,  # noqa: ANN401
    hides: Callable[[Any, Segment], bool],
) -> None:
    """Mark the points of a range that a shape hides from a light.

    Points beyond the range in the same octet are only marked if they are hidden, too.
    """
    for octet in range(begin // OCTET, (end + OCTET - 1) // OCTET):
        # The mask tells the compiler that no index is negative.
        first = octet * OCTET & (LANES - 1)
        _block_lanes(packet, first, first + OCTET, target, shape, hides)


@device
def _block_lanes(
    packet: Packet,
    begin: int,
    end: int,
    target: Target,
    shape: Any,  # noqa: ANN401
    hides: Callable[[Any, Segment], bool],
) -> None:
    """Mark those points of some lanes that a shape hides from a light."""
    for lane in range(begin, end):
        segment = Segment(
            load(packet, POINT, lane),
            target.place,
            packet[DEPTH + lane],
            target.depth,
            packet[ERROR_SCALE + lane],
            target.error_scale,
        )
        packet[BLOCKED + lane] = 1.0 if hides(shape, segment) else packet[BLOCKED + lane]
