"""Which pixels need more than one ray.

A pixel gets samples unless it is sure that all of them would see the same as the ray through its
middle. All rays that its filter weighs are a bundle; the pixel needs no samples if

- one shape is in the way of all of them before any other, or nothing is in the way of any,
- the part of the surface that they see, a patch, is nearly flat,
- for each light, nothing stands between it and the patch, or one shape does everywhere, or the
  patch faces away everywhere.

Shapes and shadows are bounded, so nothing is missed, however small it is. Estimated is only what
changes smoothly: how much the light on a curved surface, near a lamp, at the horizon of a light or
in the half-shadow of a lamp differs from its value in the middle; the limits below say how much of
it is left. None of this depends on colours or on the strength of lights. The rays by which pixels
are chosen are not used in those that are: their samples are as unbiased as if all pixels had them.

References
----------
Kirk, Arvo, "Unbiased Sampling Techniques for Image Synthesis", SIGGRAPH 1991 (why not to use them);
Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984 (what a pixel sees as a bundle).
"""

import math

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.packets.packet import (
    AIM,
    AIM_LENGTH,
    ALL_IN_FRONT,
    BEND,
    IN_FRONT,
    LENGTH,
    MIXED,
    NO_PRIMITIVE,
    NORMAL,
    OWNER,
    PATCH,
    PLANE_DEPTH,
    POINT,
    PRIMITIVE,
    REACH,
    SEEN,
    SETTLED,
    SOURCE,
    STRETCH,
    THICKEST,
    TOUCHED,
    TOWARDS,
    UNEVEN,
    VALUE,
    Packet,
    integers,
    load,
    store,
)
from vtray.geometry.packets.patch import MIDDLE, NEAR_END, OPEN, UNEVEN_ALREADY, crossed_share
from vtray.geometry.ray import Footprint, growth_of, width_at
from vtray.geometry.vector import dot, scale, sub

ROUGHLY = 1.5
"""How much wider than in the middle a patch is taken: more than perspective and the curve of the
surface, within the limits below, make its far side."""

LIMIT_OF_BEND = 0.25
"""How much the normal may turn on a patch, times the cosine at which it is seen. The mean of the
light of one lamp then differs from that in the middle by less than 3 of 255."""

LIMIT_OF_SWAY = 1.0 / 32.0
"""How much the direction to a light, relative to the normal, may change where the light rises above
the horizon. The mean then differs from the middle by less than 2 of 255."""

NEARNESS = 32.0
"""A patch must be nearer to its middle than to a light by the root of this number. The mean of the
light then differs from that in the middle by less than 4 of 255."""


@device
def note_seen(packet: Packet, lanes: int) -> None:
    """Note what rays hit, before some of it is left out."""
    numbers = integers(packet)
    for lane in range(lanes):
        numbers[SEEN + lane] = numbers[PRIMITIVE + lane]


@device
def leave_mixed(packet: Packet, lanes: int) -> None:
    """Leave out what rays hit whose pixels get samples: it is not looked at."""
    numbers = integers(packet)
    for lane in range(lanes):
        if packet[MIXED + lane] != 0.0:
            numbers[PRIMITIVE + lane] = NO_PRIMITIVE


@device
def find_patches(packet: Packet, hits: int, footprint: Footprint | None, thickest: float) -> None:
    """Set the patches of the hits of a packet; `thickest` is the radius of the thickest solid."""
    numbers = integers(packet)
    for hit in range(hits):
        width = width_at(footprint, packet[LENGTH + hit])
        cosine = -dot(load(packet, TOWARDS, hit), load(packet, NORMAL, hit))
        is_bent = width * packet[BEND + hit] > LIMIT_OF_BEND * cosine * cosine
        # Towards its horizon, a plane's part of a pixel has no end.
        is_slanted = growth_of(footprint) > LIMIT_OF_BEND * cosine
        packet[PATCH + hit] = ROUGHLY * width
        packet[STRETCH + hit] = 1.0 / cosine
        packet[REACH + hit] = ROUGHLY * width / cosine
        packet[THICKEST + hit] = thickest if packet[REACH + hit] <= thickest else 0.0
        packet[UNEVEN + hit] = 1.0 if is_bent | is_slanted else 0.0
        numbers[OWNER + hit] = numbers[PRIMITIVE + numbers[SOURCE + hit]]


@device
def ask_of_light(packet: Packet, hits: int, target: Target) -> None:
    """Begin to ask what a light does on the patches of a packet: those that are near or turned."""
    for hit in range(hits):
        way = sub(target.place, load(packet, POINT, hit))
        length2, reach = dot(way, way), packet[REACH + hit]
        length = math.sqrt(length2)
        height = dot(load(packet, NORMAL, hit), way)
        # All of these are `length` times too large.
        sway = reach * (packet[BEND + hit] * length + 1.0)
        is_near = NEARNESS * reach * reach >= length2
        rises = (abs(height) < sway) & (sway > LIMIT_OF_SWAY * length)
        uneven = 1.0 if is_near | rises else packet[UNEVEN + hit]
        settled = MIDDLE if height < sway else OPEN
        packet[UNEVEN + hit] = uneven
        packet[SETTLED + hit] = UNEVEN_ALREADY if uneven != 0.0 else settled
        packet[TOUCHED + hit] = 0.0
        depth = packet[PLANE_DEPTH + hit]
        least, most = crossed_share(depth, reach, target.plane_depth)
        store(packet, AIM, hit, scale(1.0 / length, way))
        packet[AIM_LENGTH + hit] = length
        packet[IN_FRONT + hit] = NEAR_END * most * length
        packet[ALL_IN_FRONT + hit] = NEAR_END * least * length


@device
def mix_uneven(packet: Packet, hits: int) -> None:
    """Mark the lanes of hits whose patches may not look the same everywhere; their light is 0."""
    numbers = integers(packet)
    for hit in range(hits):
        if packet[UNEVEN + hit] != 0.0:
            packet[MIXED + numbers[SOURCE + hit]] = 1.0
            store(packet, VALUE, hit, (0.0, 0.0, 0.0))
