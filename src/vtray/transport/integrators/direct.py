"""The direct integrator: from a tile of pixels to the light that comes straight from the lights."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.packets.nearest import find_mixed
from vtray.geometry.packets.occlusion import find_close_planes
from vtray.geometry.packets.packet import (
    BLOCK,
    COLUMN,
    DIRECTION,
    FORWARD,
    LANES,
    ORIGIN,
    PART,
    ROW,
    Block,
    Packet,
    load,
    start_apart,
    store,
)
from vtray.geometry.packets.search import find_nearest
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import has_width
from vtray.geometry.vector import dot
from vtray.transport.camera_rays import CameraFrame, camera_ray, sheaf_of
from vtray.transport.film import (
    Film,
    Rows,
    add_samples,
    clear_sums,
    keep_rays,
    write_middles,
    write_pixels,
)
from vtray.transport.integrators.lamps import mix_lamps, see_lamps
from vtray.transport.integrators.points import add_points
from vtray.transport.integrators.soft import add_soft_lights, clear_noise
from vtray.transport.integrators.soft_shared import add_shared_light
from vtray.transport.interaction import gather_interactions
from vtray.transport.light_buffer import KeptLight
from vtray.transport.lights.crowd import Crowd
from vtray.transport.lights.light import points_of
from vtray.transport.lights.soft_light import SoftLights
from vtray.transport.sampling.adaptive import (
    find_patches,
    leave_mixed,
    mix_uneven,
)
from vtray.transport.sampling.fans import Fans
from vtray.transport.sampling.pixel_samples import Sampling, list_pixels, place_samples
from vtray.transport.scene_arrays import SceneArrays, lit_world


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
            width, height = min(BLOCK, right - x), min(BLOCK, bottom - y)
            block = Block(x, y, width, height, x - film.left, y - film.top)
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
    peak = 0.0
    rays = 0
    if sampling.rays > 1:
        clear_sums(work.sums, end - begin, film.coverage)
    for first in range(0, sampling.rays, LANES):
        last = min(first + LANES, sampling.rays)
        lanes = place_samples(packet, block, begin, end, sampling, first, last, work.pixels)
        hits = _find_surfaces(packet, lanes, scene, sampling, film.linear, film.mixed, work)
        keep_rays(packet, block, begin, end, first, last, work.pixels, film.kept)
        if hits > 0:
            rays += _add_points(
                scene,
                scene.lights.points,
                hits,
                film.linear,
                _is_wide(sampling, film.mixed),
                film.kept,
                packet,
                work,
                stop,
            )
            rays += _add_soft_lights(
                scene,
                scene.lights.soft,
                scene.lights.crowd,
                sampling,
                sampling.fans,
                block,
                begin,
                first,
                last,
                hits,
                film.linear,
                film.error,
                _is_wide(sampling, film.mixed),
                film.kept,
                packet,
                work,
            )
            _mix_hits(packet, hits, _is_wide(sampling, film.mixed))
        rays += lanes
        if sampling.rays > 1:
            add_samples(packet, lanes, hits, last - first, work.sums, film.coverage)
        else:
            peak = write_middles(packet, block, begin, end, hits, work.pixels, film)
    if sampling.rays > 1:
        peak = write_pixels(
            block,
            begin,
            end,
            work.pixels,
            work.sums,
            sampling.rays,
            film.linear,
            film.coverage,
            film.error,
        )
    return peak, rays


@device
def _is_wide(sampling: Sampling, mixed: Rows) -> bool | None:
    """Tell whether it is asked if pixels look the same everywhere; None where it never is."""
    return None if mixed is None else has_width(sampling.footprint)


@device
def _mix_hits(packet: Packet, hits: int, is_wide: bool | None) -> None:
    """Mark the lanes of hits that do not look the same around them, if that is asked."""
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            mix_uneven(packet, hits)


@device
def _find_surfaces(
    packet: Packet,
    lanes: int,
    scene: SceneArrays,
    sampling: Sampling,
    linear: Rows,
    mixed: Rows,
    work: Workspace,
) -> int:
    """Cast the rays of a packet, and bring what they hit together; return how many hits."""
    whole = (lanes + PART - 1) // PART * PART
    sheaf = sheaf_of(scene.camera)
    _cast_rays(packet, whole, scene.camera)
    part = PART if sampling.rays == 1 else LANES
    find_nearest(packet, whole, part, sheaf, sampling.footprint, scene.world, work)
    lights, footprint = scene.lights, sampling.footprint
    see_lamps(packet, whole, sheaf, lights, lights.visible, linear)
    if mixed is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if has_width(footprint):
            find_mixed(packet, lanes)
            mix_lamps(packet, lanes, sheaf, footprint, lights.visible)
            leave_mixed(packet, lanes)
    hits = gather_interactions(
        packet,
        lanes,
        sampling.rays,
        sheaf,
        footprint,
        scene.world,
        scene.materials,
        scene.camera.forward,
        work,
    )
    if mixed is not None:  # noqa: SIM102
        if has_width(footprint) and hits > 0:
            find_patches(packet, hits, footprint, sampling.thickest)
            find_close_planes(packet, hits, scene.world, work)
    return hits


@device
def _add_points(
    scene: SceneArrays,
    points: int | None,
    hits: int,
    linear: Rows,
    is_wide: bool | None,
    kept: KeptLight,
    packet: Packet,
    work: Workspace,
    stop: NDArray[np.bool_],
) -> int:
    """Add all points to the hits of a packet; return how many shadow rays were cast."""
    if linear is None:
        return 0
    if points is None:
        return 0
    places, lit = points_of(scene.lights), lit_world(scene)
    return add_points(packet, hits, places, lit, is_wide, kept.cosines, work, stop)


@device
def _add_soft_lights(
    scene: SceneArrays,
    soft: SoftLights | None,
    crowd: Crowd | None,
    sampling: Sampling,
    fans: Fans | None,
    block: Block,
    begin: int,
    first: int,
    last: int,
    hits: int,
    linear: Rows,
    error: Rows,
    is_wide: bool | None,
    kept: KeptLight,
    packet: Packet,
    work: Workspace,
) -> int:
    """Add the lights that are no points; return how many shadow rays were cast."""
    if linear is None:
        return 0
    if soft is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if fans is not None:
            lit, seed, samples = lit_world(scene), sampling.seed, last - first
            if crowd is not None:  # noqa: SIM102
                if kept.cosines.shape[0] == 0:
                    return add_shared_light(
                        packet,
                        hits,
                        samples,
                        first,
                        block,
                        begin,
                        lit,
                        soft,
                        crowd,
                        fans,
                        seed,
                        is_wide,
                        work,
                    )
            return add_soft_lights(
                packet,
                hits,
                samples,
                first,
                block,
                begin,
                lit,
                soft,
                fans,
                seed,
                is_wide,
                kept.cosines,
                work,
            )
    if error is not None:
        clear_noise(packet, hits)
    return 0


@device
def _cast_rays(packet: Packet, lanes: int, camera: CameraFrame) -> None:
    """Set each lane's ray."""
    apart = start_apart(sheaf_of(camera))
    for lane in range(lanes):
        ray = camera_ray(camera, packet[COLUMN + lane], packet[ROW + lane])
        if apart:
            store(packet, ORIGIN, lane, ray.origin)
        store(packet, DIRECTION, lane, ray.direction)
    # A loop of its own: the compiler vectorises both then.
    for lane in range(lanes):
        packet[FORWARD + lane] = dot(load(packet, DIRECTION, lane), camera.forward)
