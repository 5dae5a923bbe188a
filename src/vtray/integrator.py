"""The integrator: from a tile of pixels to their linear light."""

import numpy as np
from numpy.typing import NDArray

from vtray.bvh_nearest import nearest_in_bvh
from vtray.bvh_occlusion import block_in_bvh
from vtray.camera import CameraFrame, camera_ray
from vtray.compiled import device, kernel
from vtray.few_spheres import block_by_few, nearest_of_few
from vtray.interaction import gather_interactions
from vtray.nearest import clear_hits, nearest_plane
from vtray.occlusion import Bounds, block_by_planes, bound_points, find_sides
from vtray.packet import (
    BLOCK,
    DIRECTION,
    FORWARD,
    LANES,
    NO_PRIMITIVE,
    PIXEL,
    PRIMITIVE,
    VALUE,
    Block,
    Packet,
    load,
    store,
)
from vtray.scene_arrays import SceneArrays, has_bvh
from vtray.shading import add_light, find_cosines
from vtray.sphere_arrays import sphere_count
from vtray.vector import dot
from vtray.workspace import Workspace


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
    _drop_outside(packet, block)
    hits = gather_interactions(packet, scene, work)
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
        facing = find_cosines(packet, hits, scene.lights, light)
        if facing > 0:
            _find_blocked(packet, hits, bounds, scene, light, work)
            add_light(packet, hits, scene.lights, light)
            rays += facing
    return _expose(packet, hits, block, film), rays


@device
def _cast_rays(packet: Packet, block: Block, camera: CameraFrame) -> None:
    """Set each lane's ray."""
    for row in range(BLOCK):
        for column in range(BLOCK):
            direction = camera_ray(camera, block.left + column, block.top + row)
            store(packet, DIRECTION, row * BLOCK + column, direction)
    for lane in range(LANES):
        packet[FORWARD + lane] = dot(load(packet, DIRECTION, lane), camera.forward)


@device
def _find_hits(packet: Packet, block: Block, scene: SceneArrays, work: Workspace) -> None:
    """Find each lane's nearest hit; planes first, so that less of the hierarchy is searched."""
    clear_hits(packet)
    for plane in range(scene.planes.x.shape[0]):
        number = sphere_count(scene.spheres) + plane
        nearest_plane(packet, scene.camera, scene.planes, plane, number)
    if has_bvh(scene):
        nearest_in_bvh(packet, block, scene, work)
    else:
        nearest_of_few(packet, block, scene, work.near)


@device
def _find_blocked(
    packet: Packet, hits: int, bounds: Bounds, scene: SceneArrays, light: int, work: Workspace
) -> None:
    """Mark in row ``BLOCKED`` the points that a light does not reach."""
    block_by_planes(packet, hits, scene.planes, scene.lights, light, work)
    if has_bvh(scene):
        block_in_bvh(packet, scene, light, work)
    else:
        block_by_few(packet, hits, bounds, scene, light, work.near)


@device
def _drop_outside(packet: Packet, block: Block) -> None:
    """Forget the hits of lanes whose pixels are not in the block."""
    if block.width < BLOCK or block.height < BLOCK:
        for row in range(BLOCK):
            for column in range(BLOCK):
                if row >= block.height or column >= block.width:
                    packet[PRIMITIVE + row * BLOCK + column] = NO_PRIMITIVE


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
        row = block.top + pixel // BLOCK
        column = block.left + pixel % BLOCK
        red, green, blue = load(packet, VALUE, lane)
        film[row, column, 0] = red
        film[row, column, 1] = green
        film[row, column, 2] = blue
        peak = max(peak, red, green, blue)
    return peak
