"""Which points of a packet have something between them and a light."""

from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    BLOCKED,
    DEPTH,
    GROUP,
    LANES,
    MAGNITUDE,
    POINT,
    Packet,
    load,
)
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.shapes.plane import plane_blocks
from vtray.geometry.shapes.sphere import sphere_blocks
from vtray.geometry.shapes.sphere_arrays import (
    SphereArrays,
    sphere_center,
    sphere_magnitude,
    sphere_radius,
)
from vtray.geometry.vector import Vec, add, dot, lower, pick, scale, sub, upper
from vtray.geometry.world import Lights, Planes


class Bounds(NamedTuple):
    """A box around the points of a packet, and their largest magnitude."""

    center: Vec
    half: Vec
    magnitude: float


@device
def bound_points(packet: Packet, hits: int) -> Bounds:
    """Return the bounds of a packet's points."""
    low = load(packet, POINT, 0)
    high = low
    magnitude = 0.0
    for lane in range(hits):
        point = load(packet, POINT, lane)
        low, high = lower(low, point), upper(high, point)
        magnitude = max(magnitude, packet[MAGNITUDE + lane])
    return Bounds(scale(0.5, add(low, high)), scale(0.5, sub(high, low)), magnitude)


@device
def find_sides(packet: Packet, hits: int, planes: Planes, work: Workspace) -> None:
    """Find on which sides of each plane a packet's points lie."""
    for plane in range(planes.x.shape[0]):
        above = 0
        below = 0
        for lane in range(hits):
            start = plane_side(planes, plane, load(packet, POINT, lane))
            reach = ROUNDING * (packet[MAGNITUDE + lane] + planes.magnitude[plane])
            above += 1 if start > reach else 0
            below += 1 if start < -reach else 0
        work.above[plane] = above > 0
        work.below[plane] = below > 0


@device
def plane_side(planes: Planes, plane: int, point: Vec) -> float:
    """Return the signed distance of a point from a plane."""
    along: float = dot(point, pick(planes, plane))
    return along - float(planes.offset[plane])


@device
def light_side(planes: Planes, plane: int, lights: Lights, light: int) -> float:
    """Return the signed distance of a light from a plane, 0 if rounding could explain it."""
    side = plane_side(planes, plane, pick(lights, light))
    return side if abs(side) > light_reach(lights, light, planes.magnitude[plane]) else 0.0


@device
def light_reach(lights: Lights, light: int, magnitude: float) -> float:
    """Return how far from a surface of a magnitude rounding may have put a light that is on it."""
    reach: float = ROUNDING * (magnitude + lights.world_magnitude[light])
    return reach


@device
def sphere_shadows(
    point: Vec,
    depth: float,
    light: Vec,
    light_depth: float,
    center: Vec,
    radius: float,
    reach: float,
    end_reach: float,
) -> bool:
    """Tell whether a sphere stands between a point and a light, in front of the image plane.

    Rounding may have moved the point by `reach` and the light by `end_reach`.
    """
    from_center = sub(point, center)
    to_end = sub(light, point)
    end_from_center = sub(light, center)
    if light_depth < 0.0:
        # The shadow ray counts up to where it passes through the image plane.
        share = depth / (depth - light_depth)
        to_end = scale(share, to_end)
        end_from_center = add(from_center, to_end)
        end_reach = reach + share * end_reach
    return sphere_blocks(from_center, to_end, end_from_center, radius, reach, end_reach)


@device
def block_by_sphere(
    packet: Packet,
    begin: int,
    end: int,
    spheres: SphereArrays,
    slot: int,
    lights: Lights,
    light: int,
) -> None:
    """Mark the points of a range that a sphere hides from a light."""
    for chunk in range(begin // GROUP, (end + GROUP - 1) // GROUP):
        # Points beyond the range in the same eight are only marked if they are hidden, too.
        _block_eight(packet, chunk * GROUP, spheres, slot, lights, light)


@device
def _block_eight(
    packet: Packet, first: int, spheres: SphereArrays, slot: int, lights: Lights, light: int
) -> None:
    """Mark those of eight points that a sphere hides from a light."""
    center, radius = sphere_center(spheres, slot), sphere_radius(spheres, slot)
    magnitude = sphere_magnitude(center, radius)
    place = pick(lights, light)
    light_depth = lights.depth[light]
    end_reach = light_reach(lights, light, magnitude)
    # The mask tells the compiler that no index is negative.
    begin = first & (LANES - 1)
    for lane in range(begin, begin + GROUP):
        point = load(packet, POINT, lane)
        reach = ROUNDING * (packet[MAGNITUDE + lane] + magnitude)
        depth = packet[DEPTH + lane]
        shadow = sphere_shadows(point, depth, place, light_depth, center, radius, reach, end_reach)
        packet[BLOCKED + lane] = 1.0 if shadow else packet[BLOCKED + lane]


@device
def block_by_planes(
    packet: Packet, hits: int, planes: Planes, lights: Lights, light: int, work: Workspace
) -> None:
    """Mark the points that planes hide from a light."""
    for plane in range(planes.x.shape[0]):
        end = light_side(planes, plane, lights, light)
        if (end < 0.0 and work.above[plane]) or (end > 0.0 and work.below[plane]):
            _block_by_plane(packet, hits, planes, plane, end, lights.depth[light])


@device
def _block_by_plane(
    packet: Packet, hits: int, planes: Planes, plane: int, end: float, light_depth: float
) -> None:
    """Mark the points that a plane hides from a light."""
    magnitude = planes.magnitude[plane]
    for lane in range(hits):
        start = plane_side(planes, plane, load(packet, POINT, lane))
        reach = ROUNDING * (packet[MAGNITUDE + lane] + magnitude)
        shadow = plane_blocks(start, end, packet[DEPTH + lane], light_depth, reach)
        packet[BLOCKED + lane] = 1.0 if shadow else packet[BLOCKED + lane]
