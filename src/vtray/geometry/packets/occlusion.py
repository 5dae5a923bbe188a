"""Which points of a packet have something between them and a light."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, part
from vtray.geometry.dispatch import with_bounded
from vtray.geometry.packets.packet import (
    BLOCKED,
    ERROR_SCALE,
    LANES,
    MET,
    NORMAL,
    OCTET,
    OWNER,
    PLANE_DEPTH,
    POINT,
    REACH,
    SOURCE,
    Packet,
    integers,
    load,
    split_met,
)
from vtray.geometry.packets.patch import is_open, note_plane, note_solid, widest_reach
from vtray.geometry.packets.shaft import outside_shaft
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import CORNER, Segment
from vtray.geometry.rounding import MARGIN, ROUNDING
from vtray.geometry.shapes.plane import PlaneShape, end_side, hides_side, load_plane, plane_side
from vtray.geometry.shapes.sphere import load_sphere
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec, add, dot, lower, magnitude, scale, sub, upper
from vtray.geometry.world import PLANE, SPHERE, Group, Solids, World, group_count, load_group

Flags = NDArray[np.bool_]

SOONER = 16
"""So few points are tested sooner than a shape is found to be outside their shaft."""


class Target(NamedTuple):
    """Where the shadow rays of a packet end: a point that light comes from.

    Attributes
    ----------
    place
        The point.
    plane_depth
        Its distance in front of the image plane.
    error_scale
        What its rounding error is relative to, beside what stands in the way.
    is_wide
        Whether rays from the patches around the points are asked for as well; None where they never
        are, so that no code is compiled for them.
    """

    place: Vec
    plane_depth: float
    error_scale: float
    is_wide: bool | None = None


class Bounds(NamedTuple):
    """What the points of a packet are within.

    Attributes
    ----------
    low, high
        Their least and their greatest coordinates.
    least, most
        The least and the greatest components of their normals.
    plane_depth, error_scale
        Their largest plane depth, and what their rounding errors are relative to at the most.
    """

    low: Vec
    high: Vec
    least: Vec
    most: Vec
    plane_depth: float
    error_scale: float


class PointBox(NamedTuple):
    """A box around points, and what their rounding errors are relative to at the most."""

    center: Vec
    half: Vec
    error_scale: float


@device
def bound_points(packet: Packet, hits: int) -> Bounds:
    """Return the bounds of a packet's points."""
    low = high = load(packet, POINT, 0)
    least = most = load(packet, NORMAL, 0)
    plane_depth = -math.inf
    error_scale = 0.0
    for lane in range(hits):
        point, normal = load(packet, POINT, lane), load(packet, NORMAL, lane)
        low, high = lower(low, point), upper(high, point)
        least, most = lower(least, normal), upper(most, normal)
        plane_depth = max(plane_depth, packet[PLANE_DEPTH + lane])
        error_scale = max(error_scale, packet[ERROR_SCALE + lane])
    return Bounds(low, high, least, most, plane_depth, error_scale)


@device
def box_of(bounds: Bounds) -> PointBox:
    """Return the box of points within bounds."""
    center = scale(0.5, add(bounds.low, bounds.high))
    return PointBox(center, scale(0.5, sub(bounds.high, bounds.low)), bounds.error_scale)


@device
def widened_box(packet: Packet, hits: int, box: PointBox, is_wide: bool | None) -> PointBox:
    """Return a box of points widened by their patches, if these are asked for."""
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            most = CORNER * widest_reach(packet, 0, hits, is_wide)
            return PointBox(box.center, add(box.half, (most, most, most)), box.error_scale)
    return box


@device
def height_range(bounds: Bounds, light: Vec) -> tuple[float, float]:
    """Return how high a light is at the least and at the most above surfaces within bounds.

    The operations are those that find the height above one of them. Rounding keeps the order of
    numbers, so none is outside this range.
    """
    a, b = bounds.least, bounds.most
    near, far = sub(light, bounds.high), sub(light, bounds.low)
    x, y, z = (
        _product_range(a[0], b[0], near[0], far[0]),
        _product_range(a[1], b[1], near[1], far[1]),
        _product_range(a[2], b[2], near[2], far[2]),
    )
    return x[0] + y[0] + z[0], x[1] + y[1] + z[1]


