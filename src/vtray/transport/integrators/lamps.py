"""Lamps that the camera sees, in the rays of a packet."""

import numpy as np

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    DISTANCE,
    LIGHT,
    NO_PRIMITIVE,
    PRIMITIVE,
    RIM,
    Packet,
    Sheaf,
    load_ray,
    store,
)
from vtray.geometry.queries import NOTHING
from vtray.geometry.ray import Footprint, Ray, has_width
from vtray.transport.film import Rows
from vtray.transport.lights.light import Lights, lamp_light, lamp_number
from vtray.transport.lights.visible import VisibleLamps, lamp_count, lamp_distance, lamp_outline


@device
def see_lamps(
    packet: Packet,
    lanes: int,
    sheaf: Sheaf,
    footprint: Footprint,
    lights: Lights,
    lamps: VisibleLamps | None,
    linear: Rows,
) -> None:
    """Let lamps take the lanes in which they are nearer than the hits so far.

    A lamp in a surface, as near as rounding can tell, is before it.

    Parameters
    ----------
    packet, lanes
        The rays of so many lanes. In field ``PRIMITIVE`` lamps have numbers below those of all
        else, and ``LIGHT`` is set for them.
    sheaf, footprint
        What the rays have in common.
    lights, lamps
        All lights, and those that are seen; None if there are none.
    linear
        Not None if it is wanted what light there is along the rays.
    """
    # Arguments that are None are known to the compiler, which drops what depends on them alone.
    if lamps is not None:  # noqa: SIM102
        if linear is not None:
            for k in range(lamp_count(lamps)):
                _see_lamp(packet, lanes, sheaf, footprint, lights, lamps, k)


@device
def _see_lamp(
    packet: Packet,
    lanes: int,
    sheaf: Sheaf,
    footprint: Footprint,
    lights: Lights,
    lamps: VisibleLamps,
    k: int,
) -> None:
    """Let a lamp take the lanes in which it is nearer."""
    numbers = packet.view(np.int64)
    light = lamp_light(lights, lamps.row[k])
    for lane in range(lanes):
        ray = load_ray(packet, sheaf, lane)
        distance, error_bound = lamp_distance(lamps, k, ray)
        is_lamp = numbers[PRIMITIVE + lane] < NO_PRIMITIVE
        if distance < packet[DISTANCE + lane] + (0.0 if is_lamp else error_bound):
            packet[DISTANCE + lane] = distance
            numbers[PRIMITIVE + lane] = lamp_number(lamps.row[k])
            store(packet, LIGHT, lane, light)
        if has_width(footprint):
            packet[RIM + lane] = min(packet[RIM + lane], lamp_outline(lamps, k, ray, footprint))


@device
def nearest_lamp(ray: Ray, distance: float, lamps: VisibleLamps | None) -> tuple[int, float]:
    """Return the row of the lamp that a ray meets before a surface, and how far away it is.

    That is ``NOTHING``, and the distance of the surface, if it meets none.
    """
    found = NOTHING
    if lamps is not None:
        for k in range(lamp_count(lamps)):
            at, error_bound = lamp_distance(lamps, k, ray)
            if at < distance + (error_bound if found == NOTHING else 0.0):
                found, distance = lamps.row[k], at
    return found, distance
