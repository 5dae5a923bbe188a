"""The nearest hit of each ray of a packet."""

import math
from collections.abc import Callable

from vtray.base.compiler.compiled import device, part
from vtray.geometry.bundle import Bundle, Crossing, image_plane_range
from vtray.geometry.dispatch import with_bounded
from vtray.geometry.packets.packet import (
    ALL_MET,
    DISTANCE,
    LANES,
    MET,
    MIXED,
    NEAREST,
    NO_PRIMITIVE,
    OCTET,
    PASSED,
    PASSING,
    POWER,
    PRIMITIVE,
    RIVAL,
    Packet,
    Sheaf,
    integers,
    join_met,
    load_ray,
)
from vtray.geometry.packets.ray_bounds import (
    Cones,
    ball_distance,
    find_farthest,
    is_known_mixed,
    latest_start,
    note_latest,
    note_mixed,
    octets_met,
)
from vtray.geometry.ray import Footprint, Ray, has_width, ray_point, width_at
from vtray.geometry.rounding import MARGIN
from vtray.geometry.shapes.plane import load_plane, plane_crossing, plane_distance
from vtray.geometry.shapes.surface import no_power
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec
from vtray.geometry.world import Clip, Group, Solids, World


@device
def clear_hits(packet: Packet, lanes: int) -> None:
    """Start with no hit in any lane."""
    numbers = integers(packet)
    for lane in range(lanes):
        packet[DISTANCE + lane] = math.inf
        packet[POWER + lane] = 0.0
        numbers[PRIMITIVE + lane] = NO_PRIMITIVE
        packet[NEAREST + lane] = math.inf
        packet[RIVAL + lane] = math.inf
        packet[ALL_MET + lane] = math.inf


@device
def find_starts(
    packet: Packet, lanes: int, sheaf: Sheaf, footprint: Footprint | None, cones: Cones
) -> None:
    """Find from where on what the bundles of lanes meet counts, if they have a width."""
    if footprint is None:
        return
    if not has_width(footprint):
        return
    for lane in range(lanes):
        first, last = image_plane_range(load_ray(packet, sheaf, lane), footprint)
        packet[PASSING + lane] = first
        packet[PASSED + lane] = last
    for lane in range(0, lanes, OCTET):
        note_latest(packet, lane, cones)
        note_mixed(packet, lane, cones)


@part
def nearest_planes(
    packet: Packet,
    lanes: int,
    sheaf: Sheaf,
    footprint: Footprint | None,
    world: World,
    group: Group,
) -> None:
    """Let planes take the lanes in which they are nearer than the hits so far."""
    for slot in range(group.begin, group.end):
        plane = load_plane(world.planes, slot, group.place)
        number = group.number + world.planes.number[slot]
        met = join_met(group.row, slot)
        _take_lanes(
            packet, 0, lanes, sheaf, met, number, plane, plane_distance, no_power, world.solids.clip
        )
        if has_width(footprint):
            _note_crossings(packet, 0, lanes, sheaf, footprint, True, plane, plane_crossing)


@part
def nearest_slots(
    packet: Packet,
    first: int,
    count: int,
    sheaf: Sheaf,
    footprint: Footprint | None,
    solids: Solids,
    group: Group,
    begin: int,
    end: int,
    cones: Cones,
) -> None:
    """Let shapes of a group take lanes of some octets in which they are nearer.

    Parameters
    ----------
    packet, sheaf, footprint
        The rays.
    first, count
        The first of the octets, and how many there are.
    solids, group
        The group, which is none of planes.
    begin, end
        The slots of its shapes, from the first to before the last.
    cones
        What is known of the directions of the rays.
    """
    for slot in range(begin, end):
        rays = packet, first, count, sheaf, footprint, cones
        arguments = rays, join_met(group.row, slot), solids.clip
        with_bounded(solids, group, slot, _take_octets, arguments)


