"""Where a ray meets the scene: the point and its surface, ready for shading."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.camera_rays import CameraFrame, is_shifted
from vtray.geometry.packets.coherence import GROUP, group_hits, list_hits
from vtray.geometry.packets.packet import (
    BLOCKED,
    COLOR,
    COSINE,
    DEPTH,
    DIRECTION,
    DISTANCE,
    LAMBERT,
    MAGNITUDE,
    NORMAL,
    OFFSET,
    POINT,
    PRIMITIVE,
    SLOT,
    SOURCE,
    VALUE,
    Packet,
    load,
    store,
)
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.shapes.sphere_arrays import (
    sphere_center,
    sphere_count,
    sphere_magnitude,
    sphere_radius,
)
from vtray.geometry.vector import Vec, add, dot, pick, scale, sub
from vtray.geometry.world import SceneArrays, has_bvh


class Interaction(NamedTuple):
    """A point on a surface.

    Attributes
    ----------
    point
        The place, relative to the centre of the image plane.
    normal
        The surface's unit normal, on the side that the ray came from.
    magnitude
        What the point's rounding error is relative to.
    """

    point: Vec
    normal: Vec
    magnitude: float


@device
def interact(
    scene: SceneArrays, offset: Vec, direction: Vec, distance: float, primitive: int, slot: int
) -> Interaction:
    """Return the point where a camera ray hits a primitive, which the arrays have at `slot`."""
    point = _ray_point(scene.camera, offset, direction, distance)
    if primitive < sphere_count(scene.spheres):
        center = sphere_center(scene.spheres, slot)
        normal = _sphere_normal(point, center, direction)
        magnitude = sphere_magnitude(center, sphere_radius(scene.spheres, slot))
    else:
        normal = pick(scene.planes, slot)
        magnitude = scene.planes.magnitude[slot]
    magnitude += scene.camera.extent
    magnitude = magnitude + scene.camera.focus + distance
    return Interaction(point, _turned(normal, direction), magnitude)


@device
def _ray_point(camera: CameraFrame, offset: Vec, direction: Vec, distance: float) -> Vec:
    """Return the point of a camera ray at a distance."""
    point = add(camera.eye, scale(distance, direction))
    return add(point, offset) if is_shifted(camera) else point


@device
def _sphere_normal(point: Vec, center: Vec, direction: Vec) -> Vec:
    """Return the unit normal of a sphere at a point where a ray of a direction hits it.

    That of a sphere so small that rounding put the point in its centre is towards the ray.
    """
    outward = sub(point, center)
    length2 = dot(outward, outward)
    length = math.sqrt(length2) if length2 > 0.0 else -1.0
    x = outward[0] if length2 > 0.0 else direction[0]
    y = outward[1] if length2 > 0.0 else direction[1]
    z = outward[2] if length2 > 0.0 else direction[2]
    return x / length, y / length, z / length


@device
def _turned(normal: Vec, direction: Vec) -> Vec:
    """Return a normal, turned to the side that a ray comes from."""
    side = -1.0 if dot(normal, direction) > 0.0 else 1.0
    return scale(side, normal)


@device
def material(scene: SceneArrays, primitive: int) -> tuple[Vec, float]:
    """Return colour and Lambert coefficient of a primitive."""
    materials = scene.materials
    plane = primitive - sphere_count(scene.spheres)
    if plane >= 0:
        return _triple(materials.plane_color, plane), materials.plane_lambert[plane]
    color, lambert = materials.sphere_color, materials.sphere_lambert
    # One row may stand for all spheres.
    row = min(primitive, color.shape[0] - 1)
    return _triple(color, row), lambert[min(primitive, lambert.shape[0] - 1)]


@device
def _triple(rows: NDArray[np.uint8], k: int) -> Vec:
    """Return a row of an (n, 3) array as numbers."""
    return float(rows[k, 0]), float(rows[k, 1]), float(rows[k, 2])


@device
def gather_interactions(
    packet: Packet, lanes: int, samples: int, scene: SceneArrays, work: Workspace
) -> int:
    """Move the lanes with a hit to the front, as interactions with no light yet; return how many.

    With a hierarchy they are in groups. Row ``SOURCE`` keeps where each came from.
    """
    if has_bvh(scene):
        hits = group_hits(packet, lanes, GROUP * min(samples, 8), work)
    else:
        hits = list_hits(packet, lanes, work)
    for hit in range(hits):
        _fetch(packet, hit, work.order[hit], scene)
    # A loop of its own, only so is it vectorised.
    camera = scene.camera
    for hit in range(hits):
        direction, offset = load(packet, VALUE, hit), load(packet, POINT, hit)
        distance = packet[BLOCKED + hit]
        point = _ray_point(camera, offset, direction, distance)
        surface = load(packet, NORMAL, hit)
        normal = _sphere_normal(point, surface, direction)
        curved = packet[COSINE + hit] > 0.0
        normal = (
            normal[0] if curved else surface[0],
            normal[1] if curved else surface[1],
            normal[2] if curved else surface[2],
        )
        store(packet, POINT, hit, point)
        store(packet, NORMAL, hit, _turned(normal, direction))
        store(packet, VALUE, hit, (0.0, 0.0, 0.0))
        magnitude = packet[MAGNITUDE + hit] + camera.extent
        packet[MAGNITUDE + hit] = magnitude + camera.focus + distance
        packet[DEPTH + hit] = dot(point, camera.forward)
    return hits


@device
def _fetch(packet: Packet, hit: int, lane: int, scene: SceneArrays) -> None:
    """Bring together what a hit is made of, in rows that are not in use so far.

    The ray's direction goes to row ``VALUE``, its start to ``POINT``, the distance to ``BLOCKED``,
    a sphere's centre or a plane's normal to ``NORMAL``, and whether it is a sphere to ``COSINE``.
    """
    primitive = int(packet[PRIMITIVE + lane])
    slot = int(packet[SLOT + lane])
    if primitive < sphere_count(scene.spheres):
        surface = sphere_center(scene.spheres, slot)
        packet[MAGNITUDE + hit] = sphere_magnitude(surface, sphere_radius(scene.spheres, slot))
        packet[COSINE + hit] = 1.0
    else:
        surface = pick(scene.planes, slot)
        packet[MAGNITUDE + hit] = scene.planes.magnitude[slot]
        packet[COSINE + hit] = 0.0
    store(packet, NORMAL, hit, surface)
    store(packet, VALUE, hit, load(packet, DIRECTION, lane))
    if is_shifted(scene.camera):
        store(packet, POINT, hit, load(packet, OFFSET, lane))
    packet[BLOCKED + hit] = packet[DISTANCE + lane]
    color, lambert = material(scene, primitive)
    store(packet, COLOR, hit, color)
    packet[LAMBERT + hit] = lambert
    packet[SOURCE + hit] = lane
