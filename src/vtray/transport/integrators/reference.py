"""One pixel, ray by ray: the light that comes straight from the lights, in nothing but scalars.

The packets must give the same to the last bit. This is also what ``vtray --pixel`` shows.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.between import first_between
from vtray.geometry.caps import UNKNOWN, Caps
from vtray.geometry.faded.dimming import blocked_share
from vtray.geometry.packets.cone import Touching
from vtray.geometry.packets.fan import BLOCKED, Fan, Start, fan_segment, set_start
from vtray.geometry.packets.layer_notes import Walk
from vtray.geometry.packets.stack import Stack
from vtray.geometry.packets.workspace import Shared
from vtray.geometry.queries import NOTHING, Hit, nearest_hit
from vtray.geometry.ray import Ray, Segment
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.vector import Vec, add, scale, sub
from vtray.transport.camera_rays import camera_ray, plane_depth_of
from vtray.transport.integrators.lamps import nearest_lamp
from vtray.transport.integrators.soft_known import share_at
from vtray.transport.integrators.soft_shared import decide_by_cones
from vtray.transport.interaction import Interaction, interact, material_at
from vtray.transport.lights.crowd import Crowd
from vtray.transport.lights.light import (
    lamp_light,
    light_count,
    light_target,
    load_power,
    powers_of,
    soft_worth,
)
from vtray.transport.lights.soft_light import SoftLights, aim_at, component_count, soft_count
from vtray.transport.materials.lambert import lambert_cosine
from vtray.transport.materials.material import Material, scattered
from vtray.transport.sampling.estimate import (
    counted_variance,
    needs_more,
    no_estimate,
    shares_of,
    with_fan,
)
from vtray.transport.sampling.fans import (
    Fans,
    fan_of,
    fans_of_share,
    shared_keys,
)
from vtray.transport.sampling.light_rays import arriving_shares, spread_fan
from vtray.transport.sampling.shared_estimate import (
    light_of,
    needs_more_shared,
    no_shared_estimate,
    with_shared_fan,
)
from vtray.transport.sampling.shared_fans import spread_among, weigh_lights
from vtray.transport.scene_arrays import SceneArrays, lit_world


class TracedPixel(NamedTuple):
    """How a pixel got its value, lengths in units of the arrays.

    Attributes
    ----------
    ray
        The camera ray.
    distance
        Along the ray to the hit or to a lamp, ``inf`` if there is none.
    primitive
        What is hit, or ``NOTHING``.
    interaction
        Where it is hit; without meaning if nothing is.
    value
        Linear red, green and blue.
    lamp
        The row of the lamp that is seen, or ``NOTHING``; then nothing is hit.
    share
        How much of the light from there is seen: 1 with nothing before it.
    material
        What is hit is made of, whose colour counts as much as is seen of it.
    color
        The colour there as light, 255 for white, of a pattern if there is one.
    sample
        The number of the ray among the samples of the pixel; 0 for that through its middle.
    """

    ray: Ray
    distance: float
    primitive: int
    interaction: Interaction
    value: Vec
    lamp: int
    share: float
    material: Material
    color: Vec
    sample: int


@kernel
def trace_pixel(
    scene: SceneArrays,
    column: int,
    row: int,
    stack: Stack,
    cosines: NDArray[np.float64],
    blockers: NDArray[np.int64],
    walk: Walk,
) -> TracedPixel:
    """Trace one pixel, with the light of points, as if faded bodies were not seen.

    Parameters
    ----------
    scene
        The scene.
    column, row
        The pixel, from the left and from the top.
    stack, walk
        Scratch memory.
    cosines
        Out: for each point light the cosine at the hit, 0 for a light below the horizon, times what
        passes faded bodies.
    blockers
        Out: for each point light the first primitive between hit and light, or ``NOTHING``.
    """
    return trace_behind(scene, column, row, 1.0, stack, cosines, blockers, walk)


@device
def trace_behind(
    scene: SceneArrays,
    column: int,
    row: int,
    share: float,
    stack: Stack,
    cosines: NDArray[np.float64],
    blockers: NDArray[np.int64],
    walk: Walk,
) -> TracedPixel:
    """Trace one pixel, of which a share is seen; the parameters are those of `trace_pixel`."""
    ray = camera_ray(scene.camera, column, row)
    hit = nearest_hit(scene.world, ray, stack)
    value = (0.0, 0.0, 0.0)
    nowhere = Interaction(ray.origin, ray.direction, 0.0, 0)
    lamp, distance = nearest_lamp(ray, hit.distance, scene.lights.visible)
    nothing = Material(value, 0.0), value, 0
    if lamp != NOTHING:
        light = scale(share, lamp_light(scene.lights, lamp))
        return TracedPixel(ray, distance, NOTHING, nowhere, light, lamp, share, *nothing)
    if hit.primitive == NOTHING:
        return TracedPixel(ray, hit.distance, NOTHING, nowhere, value, NOTHING, share, *nothing)
    return light_hit(scene, ray, hit, share, stack, cosines, blockers, walk)


@device
def light_hit(
    scene: SceneArrays,
    ray: Ray,
    hit: Hit,
    share: float,
    stack: Stack,
    cosines: NDArray[np.float64],
    blockers: NDArray[np.int64],
    walk: Walk,
) -> TracedPixel:
    """Return what a ray hits with the light of points, of which a share is seen.

    The parameters are those of `trace_pixel`.
    """
    found = interact(scene.world, ray, hit.distance, hit.group, hit.slot)
    own = material_at(
        scene.world,
        scene.materials,
        hit.primitive,
        found.half,
        hit.group,
        hit.slot,
        found.point,
    )
    material = Material(scale(share, own.color), own.lambert)
    value = light_of_points(scene, found, material, stack, cosines, blockers, walk)
    made = material, own.color, 0
    return TracedPixel(ray, hit.distance, hit.primitive, found, value, NOTHING, share, *made)


@device
def light_of_points(
    scene: SceneArrays,
    found: Interaction,
    material: Material,
    stack: Stack,
    cosines: NDArray[np.float64],
    blockers: NDArray[np.int64],
    walk: Walk,
) -> Vec:
    """Return the light of points at a hit.

    Parameters
    ----------
    scene, stack, cosines, blockers, walk
        As for `trace_pixel`.
    found, material
        The hit, and what is hit is made of, as in `TracedPixel`.
    """
    value, plane_depth = (0.0, 0.0, 0.0), plane_depth_of(scene.camera, found.point)
    for light in range(light_count(scene.lights)):
        target = light_target(scene.lights, light)
        error_bound = ROUNDING * (found.error_scale + target.error_scale)
        to_light = sub(target.place, found.point)
        cosines[light] = lambert_cosine(found.normal, to_light, error_bound)
        segment = Segment(
            found.point,
            target.place,
            plane_depth,
            target.plane_depth,
            found.error_scale,
            target.error_scale,
        )
        blockers[light] = first_between(scene.world, segment, stack)
        if blockers[light] == NOTHING:
            blocked = blocked_share(scene.world, segment, walk, stack)
            cosines[light] = cosines[light] * (1.0 - blocked) if blocked < 1.0 else 0.0
            power = load_power(scene.lights, light)
            value = add(value, scattered(material, cosines[light], power))
    return value


def _trace_fan(
    scene: SceneArrays,
    soft: SoftLights,
    traced: TracedPixel,
    column: int,
    row: int,
    light: int,
    fans: Fans,
    count: int,
    number: int,
    seed: int,
    stack: Stack,
    fan: Fan,
    blockers: NDArray[np.int64],
    walk: Walk,
) -> tuple[Vec, float]:
    """Trace the rays of a fan from the hit of a pixel to one soft light, one by one.

    Parameters
    ----------
    scene, soft
        The scene, and its soft lights.
    traced
        The pixel.
    column, row
        The pixel, from the left and from the top.
    light
        The light, counted among the soft ones.
    fans, count, number, seed
        Which rays are cast: those of the fan of this number, from 0, and of so many; ``AS_NEEDED``
        if that follows of their variance.
    stack, walk
        Scratch memory.
    fan
        Out: the rays.
    blockers
        Out: for each ray the first primitive on its way, or ``NOTHING``.

    Returns
    -------
    shares, spread
        How much of each component of the light arrives, and the variance of that, as the fan alone
        tells it.
    """
    fans = fans_of_share(fans, traced.share)
    point, normal, error_scale, _ = traced.interaction
    start = Start(point, plane_depth_of(scene.camera, point), error_scale)
    aim = aim_at(soft, light, start, normal)
    offset, keys = fan_of(fans, number, max(count, 1), traced.sample, column, row, light, seed)
    spread_fan(
        fan,
        fans.rays,
        aim,
        start,
        normal,
        scene.camera.forward,
        soft.skies,
        fans.points,
        fans.first,
        offset,
        keys,
    )
    set_start(fan, 0, start, aim.error_scale + error_scale)
    for ray in range(fans.rays):
        blockers[ray] = NOTHING
        if fan[BLOCKED + ray] == 0.0:
            segment = fan_segment(fan, ray, 0)
            blockers[ray] = first_between(scene.world, segment, stack)
            is_free = blockers[ray] == NOTHING
            fan[BLOCKED + ray] = (
                blocked_share(scene.world, segment, walk, stack) if is_free else 1.0
            )
    return arriving_shares(fan, fans.rays, component_count(soft, light), aim, normal)


trace_fan, _trace_any_fan = kernel(_trace_fan), device(_trace_fan)
"""What traces one fan, for Python and for kernels."""


@device
def _known_share(
    scene: SceneArrays,
    soft: SoftLights,
    traced: TracedPixel,
    light: int,
    fans: Fans,
    stack: Stack,
    touching: Touching,
    caps: Caps,
) -> float:
    """Return which share of a light is known to arrive at the hit of a pixel, or ``UNKNOWN``."""
    point, normal, error_scale, _ = traced.interaction
    start = Start(point, plane_depth_of(scene.camera, point), error_scale)
    aim, own = aim_at(soft, light, start, normal), fans_of_share(fans, traced.share)
    forward = scene.camera.forward
    return share_at(aim, start, normal, forward, scene.world, own, touching, caps, stack)


class TracedLamp(NamedTuple):
    """What all fans from a hit to a soft light tell.

    Attributes
    ----------
    shares
        How much of each component of the light arrives.
    counted
        The variance of that, as a part of what all lights may have.
    fans
        How many fans that took.
    value
        The light of the pixel with all that arrives.
    """

    shares: Vec
    counted: float
    fans: int
    value: Vec


@kernel
def trace_lamp(
    scene: SceneArrays,
    soft: SoftLights,
    traced: TracedPixel,
    column: int,
    row: int,
    light: int,
    fans: Fans,
    count: int,
    spent: float,
    seed: int,
    stack: Stack,
    fan: Fan,
    blockers: NDArray[np.int64],
    walk: Walk,
    touching: Touching,
    caps: Caps,
) -> TracedLamp:
    """Trace all fans from the hit of a pixel to one soft light.

    Where it is known without rays what arrives, a single one is, and tells nothing.

    Parameters
    ----------
    scene, soft, column, row, light, fans, count, seed, stack, fan, blockers, walk
        As for `trace_fan`.
    traced
        The pixel, with the light of all lights before this one.
    spent
        What these have of the variance that all may have.
    touching, caps
        Scratch memory.
    """
    material = traced.material
    worth, estimate = soft_worth(scene.lights, soft, light, material), no_estimate()
    known = _known_share(scene, soft, traced, light, fans, stack, touching, caps)
    if known != UNKNOWN:
        estimate = with_fan(estimate, (known, 0.0, 0.0), 0.0)
        count = estimate.fans
    while needs_more(estimate, fans, count, worth, spent, light, soft_count(soft)):
        number = estimate.fans
        shares, spread = _trace_any_fan(
            scene,
            soft,
            traced,
            column,
            row,
            light,
            fans,
            count,
            number,
            seed,
            stack,
            fan,
            blockers,
            walk,
        )
        estimate = with_fan(estimate, shares, spread)
    shares, value = shares_of(estimate), traced.value
    counted = counted_variance(estimate, fans, worth)
    for component in range(component_count(soft, light)):
        power = load_power(scene.lights, soft.row[light] + component)
        value = add(value, scattered(material, shares[component], power))
    return TracedLamp(shares, counted, estimate.fans, value)


def _trace_shared_fan(
    scene: SceneArrays,
    soft: SoftLights,
    crowd: Crowd,
    traced: TracedPixel,
    column: int,
    row: int,
    fans: Fans,
    number: int,
    seed: int,
    stack: Stack,
    fan: Fan,
    blockers: NDArray[np.int64],
    shared: Shared,
    walk: Walk,
) -> None:
    """Trace the rays of a shared fan from the hit of a pixel, one by one.

    Parameters
    ----------
    scene, soft, crowd
        The scene, and its soft lights.
    traced, column, row, fans, number, seed, stack, fan, blockers, walk
        As for `trace_fan`.
    shared
        What `trace_crowd` leaves there; out: the light of each ray.
    """
    point, normal, error_scale, _ = traced.interaction
    material = traced.material
    start = Start(point, plane_depth_of(scene.camera, point), error_scale)
    keys, first = shared_keys(column, row, traced.sample, seed), number * fans.rays
    spread_among(
        fan,
        fans.rays,
        powers_of(scene.lights),
        soft,
        crowd,
        start,
        normal,
        material,
        scene.camera.forward,
        fans.points,
        first,
        keys,
        shared,
    )
    for ray in range(fans.rays):
        blockers[ray] = NOTHING
        if fan[BLOCKED + ray] == 0.0:
            segment = fan_segment(fan, ray, ray)
            blockers[ray] = first_between(scene.world, segment, stack)
            is_free = blockers[ray] == NOTHING
            fan[BLOCKED + ray] = (
                blocked_share(scene.world, segment, walk, stack) if is_free else 1.0
            )


trace_shared_fan, _trace_any_shared_fan = kernel(_trace_shared_fan), device(_trace_shared_fan)
"""What traces one shared fan, for Python and for kernels."""


class TracedCrowd(NamedTuple):
    """What all shared fans from a hit tell.

    Attributes
    ----------
    fans
        How many there were.
    value
        The light of the pixel with all that arrives.
    """

    fans: int
    value: Vec


@kernel
def trace_crowd(
    scene: SceneArrays,
    soft: SoftLights,
    crowd: Crowd,
    traced: TracedPixel,
    column: int,
    row: int,
    fans: Fans,
    seed: int,
    stack: Stack,
    fan: Fan,
    blockers: NDArray[np.int64],
    shared: Shared,
    touching: Touching,
    walk: Walk,
) -> TracedCrowd:
    """Trace all shared fans from the hit of a pixel.

    Parameters
    ----------
    scene, soft, crowd, column, row, fans, seed, stack, fan, blockers, walk
        As for `trace_shared_fan`.
    traced
        The pixel, with the light of the points.
    shared
        Out: notes on the lights.
    touching
        Scratch memory.
    """
    point, normal, error_scale, _ = traced.interaction
    material = traced.material
    start = Start(point, plane_depth_of(scene.camera, point), error_scale)
    lit, value, estimate = lit_world(scene), traced.value, no_shared_estimate()
    most = weigh_lights(lit.powers, soft, crowd, start, normal, material, shared.sums)
    if not most > 0.0:
        return TracedCrowd(0, value)
    whole, pool = decide_by_cones(
        lit, soft, crowd, start, normal, material, most, shared, touching, stack
    )
    value = add(value, whole)
    if not pool.most > 0.0:
        return TracedCrowd(0, value)
    while needs_more_shared(estimate, fans):
        number = estimate.fans
        _trace_any_shared_fan(
            scene,
            soft,
            crowd,
            traced,
            column,
            row,
            fans,
            number,
            seed,
            stack,
            fan,
            blockers,
            shared,
            walk,
        )
        estimate = with_shared_fan(estimate, pool, fan, fans, shared.brought)
    return TracedCrowd(estimate.fans, add(value, light_of(estimate, fans)))
