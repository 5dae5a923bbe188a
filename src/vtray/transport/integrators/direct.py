"""The direct integrator: from a tile of pixels to the light that comes straight from the lights."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel, passing_on
from vtray.geometry.packets.layer_notes import AT_ONCE
from vtray.geometry.packets.nearest import find_mixed
from vtray.geometry.packets.occlusion import find_close_planes
from vtray.geometry.packets.packet import (
    BLOCK,
    LANES,
    PART,
    Block,
    Packet,
    has_own,
    in_common,
)
from vtray.geometry.packets.search import find_nearest
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import has_width, some_footprint
from vtray.geometry.world import Faded, Solids
from vtray.transport.camera_rays import cast_rays, sheaf_of
from vtray.transport.film import (
    Film,
    Rows,
    add_samples,
    clear_sums,
    keep_rays,
    write_middles,
    write_pixels,
)
from vtray.transport.fog import veil
from vtray.transport.integrators.bounces import (
    begin_bounces,
    bounced_sheaf,
    end_bounces,
    follow_rays,
    mix_looks,
)
from vtray.transport.integrators.lamps import mix_lamps, see_lamps
from vtray.transport.integrators.layered import (
    begin_layers,
    choose_surfaces,
    end_layers,
    gather_albedos,
    gather_light,
    leave_layers,
    list_lanes,
    mix_faded,
    see_all,
    take_round,
    weigh_colors,
)
from vtray.transport.integrators.path import scatter_hits
from vtray.transport.integrators.points import add_points
from vtray.transport.integrators.soft import add_soft_lights, clear_noise
from vtray.transport.integrators.soft_shared import add_shared_light
from vtray.transport.integrators.whitted import split_hits
from vtray.transport.interaction import gather_interactions
from vtray.transport.light_buffer import KeptLight
from vtray.transport.lights.crowd import Crowd
from vtray.transport.lights.light import points_of
from vtray.transport.lights.soft_light import SoftLights
from vtray.transport.lights.surroundings import Surroundings
from vtray.transport.materials.look import Looks
from vtray.transport.materials.material import Paints
from vtray.transport.orders import (
    OrderRows,
    add_orders,
    clear_orders,
    clear_sums_of_orders,
    order_hits,
    order_lamps,
    veil_orders,
    write_orders,
    write_sums_of_orders,
)
from vtray.transport.sampling.adaptive import (
    find_patches,
    leave_mixed,
    mix_uneven,
    note_seen,
)
from vtray.transport.sampling.fans import Fans
from vtray.transport.sampling.paths import Paths, seed_of_step
from vtray.transport.sampling.pixel_samples import Sampling, list_pixels, place_samples
from vtray.transport.scene_arrays import SceneArrays, lit_world, path_world


@kernel
@passing_on(Solids, Paints, SoftLights, Surroundings)
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
        clear_sums_of_orders(work.sums, end - begin, film.orders)
    for first in range(0, sampling.rays, LANES):
        last = min(first + LANES, sampling.rays)
        lens = scene.camera.lens
        lanes = place_samples(packet, block, begin, end, sampling, first, last, work.pixels, lens)
        _meet(
            packet,
            lanes,
            scene,
            scene.world.faded,
            sampling,
            film.linear,
            film.albedo,
            film.mixed,
            film.orders,
            work,
        )
        clear_orders(packet, lanes, film.orders)
        hits, cast = _light_lanes(
            packet,
            lanes,
            scene,
            scene.world.faded,
            scene.materials.looks,
            sampling,
            block,
            begin,
            end,
            first,
            last,
            film,
            film.linear,
            work,
            stop,
        )
        order_lamps(packet, lanes, film.orders)
        rays += lanes + cast
        if sampling.rays > 1:
            add_samples(
                packet,
                lanes,
                hits,
                last - first,
                work.sums,
                film.coverage,
                scene.fog,
                scene.world.faded,
            )
            add_orders(packet, lanes, last - first, work.sums, film.orders)
        else:
            peak = write_middles(
                packet,
                block,
                begin,
                end,
                hits,
                work.pixels,
                film,
                scene.fog,
                scene.world,
                scene.materials,
            )
            write_orders(packet, block, begin, end, work.pixels, film.orders)
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
            film.fog,
            film.error,
        )
        write_sums_of_orders(block, begin, end, work.pixels, work.sums, film.orders)
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
def _meet(
    packet: Packet,
    lanes: int,
    scene: SceneArrays,
    faded: Faded | None,
    sampling: Sampling,
    linear: Rows,
    albedo: Rows,
    mixed: Rows,
    orders: OrderRows,
    work: Workspace,
) -> None:
    """Cast the rays of a packet, and find what they meet first."""
    whole = (lanes + PART - 1) // PART * PART
    sheaf = sheaf_of(scene.camera)
    cast_rays(packet, whole, scene.camera)
    part = PART if sampling.rays == 1 else LANES
    find_nearest(packet, whole, part, sheaf, sampling.footprint, scene.world, work)
    lights, footprint = scene.lights, sampling.footprint
    see_lamps(packet, whole, sheaf, lights, lights.visible, linear)
    # Arguments that are None are known to the compiler, which drops what depends on that alone.
    if faded is not None:  # noqa: SIM102
        if linear is None:
            _gather_albedos(packet, lanes, scene, faded, sampling, albedo, mixed, orders, work)
            choose_surfaces(packet, lanes, sheaf, scene.world, faded, work)
    if mixed is not None:
        note_seen(packet, lanes)
        if has_width(footprint):
            find_mixed(packet, lanes)
            mix_lamps(packet, lanes, sheaf, footprint, lights.visible)
            mix_faded(packet, lanes, sheaf, footprint, scene.world, faded, work)
            mix_looks(
                packet,
                lanes,
                sheaf,
                scene.world,
                scene.materials,
                scene.materials.looks,
                sampling.paths,
                work.stack,
            )
            leave_mixed(packet, lanes)


@device
def _gather_albedos(
    packet: Packet,
    lanes: int,
    scene: SceneArrays,
    faded: Faded,
    sampling: Sampling,
    albedo: Rows,
    mixed: Rows,
    orders: OrderRows,
    work: Workspace,
) -> None:
    """Add up what share of light all that lanes see sends on, layer by layer, if it is wanted."""
    if albedo is None:
        return
    sheaf, skipped, listed = sheaf_of(scene.camera), 0, 1
    begin_layers(packet, lanes)
    while listed > 0:
        listed = list_lanes(packet, lanes, skipped, sheaf, scene.world, faded, work)
        waiting = listed
        while waiting > 0:
            waiting -= take_round(packet, lanes, lanes, skipped, work.layers, None, orders)
            hits = _gather(packet, lanes, scene, sampling, mixed, work)
            weigh_colors(packet, hits)
            gather_albedos(packet, hits)
        skipped += AT_ONCE
    leave_layers(packet, lanes, work.layers)


@device
def _light_lanes(
    packet: Packet,
    lanes: int,
    scene: SceneArrays,
    faded: Faded | None,
    looks: Looks | None,
    sampling: Sampling,
    block: Block,
    begin: int,
    end: int,
    first: int,
    last: int,
    film: Film,
    linear: Rows,
    work: Workspace,
    stop: NDArray[np.bool_],
) -> tuple[int, int]:
    """Find the light of all lanes; return how many hits have it, and how many rays that took."""
    if faded is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if linear is not None:
            if not has_width(sampling.footprint):
                return _light_layers(
                    packet,
                    lanes,
                    scene,
                    faded,
                    sampling,
                    block,
                    begin,
                    first,
                    last,
                    film,
                    work,
                    stop,
                )
            see_all(packet, lanes, scene.fog)
    if looks is not None:  # noqa: SIM102
        if linear is not None:  # noqa: SIM102
            if not has_width(sampling.footprint):
                return _light_bounces(
                    packet,
                    lanes,
                    scene,
                    looks,
                    sampling.paths,
                    sampling,
                    block,
                    begin,
                    first,
                    last,
                    film,
                    work,
                    stop,
                )
    hits = _gather(packet, lanes, scene, sampling, film.mixed, work)
    keep_rays(packet, block, begin, end, first, last, work.pixels, film.kept, scene.fog)
    cast = _light_hits(
        packet, hits, scene, sampling, block, begin, first, last, film, work, stop, 0
    )
    veil(packet, lanes, hits, film.linear, film.error, scene.fog)
    order_hits(packet, hits, film.orders)
    return hits, cast


@device
def _light_layers(
    packet: Packet,
    lanes: int,
    scene: SceneArrays,
    faded: Faded,
    sampling: Sampling,
    block: Block,
    begin: int,
    first: int,
    last: int,
    film: Film,
    work: Workspace,
    stop: NDArray[np.bool_],
) -> tuple[int, int]:
    """Find the light of all lanes layer by layer; the result is that of `_light_lanes`."""
    sheaf, cast, skipped, listed = sheaf_of(scene.camera), 0, 0, 1
    # The samples of a pixel decide together how many rays go to soft lights.
    together = lanes if scene.lights.soft is None else last - first
    begin_layers(packet, lanes)
    while listed > 0 and not stop[0]:
        listed = list_lanes(packet, lanes, skipped, sheaf, scene.world, faded, work)
        waiting = listed
        while waiting > 0 and not stop[0]:
            waiting -= take_round(
                packet, lanes, together, skipped, work.layers, scene.fog, film.orders
            )
            hits = _gather(packet, lanes, scene, sampling, film.mixed, work)
            weigh_colors(packet, hits)
            cast += _light_hits(
                packet, hits, scene, sampling, block, begin, first, last, film, work, stop, 0
            )
            gather_light(packet, hits)
            order_hits(packet, hits, film.orders)
        skipped += AT_ONCE
    return end_layers(packet, lanes, work.layers), cast


@device
def _light_bounces(
    packet: Packet,
    lanes: int,
    scene: SceneArrays,
    looks: Looks,
    paths: Paths | None,
    sampling: Sampling,
    block: Block,
    begin: int,
    first: int,
    last: int,
    film: Film,
    work: Workspace,
    stop: NDArray[np.bool_],
) -> tuple[int, int]:
    """Find the light of all lanes over many surfaces; the result is that of `_light_lanes`."""
    cast, steps, sheaf, pending = 0, 0, bounced_sheaf(), work.pending
    world, materials, forward = scene.world, scene.materials, scene.camera.forward
    begin_bounces(
        packet, lanes, sheaf_of(scene.camera), world, materials, looks, pending, work.stack
    )
    hits = _gather(packet, lanes, scene, sampling, film.mixed, work)
    while hits > 0 and not stop[0]:
        if paths is not None:
            cast += scatter_hits(
                packet,
                hits,
                path_world(scene),
                looks,
                last - first,
                first,
                block,
                begin,
                paths,
                sampling.seed,
                work,
                film.orders,
            )
        else:
            split_hits(
                packet,
                hits,
                world,
                materials,
                looks,
                forward,
                pending,
                looks.depth,
                film.orders,
            )
        cast += _light_hits(
            packet, hits, scene, sampling, block, begin, first, last, film, work, stop, steps
        )
        gather_light(packet, hits)
        order_hits(packet, hits, film.orders)
        cast += follow_rays(
            packet, lanes, world, scene.lights, looks, pending, looks.depth, work, film.orders
        )
        hits = gather_interactions(
            packet,
            lanes,
            sampling.rays,
            in_common(sheaf),
            True,
            some_footprint(sampling.footprint),
            world,
            materials,
            forward,
            scene.camera.middle_depth,
            work,
        )
        steps += 1
    cast_rays(packet, lanes, scene.camera)
    hits = end_bounces(packet, lanes, looks.brightest, film.orders)
    veil(packet, lanes, hits, film.linear, film.error, scene.fog)
    veil_orders(packet, lanes, film.orders, scene.fog)
    return hits, cast


@device
def _gather(
    packet: Packet,
    lanes: int,
    scene: SceneArrays,
    sampling: Sampling,
    mixed: Rows,
    work: Workspace,
) -> int:
    """Bring what the rays of a packet hit together; return how many hits."""
    sheaf, footprint = sheaf_of(scene.camera), sampling.footprint
    hits = gather_interactions(
        packet,
        lanes,
        sampling.rays,
        in_common(sheaf),
        has_own(sheaf),
        some_footprint(footprint),
        scene.world,
        scene.materials,
        scene.camera.forward,
        scene.camera.middle_depth,
        work,
    )
    if mixed is not None:  # noqa: SIM102
        if has_width(footprint) and hits > 0:
            find_patches(packet, hits, footprint, sampling.thickest)
            find_close_planes(packet, hits, scene.world, work)
    return hits


@device
def _light_hits(
    packet: Packet,
    hits: int,
    scene: SceneArrays,
    sampling: Sampling,
    block: Block,
    begin: int,
    first: int,
    last: int,
    film: Film,
    work: Workspace,
    stop: NDArray[np.bool_],
    step: int,
) -> int:
    """Add all lights to the hits of a packet; return how many shadow rays were cast.

    Between them and the camera are as many other surfaces as `step` says.
    """
    if hits == 0:
        return 0
    is_wide = _is_wide(sampling, film.mixed)
    cast = _add_points(
        scene, scene.lights.points, hits, film.linear, is_wide, film.kept, packet, work, stop
    )
    cast += _add_soft_lights(
        scene,
        scene.lights.soft,
        scene.lights.crowd,
        seed_of_step(sampling.seed, step),
        step == 0,
        sampling.fans,
        block,
        begin,
        first,
        last,
        hits,
        film.linear,
        film.error,
        is_wide,
        film.kept,
        packet,
        work,
    )
    _mix_hits(packet, hits, is_wide)
    return cast


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
    seed: int,
    is_near: bool,
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
            lit, samples = lit_world(scene), last - first
            # A truth value in any case: what takes long to compile is the same for all films.
            is_asked = False if is_wide is None else is_wide
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
                        is_asked,
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
                is_asked,
                is_near,
                kept.cosines,
                work,
            )
    if error is not None:
        clear_noise(packet, hits)
    return 0
