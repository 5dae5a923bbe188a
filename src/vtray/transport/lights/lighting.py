"""What a light adds to the hits of a packet."""

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.packets.packet import (
    BLOCKED,
    COLOR,
    COSINE,
    ERROR_SCALE,
    LAMBERT,
    NORMAL,
    POINT,
    SHADOWS,
    VALUE,
    Packet,
    load,
    store,
)
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.vector import add, sub
from vtray.transport.materials.lambert import lambert_cosine
from vtray.transport.materials.material import Material, scattered

MANTISSA = 53
"""Bits of a double that can stand for a light each."""


@device
def find_cosines(packet: Packet, hits: int, target: Target) -> int:
    """Set fields ``COSINE`` and ``BLOCKED`` for a light; return how many points face it.

    What faces away counts as blocked, so that no shadow ray is cast from there.
    """
    facing = 0
    for lane in range(hits):
        to_light = sub(target.place, load(packet, POINT, lane))
        error_bound = ROUNDING * (packet[ERROR_SCALE + lane] + target.error_scale)
        cosine = lambert_cosine(load(packet, NORMAL, lane), to_light, error_bound)
        packet[COSINE + lane] = cosine
        packet[BLOCKED + lane] = 0.0 if cosine > 0.0 else 1.0
        facing += 1 if cosine > 0.0 else 0
    return facing


@device
def add_light(packet: Packet, hits: int, intensity: float) -> None:
    """Add a light to the points of a packet that it reaches."""
    for lane in range(hits):
        cosine = packet[COSINE + lane] if packet[BLOCKED + lane] == 0.0 else 0.0
        material = Material(load(packet, COLOR, lane), packet[LAMBERT + lane])
        added = scattered(material, cosine, intensity)
        store(packet, VALUE, lane, add(load(packet, VALUE, lane), added))


@device
def clear_shadows(packet: Packet, hits: int) -> None:
    """Start with no light blocked."""
    for lane in range(hits):
        packet[SHADOWS + lane] = 0.0


@device
def note_shadows(packet: Packet, hits: int, light: int) -> None:
    """Add a number of a light's own in field ``SHADOWS`` where something blocks it."""
    bit = float(1 << light % MANTISSA)
    for lane in range(hits):
        blocked = (packet[BLOCKED + lane] != 0.0) & (packet[COSINE + lane] > 0.0)
        packet[SHADOWS + lane] += bit if blocked else 0.0
