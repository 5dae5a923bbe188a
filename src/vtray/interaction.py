"""Where a ray meets the scene: the point and its surface, ready for shading."""

import math
from typing import NamedTuple

from vtray.compiled import device
from vtray.packet import (
    COLOR,
    DEPTH,
    DIRECTION,
    DISTANCE,
    LAMBERT,
    MAGNITUDE,
    NO_PRIMITIVE,
    NORMAL,
    PIXEL,
    POINT,
    PRIMITIVE,
    VALUE,
    Packet,
    load,
    store,
)
from vtray.scene_arrays import SceneArrays
from vtray.vector import Vec, add, dot, pick, scale, sub


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
def interact(scene: SceneArrays, direction: Vec, distance: float, primitive: int) -> Interaction:
    """Return the point where a camera ray hits a primitive."""
    point = add(scene.camera.eye, scale(distance, direction))
    spheres, planes = scene.spheres, scene.planes
    plane = primitive - spheres.x.shape[0]
    if plane < 0:
        outward = sub(point, pick(spheres, primitive))
        length = math.sqrt(dot(outward, outward))
        normal = (outward[0] / length, outward[1] / length, outward[2] / length)
        magnitude = spheres.magnitude[primitive]
    else:
        normal = pick(planes, plane)
        magnitude = planes.magnitude[plane]
    side = -1.0 if dot(normal, direction) > 0.0 else 1.0
    return Interaction(point, scale(side, normal), magnitude + scene.camera.focus + distance)


@device
def gather_interactions(packet: Packet, lanes: int, scene: SceneArrays) -> int:
    """Move the lanes with a hit to the front, as interactions with no light yet; return how many.

    Row ``PIXEL`` keeps where each came from.
    """
    hits = 0
    materials = scene.materials
    for lane in range(lanes):
        if packet[PRIMITIVE + lane] == NO_PRIMITIVE:
            continue
        primitive = int(packet[PRIMITIVE + lane])
        direction = load(packet, DIRECTION, lane)
        found = interact(scene, direction, packet[DISTANCE + lane], primitive)
        store(packet, POINT, hits, found.point)
        store(packet, NORMAL, hits, found.normal)
        color = (materials.red[primitive], materials.green[primitive], materials.blue[primitive])
        store(packet, COLOR, hits, color)
        store(packet, VALUE, hits, (0.0, 0.0, 0.0))
        packet[PIXEL + hits] = lane
        packet[DEPTH + hits] = dot(found.point, scene.camera.forward)
        packet[MAGNITUDE + hits] = found.magnitude
        packet[LAMBERT + hits] = materials.lambert[primitive]
        hits += 1
    return hits
