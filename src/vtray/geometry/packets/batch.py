"""Batches: hits near each other on one surface, whose fans go through hierarchies together.

What comes of a fan does not depend on which others go with it; only the time does that it takes.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.fan import FAN, Spot, Start, spot_at
from vtray.geometry.packets.packet import (
    COLUMN,
    ERROR_SCALE,
    LANES,
    NORMAL,
    PLANE_DEPTH,
    POINT,
    PRIMITIVE,
    ROW,
    SOURCE,
    TOWARDS,
    Packet,
    integers,
    load,
)
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import add, dot, scale, sub

APART = 1.6
"""So many pixels are between the hits of a batch and its first at the most, each way."""

STEEP = 4.0
"""So many times as far as they are beside each other, one may be behind the other."""

AKIN = 0.95
"""The least cosine between their normals. On smaller balls rays are sooner done alone."""

SLACK = 1.0 + 2.0**-40
"""More than what lengths lose by rounding."""

WIDER = 1.0 + 2.0**-10
"""More than what rounding may have taken from lengths beside those of the scene."""


class Batch(NamedTuple):
    """The hits of a batch.

    Attributes
    ----------
    is_taken
        Whether a hit of the packet was in a batch before, (``LANES``,).
    hit
        The hits, at most ``FAN``.
    active
        The numbers of those in the batch that cast a fan at a time.
    spent
        What the lights so far have of the variance that all may have.
    estimate
        What is known of a light at each, ``ESTIMATE`` numbers.
    """

    is_taken: NDArray[np.bool_]
    hit: NDArray[np.int64]
    active: NDArray[np.int64]
    spent: NDArray[np.float64]
    estimate: NDArray[np.float64]


ESTIMATE = 8
"""Numbers of an estimate."""


def new_batch() -> Batch:
    """Return the batch of one thread."""
    return Batch(
        np.zeros(LANES, np.bool_),
        np.zeros(FAN, np.int64),
        np.zeros(FAN, np.int64),
        np.zeros(FAN),
        np.zeros(ESTIMATE * FAN),
    )


@device
def take_near(packet: Packet, hits: int, first: int, most: int, apart: float, batch: Batch) -> int:
    """Take a hit, and those after it that are near it, into a batch; return how many they are.

    Parameters
    ----------
    packet, hits, first
        The hits, and the number of the first.
    most, apart
        How many a batch has at the most, and how many pixels are between them and the first one.
    batch
        Out: the batch. What is taken already stays out of it.
    """
    batch.hit[0], count = first, 1
    for hit in range(first + 1, hits):
        if count == most:
            break
        if not batch.is_taken[hit] and _are_near(packet, first, hit, apart):
            batch.is_taken[hit] = True
            batch.hit[count] = hit
            count += 1
    return count


@device
def _are_near(packet: Packet, one: int, other: int, apart: float) -> bool:
    """Tell whether two hits are near each other, on one surface."""
    numbers = integers(packet)
    lane, beside = numbers[SOURCE + one], numbers[SOURCE + other]
    if numbers[PRIMITIVE + lane] != numbers[PRIMITIVE + beside]:
        return False
    across = abs(packet[COLUMN + lane] - packet[COLUMN + beside])
    down = abs(packet[ROW + lane] - packet[ROW + beside])
    way = sub(load(packet, POINT, other), load(packet, POINT, one))
    along = dot(way, load(packet, TOWARDS, one))
    is_flat = (1.0 + STEEP * STEEP) * along * along <= STEEP * STEEP * dot(way, way)
    cosine = dot(load(packet, NORMAL, one), load(packet, NORMAL, other))
    are_near: bool = (max(across, down) <= apart) & is_flat & (cosine >= AKIN)
    return are_near


@device
def start_of(packet: Packet, hit: int) -> Start:
    """Return where rays from a hit start."""
    return Start(load(packet, POINT, hit), packet[PLANE_DEPTH + hit], packet[ERROR_SCALE + hit])


@device
def spot_of(packet: Packet, batch: Batch, count: int) -> Spot:
    """Return the spot from which the rays of the active hits of a batch start, so many."""
    first = batch.hit[batch.active[0]]
    start, normal = start_of(packet, first), load(packet, NORMAL, first)
    if count == 1:
        return spot_at(start, normal)
    middle, error_scale = start.point, start.error_scale
    for k in range(1, count):
        point = load(packet, POINT, batch.hit[batch.active[k]])
        # The mean of all so far.
        middle = add(middle, scale(1.0 / (k + 1), sub(point, middle)))
    extent2, tilt2, sunk = 0.0, 0.0, 0.0
    for k in range(count):
        hit = batch.hit[batch.active[k]]
        away = sub(load(packet, POINT, hit), middle)
        turn = sub(load(packet, NORMAL, hit), normal)
        extent2, tilt2 = max(extent2, dot(away, away)), max(tilt2, dot(turn, turn))
        sunk = max(sunk, -dot(away, load(packet, NORMAL, hit)))
        error_scale = max(error_scale, packet[ERROR_SCALE + hit])
    extent, tilt = SLACK * math.sqrt(extent2), SLACK * math.sqrt(tilt2)
    return Spot(Start(middle, start.plane_depth, error_scale), extent, normal, tilt, SLACK * sunk)


@device
def wider_spot(spot: Spot, reach: float) -> Spot:
    """Return what holds all points within a reach of those of a spot, whatever rounding does."""
    extent = WIDER * (spot.extent + reach) + MARGIN * spot.start.error_scale
    return Spot(spot.start, extent, spot.normal, spot.tilt, spot.sunk)