@device
def _take_octets(
    shape: Shape,
    verbs: Verbs,
    number: int,
    arguments: tuple[tuple[Packet, int, int, Sheaf, Footprint | None, Cones], int, Clip | None],
) -> None:
    """Test a shape for those of some octets that it may meet."""
    (packet, first, count, sheaf, footprint, cones), met_here, clip = arguments
    margin = MARGIN * (shape.error_scale + sheaf.error_scale)
    met = octets_met(cones, first, count, sheaf, shape.center, shape.radius + margin, footprint)
    distance = ball_distance(shape.center, shape.radius, sheaf)
    may_cover = shape.radius > width_at(footprint, distance)
    lane = first * OCTET
    while met > 0:
        if met & 1:
            # The mask tells the compiler that no index is negative.
            begin = lane & (LANES - 1)
            end = begin + OCTET
            _take_lanes(
                packet,
                begin,
                end,
                sheaf,
                met_here,
                number,
                shape,
                verbs.distance_to,
                verbs.power_at,
                clip,
            )
            if has_width(footprint) and (may_cover or not is_known_mixed(cones, lane)):
                is_cut = distance <= latest_start(cones, lane)
                cross = verbs.crossing
                _note_crossings(packet, begin, end, sheaf, footprint, is_cut, shape, cross)
                note_mixed(packet, lane, cones)
            find_farthest(packet, lane // OCTET, 1, footprint, cones)
        met >>= 1
        lane += OCTET


@device
def _take_lanes(
    packet: Packet,
    begin: int,
    end: int,
    sheaf: Sheaf,
    met: int,
    number: int,
    shape: Shape,
    distance_to: Callable[[Shape, Ray], float],
    power_at: Callable[[Shape, Vec], float],
    clip: Clip | None,
) -> None:
    """Let a shape take those of some lanes in which it is nearer than the hit so far.

    Of two at the same distance, that with the lower power is hit, and of two with the same that
    with the lower number. Where clip planes cut nothing, all powers are the same.
    """
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if clip is not None:
        _take_deepest(packet, begin, end, sheaf, met, number, shape, distance_to, power_at)
        return
    numbers = integers(packet)
    for lane in range(begin, end):
        distance = distance_to(shape, load_ray(packet, sheaf, lane))
        best = packet[DISTANCE + lane]
        nearer = (distance < best) | ((distance == best) & (number < numbers[PRIMITIVE + lane]))
        packet[DISTANCE + lane] = distance if nearer else packet[DISTANCE + lane]
        numbers[PRIMITIVE + lane] = number if nearer else numbers[PRIMITIVE + lane]
        numbers[MET + lane] = met if nearer else numbers[MET + lane]


@device
def _take_deepest(
    packet: Packet,
    begin: int,
    end: int,
    sheaf: Sheaf,
    met: int,
    number: int,
    shape: Shape,
    distance_to: Callable[[Shape, Ray], float],
    power_at: Callable[[Shape, Vec], float],
) -> None:
    """Let a shape take those of some lanes in which it is nearer, or as near and deeper."""
    numbers = integers(packet)
    for lane in range(begin, end):
        ray = load_ray(packet, sheaf, lane)
        distance = distance_to(shape, ray)
        best, deepest = packet[DISTANCE + lane], packet[POWER + lane]
        power = power_at(shape, ray_point(ray, distance)) if distance <= best else 0.0
        is_first = (power == deepest) & (number < numbers[PRIMITIVE + lane])
        nearer = (distance < best) | ((distance == best) & ((power < deepest) | is_first))
        packet[DISTANCE + lane] = distance if nearer else packet[DISTANCE + lane]
        packet[POWER + lane] = power if nearer else packet[POWER + lane]
        numbers[PRIMITIVE + lane] = number if nearer else numbers[PRIMITIVE + lane]
        numbers[MET + lane] = met if nearer else numbers[MET + lane]


@device
def _note_crossings(
    packet: Packet,
    begin: int,
    end: int,
    sheaf: Sheaf,
    footprint: Footprint | None,
    is_cut: bool,
    shape: Shape,
    crossing_of: Callable[[Shape, Bundle], Crossing],
) -> None:
    """Note where all that belongs to the pixels of some lanes meets a shape."""
    if footprint is None:
        return
    for lane in range(begin, end):
        ray = load_ray(packet, sheaf, lane)
        bundle = Bundle(
            ray.origin,
            ray.direction,
            footprint.width,
            footprint.growth,
            1.0,
            None,
            None,
            packet[PASSING + lane],
            packet[PASSED + lane],
            is_cut,
        )
        near, far = crossing_of(shape, bundle)
        nearest = packet[NEAREST + lane]
        packet[RIVAL + lane] = min(packet[RIVAL + lane], max(nearest, near))
        packet[NEAREST + lane] = min(nearest, near)
        packet[ALL_MET + lane] = min(packet[ALL_MET + lane], far)


@device
def find_mixed(packet: Packet, lanes: int) -> None:
    """Set field ``MIXED``: all rays of a lane's bundle hit one same shape first, or nothing.

    That is so if one is in the way of all of them, and no other is met before that; which must be
    true of the ray itself, too.
    """
    for lane in range(lanes):
        distance, nearest = packet[DISTANCE + lane], packet[NEAREST + lane]
        last = packet[ALL_MET + lane]
        is_one = (nearest <= distance) & (distance <= last) & (last < packet[RIVAL + lane])
        is_none = (nearest == math.inf) & (distance == math.inf)
        packet[MIXED + lane] = 0.0 if is_one | is_none else 1.0
