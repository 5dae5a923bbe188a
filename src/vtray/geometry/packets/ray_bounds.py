"""Cones around octets of rays, which tell for eight octets at once which a shape may meet.

The line of the ray from ``o`` along the unit vector ``d`` passes a point ``c`` at the distance
``|(c - o) x d|``. For another start ``p`` and any vector ``a`` that is at least
``|(c - p) x a| - |o - p| - |c - o| * |d - a|``: so one start and one axis speak for an octet of
rays, from anywhere.
"""

import math

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    ALL_MET,
    DIRECTION,
    DISTANCE,
    LANES,
    NEAREST,
    OCTET,
    ORIGIN,
    PASSED,
    RIVAL,
    Packet,
    Sheaf,
    integers,
    start_apart,
)
from vtray.geometry.ray import Footprint, has_width, reach_at
from vtray.geometry.vector import Vec, add, cross, dot, lower, scale, sub, upper

OCTETS = LANES // OCTET

# Rows of one number an octet; a vector takes three rows.
AXIS = 0 * OCTETS
START = 3 * OCTETS
SPREAD = 6 * OCTETS  # how far directions are from the axis at the most
WIDTH = 7 * OCTETS  # how far starts are from that of the cone at the most
LOW = 8 * OCTETS  # the least and the greatest components of the directions
HIGH = 11 * OCTETS
FIRST = 14 * OCTETS  # the least and the greatest coordinates of the starts
LAST = 17 * OCTETS
FARTHEST = 20 * OCTETS  # the largest distance at which hits so far leave something to find
KNOWN = 21 * OCTETS  # 1 where no ray can see only one thing, but for what covers all it sees
LATEST = 22 * OCTETS  # where the last of all that belongs to its pixels passes the image plane
ROWS = 23

Cones = NDArray[np.float64]


def new_cones() -> Cones:
    """Return the cones of a packet."""
    return np.zeros(ROWS * OCTETS)


