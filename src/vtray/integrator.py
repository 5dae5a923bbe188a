"""The integrator: from a tile of pixels to their linear light."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.camera import CameraFrame, camera_ray
from vtray.compiled import device, kernel
from vtray.culling import MARGIN, outside_side
from vtray.interaction import gather_interactions
from vtray.nearest import clear_hits, nearest_plane, nearest_sphere
from vtray.occlusion import Workspace, bound_points, find_blocked, find_sides
from vtray.packet import (
    BLOCK,
    DIRECTION,
    FORWARD,
    PIXEL,
    VALUE,
    Packet,
    load,
    store,
)
from vtray.scene_arrays import SceneArrays, Spheres
from vtray.shading import add_light
from vtray.vector import cross, dot, pick, sub


class Block(NamedTuple):
    """A rectangle of pixels, at most ``BLOCK`` wide and high, traced as one packet."""

    left: int
    top: int
    width: int
    height: int


@kernel
def trace_tile(
    scene: SceneArrays,
    left: int,
    top: int,
    right: int,
    bottom: int,
    film: NDArray[np.float64],
    packet: Packet,
    work: Workspace,
    stop: NDArray[np.bool_],
) -> tuple[float, int]:
    """Trace a tile, block by block.

    Parameters
    ----------
    scene
        The scene.
    left, top, right, bottom
        The tile in pixels; right and bottom are the first that no longer belong to it.
    film
        The linear light of the image, (height, width, 3); the tile's part of it is written.
    packet, work
        Scratch memory of this thread.
    stop
        One flag: the tile is given up soon after another thread sets it.

    Returns
    -------
    peak, rays
        The largest channel of the tile, and how many rays were cast.
    """
    peak = 0.0
    rays = 0
    for y in range(top, bottom, BLOCK):
        for x in range(left, right, BLOCK):
            block = Block(x, y, min(BLOCK, right - x), min(BLOCK, bottom - y))
            brightest, cast = _trace_block(scene, block, film, packet, work, stop)
            peak = max(peak, brightest)
            rays += cast
            if stop[0]:
                return peak, rays
    return peak, rays


@device
def _trace_block(
    scene: SceneArrays,
    block: Block,
    film: NDArray[np.float64],
    packet: Packet,
    work: Workspace,
    stop: NDArray[np.bool_],
) -> tuple[float, int]:
    """Trace the packet of one block: rays, hits, light, film."""
    lanes = block.width * block.height
    _cast_rays(packet, block, scene.camera)
    _find_hits(packet, block, scene, work)
    hits = gather_interactions(packet, lanes, scene)
    if hits < lanes:
        _blacken(block, film)
    if hits == 0:
        return 0.0, lanes
    rays = lanes
    bounds = bound_points(packet, hits)
    find_sides(packet, hits, scene.planes, work)
    for light in range(scene.lights.x.shape[0]):
        if stop[0]:
            break
        find_blocked(packet, hits, bounds, scene, light, work)
        rays += add_light(packet, hits, scene.lights, light)
    return _expose(packet, hits, block, film), rays


@device
def _cast_rays(packet: Packet, block: Block, camera: CameraFrame) -> None:
    """Set each lane's ray, row by row through the block."""
    for row in range(block.height):
        start = row * block.width
        for column in range(block.width):
            direction = camera_ray(camera, block.left + column, block.top + row)
            store(packet, DIRECTION, start + column, direction)
    for lane in range(block.width * block.height):
        packet[FORWARD + lane] = dot(load(packet, DIRECTION, lane), camera.forward)


@device
def _find_hits(packet: Packet, block: Block, scene: SceneArrays, work: Workspace) -> None:
    """Find each lane's nearest hit: spheres first, then planes."""
    lanes = block.width * block.height
    spheres = scene.spheres.x.shape[0]
    clear_hits(packet, lanes)
    _cull_spheres(packet, block, scene.camera, scene.spheres, work.near)
    for sphere in range(spheres):
        if work.near[sphere]:
            nearest_sphere(packet, lanes, scene.camera, scene.spheres, sphere)
    for plane in range(scene.planes.x.shape[0]):
        nearest_plane(packet, lanes, scene.camera, scene.planes, plane, spheres + plane)


@device
def _cull_spheres(
    packet: Packet, block: Block, camera: CameraFrame, spheres: Spheres, near: NDArray[np.bool_]
) -> None:
    """Find the spheres that reach into the pyramid from the eye through a block."""
    # Not by rays of two corners: far from the eye of a narrow view they are too nearly parallel.
    left_top = load(packet, DIRECTION, 0)
    right_bottom = load(packet, DIRECTION, block.width * block.height - 1)
    left = cross(left_top, camera.down)
    top = cross(camera.right, left_top)
    right = cross(camera.down, right_bottom)
    bottom = cross(right_bottom, camera.right)
    for sphere in range(spheres.x.shape[0]):
        center = sub(pick(spheres, sphere), camera.eye)
        radius = spheres.radius[sphere] + MARGIN * (spheres.magnitude[sphere] + camera.focus)
        near[sphere] = not (
            outside_side(center, left, radius)
            | outside_side(center, top, radius)
            | outside_side(center, right, radius)
            | outside_side(center, bottom, radius)
        )


@device
def _blacken(block: Block, film: NDArray[np.float64]) -> None:
    """Write no light to a block's part of the film, for the rays that hit nothing."""
    for row in range(block.top, block.top + block.height):
        for column in range(block.left, block.left + block.width):
            for channel in range(3):
                film[row, column, channel] = 0.0


@device
def _expose(packet: Packet, hits: int, block: Block, film: NDArray[np.float64]) -> float:
    """Write the light of a packet's points to the film; return the largest channel."""
    peak = 0.0
    for lane in range(hits):
        pixel = int(packet[PIXEL + lane])
        row = block.top + pixel // block.width
        column = block.left + pixel % block.width
        red, green, blue = load(packet, VALUE, lane)
        film[row, column, 0] = red
        film[row, column, 1] = green
        film[row, column, 2] = blue
        peak = max(peak, red, green, blue)
    return peak


def new_workspace(scene: SceneArrays) -> Workspace:
    """Return the scratch memory of one thread for a scene."""
    planes = scene.planes.x.shape[0]
    return Workspace(
        near=np.zeros(scene.spheres.x.shape[0], np.bool_),
        above=np.zeros(planes, np.bool_),
        below=np.zeros(planes, np.bool_),
    )
