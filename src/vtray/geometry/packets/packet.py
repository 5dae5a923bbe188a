"""A packet: the rays of one block of pixels, side by side in one scratch array.

Each field has a number for each of ``LANES`` lanes, or three for a vector, so that a loop over the
lanes reads and writes runs of memory that the compiler can turn into vector instructions. All lie
in one flat array at distances known at compile time: with an array for each, the compiler could not
tell that they do not overlap, and would not vectorise. Integers lie in the same memory, seen as
such by `integers`.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, written_in_llvm
from vtray.geometry.ray import Ray
from vtray.geometry.vector import Vec

BLOCK = 16
"""Side of a block in pixels."""

LANES = BLOCK * BLOCK
"""Rays in a packet: one per pixel of its block."""

OCTET = 8
"""Lanes that one vector instruction handles: rays near each other."""

PART = 8 * OCTET
"""Lanes that go through the hierarchy as one beam."""


class _Fields:
    """Gives each field its place in the array."""

    def __init__(self) -> None:
        self.size = 0

    def scalar(self) -> int:
        """Return where a field of one number a lane begins."""
        self.size += LANES
        return self.size - LANES

    def vector(self) -> int:
        """Return where a field of a vector a lane begins."""
        self.size += 3 * LANES
        return self.size - 3 * LANES


_fields = _Fields()

# The rays, by their lanes.
DIRECTION = _fields.vector()
FORWARD = _fields.scalar()
"""As in `Ray`."""
ORIGIN = _fields.vector()
"""Where the ray starts, if not all start together."""
COLUMN = _fields.scalar()
ROW = _fields.scalar()
"""The place in the image that the ray goes through, in pixels."""
WEIGHT = _fields.scalar()
"""What the ray counts for its pixel."""
LENS_RIGHT = _fields.scalar()
LENS_DOWN = _fields.scalar()
"""The place in the lens that the ray goes through, in parts of its radius, if there is a lens."""
KEPT = _fields.scalar()
"""Integer: the place of what is kept of the ray."""

START_DEPTH = _fields.scalar()
START_SCALE = _fields.scalar()
START_BOUND = _fields.scalar()
"""``plane_depth``, ``error_scale`` and ``error_bound`` of the ray, if each has its own."""
THROUGHPUT = _fields.vector()
"""How much of the light along the ray is seen, where rays are followed over surfaces."""
BOUNCES = _fields.scalar()
"""Integer: how many surfaces lie between the ray and the camera."""
WITHIN = _fields.scalar()
"""Integer: the row of the material within which the ray goes, -1 for none."""

# What they meet, by the same lanes.
DISTANCE = _fields.scalar()
PRIMITIVE = _fields.scalar()
"""Integer: the number of what is hit, which decides between equal distances."""
SEEN = _fields.scalar()
"""Integer: the same, also for rays whose hit is left out as their pixel gets samples."""
MET = _fields.scalar()
"""Integer: where to find what is hit; see `join_met`."""
POWER = _fields.scalar()
"""The power of the point that is hit, as in `Verbs`, where clip planes cut anything."""
HALF = _fields.scalar()
"""Integer: ``SECOND`` where the second half of what is hit is, and ``CAP`` where a clip plane cuts
it; both where both are, and 0 where none is."""
NEAREST = _fields.scalar()
RIVAL = _fields.scalar()
"""Before that distance no ray of the lane's bundle meets anything, and before this one only one
shape."""
ALL_MET = _fields.scalar()
"""By that distance all its rays have met one same shape; infinite if that is not sure."""
PASSING = _fields.scalar()
PASSED = _fields.scalar()
"""From where to where they pass through the image plane."""
MIXED = _fields.scalar()
"""1 where the rays of the bundle may not all see the same, else 0."""
LIGHT = _fields.vector()
"""The light along the ray."""

# What is seen of layers of faded bodies, by the same lanes.
BEHIND = _fields.scalar()
BEHIND_DISTANCE = _fields.scalar()
BEHIND_MET = _fields.scalar()
"""``PRIMITIVE``, ``DISTANCE`` and ``MET`` of what is behind all layers."""
PASSED_LAYERS = _fields.scalar()
"""Integer: how many layers there are."""
NEXT_LAYER = _fields.scalar()
"""Integer: how many of those that are listed were seen."""
SHARE = _fields.scalar()
"""How much light passes from a layer to the start of the ray, times how opaque it is."""
GATHERED = _fields.vector()
VARIANCE = _fields.scalar()
"""The light of the layers so far, and its variance."""
FOGGED = _fields.scalar()
"""The share of what is seen that is fog."""
COVER = _fields.scalar()
"""The share of what is behind everything that does not get through."""

# The hits, from the first lane on.
SOURCE = _fields.scalar()
"""Integer: the lane of the hit's ray."""
TOWARDS = _fields.vector()
START = _fields.vector()
"""The direction of its ray, and the start, if not all start together."""
LENGTH = _fields.scalar()
"""The length of its ray."""
POINT = _fields.vector()
PLANE_DEPTH = _fields.scalar()
"""The point's distance in front of the image plane."""
NORMAL = _fields.vector()
"""The normal; before it is worked out, that of a flat surface, or what a curved one is round."""
CURVED = _fields.scalar()
"""1 where it is round, and 0 where it is flat."""
ERROR_SCALE = _fields.scalar()
"""What the point's rounding error is relative to."""
LAMBERT = _fields.scalar()
COLOR = _fields.vector()
VALUE = _fields.vector()
"""The light from the hit."""
NOISE = _fields.scalar()
"""The variance of that, which soft lights have."""

