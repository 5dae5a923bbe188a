"""Where a ray meets the scene: the point and its surface, ready for shading."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.camera import is_shifted
from vtray.compiled import device
from vtray.grouping import GROUP, group_hits, list_hits
from vtray.packet import (
    COLOR,
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
from vtray.scene_arrays import SceneArrays, has_bvh
from vtray.sphere_arrays import sphere_center, sphere_count, sphere_magnitude, sphere_radius
from vtray.vector import Vec, add, dot, pick, scale, sub
from vtray.workspace import Workspace


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
    point = add(scene.camera.eye, scale(distance, direction))
    if is_shifted(scene.camera):
        point = add(point, offset)
    if primitive < sphere_count(scene.spheres):
        center = sphere_center(scene.spheres, slot)
        outward = sub(point, center)
        length = math.sqrt(dot(outward, outward))
        normal = (outward[0] / length, outward[1] / length, outward[2] / length)
        magnitude = sphere_magnitude(center, sphere_radius(scene.spheres, slot))
    else:
        normal = pick(scene.planes, slot)
        magnitude = scene.planes.magnitude[slot]
    side = -1.0 if dot(normal, direction) > 0.0 else 1.0
    magnitude += scene.camera.extent
    return Interaction(point, scale(side, normal), magnitude + scene.camera.focus + distance)


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
    nowhere = (0.0, 0.0, 0.0)
    hits = (
        group_hits(packet, lanes, GROUP * min(samples, 8), work)
        if has_bvh(scene)
        else list_hits(packet, lanes, work)
    )
    for hit in range(hits):
        lane = work.order[hit]
        primitive = int(packet[PRIMITIVE + lane])
        direction = load(packet, DIRECTION, lane)
        slot = int(packet[SLOT + lane])
        offset = load(packet, OFFSET, lane) if is_shifted(scene.camera) else nowhere
        found = interact(scene, offset, direction, packet[DISTANCE + lane], primitive, slot)
        color, lambert = material(scene, primitive)
        store(packet, POINT, hit, found.point)
        store(packet, NORMAL, hit, found.normal)
        store(packet, COLOR, hit, color)
        store(packet, VALUE, hit, (0.0, 0.0, 0.0))
        packet[SOURCE + hit] = lane
        packet[DEPTH + hit] = dot(found.point, scene.camera.forward)
        packet[MAGNITUDE + hit] = found.magnitude
        packet[LAMBERT + hit] = lambert
    return hits
