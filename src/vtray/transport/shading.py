"""What a light adds to a point: Lambert's cosine law, without fall-off."""

import math

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.occlusion import light_reach
from vtray.geometry.packets.packet import (
    BLOCKED,
    COLOR,
    COSINE,
    LAMBERT,
    MAGNITUDE,
    NORMAL,
    POINT,
    SHADOWS,
    VALUE,
    Packet,
    load,
    store,
)
from vtray.geometry.vector import Vec, add, dot, pick, scale, sub
from vtray.geometry.world import Lights

MANTISSA = 53
"""Bits of a double that can stand for a light each."""


@device
def lambert_cosine(normal: Vec, to_light: Vec, reach: float) -> float:
    """Return the cosine of the angle between normal and light, 0 for a light below the horizon.

    Parameters
    ----------
    normal
        The surface's unit normal.
    to_light
        The light's place minus the point.
    reach
        How far rounding may have moved the point or the light: one no higher than that is on the
        horizon.
    """
    height = dot(normal, to_light)
    length2 = dot(to_light, to_light)
    # The square is 0 for a light that is nearer than 1e-300 of the scene's size.
    return height / math.sqrt(length2) if (height > reach) & (length2 > 0.0) else 0.0


@device
def find_cosines(packet: Packet, hits: int, lights: Lights, light: int) -> int:
    """Set rows ``COSINE`` and ``BLOCKED`` for a light; return how many points face it.

    What faces away counts as blocked, so that no shadow ray is cast from there.
    """
    place = pick(lights, light)
    facing = 0
    for lane in range(hits):
        to_light = sub(place, load(packet, POINT, lane))
        reach = light_reach(lights, light, packet[MAGNITUDE + lane])
        cosine = lambert_cosine(load(packet, NORMAL, lane), to_light, reach)
        packet[COSINE + lane] = cosine
        packet[BLOCKED + lane] = 0.0 if cosine > 0.0 else 1.0
        facing += 1 if cosine > 0.0 else 0
    return facing


@device
def add_light(packet: Packet, hits: int, lights: Lights, light: int) -> None:
    """Add a light to the points of a packet that it reaches."""
    intensity = lights.intensity[light]
    for lane in range(hits):
        cosine = packet[COSINE + lane] if packet[BLOCKED + lane] == 0.0 else 0.0
        strength = cosine * packet[LAMBERT + lane] * intensity
        added = scale(strength, load(packet, COLOR, lane))
        store(packet, VALUE, lane, add(load(packet, VALUE, lane), added))


@device
def clear_shadows(packet: Packet, hits: int) -> None:
    """Start with no light blocked."""
    for lane in range(hits):
        packet[SHADOWS + lane] = 0.0


@device
def note_shadows(packet: Packet, hits: int, light: int) -> None:
    """Add a number of a light's own in row ``SHADOWS`` where something blocks it."""
    bit = float(1 << light % MANTISSA)
    for lane in range(hits):
        blocked = (packet[BLOCKED + lane] != 0.0) & (packet[COSINE + lane] > 0.0)
        packet[SHADOWS + lane] += bit if blocked else 0.0