@device
def find_cones(packet: Packet, lanes: int, sheaf: Sheaf, cones: Cones) -> None:
    """Find the cones of the octets of so many lanes."""
    for axis in range(3):
        _bound_octets(packet, DIRECTION + axis * LANES, lanes, cones, LOW + axis * OCTETS)
        if start_apart(sheaf):
            _bound_octets(packet, ORIGIN + axis * LANES, lanes, cones, FIRST + axis * OCTETS)
    for octet in range(lanes // OCTET):
        low, high = _load(cones, LOW, octet), _load(cones, HIGH, octet)
        directions = sub(high, low)
        _store(cones, AXIS, octet, scale(0.5, add(low, high)))
        cones[SPREAD + octet] = 0.5 * math.sqrt(dot(directions, directions))
    for octet in range(lanes // OCTET):
        first, last = sheaf.origin, sheaf.origin
        if start_apart(sheaf):
            first, last = _load(cones, FIRST, octet), _load(cones, LAST, octet)
        starts = sub(last, first)
        _store(cones, START, octet, scale(0.5, add(first, last)))
        cones[WIDTH + octet] = 0.5 * math.sqrt(dot(starts, starts))


@device
def _bound_octets(packet: Packet, field: int, lanes: int, cones: Cones, to: int) -> None:
    """Set the least number of each octet, and three rows later the greatest."""
    for octet in range(lanes // OCTET):
        first = field + octet * OCTET
        # Infinite at first, so that what is not a number, and hits nothing, is no bound.
        low, high = math.inf, -math.inf
        for lane in range(first, first + OCTET):
            low, high = min(low, packet[lane]), max(high, packet[lane])
        cones[to + octet] = low
        cones[to + 3 * OCTETS + octet] = high


@device
def part_directions(cones: Cones, first: int, count: int) -> tuple[Vec, Vec]:
    """Return the least and the greatest components of the directions of some octets."""
    return _bound_part(cones, LOW, HIGH, first, count)


@device
def part_starts(cones: Cones, first: int, count: int, sheaf: Sheaf) -> tuple[Vec, Vec]:
    """Return the least and the greatest coordinates of the starts of some octets."""
    if not start_apart(sheaf):
        return sheaf.origin, sheaf.origin
    return _bound_part(cones, FIRST, LAST, first, count)


@device
def _bound_part(cones: Cones, least: int, greatest: int, begin: int, count: int) -> tuple[Vec, Vec]:
    low, high = _load(cones, least, begin), _load(cones, greatest, begin)
    for octet in range(begin + 1, begin + count):
        low, high = (
            lower(low, _load(cones, least, octet)),
            upper(high, _load(cones, greatest, octet)),
        )
    return low, high


@device
def farthest_of(cones: Cones, first: int, count: int) -> float:
    """Return the largest distance of the hits so far of some octets."""
    begin = first & (OCTETS - 1)
    far = 0.0
    for octet in range(begin, begin + count):
        far = max(far, cones[FARTHEST + octet])
    return far


@device
def find_farthest(
    packet: Packet, first: int, count: int, footprint: Footprint | None, cones: Cones
) -> None:
    """Find the largest distance in each of some octets at which hits so far leave some to find.

    That is where their rays hit; with a footprint, where all rays in it do, if they hit one shape.
    If they do not, they never will, whatever is farther away.
    """
    # Doubles ≥ 0 are in the order of their bits, and a maximum of integers can be vectorised.
    bits = integers(packet)
    for octet in range(first, first + count):
        far = 0
        begin = octet * OCTET & (LANES - 1)
        for lane in range(begin, begin + OCTET):
            far = max(far, bits[DISTANCE + lane])
        cones[FARTHEST + octet] = np.int64(far).view(np.float64)
        if has_width(footprint):
            farthest = 0.0
            for lane in range(begin, begin + OCTET):
                met, distance = packet[ALL_MET + lane], packet[DISTANCE + lane]
                farthest = max(farthest, met if met < packet[RIVAL + lane] else distance)
            cones[FARTHEST + octet] = farthest


@device
def ball_distance(center: Vec, radius: float, sheaf: Sheaf) -> float:
    """Return how far away a ball is at the least along any ray."""
    from_origin = sub(center, sheaf.origin)
    return max(math.sqrt(dot(from_origin, from_origin)) - sheaf.extent - radius, 0.0)


@device
def note_mixed(packet: Packet, lane: int, cones: Cones) -> None:
    """Note if all bundles of an octet, of this first lane, meet more than one shape or its edge."""
    begin = lane & (LANES - 1)
    count = 0
    for at in range(begin, begin + OCTET):
        met = packet[ALL_MET + at]
        is_mixed = (packet[NEAREST + at] < math.inf) & (not met < packet[RIVAL + at])
        count += 1 if is_mixed else 0
    cones[KNOWN + lane // OCTET] = 1.0 if count == OCTET else 0.0


@device
def is_known_mixed(cones: Cones, lane: int) -> bool:
    """Tell what `note_mixed` noted: nothing changes that but a shape that covers a whole bundle."""
    is_known: bool = cones[KNOWN + lane // OCTET] > 0.0
    return is_known


@device
def note_latest(packet: Packet, lane: int, cones: Cones) -> None:
    """Note where the last bundle of an octet, of this first lane, passes the image plane."""
    begin = lane & (LANES - 1)
    latest = 0.0
    for at in range(begin, begin + OCTET):
        latest = max(latest, packet[PASSED + at])
    cones[LATEST + lane // OCTET] = latest


@device
def latest_start(cones: Cones, lane: int) -> float:
    """Return what `note_latest` noted."""
    latest: float = cones[LATEST + lane // OCTET]
    return latest


@device
def octets_met(
    cones: Cones,
    first: int,
    count: int,
    sheaf: Sheaf,
    center: Vec,
    radius: float,
    footprint: Footprint | None,
) -> int:
    """Return a bit for each of some octets whose rays or footprints a ball may meet.

    Parameters
    ----------
    cones
        The cones of a packet.
    first, count
        The first of the octets, and how many there are.
    sheaf
        What all rays have in common.
    center, radius
        The ball around a shape, its radius widened by a margin for rounding.
    footprint
        That of all rays.
    """
    from_origin = sub(center, sheaf.origin)
    reach = math.sqrt(dot(from_origin, from_origin)) + sheaf.extent
    radius += reach_at(footprint, reach + radius)
    # The mask tells the compiler that no index is negative.
    begin = first & (OCTETS - 1)
    met = 0
    for k in range(count):
        octet = begin + k
        start, axis = sub(center, _load(cones, START, octet)), _load(cones, AXIS, octet)
        moment = cross(start, axis)
        limit = radius + cones[WIDTH + octet] + reach * cones[SPREAD + octet]
        beside = dot(moment, moment) > limit * limit
        behind = dot(start, axis) - limit > cones[FARTHEST + octet]
        met |= 0 if beside | behind else 1 << k
    return met


@device
def _load(cones: Cones, row: int, octet: int) -> Vec:
    return cones[row + octet], cones[row + OCTETS + octet], cones[row + 2 * OCTETS + octet]


@device
def _store(cones: Cones, row: int, octet: int, vector: Vec) -> None:
    cones[row + octet] = vector[0]
    cones[row + OCTETS + octet] = vector[1]
    cones[row + 2 * OCTETS + octet] = vector[2]
