"""One pixel, traced plainly: every object tested, nothing left out, nothing in packets.

The fast path must give the same to the last bit. This is also what ``vtray --pixel`` shows.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.camera_rays import camera_ray
from vtray.geometry.packets.nearest import plane_distance, sphere_distance
from vtray.geometry.packets.occlusion import light_reach, light_side, plane_side, sphere_shadows
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.shapes.plane import plane_blocks
from vtray.geometry.shapes.sphere_arrays import (
    sphere_center,
    sphere_count,
    sphere_magnitude,
    sphere_radius,
)
from vtray.geometry.vector import Vec, add, dot, pick, scale, sub
from vtray.geometry.world import SceneArrays
from vtray.transport.interaction import Interaction, interact, material
from vtray.transport.shading import lambert_cosine

NOTHING = -1
"""In place of a primitive: nothing is hit, nothing blocks."""


class TracedPixel(NamedTuple):
    """How a pixel got its value, lengths in units of the arrays.

    Attributes
    ----------
    offset
        Where the camera ray starts, minus the eye.
    direction
        The camera ray's unit direction.
    distance
        From the eye to the hit, ``inf`` if there is none.
    primitive
        What is hit, or ``NOTHING``.
    interaction
        Where it is hit; without meaning if nothing is.
    value
        Linear red, green and blue.
    """

    offset: Vec
    direction: Vec
    distance: float
    primitive: int
    interaction: Interaction
    value: Vec


@kernel
def trace_pixel(
    scene: SceneArrays,
    column: int,
    row: int,
    cosines: NDArray[np.float64],
    blockers: NDArray[np.int64],
) -> TracedPixel:
    """Trace one pixel.

    Parameters
    ----------
    scene
        The scene.
    column, row
        The pixel, from the left and from the top.
    cosines
        Out: for each light the cosine at the hit, 0 for a light below the horizon.
    blockers
        Out: for each light the first primitive between hit and light, or ``NOTHING``.
    """
    offset, direction = camera_ray(scene.camera, column, row)
    distance, primitive, slot = _nearest_hit(scene, offset, direction)
    value = (0.0, 0.0, 0.0)
    found = Interaction(scene.camera.eye, direction, 0.0)
    if primitive == NOTHING:
        return TracedPixel(offset, direction, distance, primitive, found, value)
    found = interact(scene, offset, direction, distance, primitive, slot)
    color, lambert = material(scene, primitive)
    lights = scene.lights
    for light in range(lights.x.shape[0]):
        to_light = sub(pick(lights, light), found.point)
        reach = light_reach(lights, light, found.magnitude)
        cosines[light] = lambert_cosine(found.normal, to_light, reach)
        blockers[light] = _first_blocker(scene, found, light)
        if blockers[light] == NOTHING:
            strength = cosines[light] * lambert * lights.intensity[light]
            value = add(value, scale(strength, color))
    return TracedPixel(offset, direction, distance, primitive, found, value)


@device
def _nearest_hit(scene: SceneArrays, offset: Vec, direction: Vec) -> tuple[float, int, int]:
    """Return distance, primitive and slot of a camera ray's nearest hit."""
    camera, spheres, planes = scene.camera, scene.spheres, scene.planes
    forward = dot(direction, camera.forward)
    nearest, primitive, slot = math.inf, NOTHING, 0
    for k in range(sphere_count(spheres)):
        center, radius = sphere_center(spheres, k), sphere_radius(spheres, k)
        from_center = add(sub(camera.eye, center), offset)
        magnitude = sphere_magnitude(center, radius) + camera.extent
        distance = sphere_distance(from_center, direction, radius, forward, camera.focus, magnitude)
        number = int(spheres.number[k])
        if distance < nearest or (distance == nearest and number < primitive):
            nearest, primitive, slot = distance, number, k
    for k in range(planes.x.shape[0]):
        descent = dot(direction, pick(planes, k))
        height = planes.height[k] - dot(offset, pick(planes, k))
        magnitude = planes.magnitude[k] + camera.extent
        distance = plane_distance(height, descent, forward, camera.focus, magnitude)
        if distance < nearest:
            nearest, primitive, slot = distance, sphere_count(spheres) + k, k
    return nearest, primitive, slot


@device
def _first_blocker(scene: SceneArrays, start: Interaction, light: int) -> int:
    """Return the lowest primitive between a point and a light, or ``NOTHING``."""
    lights, spheres, planes = scene.lights, scene.spheres, scene.planes
    count = sphere_count(spheres)
    place = pick(lights, light)
    light_depth = lights.depth[light]
    depth = dot(start.point, scene.camera.forward)
    blocker = NOTHING
    for k in range(count):
        center, radius = sphere_center(spheres, k), sphere_radius(spheres, k)
        magnitude = sphere_magnitude(center, radius)
        reach = ROUNDING * (start.magnitude + magnitude)
        end_reach = light_reach(lights, light, magnitude)
        if sphere_shadows(start.point, depth, place, light_depth, center, radius, reach, end_reach):
            number = int(spheres.number[k])
            blocker = number if blocker == NOTHING else min(blocker, number)
    if blocker != NOTHING:
        return blocker
    for k in range(planes.x.shape[0]):
        reach = ROUNDING * (start.magnitude + planes.magnitude[k])
        side = plane_side(planes, k, start.point)
        if plane_blocks(side, light_side(planes, k, lights, light), depth, light_depth, reach):
            return count + k
    return NOTHING
