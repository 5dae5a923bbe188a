"""Few spheres: each is tested for a whole packet, unless a quick look leaves it out."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.nearest import test_sphere
from vtray.geometry.packets.occlusion import Bounds, block_by_sphere
from vtray.geometry.packets.packet import GROUP, PART, Packet
from vtray.geometry.packets.ray_bounds import Footprint
from vtray.geometry.packets.shaft import MARGIN, outside_shaft
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.shapes.sphere_arrays import (
    SphereArrays,
    sphere_center,
    sphere_count,
    sphere_magnitude,
    sphere_radius,
)
from vtray.geometry.vector import pick
from vtray.geometry.world import Lights, SceneArrays

Flags = NDArray[np.bool_]


@device
def nearest_of_few(
    packet: Packet, lanes: int, scene: SceneArrays, footprint: Footprint, work: Workspace
) -> None:
    """Let the spheres take the lanes in which they are nearer than the hits so far."""
    for first in range(0, lanes, PART):
        for slot in range(sphere_count(scene.spheres)):
            test_sphere(
                packet,
                first // GROUP,
                PART // GROUP,
                scene.camera,
                scene.spheres,
                slot,
                work.cones,
                footprint,
            )


@device
def block_by_few(
    packet: Packet, hits: int, bounds: Bounds, scene: SceneArrays, light: int, near: Flags
) -> None:
    """Mark the points that spheres hide from a light."""
    _cull_for_shadows(bounds, scene.spheres, scene.lights, light, near)
    for slot in range(sphere_count(scene.spheres)):
        if near[slot]:
            block_by_sphere(packet, 0, hits, scene.spheres, slot, scene.lights, light)


@device
def _cull_for_shadows(
    bounds: Bounds, spheres: SphereArrays, lights: Lights, light: int, near: Flags
) -> None:
    """Find the spheres that may stand between any of the points and a light."""
    tip = pick(lights, light)
    magnitude = bounds.magnitude + lights.magnitude[light]
    for slot in range(sphere_count(spheres)):
        center, radius = sphere_center(spheres, slot), sphere_radius(spheres, slot)
        radius += MARGIN * (sphere_magnitude(center, radius) + magnitude)
        near[slot] = not outside_shaft(center, radius, tip, bounds.center, bounds.half)
