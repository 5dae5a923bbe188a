"""Shadow rays of a packet to a point of light: those near each other go side by side."""

import math

from vtray.base.compiler.compiled import device
from vtray.geometry.faded.layers import passed_share, ray_along
from vtray.geometry.faded.nearby import Tube
from vtray.geometry.faded.shares import share_beside
from vtray.geometry.faded.side_by_side import (
    FULL,
    Band,
    collect_side_by_side,
    load_direction,
    set_ray,
)
from vtray.geometry.packets.from_light import Box
from vtray.geometry.packets.layer_notes import CELLS, SIDE_BY_SIDE, STRIPS, SideBySide, Walk
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.packets.packet import (
    BLOCKED,
    ERROR_SCALE,
    PLANE_DEPTH,
    POINT,
    Packet,
    load,
)
from vtray.geometry.packets.stack import Stack
from vtray.geometry.ray import CORNER, Segment
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import Vec, add, cross, dot, lower, scale, sub, upper
from vtray.geometry.world import Faded, World


@device
def list_open(packet: Packet, hits: int, target: Target, beside: SideBySide) -> int:
    """List the hits that nothing blocks; return how many there are.

    What follows each other in the list is near each other as the light sees it: strip by strip, and
    in each along it. Nothing but time depends on that.
    """
    count = 0
    low, high = (math.inf, math.inf, math.inf), (-math.inf, -math.inf, -math.inf)
    for hit in range(hits):
        if packet[BLOCKED + hit] == 0.0:
            beside.hit[count] = hit
            count += 1
            way = _way_to(packet, hit, target)
            low, high = lower(low, way), upper(high, way)
    if count > SIDE_BY_SIDE:
        _sort_by_cells(packet, count, target, low, high, beside)
    return count


@device
def _sort_by_cells(
    packet: Packet, count: int, target: Target, low: Vec, high: Vec, beside: SideBySide
) -> None:
    """Sort so many hits that are listed by the cells in which the light sees them.

    The least and the greatest components of the ways to them are `low` and `high`.
    """
    across, along = _axes_across(scale(0.5, add(low, high)))
    left, wide = _range_of(low, high, across)
    bottom, tall = _range_of(low, high, along)
    # As wide as a square that holds as many as go side by side.
    side = math.sqrt(wide * tall * SIDE_BY_SIDE / count)
    strips = min(max(wide / side, 1.0), float(STRIPS)) if side > 0.0 else 1.0
    begins = beside.begins
    for k in range(STRIPS * CELLS + 1):
        begins[k] = 0
    for k in range(count):
        way = _way_to(packet, beside.hit[k], target)
        strip = _part_of(dot(way, across), left, wide, strips)
        cell = _part_of(dot(way, along), bottom, tall, float(CELLS))
        # Every other strip is gone through backwards: its begin is near the end of the last.
        place = strip * CELLS + (cell if strip & 1 == 0 else CELLS - 1 - cell)
        beside.cell[k] = place
        begins[place + 1] += 1
    for k in range(STRIPS * CELLS):
        begins[k + 1] += begins[k]
    for k in range(count):
        cell = beside.cell[k]
        beside.sorted[begins[cell]] = beside.hit[k]
        begins[cell] += 1
    for k in range(count):
        beside.hit[k] = beside.sorted[k]


@device
def _way_to(packet: Packet, hit: int, target: Target) -> Vec:
    """Return the unit direction in which a light sees a hit."""
    return _unit(sub(load(packet, POINT, hit), target.place))


@device
def _unit(way: Vec) -> Vec:
    """Return a way with length 1, or 0 if it has none."""
    length = math.sqrt(dot(way, way))
    return scale(1.0 / length if length > 0.0 else 0.0, way)


@device
def _axes_across(way: Vec) -> tuple[Vec, Vec]:
    """Return two unit directions across a way, and across each other."""
    x, y, z = abs(way[0]), abs(way[1]), abs(way[2])
    axis = (1.0, 0.0, 0.0) if x <= min(y, z) else (0.0, 1.0, 0.0) if y <= z else (0.0, 0.0, 1.0)
    across = _unit(cross(way, axis))
    return across, cross(_unit(way), across)


@device
def _range_of(low: Vec, high: Vec, axis: Vec) -> tuple[float, float]:
    """Return from where on a box lies along an axis, and how far."""
    middle, half = scale(0.5, add(low, high)), scale(0.5, sub(high, low))
    reach = abs(axis[0]) * half[0] + abs(axis[1]) * half[1] + abs(axis[2]) * half[2]
    return dot(axis, middle) - reach, 2.0 * reach


@device
def _part_of(place: float, begin: float, length: float, parts: float) -> int:
    """Return in which of equal parts of a range a place is."""
    part = (place - begin) / length * parts if length > 0.0 else 0.0
    return int(min(max(part, 0.0), parts - 1.0))


@device
def dim_some(
    packet: Packet,
    begin: int,
    rays: int,
    world: World,
    faded: Faded,
    target: Target,
    walk: Walk,
    stack: Stack,
) -> None:
    """Let faded bodies take their share of a light, in field ``BLOCKED``.

    Parameters
    ----------
    packet
        The hits.
    begin, rays
        The first of those that are listed, and how many go side by side.
    world, faded
        What is in the way.
    target
        The light.
    walk, stack
        Scratch memory, with the list.
    """
    beside = walk.beside
    low, high = (math.inf, math.inf, math.inf), (-math.inf, -math.inf, -math.inf)
    error_scale, longest = 0.0, 0.0
    for k in range(rays):
        segment = _segment_of(packet, beside.hit[begin + k], target)
        ray, end = ray_along(segment)
        set_ray(beside, k, ray, end)
        way = scale(-1.0, ray.direction)
        low, high = lower(low, way), upper(high, way)
        longest = max(longest, end.distance)
        error_scale = max(error_scale, segment.start_scale)
    # Of where they would start, were all as long as the longest.
    box = Box(scale(longest, low), scale(longest, high), error_scale)
    middle = _unit(add(low, high))
    growth = _spread_of(beside, rays, middle) * (1.0 + MARGIN) / CORNER
    length, scale_of_all = longest * (1.0 + MARGIN), target.error_scale + error_scale
    tube = Tube(target.place, middle, 0.0, growth, length, scale_of_all)
    collect_side_by_side(world, faded, Band(rays, box, target, tube, beside), stack)
    for k in range(rays):
        hit = beside.hit[begin + k]
        if beside.chords.found[k] < FULL:
            passed = share_beside(faded.bodies, k, walk)
        else:
            passed = passed_share(world, faded, _segment_of(packet, hit, target), walk, stack)
        packet[BLOCKED + hit] = 1.0 - passed


@device
def _spread_of(beside: SideBySide, rays: int, middle: Vec) -> float:
    """Return the largest tangent of the angles between rays, backwards, and a direction."""
    spread = 0.0
    for k in range(rays):
        way = scale(-1.0, load_direction(beside, k))
        ahead = dot(way, middle)
        off = sub(way, scale(ahead, middle))
        spread = max(spread, math.sqrt(dot(off, off)) / ahead if ahead > 0.0 else math.inf)
    return spread


@device
def _segment_of(packet: Packet, hit: int, target: Target) -> Segment:
    """Return the way from a hit to a light."""
    return Segment(
        load(packet, POINT, hit),
        target.place,
        packet[PLANE_DEPTH + hit],
        target.plane_depth,
        packet[ERROR_SCALE + hit],
        target.error_scale,
    )
