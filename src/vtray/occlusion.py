"""Which points of a packet have something between them and a light."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.compiled import device
from vtray.culling import MARGIN, outside_shaft
from vtray.packet import BLOCKED, DEPTH, MAGNITUDE, POINT, Packet, load
from vtray.plane import plane_blocks
from vtray.rounding import ROUNDING
from vtray.scene_arrays import Lights, Planes, SceneArrays, Spheres
from vtray.sphere import sphere_blocks
from vtray.vector import Vec, add, dot, pick, scale, sub


class Bounds(NamedTuple):
    """A box around the points of a packet, and their largest magnitude."""

    center: Vec
    half: Vec
    magnitude: float


class Workspace(NamedTuple):
    """A thread's notes on the packet at hand.

    Attributes
    ----------
    near
        Which spheres may be met, one per sphere.
    above, below
        Whether any point lies on that side of a plane, clear of rounding, one per plane.
    """

    near: NDArray[np.bool_]
    above: NDArray[np.bool_]
    below: NDArray[np.bool_]


@device
def bound_points(packet: Packet, hits: int) -> Bounds:
    """Return the bounds of a packet's points."""
    low = load(packet, POINT, 0)
    high = low
    magnitude = 0.0
    for lane in range(hits):
        x, y, z = load(packet, POINT, lane)
        low = min(low[0], x), min(low[1], y), min(low[2], z)
        high = max(high[0], x), max(high[1], y), max(high[2], z)
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
    reach = ROUNDING * (planes.magnitude[plane] + lights.magnitude[light])
    return side if abs(side) > reach else 0.0


@device
def sphere_shadows(
    point: Vec,
    depth: float,
    light: Vec,
    light_depth: float,
    center: Vec,
    radius: float,
    reach: float,
) -> bool:
    """Tell whether a sphere stands between a point and a light, in front of the image plane."""
    from_center = sub(point, center)
    to_end = sub(light, point)
    end_from_center = sub(light, center)
    if light_depth < 0.0:
        # The shadow ray counts up to where it passes through the image plane.
        to_end = scale(depth / (depth - light_depth), to_end)
        end_from_center = add(from_center, to_end)
    return sphere_blocks(from_center, to_end, end_from_center, radius, reach)


@device
def find_blocked(
    packet: Packet, hits: int, bounds: Bounds, scene: SceneArrays, light: int, work: Workspace
) -> None:
    """Mark in row ``BLOCKED`` the points that a light does not reach."""
    for lane in range(hits):
        packet[BLOCKED + lane] = 0.0
    _cull_spheres(bounds, scene.spheres, scene.lights, light, work.near)
    for sphere in range(scene.spheres.x.shape[0]):
        if work.near[sphere]:
            _block_by_sphere(packet, hits, scene.spheres, sphere, scene.lights, light)
    for plane in range(scene.planes.x.shape[0]):
        end = light_side(scene.planes, plane, scene.lights, light)
        if (end < 0.0 and work.above[plane]) or (end > 0.0 and work.below[plane]):
            depth = scene.lights.depth[light]
            _block_by_plane(packet, hits, scene.planes, plane, end, depth)


@device
def _cull_spheres(
    bounds: Bounds, spheres: Spheres, lights: Lights, light: int, near: NDArray[np.bool_]
) -> None:
    """Find the spheres that may stand between any of the points and a light."""
    tip = pick(lights, light)
    magnitude = bounds.magnitude + lights.magnitude[light]
    for sphere in range(spheres.x.shape[0]):
        center = pick(spheres, sphere)
        radius = spheres.radius[sphere] + MARGIN * (spheres.magnitude[sphere] + magnitude)
        near[sphere] = not outside_shaft(center, radius, tip, bounds.center, bounds.half)


@device
def _block_by_sphere(
    packet: Packet, hits: int, spheres: Spheres, sphere: int, lights: Lights, light: int
) -> None:
    """Mark the points that a sphere hides from a light."""
    center = pick(spheres, sphere)
    radius = spheres.radius[sphere]
    magnitude = spheres.magnitude[sphere]
    place = pick(lights, light)
    light_depth = lights.depth[light]
    for lane in range(hits):
        point = load(packet, POINT, lane)
        reach = ROUNDING * (packet[MAGNITUDE + lane] + magnitude)
        depth = packet[DEPTH + lane]
        shadow = sphere_shadows(point, depth, place, light_depth, center, radius, reach)
        packet[BLOCKED + lane] = 1.0 if shadow else packet[BLOCKED + lane]


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
