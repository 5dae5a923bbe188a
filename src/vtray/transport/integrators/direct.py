"""The integrator: from a tile of pixels to their linear light."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.camera_rays import CameraFrame, camera_ray, is_shifted
from vtray.geometry.packets.bvh_nearest import nearest_in_bvh
from vtray.geometry.packets.bvh_occlusion import block_in_bvh
from vtray.geometry.packets.few_spheres import block_by_few, nearest_of_few
from vtray.geometry.packets.nearest import clear_hits, nearest_plane
from vtray.geometry.packets.occlusion import Bounds, block_by_planes, bound_points, find_sides
from vtray.geometry.packets.packet import (
    BLOCK,
    COLUMN,
    DIRECTION,
    FORWARD,
    GROUP,
    LANES,
    OFFSET,
    PART,
    ROW,
    Block,
    Packet,
    load,
    store,
)
from vtray.geometry.packets.ray_bounds import find_cones, find_farthest
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.shapes.sphere_arrays import sphere_count
from vtray.geometry.vector import dot
from vtray.geometry.world import SceneArrays, has_bvh
from vtray.transport.film import (
    Film,
    add_samples,
    clear_sums,
    is_wanted,
    keep_rays,
    write_middles,
    write_pixels,
)
from vtray.transport.interaction import gather_interactions
from vtray.transport.light_buffer import is_kept, keep_cosines
from vtray.transport.sampling.pixel_samples import Sampling, list_pixels, place_samples
from vtray.transport.shading import add_light, clear_shadows, find_cosines, note_shadows


@kernel
def trace_tile(
    scene: SceneArrays,
    sampling: Sampling,
    left: int,
    top: int,
    right: int,
    bottom: int,
    film: Film,
    packet: Packet,
    work: Workspace,
    stop: NDArray[np.bool_],
) -> tuple[float, int]:
    """Trace a tile, block by block.

    Parameters
    ----------
    scene
        The scene.
    sampling
        Which rays are cast for which pixels.
    left, top, right, bottom
        The tile in pixels; right and bottom are the first that no longer belong to it.
    film
        What is wanted of the image; the tile's part of it is written.
    packet, work
        Scratch memory of this thread.
    stop
        One flag: the tile is given up soon after another thread sets it.

    Returns
    -------
    peak, rays
        The largest channel of the pixels traced, and how many rays were cast.
    """
    peak = 0.0
    rays = 0
    together = max(1, LANES // sampling.rays)
    for y in range(top, bottom, BLOCK):
        for x in range(left, right, BLOCK):
            block = Block(x, y, min(BLOCK, right - x), min(BLOCK, bottom - y))
            pixels = list_pixels(block, sampling.marks, work.curve, work.pixels)
            for begin in range(0, pixels, together):
                end = min(begin + together, pixels)
                brightest, cast = _trace_pixels(
                    scene, sampling, block, begin, end, film, packet, work, stop
                )
                peak = max(peak, brightest)
                rays += cast
                if stop[0]:
                    return peak, rays
    return peak, rays


@device
def _trace_pixels(
    scene: SceneArrays,
    sampling: Sampling,
    block: Block,
    begin: int,
    end: int,
    film: Film,
    packet: Packet,
    work: Workspace,
    stop: NDArray[np.bool_],
) -> tuple[float, int]:
    """Trace pixels of a block's list, a packet of samples after the other."""
    rays = 0
    hits = 0
    if sampling.rays > 1:
        clear_sums(work.sums, end - begin)
    for first in range(0, sampling.rays, LANES):
        last = min(first + LANES, sampling.rays)
        lanes = place_samples(packet, block, begin, end, sampling, first, last, work.pixels)
        hits = _find_surfaces(packet, lanes, scene, sampling, work)
        if is_kept(film.kept):
            keep_rays(packet, block, begin, end, first, last, work.pixels, film.kept)
        if is_wanted(film.linear) and hits > 0:
            rays += _light_hits(scene, hits, film, packet, work, stop)
        rays += lanes
        if sampling.rays > 1:
            add_samples(packet, lanes, hits, last - first, work.sums)
    if sampling.rays > 1:
        return write_pixels(block, begin, end, work.pixels, work.sums, film), rays
    return write_middles(packet, block, begin, end, hits, work.pixels, film), rays


@device
def _find_surfaces(
    packet: Packet, lanes: int, scene: SceneArrays, sampling: Sampling, work: Workspace
) -> int:
    """Cast the rays of a packet, and bring what they hit to its front; return how many hits."""
    whole = (lanes + PART - 1) // PART * PART
    _cast_rays(packet, whole, scene.camera)
    find_cones(packet, whole, is_shifted(scene.camera), work.cones)
    _find_hits(packet, whole, sampling, scene, work)
    return gather_interactions(packet, lanes, sampling.rays, scene, work)


@device
def _light_hits(
    scene: SceneArrays,
    hits: int,
    film: Film,
    packet: Packet,
    work: Workspace,
    stop: NDArray[np.bool_],
) -> int:
    """Add all lights to the hits of a packet; return how many shadow rays were cast."""
    rays = 0
    bounds = bound_points(packet, hits)
    find_sides(packet, hits, scene.planes, work)
    if is_wanted(film.shadows):
        clear_shadows(packet, hits)
    for light in range(scene.lights.x.shape[0]):
        if stop[0]:
            break
        facing = find_cosines(packet, hits, scene.lights, light)
        if facing > 0:
            _find_blocked(packet, hits, bounds, scene, light, work)
            add_light(packet, hits, scene.lights, light)
            if is_wanted(film.shadows):
                note_shadows(packet, hits, light)
            if is_kept(film.kept):
                keep_cosines(packet, hits, light, film.kept)
            rays += facing
    return rays


@device
def _cast_rays(packet: Packet, lanes: int, camera: CameraFrame) -> None:
    """Set each lane's ray."""
    for lane in range(lanes):
        offset, direction = camera_ray(camera, packet[COLUMN + lane], packet[ROW + lane])
        if is_shifted(camera):
            store(packet, OFFSET, lane, offset)
        store(packet, DIRECTION, lane, direction)
    for lane in range(lanes):
        packet[FORWARD + lane] = dot(load(packet, DIRECTION, lane), camera.forward)


@device
def _find_hits(
    packet: Packet, lanes: int, sampling: Sampling, scene: SceneArrays, work: Workspace
) -> None:
    """Find each lane's nearest hit; planes first, so that less of the hierarchy is searched."""
    clear_hits(packet, lanes)
    for plane in range(scene.planes.x.shape[0]):
        number = sphere_count(scene.spheres) + plane
        nearest_plane(packet, lanes, scene.camera, scene.planes, plane, number)
    find_farthest(packet, 0, lanes // GROUP, work.cones)
    if has_bvh(scene):
        part = PART if sampling.rays == 1 else LANES
        nearest_in_bvh(packet, lanes, part, scene, sampling.footprint, work)
    else:
        nearest_of_few(packet, lanes, scene, sampling.footprint, work)


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
