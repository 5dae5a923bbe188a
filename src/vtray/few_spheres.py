"""Few spheres: each is tested for a whole packet, unless a quick look leaves it out."""

import numpy as np
from numpy.typing import NDArray

from vtray.camera import CameraFrame, left_side, top_side
from vtray.compiled import device
from vtray.culling import MARGIN, outside_shaft, outside_side
from vtray.nearest import nearest_sphere
from vtray.occlusion import Bounds, block_by_sphere
from vtray.packet import BLOCK, LANES, PART, Block, Packet
from vtray.scene_arrays import Lights, SceneArrays
from vtray.sphere_arrays import (
    SphereArrays,
    sphere_center,
    sphere_count,
    sphere_magnitude,
    sphere_radius,
)
from vtray.vector import pick, scale, sub

Flags = NDArray[np.bool_]


@device
def nearest_of_few(packet: Packet, block: Block, scene: SceneArrays, near: Flags) -> None:
    """Let the spheres take the lanes in which they are nearer than the hits so far."""
    _cull_for_rays(block, scene.camera, scene.spheres, near)
    for slot in range(sphere_count(scene.spheres)):
        if near[slot]:
            for first in range(0, LANES, PART):
                nearest_sphere(packet, first, scene.camera, scene.spheres, slot)


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
def _cull_for_rays(block: Block, camera: CameraFrame, spheres: SphereArrays, near: Flags) -> None:
    """Find the spheres that reach into the pyramid from the eye through a block."""
    # Not by rays of two corners: far from the eye of a narrow view they are too nearly parallel.
    left, top = left_side(camera, block.left), top_side(camera, block.top)
    right = scale(-1.0, left_side(camera, block.left + BLOCK - 1))
    bottom = scale(-1.0, top_side(camera, block.top + BLOCK - 1))
    for slot in range(sphere_count(spheres)):
        place, radius = sphere_center(spheres, slot), sphere_radius(spheres, slot)
        center = sub(place, camera.eye)
        radius += MARGIN * (sphere_magnitude(place, radius) + camera.focus)
        near[slot] = not (
            outside_side(center, left, radius)
            | outside_side(center, top, radius)
            | outside_side(center, right, radius)
            | outside_side(center, bottom, radius)
        )


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