# How many fans soft lights have, where a pixel has samples.
UNLIT = _fields.vector()
"""The light from a hit before that of soft lights."""
COUNTED = _fields.scalar()
"""The variance of their first fans, as a part of what it may be, by the lanes."""
FANS = _fields.scalar()
"""Integer: how many each of them has, by the lanes."""

# Its shadow rays to one light.
BLOCKED = _fields.scalar()
"""The share of its light that something stops."""

# What tells whether the surface around a hit looks the same everywhere.
OWNER = _fields.scalar()
"""Integer: the number of what is hit."""
BEND = _fields.scalar()
"""One divided by the radius of the surface, 0 where it is flat."""
PATCH = _fields.scalar()
"""How wide the bundle is in which the part of the surface is seen that belongs to the pixel."""
STRETCH = _fields.scalar()
REACH = _fields.scalar()
"""How much wider that part is on the surface, and how far it reaches from the hit."""
AIM = _fields.vector()
AIM_LENGTH = _fields.scalar()
"""The unit direction to a light, and how far it is."""
IN_FRONT = _fields.scalar()
ALL_IN_FRONT = _fields.scalar()
"""How far any or all shadow rays from that part to the light are in front of the image plane."""
THICKEST = _fields.scalar()
"""The radius of the thickest solid where it may be wide enough to hide all of that part, else 0."""
UNEVEN = _fields.scalar()
"""1 where that part may not look the same everywhere, by what is known so far, else 0."""
TOUCHED = _fields.scalar()
"""1 where something may stand between any of it and the light, else 0."""
SETTLED = _fields.scalar()
"""What is known of that part and the light; see `patch`."""

# The light along the rays in orders, by the same lanes, if that is asked.
EMISSION = _fields.vector()
DIRECT = _fields.vector()
INDIRECT = _fields.vector()
"""What surfaces have scattered not at all, once, and more often: one field after the other."""

SIZE = _fields.size

NO_PRIMITIVE = -1
"""In field ``PRIMITIVE``: the ray hits nothing. Lower numbers are lamps, which are no surfaces."""

SECOND, CAP = 1, 2
"""In field ``HALF``."""

SLOT_BITS = 27
"""The low bits of an integer in field ``MET``, which say the slot; see `MAX_SPHERES`."""

Packet = NDArray[np.float64]


