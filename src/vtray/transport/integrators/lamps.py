"""Lamps that the camera sees, in the rays of a packet."""

import math

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    DISTANCE,
    LIGHT,
    MIXED,
    NEAREST,
    NO_PRIMITIVE,
    PRIMITIVE,
    Packet,
    Sheaf,
    integers,
    load_ray,
    store,
)
from vtray.geometry.queries import NOTHING
from vtray.geometry.ray import Footprint, Ray
from vtray.transport.film import Rows
from vtray.transport.lights.light import Lights, lamp_light, lamp_number
from vtray.transport.lights.visible import VisibleLamps, lamp_count, lamp_distance, lamp_outline


@device
def see_lamps(
    packet: Packet,
    lanes: int,
    sheaf: Sheaf,
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
    sheaf
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
                _see_lamp(packet, lanes, sheaf, lights, lamps, k)


@device
def _see_lamp(
    packet: Packet,
    lanes: int,
    sheaf: Sheaf,
    lights: Lights,
    lamps: VisibleLamps,
    k: int,
) -> None:
    """Let a lamp take the lanes in which it is nearer."""
    numbers = integers(packet)
    light = lamp_light(lights, lamps.row[k])
    for lane in range(lanes):
        ray = load_ray(packet, sheaf, lane)
        distance, error_bound = lamp_distance(lamps, k, ray)
        is_lamp = numbers[PRIMITIVE + lane] < NO_PRIMITIVE
        if distance < packet[DISTANCE + lane] + (0.0 if is_lamp else error_bound):
            packet[DISTANCE + lane] = distance
            numbers[PRIMITIVE + lane] = lamp_number(lamps.row[k])
            store(packet, LIGHT, lane, light)


@device
def mix_lamps(
    packet: Packet,
    lanes: int,
    sheaf: Sheaf,
    footprint: Footprint | None,
    lamps: VisibleLamps | None,
) -> None:
    """Set field ``MIXED`` where a lamp is seen: 1 if its outline passes near, or a surface before.

    Elsewhere, it is set where the outline of a lamp passes before what is hit.
    """
    if lamps is not None:  # noqa: SIM102
        if footprint is not None:
            for lane in range(lanes):
                _mix_lane(packet, lane, sheaf, footprint, lamps)


@device
def _mix_lane(
    packet: Packet, lane: int, sheaf: Sheaf, footprint: Footprint, lamps: VisibleLamps
) -> None:
    """Set field ``MIXED`` for one lane."""
    ray, distance = load_ray(packet, sheaf, lane), packet[DISTANCE + lane]
    met = integers(packet)[PRIMITIVE + lane]
    if met < NO_PRIMITIVE:
        packet[MIXED + lane] = 1.0 if packet[NEAREST + lane] <= distance else 0.0
    for k in range(lamp_count(lamps)):
        outline = lamp_outline(lamps, k, ray, footprint)
        is_own = lamp_number(lamps.row[k]) == met
        if outline < math.inf and (is_own or outline <= distance):
            packet[MIXED + lane] = 1.0


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


@device
def lamp_beyond(ray: Ray, distance: float, lamps: VisibleLamps | None) -> tuple[int, float]:
    """Return the lamp that a ray from a surface meets, as `nearest_lamp` does for the camera's.

    Lamps behind the image plane count: their light falls on what is before it.
    """
    everywhere = Ray(ray.origin, ray.direction, math.inf, 0.0, ray.error_scale, ray.error_bound)
    return nearest_lamp(everywhere, distance, lamps)
