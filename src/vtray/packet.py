"""A packet: the rays of one block of pixels, side by side in one scratch array.

Each quantity has a row of ``LANES`` numbers, one per ray, so that a loop over the lanes reads and
writes runs of memory that the compiler can turn into vector instructions. All rows live in one flat
array at distances known at compile time: with an array for each, the compiler could not tell that
they do not overlap, and would not vectorise.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.compiled import device
from vtray.vector import Vec

BLOCK = 16
"""Side of a block in pixels."""

LANES = BLOCK * BLOCK
"""Rays in a packet: one per pixel of its block."""

PART = 8
"""Lanes that one vector instruction handles, and the side of a part of a block."""

# Rows of one number a lane; a vector takes three rows.
DIRECTION = 0 * LANES
FORWARD = 3 * LANES  # the ray's direction along the camera's normal
DISTANCE = 4 * LANES
PRIMITIVE = 5 * LANES  # the number of what is hit, which decides between equal distances
PIXEL = 6 * LANES
POINT = 7 * LANES
DEPTH = 10 * LANES  # the point's distance in front of the image plane
NORMAL = 11 * LANES
MAGNITUDE = 14 * LANES  # what the point's rounding error is relative to
LAMBERT = 15 * LANES
COLOR = 16 * LANES
VALUE = 19 * LANES
BLOCKED = 22 * LANES
COSINE = 23 * LANES
SLOT = 24 * LANES  # where the arrays have what is hit
ROWS = 25

NO_PRIMITIVE = -1.0
"""In row ``PRIMITIVE``: the ray hits nothing. (A double as all rows: lanes stay equally wide.)"""

Packet = NDArray[np.float64]


class Block(NamedTuple):
    """A rectangle of pixels, at most ``BLOCK`` wide and high, traced as one packet."""

    left: int
    top: int
    width: int
    height: int


def new_packet() -> Packet:
    """Return a packet for one thread."""
    return np.zeros(ROWS * LANES)


@device
def load(packet: Packet, row: int, lane: int) -> Vec:
    """Return a lane's vector."""
    return packet[row + lane], packet[row + LANES + lane], packet[row + 2 * LANES + lane]


@device
def store(packet: Packet, row: int, lane: int, vector: Vec) -> None:
    """Set a lane's vector."""
    packet[row + lane] = vector[0]
    packet[row + LANES + lane] = vector[1]
    packet[row + 2 * LANES + lane] = vector[2]