@device
def _product_range(a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """Return the least and the greatest product of numbers from a to b with ones from c to d."""
    return min(a * c, a * d, b * c, b * d), max(a * c, a * d, b * c, b * d)


@device
def own_sphere(packet: Packet, hits: int, world: World) -> int:
    """Return the slot of the sphere on which all points are, outside; -1 if there is none.

    It hides none of them from a light above their horizon: a shadow ray that starts on a sphere, or
    outside, meets it only on its way towards the centre, and this one leads away by more than
    rounding could explain.
    """
    numbers = integers(packet)
    met = numbers[MET + numbers[SOURCE]]
    row, slot = split_met(met)
    group = load_group(world, row)
    if group.kind != SPHERE:
        return -1
    center = load_sphere(world.spheres, slot, group.place).center
    for hit in range(hits):
        outward = sub(load(packet, POINT, hit), center)
        is_outside = dot(load(packet, NORMAL, hit), outward) > 0.0
        if numbers[MET + numbers[SOURCE + hit]] != met or not is_outside:
            return -1
    return slot


@device
def find_sides(packet: Packet, hits: int, world: World, work: Workspace) -> None:
    """Find how near a packet's points come to each plane on both of its sides."""
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.kind == PLANE:
            for slot in range(group.begin, group.end):
                plane = load_plane(world.planes, slot, group.place)
                _find_sides_of(packet, hits, plane, slot, work)


@device
def find_close_planes(packet: Packet, hits: int, world: World, work: Workspace) -> None:
    """Find the planes that the patches of a packet reach, and on which they are not."""
    numbers = integers(packet)
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.kind == PLANE:
            for slot in range(group.begin, group.end):
                plane = load_plane(world.planes, slot, group.place)
                number, count = group.number + world.planes.number[slot], 0
                for lane in range(hits):
                    side = plane_side(plane, load(packet, POINT, lane))
                    is_close = (abs(side) <= packet[REACH + lane]) & (
                        numbers[OWNER + lane] != number
                    )
                    count += 1 if is_close else 0
                work.close[slot] = count > 0


@device
def _find_sides_of(
    packet: Packet, hits: int, plane: PlaneShape, slot: int, work: Workspace
) -> None:
    """Find how near a packet's points come to a plane on both of its sides."""
    far = np.float64(math.inf).view(np.int64)
    # Doubles ≥ 0 are in the order of their bits, and a minimum of integers can be vectorised.
    above = far
    below = far
    for lane in range(hits):
        side = plane_side(plane, load(packet, POINT, lane))
        error_bound = ROUNDING * (packet[ERROR_SCALE + lane] + plane.error_scale)
        bits = np.float64(abs(side)).view(np.int64)
        above = min(above, bits if side > error_bound else far)
        below = min(below, bits if side < -error_bound else far)
    work.above[slot] = np.int64(above).view(np.float64)
    work.below[slot] = np.int64(below).view(np.float64)


@device
def block_by_planes(
    packet: Packet,
    hits: int,
    bounds: Bounds,
    world: World,
    group: Group,
    target: Target,
    work: Workspace,
) -> bool:
    """Mark the points that planes hide from a light; tell whether any is left."""
    for slot in range(group.begin, group.end):
        plane = load_plane(world.planes, slot, group.place)
        # Worked out here: in the loop over lanes, the compiler did not see that it is always the
        # same, and it took a quarter more time.
        end = end_side(plane, target.place, target.error_scale)
        nearest = work.above[slot] if end < 0.0 else work.below[slot]
        if work.close[slot] or nearest < math.inf:
            number = group.number + world.planes.number[slot]
            _note_plane(packet, hits, target.is_wide, plane, number)
        if end != 0.0 and _crosses(nearest, abs(end), bounds.plane_depth, target.plane_depth):
            _block_lanes(packet, 0, hits, target, (plane, end), hides_side)
            if not _any_open(packet, hits, target.is_wide):
                return False
    return True


@device
def _crosses(nearest: float, end: float, plane_depth: float, end_plane_depth: float) -> bool:
    """Tell whether shadow rays may cross a plane in front of the image plane.

    Rounding keeps the order of numbers, so where this is not so, it is for no point of a packet.

    Parameters
    ----------
    nearest, end
        The least distance from the plane of points on its one side, and of the light on the other.
    plane_depth, end_plane_depth
        The largest plane depth of the points, and that of the light.
    """
    crossing = nearest * end_plane_depth + end * plane_depth
    return (nearest < math.inf) & ((end_plane_depth >= 0.0) | (crossing > 0.0))


@device
def _any_open(packet: Packet, hits: int, is_wide: bool | None) -> bool:
    """Tell whether nothing so far hides a light from any of the points."""
    count = 0
    for lane in range(hits):
        count += 1 if is_open(packet, lane, is_wide) else 0
    return count > 0


@part
def block_by_few(
    packet: Packet,
    hits: int,
    box: PointBox,
    own: int,
    solids: Solids,
    group: Group,
    target: Target,
    near: Flags,
) -> None:
    """Mark the points that shapes of a group without a hierarchy hide from a light.

    If all are on one sphere, `own` is its slot, and it is not asked; otherwise it is -1.
    """
    for slot in range(group.begin, group.end):
        near[slot] = _in_shaft(solids, group, slot, target, box)
    for slot in range(group.begin, group.end):
        if near[slot] and not (slot == own and group.kind == SPHERE):
            _block_by_slot(packet, 0, hits, solids, group, slot, target)


@part
def block_by_slots(
    packet: Packet,
    begin: int,
    end: int,
    box: PointBox,
    solids: Solids,
    group: Group,
    first: int,
    after: int,
    target: Target,
) -> None:
    """Mark the points of a range that shapes of a leaf hide from a light.

    Parameters
    ----------
    packet, begin, end, box
        The points, and what they are within.
    solids, group, first, after
        The shapes in the slots of a group from `first` to before `after`.
    target
        The light.
    """
    for slot in range(first, after):
        if end - begin <= SOONER or _in_shaft(solids, group, slot, target, box):
            _block_by_slot(packet, begin, end, solids, group, slot, target)


@device
def _block_by_slot(
    packet: Packet, begin: int, end: int, solids: Solids, group: Group, slot: int, target: Target
) -> None:
    """Mark the points of a range that a shape of a group hides from a light."""
    with_bounded(solids, group, slot, _block_by_shape, (packet, begin, end, target))


@device
def _block_by_shape(
    shape: Shape,
    verbs: Verbs,
    number: int,
    arguments: tuple[Packet, int, int, Target],
) -> None:
    """Mark the points of a range that a shape hides from a light."""
    packet, begin, end, target = arguments
    _block_octets(packet, begin, end, target, shape, verbs.hides)
    _note_solid(packet, begin, end, target.is_wide, number, shape, verbs)


@device
def _in_shaft(solids: Solids, group: Group, slot: int, target: Target, box: PointBox) -> bool:
    """Tell whether a shape of a group may stand between any point of a box and a light."""
    in_way: bool = with_bounded(solids, group, slot, _is_in_shaft, (target, box))
    return in_way


@device
def _is_in_shaft(
    shape: Shape,
    verbs: Verbs,  # noqa: ARG001
    number: int,  # noqa: ARG001
    arguments: tuple[Target, PointBox],
) -> bool:
    """Tell whether the ball around a shape may stand between any point of a box and a light."""
    target, box = arguments
    margin = shape.error_scale + box.error_scale + magnitude(target.place)
    radius = shape.radius + MARGIN * margin
    return not outside_shaft(shape.center, radius, target.place, box.center, box.half)


@device
def _block_octets(
    packet: Packet,
    begin: int,
    end: int,
    target: Target,
    shape: Shape,
    hides: Callable[[Shape, Segment], bool],
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
    shape: Shape,
    hides: Callable[[Shape, Segment], bool],
) -> None:
    """Mark those points of some lanes that a shape hides from a light."""
    for lane in range(begin, end):
        segment = Segment(
            load(packet, POINT, lane),
            target.place,
            packet[PLANE_DEPTH + lane],
            target.plane_depth,
            packet[ERROR_SCALE + lane],
            target.error_scale,
        )
        packet[BLOCKED + lane] = 1.0 if hides(shape, segment) else packet[BLOCKED + lane]


@device
def _note_plane(
    packet: Packet,
    hits: int,
    is_wide: bool | None,
    plane: PlaneShape,
    number: int,
) -> None:
    """Note what a plane does to the light on patches, if these are asked for."""
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            note_plane(packet, hits, number, plane)


@device
def _note_solid(
    packet: Packet,
    begin: int,
    end: int,
    is_wide: bool | None,
    number: int,
    shape: Shape,
    verbs: Verbs,
) -> None:
    """Note what a shape does to the light on patches of a range, if these are asked for."""
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            note_solid(packet, begin, end, number, shape, verbs.is_outside, verbs.crossing)
