"""A packet: the rays of one block of pixels, side by side in one scratch array.

Each quantity has a row of ``LANES`` numbers, one per ray, so that a loop over the lanes reads and
writes runs of memory that the compiler can turn into vector instructions. All rows live in one flat
array at distances known at compile time: with an array for each, the compiler could not tell that
they do not overlap, and would not vectorise.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec

BLOCK = 16
"""Side of a block in pixels."""

LANES = BLOCK * BLOCK
"""Rays in a packet: one per pixel of its block."""

GROUP = 8
"""Lanes that one vector instruction handles: rays near each other."""

PART = 8 * GROUP
"""Lanes that go through the hierarchy as one beam."""

# Rows of one number a lane; a vector takes three rows.
DIRECTION = 0 * LANES
FORWARD = 3 * LANES  # the ray's direction along the camera's normal
DISTANCE = 4 * LANES
PRIMITIVE = 5 * LANES  # the number of what is hit, which decides between equal distances
SOURCE = 6 * LANES  # of a hit: the lane of its ray
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
OFFSET = 25 * LANES  # where the ray starts, minus the eye
COLUMN = 28 * LANES  # the place in the image that the ray goes through, in pixels
ROW = 29 * LANES
WEIGHT = 30 * LANES  # what the ray counts for its pixel
LIGHT = 31 * LANES  # the light along the ray; in the rows before, hits have moved to the front
SHADOWS = 34 * LANES  # a number for the lights that something blocks
RIM = 35 * LANES  # the distance of the nearest outline that passes near the ray
KEPT = 36 * LANES  # the place of what is kept of the ray
ROWS = 37

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
