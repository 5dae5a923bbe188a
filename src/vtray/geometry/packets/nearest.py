"""The nearest hit of each ray of a packet."""

import math

from vtray.base.compiler.compiled import device
from vtray.geometry.camera_rays import CameraFrame, is_shifted
from vtray.geometry.packets.packet import (
    DIRECTION,
    DISTANCE,
    FORWARD,
    GROUP,
    LANES,
    NO_PRIMITIVE,
    OFFSET,
    PRIMITIVE,
    RIM,
    SLOT,
    Packet,
    load,
)
from vtray.geometry.packets.ray_bounds import (
    Cones,
    Footprint,
    find_farthest,
    groups_met,
    has_width,
    width_at,
)
from vtray.geometry.packets.shaft import MARGIN
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.shapes.plane import intersect_plane
from vtray.geometry.shapes.sphere import intersect_sphere
from vtray.geometry.shapes.sphere_arrays import (
    SphereArrays,
    sphere_center,
    sphere_magnitude,
    sphere_radius,
)
from vtray.geometry.vector import Vec, add, dot, pick, scale, sub
from vtray.geometry.world import Planes


@device
def sphere_distance(
    eye_from_center: Vec,
    direction: Vec,
    radius: float,
    forward: float,
    focus: float,
    magnitude: float,
) -> float:
    """Return the distance to the first point of a sphere in front of the image plane, or inf."""
    near, far = intersect_sphere(eye_from_center, direction, radius)
    magnitude += focus
    if near * forward - focus > ROUNDING * (abs(near) + magnitude):
        return near
    if far * forward - focus > ROUNDING * (abs(far) + magnitude):
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
def clear_hits(packet: Packet, lanes: int) -> None:
    """Start with no hit in any lane."""
    for lane in range(lanes):
        packet[DISTANCE + lane] = math.inf
        packet[PRIMITIVE + lane] = NO_PRIMITIVE
        packet[RIM + lane] = math.inf


@device
def test_sphere(
    packet: Packet,
    first: int,
    count: int,
    camera: CameraFrame,
    spheres: SphereArrays,
    slot: int,
    cones: Cones,
    footprint: Footprint,
) -> None:
    """Test a sphere for those of some groups of a packet that it may meet."""
    place, radius = sphere_center(spheres, slot), sphere_radius(spheres, slot)
    radius += MARGIN * (sphere_magnitude(place, radius) + camera.extent + camera.focus)
    met = groups_met(cones, first, count, sub(place, camera.eye), radius, footprint)
    lane = first * GROUP
    while met > 0:
        if met & 1:
            nearest_sphere(packet, lane, camera, spheres, slot)
            if has_width(footprint):
                note_rim(packet, lane, camera, spheres, slot, footprint)
            find_farthest(packet, lane // GROUP, 1, cones)
        met >>= 1
        lane += GROUP


@device
def nearest_sphere(
    packet: Packet, first: int, camera: CameraFrame, spheres: SphereArrays, slot: int
) -> None:
    """Let a sphere take those of a group of lanes in which it is nearer than the hit so far."""
    center, radius = sphere_center(spheres, slot), sphere_radius(spheres, slot)
    eye_from_center = sub(camera.eye, center)
    magnitude = sphere_magnitude(center, radius) + camera.extent
    number = spheres.number[slot]
    # The mask tells the compiler that no index is negative.
    begin = first & (LANES - 1)
    shifted = is_shifted(camera)
    for lane in range(begin, begin + GROUP):
        direction = load(packet, DIRECTION, lane)
        offset = load(packet, OFFSET, lane)
        from_center = add(eye_from_center, offset) if shifted else eye_from_center
        forward = packet[FORWARD + lane]
        distance = sphere_distance(from_center, direction, radius, forward, camera.focus, magnitude)
        _take_nearer(packet, lane, distance, number, slot)


@device
def note_rim(
    packet: Packet,
    first: int,
    camera: CameraFrame,
    spheres: SphereArrays,
    slot: int,
    footprint: Footprint,
) -> None:
    """Note the distance of a sphere's outline in those of a group of lanes that it passes near."""
    eye_from_center = sub(camera.eye, sphere_center(spheres, slot))
    radius = sphere_radius(spheres, slot)
    begin = first & (LANES - 1)
    shifted = is_shifted(camera)
    for lane in range(begin, begin + GROUP):
        direction = load(packet, DIRECTION, lane)
        offset = load(packet, OFFSET, lane)
        from_center = add(eye_from_center, offset) if shifted else eye_from_center
        middle = -dot(from_center, direction)
        approach = add(from_center, scale(middle, direction))
        gap2 = dot(approach, approach)
        width = width_at(footprint, middle)
        outer, inner = radius + width, max(radius - width, 0.0)
        near = (gap2 < outer * outer) & (gap2 >= inner * inner) & (middle > camera.focus)
        entry = middle - math.sqrt(max(radius * radius - gap2, 0.0))
        packet[RIM + lane] = min(entry, packet[RIM + lane]) if near else packet[RIM + lane]


@device
def nearest_plane(
    packet: Packet, lanes: int, camera: CameraFrame, planes: Planes, plane: int, number: int
) -> None:
    """Let a plane take the lanes in which it is nearer than the hit so far."""
    normal = pick(planes, plane)
    eye_height = planes.height[plane]
    magnitude = planes.magnitude[plane] + camera.extent
    shifted = is_shifted(camera)
    for lane in range(lanes):
        descent = dot(load(packet, DIRECTION, lane), normal)
        offset = load(packet, OFFSET, lane)
        height = eye_height - dot(offset, normal) if shifted else eye_height
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