class Block(NamedTuple):
    """A rectangle of pixels, at most ``BLOCK`` wide and high, traced as one packet.

    Attributes
    ----------
    left, top
        Its first pixel in the image.
    width, height
        Its size.
    column, row
        Its first pixel on the film, which may be that of a part of the image.
    """

    left: int
    top: int
    width: int
    height: int
    column: int
    row: int


class Sheaf(NamedTuple):
    """What the rays of a packet have in common.

    Attributes
    ----------
    origin
        Where they start; if they start apart, the middle.
    extent
        How far from there they start at the most; where it is not 0, each starts at a place of its
        own, in field ``ORIGIN``.
    plane_depth, error_scale
        As in `Ray`.
    bounced
        None for most rays of a camera; else they come from surfaces, or there is no image plane,
        and they have all that is in `Ray` in fields of their own.
    """

    origin: Vec
    extent: float
    plane_depth: float
    error_scale: float
    bounced: bool | None = None


def new_packet() -> Packet:
    """Return a packet for one thread."""
    return np.zeros(SIZE)


@device
def start_apart(sheaf: Sheaf) -> bool:
    """Tell whether rays start side by side, as in an orthographic view, not all at one place."""
    # A field that is None is known to the compiler, which drops what depends on that alone.
    return True if sheaf.bounced is not None else sheaf.extent > 0.0


@written_in_llvm("vtray.geometry.packets.packet_in_llvm:write_integers")
def integers(packet: Packet) -> NDArray[np.int64]:
    """Return the memory of a packet as integers."""
    return packet.view(np.int64)


@device
def join_met(row: int, slot: int) -> int:
    """Return one integer for the row of a group and the slot of a shape."""
    return row << SLOT_BITS | slot


@device
def split_met(met: int) -> tuple[int, int]:
    """Return the row of a group and the slot of a shape."""
    return met >> SLOT_BITS, met & ((1 << SLOT_BITS) - 1)


@device
def load(packet: Packet, field: int, lane: int) -> Vec:
    """Return a lane's vector."""
    return packet[field + lane], packet[field + LANES + lane], packet[field + 2 * LANES + lane]


@device
def store(packet: Packet, field: int, lane: int, vector: Vec) -> None:
    """Set a lane's vector."""
    packet[field + lane] = vector[0]
    packet[field + LANES + lane] = vector[1]
    packet[field + 2 * LANES + lane] = vector[2]


@device
def has_own(sheaf: Sheaf) -> bool:
    """Tell whether rays have all that is in `Ray` in fields of their own."""
    return sheaf.bounced is not None


@device
def in_common(sheaf: Sheaf) -> Sheaf:
    """Return what rays have in common, for code that is told by itself which have their own."""
    return Sheaf(sheaf.origin, sheaf.extent, sheaf.plane_depth, sheaf.error_scale, None)


@device
def load_own_ray(packet: Packet, lane: int) -> Ray:
    """Return a lane's ray, all of which is in fields of its own."""
    return Ray(
        load(packet, ORIGIN, lane),
        load(packet, DIRECTION, lane),
        packet[START_DEPTH + lane],
        packet[FORWARD + lane],
        packet[START_SCALE + lane],
        packet[START_BOUND + lane],
    )


@device
def load_ray(packet: Packet, sheaf: Sheaf, lane: int) -> Ray:
    """Return a lane's ray, which starts exactly where it says."""
    if sheaf.bounced is not None:
        return load_own_ray(packet, lane)
    origin = load(packet, ORIGIN, lane) if start_apart(sheaf) else sheaf.origin
    return Ray(
        origin,
        load(packet, DIRECTION, lane),
        sheaf.plane_depth,
        packet[FORWARD + lane],
        sheaf.error_scale,
        0.0,
    )


@device
def store_ray(packet: Packet, lane: int, ray: Ray) -> None:
    """Set all that is known of a lane's ray, where each has its own."""
    store(packet, ORIGIN, lane, ray.origin)
    store(packet, DIRECTION, lane, ray.direction)
    packet[FORWARD + lane] = ray.forward
    packet[START_DEPTH + lane] = ray.plane_depth
    packet[START_SCALE + lane] = ray.error_scale
    packet[START_BOUND + lane] = ray.error_bound
