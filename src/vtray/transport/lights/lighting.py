"""What a light adds to the hits of a packet."""

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.occlusion import Bounds, Target, height_range
from vtray.geometry.packets.packet import (
    BLOCKED,
    COLOR,
    ERROR_SCALE,
    LAMBERT,
    NORMAL,
    POINT,
    VALUE,
    Packet,
    load,
    store,
)
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.vector import add, sub
from vtray.transport.materials.lambert import cosine_of, is_above
from vtray.transport.materials.material import Material, Power, scattered


@device
def find_facing(packet: Packet, hits: int, bounds: Bounds, target: Target) -> int:
    """Set field ``BLOCKED`` for a light, if any point faces it; return how many do.

    What faces away counts as blocked, so that no shadow ray is cast from there.
    """
    least, most = height_range(bounds, target.place)
    if most <= 0.0:
        return 0
    # Rounding keeps the order of numbers: what holds at the bounds holds for each point. Along some
    # axis the light is at least half as far as it is high, so its distance has a square, too.
    error_bound = ROUNDING * (bounds.error_scale + target.error_scale)
    half = 0.5 * least
    if (least > error_bound) & (half * half > 0.0):
        for lane in range(hits):
            packet[BLOCKED + lane] = 0.0
        return hits
    facing = 0
    for lane in range(hits):
        above = _is_lane_above(packet, lane, target)
        packet[BLOCKED + lane] = 0.0 if above else 1.0
        facing += 1 if above else 0
    return facing


@device
def _is_lane_above(packet: Packet, lane: int, target: Target) -> bool:
    """Tell whether a light is above the horizon of a point of a packet."""
    error_bound = ROUNDING * (packet[ERROR_SCALE + lane] + target.error_scale)
    to_light = sub(target.place, load(packet, POINT, lane))
    return is_above(load(packet, NORMAL, lane), to_light, error_bound)


@device
def arriving_cosine(packet: Packet, lane: int, target: Target) -> float:
    """Return the cosine of a light for a point of a packet, 0 if it is blocked.

    Of light that is blocked in part, only the rest counts.
    """
    to_light = sub(target.place, load(packet, POINT, lane))
    cosine, blocked = cosine_of(load(packet, NORMAL, lane), to_light), packet[BLOCKED + lane]
    return cosine * (1.0 - blocked) if blocked < 1.0 else 0.0


@device
def add_light(packet: Packet, hits: int, target: Target, power: Power) -> None:
    """Add a light to the points of a packet that it reaches.

    The root and the division of the cosine cost more than all else: packets in the dark go without.
    """
    for lane in range(hits):
        cosine = arriving_cosine(packet, lane, target)
        material = Material(load(packet, COLOR, lane), packet[LAMBERT + lane])
        added = scattered(material, cosine, power)
        store(packet, VALUE, lane, add(load(packet, VALUE, lane), added))
