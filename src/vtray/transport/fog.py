"""Fog: how much of the light along a ray it hides, by how far that has gone.

Nothing is compiled where there is none: arguments that are None are known to the compiler, which
drops what depends on them alone.
"""

from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    DISTANCE,
    LENGTH,
    LIGHT,
    NO_PRIMITIVE,
    NOISE,
    PRIMITIVE,
    VALUE,
    Packet,
    integers,
    load,
    store,
)
from vtray.geometry.vector import scale


class FogFrame(NamedTuple):
    """Fog as kernels see it, lengths along camera rays in units of the arrays.

    Attributes
    ----------
    start
        Where it begins.
    length
        How far from there on nothing else is seen, > 0.
    """

    start: float
    length: float


@device
def fog_share(fog: FogFrame, distance: float) -> float:
    """Return how much of what is seen at a distance is fog, from 0 to 1."""
    return min(max((distance - fog.start) / fog.length, 0.0), 1.0)


@device
def lane_share(packet: Packet, lane: int, fog: FogFrame) -> float:
    """Return how much of what a ray meets is fog; 0 if it meets nothing."""
    if integers(packet)[PRIMITIVE + lane] == NO_PRIMITIVE:
        return 0.0
    return fog_share(fog, packet[DISTANCE + lane])


@device
def veil(
    packet: Packet, lanes: int, hits: int, linear: object, error: object, fog: FogFrame | None
) -> None:
    """Take from the light of hits and lamps what fog hides of it.

    Parameters
    ----------
    packet, lanes, hits
        The rays of so many lanes, and the hits of these.
    linear, error
        Not None if light is wanted, and how exact that is.
    fog
        The fog; None if there is none.
    """
    if linear is not None:  # noqa: SIM102
        if fog is not None:
            for hit in range(hits):
                clear = 1.0 - fog_share(fog, packet[LENGTH + hit])
                store(packet, VALUE, hit, scale(clear, load(packet, VALUE, hit)))
            numbers = integers(packet)
            for lane in range(lanes):
                if numbers[PRIMITIVE + lane] < NO_PRIMITIVE:
                    clear = 1.0 - lane_share(packet, lane, fog)
                    store(packet, LIGHT, lane, scale(clear, load(packet, LIGHT, lane)))
            _veil_noise(packet, hits, error, fog)


@device
def _veil_noise(packet: Packet, hits: int, error: object, fog: FogFrame) -> None:
    """Let the variance of light follow it."""
    if error is not None:
        for hit in range(hits):
            clear = 1.0 - fog_share(fog, packet[LENGTH + hit])
            packet[NOISE + hit] *= clear * clear
