"""Cones around groups of rays, which tell for eight groups at once which a sphere may meet.

The line of the ray from ``o`` along the unit vector ``d`` passes a centre ``c`` at the distance
``|(c - o) x d|``. For another start ``p`` and any vector ``a`` that is at least
``|(c - p) x a| - |o - p| - |c - o| * |d - a|``: so one start and one axis speak for a group of
rays, from any camera.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import DIRECTION, DISTANCE, GROUP, LANES, OFFSET, Packet
from vtray.geometry.vector import Vec, add, cross, dot, lower, scale, sub, upper

GROUPS = LANES // GROUP

# Rows of one number a group; a vector takes three rows.
AXIS = 0 * GROUPS
START = 3 * GROUPS  # relative to the eye
SPREAD = 6 * GROUPS  # how far directions are from the axis at the most
WIDTH = 7 * GROUPS  # how far starts are from that of the cone at the most
LOW = 8 * GROUPS  # the least and the greatest components of the directions
HIGH = 11 * GROUPS
NEAR = 14 * GROUPS  # the least and the greatest components of the starts
FAR = 17 * GROUPS
FARTHEST = 20 * GROUPS  # the largest distance of the hits so far
ROWS = 21

Cones = NDArray[np.float64]


def new_cones() -> Cones:
    """Return the cones of a packet."""
    return np.zeros(ROWS * GROUPS)


class Footprint(NamedTuple):
    """How wide the part of the scene is around a ray that its pixel is made of.

    Attributes
    ----------
    width
        At the start of the ray.
    growth
        By how much it grows with each unit of length along the ray.
    """

    width: float
    growth: float


@device
def has_width(footprint: Footprint) -> bool:
    """Tell whether a footprint is more than the ray itself."""
    return (footprint.width > 0.0) | (footprint.growth > 0.0)


@device
def width_at(footprint: Footprint, distance: float) -> float:
    """Return how far from a ray its pixel's part of the scene reaches at a distance."""
    return footprint.width + footprint.growth * distance


@device
def find_cones(packet: Packet, lanes: int, shifted: bool, cones: Cones) -> None:
    """Find the cones of the groups of so many lanes; if not `shifted`, all start at the eye."""
    for axis in range(3):
        _bound_groups(packet, DIRECTION + axis * LANES, lanes, cones, LOW + axis * GROUPS)
        if shifted:
            _bound_groups(packet, OFFSET + axis * LANES, lanes, cones, NEAR + axis * GROUPS)
    for group in range(lanes // GROUP):
        low, high = _load(cones, LOW, group), _load(cones, HIGH, group)
        near, far = _load(cones, NEAR, group), _load(cones, FAR, group)
        _store(cones, AXIS, group, scale(0.5, add(low, high)))
        _store(cones, START, group, scale(0.5, add(near, far)))
        directions, starts = sub(high, low), sub(far, near)
        cones[SPREAD + group] = 0.5 * math.sqrt(dot(directions, directions))
        cones[WIDTH + group] = 0.5 * math.sqrt(dot(starts, starts))


@device
def _bound_groups(packet: Packet, row: int, lanes: int, cones: Cones, to: int) -> None:
    """Set the least number of each group, and three rows later the greatest."""
    for group in range(lanes // GROUP):
        first = row + group * GROUP
        # Infinite at first, so that what is not a number, and hits nothing, is no bound.
        low, high = math.inf, -math.inf
        for lane in range(first, first + GROUP):
            low, high = min(low, packet[lane]), max(high, packet[lane])
        cones[to + group] = low
        cones[to + 3 * GROUPS + group] = high


@device
def part_directions(cones: Cones, first: int, count: int) -> tuple[Vec, Vec]:
    """Return the least and the greatest components of the directions of some groups."""
    return _bound_part(cones, LOW, HIGH, first, count)


@device
def part_starts(cones: Cones, first: int, count: int) -> tuple[Vec, Vec]:
    """Return the least and the greatest components of the starts of some groups, minus the eye."""
    return _bound_part(cones, NEAR, FAR, first, count)


@device
def _bound_part(cones: Cones, least: int, greatest: int, begin: int, count: int) -> tuple[Vec, Vec]:
    low, high = _load(cones, least, begin), _load(cones, greatest, begin)
    for group in range(begin + 1, begin + count):
        low, high = (
            lower(low, _load(cones, least, group)),
            upper(high, _load(cones, greatest, group)),
        )
    return low, high


@device
def farthest_of(cones: Cones, first: int, count: int) -> float:
    """Return the largest distance of the hits so far of some groups."""
    begin = first & (GROUPS - 1)
    far = 0.0
    for group in range(begin, begin + count):
        far = max(far, cones[FARTHEST + group])
    return far


@device
def find_farthest(packet: Packet, first: int, count: int, cones: Cones) -> None:
    """Find the largest distance of the hits so far in each of some groups."""
    for group in range(first, first + count):
        # Doubles ≥ 0 are in the order of their bits, and a maximum of integers can be vectorised.
        bits = packet.view(np.int64)
        far = 0
        begin = group * GROUP & (LANES - 1)
        for lane in range(begin, begin + GROUP):
            far = max(far, bits[DISTANCE + lane])
        cones[FARTHEST + group] = np.int64(far).view(np.float64)


@device
def groups_met(
    cones: Cones, first: int, count: int, from_eye: Vec, radius: float, footprint: Footprint
) -> int:
    """Return a bit for each of some groups whose rays or footprints a sphere may meet.

    Parameters
    ----------
    cones
        The cones of a packet.
    first, count
        The first of the groups, and how many there are.
    from_eye
        The sphere's centre minus the eye.
    radius
        The sphere's radius, widened by a margin for rounding.
    footprint
        That of all rays.
    """
    reach = math.sqrt(dot(from_eye, from_eye))
    radius += width_at(footprint, reach)
    # The mask tells the compiler that no index is negative.
    begin = first & (GROUPS - 1)
    met = 0
    for k in range(count):
        group = begin + k
        start, axis = sub(from_eye, _load(cones, START, group)), _load(cones, AXIS, group)
        moment = cross(start, axis)
        limit = radius + cones[WIDTH + group] + reach * cones[SPREAD + group]
        beside = dot(moment, moment) > limit * limit
        behind = dot(start, axis) - limit > cones[FARTHEST + group]
        met |= 0 if beside | behind else 1 << k
    return met


@device
def _load(cones: Cones, row: int, group: int) -> Vec:
    return cones[row + group], cones[row + GROUPS + group], cones[row + 2 * GROUPS + group]


@device
def _store(cones: Cones, row: int, group: int, vector: Vec) -> None:
    cones[row + group] = vector[0]
    cones[row + GROUPS + group] = vector[1]
    cones[row + 2 * GROUPS + group] = vector[2]
