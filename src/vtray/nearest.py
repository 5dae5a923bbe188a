"""The nearest hit of each ray of a packet."""

import math

from vtray.camera import CameraFrame
from vtray.compiled import device
from vtray.packet import (
    DIRECTION,
    DISTANCE,
    FORWARD,
    LANES,
    NO_PRIMITIVE,
    PART,
    PRIMITIVE,
    SLOT,
    Packet,
    load,
)
from vtray.plane import intersect_plane
from vtray.rounding import ROUNDING
from vtray.scene_arrays import Planes
from vtray.sphere import intersect_sphere
from vtray.sphere_arrays import SphereArrays, sphere_center, sphere_radius
from vtray.vector import Vec, dot, pick, sub


@device
def sphere_distance(
    eye_from_center: Vec, direction: Vec, radius: float, forward: float, focus: float
) -> float:
    """Return the distance to the first point of a sphere in front of the image plane, or inf."""
    near, far = intersect_sphere(eye_from_center, direction, radius)
    if near * forward - focus > ROUNDING * (abs(near) + focus):
        return near
    if far * forward - focus > ROUNDING * (abs(far) + focus):
        return far
    return math.inf


@device
def plane_distance(
    height: float, descent: float, forward: float, focus: float, magnitude: float
) -> float:
    """Return the distance to a plane if the hit is in front of the image plane, otherwise inf.

    A small `descent` magnifies the error of the distance, so the bound is divided by it; that also
    ends the plane where, towards its horizon, rounding would decide what is hit.
    """
    distance = intersect_plane(height, descent)
    depth = distance * forward - focus
    seen = depth * abs(descent) > ROUNDING * (magnitude + focus + abs(distance))
    return distance if seen else math.inf


@device
def clear_hits(packet: Packet) -> None:
    """Start with no hit in any lane."""
    for lane in range(LANES):
        packet[DISTANCE + lane] = math.inf
        packet[PRIMITIVE + lane] = NO_PRIMITIVE


@device
def nearest_sphere(
    packet: Packet, first: int, camera: CameraFrame, spheres: SphereArrays, slot: int
) -> None:
    """Let a sphere take those of eight lanes in which it is nearer than the hit so far."""
    from_center = sub(camera.eye, sphere_center(spheres, slot))
    radius = sphere_radius(spheres, slot)
    number = spheres.number[slot]
    # The mask tells the compiler that no index is negative.
    begin = first & (LANES - 1)
    for lane in range(begin, begin + PART):
        direction = load(packet, DIRECTION, lane)
        forward = packet[FORWARD + lane]
        distance = sphere_distance(from_center, direction, radius, forward, camera.focus)
        _take_nearer(packet, lane, distance, number, slot)


@device
def nearest_plane(
    packet: Packet, camera: CameraFrame, planes: Planes, plane: int, number: int
) -> None:
    """Let a plane take the lanes in which it is nearer than the hit so far."""
    normal = pick(planes, plane)
    height = planes.height[plane]
    magnitude = planes.magnitude[plane]
    for lane in range(LANES):
        descent = dot(load(packet, DIRECTION, lane), normal)
        forward = packet[FORWARD + lane]
        distance = plane_distance(height, descent, forward, camera.focus, magnitude)
        _take_nearer(packet, lane, distance, number, plane)


@device
def _take_nearer(packet: Packet, lane: int, distance: float, number: int, slot: int) -> None:
    """Keep the nearer of two hits; of two at the same distance, that with the lower number."""
    best = packet[DISTANCE + lane]
    nearer = (distance < best) | ((distance == best) & (number < packet[PRIMITIVE + lane]))
    packet[DISTANCE + lane] = distance if nearer else packet[DISTANCE + lane]
    packet[PRIMITIVE + lane] = number if nearer else packet[PRIMITIVE + lane]
    packet[SLOT + lane] = slot if nearer else packet[SLOT + lane]
