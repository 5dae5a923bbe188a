"""The whitted integrator: mirrors and smooth glass followed exactly, without chance.

Each ray that meets a mirror goes on; each that meets glass goes on as two. What they meet is lit as
by the direct integrator. Rays of which less than ``LEAST`` would be seen are not followed.

References
----------
Whitted, "An Improved Illumination Model for Shaded Display", Communications of the ACM 23, 1980.
"""

import numpy as np

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    BEHIND,
    BEHIND_DISTANCE,
    BEHIND_MET,
    BOUNCES,
    COLOR,
    DIRECTION,
    DISTANCE,
    ERROR_SCALE,
    FORWARD,
    GATHERED,
    MET,
    MIXED,
    NO_PRIMITIVE,
    NOISE,
    NORMAL,
    ORIGIN,
    PLANE_DEPTH,
    POINT,
    PRIMITIVE,
    SOURCE,
    START_BOUND,
    START_DEPTH,
    START_SCALE,
    THROUGHPUT,
    TOWARDS,
    VALUE,
    VARIANCE,
    Packet,
    Sheaf,
    join_met,
    load,
    split_met,
    store,
)
from vtray.geometry.packets.pending import Pending, Waiting, clear_pending, pop_ray, push_ray
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.queries import NOTHING, nearest_hit
from vtray.geometry.ray import Ray
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.vector import Vec, add, dot, scale, sub
from vtray.geometry.world import World, load_group
from vtray.transport.integrators.lamps import nearest_lamp
from vtray.transport.interaction import surface_at
from vtray.transport.lights.light import Lights, lamp_light
from vtray.transport.materials.look import GLASS, MATT, MIRROR, Looks
from vtray.transport.materials.material import Materials, load_look
from vtray.transport.materials.optics import mirrored, split_at
from vtray.transport.surroundings import Surroundings, far_light

LEAST = 2.0**-10
"""Rays of which no channel would be seen by more than that are not followed: less than a quarter of
a step of 255, for light that is white."""


@device
def bounced_sheaf() -> Sheaf:
    """Return what rays from surfaces have in common: nothing."""
    return Sheaf((0.0, 0.0, 0.0), 0.0, 0.0, 0.0, True)


@device
def mix_looks(packet: Packet, lanes: int, materials: Materials, looks: Looks | None) -> None:
    """Set field ``MIXED`` of the lanes that meet mirrors or glass: what these show is not known."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if looks is None:
        return
    numbers = packet.view(np.int64)
    for lane in range(lanes):
        met = numbers[PRIMITIVE + lane]
        if met > NO_PRIMITIVE:  # noqa: SIM102 - the look of nothing is not asked
            if load_look(materials, looks, met).kind != MATT:
                packet[MIXED + lane] = 1.0


@device
def begin_bounces(packet: Packet, lanes: int, pending: Pending) -> None:
    """Keep what the rays of the camera meet, and start with no light."""
    numbers = packet.view(np.int64)
    clear_pending(pending, lanes)
    for lane in range(lanes):
        packet[BEHIND_DISTANCE + lane] = packet[DISTANCE + lane]
        numbers[BEHIND + lane] = numbers[PRIMITIVE + lane]
        numbers[BEHIND_MET + lane] = numbers[MET + lane]
        packet[VARIANCE + lane] = 0.0
        numbers[BOUNCES + lane] = 0
        store(packet, GATHERED, lane, (0.0, 0.0, 0.0))
        store(packet, THROUGHPUT, lane, (1.0, 1.0, 1.0))


@device
def split_hits(
    packet: Packet,
    hits: int,
    world: World,
    materials: Materials,
    looks: Looks,
    forward: Vec,
    pending: Pending,
    most: int,
) -> None:
    """Let the rays that go on from hits wait, and weigh the colours of hits by what is seen.

    Parameters
    ----------
    packet, hits
        So many hits.
    world, materials, looks
        What they are on, and what that is made of.
    forward
        The unit direction in which the camera looks.
    pending
        Out: the rays.
    most
        How many bounces there are at the most.
    """
    numbers = packet.view(np.int64)
    for hit in range(hits):
        lane = numbers[SOURCE + hit]
        look = load_look(materials, looks, numbers[PRIMITIVE + lane])
        seen, color = load(packet, THROUGHPUT, lane), load(packet, COLOR, hit)
        packet[NOISE + hit] = 0.0
        if look.kind == MATT:
            store(packet, COLOR, hit, _times(seen, color))
            continue
        store(packet, COLOR, hit, (0.0, 0.0, 0.0))
        bounces = numbers[BOUNCES + lane] + 1
        if bounces > most:
            continue
        tinted = _times(seen, scale(1.0 / 255.0, color))
        direction, normal = load(packet, TOWARDS, hit), load(packet, NORMAL, hit)
        if look.kind == MIRROR:
            way = mirrored(direction, normal)
            _push(packet, hit, lane, way, tinted, bounces, forward, pending)
        if look.kind == GLASS:
            is_inner = _is_inner(packet, hit, lane, world)
            ratio = 1.0 / look.ior if is_inner else look.ior
            split = split_at(direction, normal, ratio)
            way, share = mirrored(direction, normal), split.reflected
            _push(packet, hit, lane, way, scale(share, seen), bounces, forward, pending)
            passed = scale(1.0 - share, tinted)
            _push(packet, hit, lane, split.refracted, passed, bounces, forward, pending)


@device
def _is_inner(packet: Packet, hit: int, lane: int, world: World) -> bool:
    """Tell whether a ray meets a surface from within."""
    row, slot = split_met(packet.view(np.int64)[MET + lane])
    point, direction = load(packet, POINT, hit), load(packet, TOWARDS, hit)
    surface = surface_at(world, load_group(world, row), slot, point, packet[ERROR_SCALE + hit])
    outward = sub(point, surface.pole) if surface.is_round else surface.pole
    return dot(outward, direction) > 0.0


@device
def _push(
    packet: Packet,
    hit: int,
    lane: int,
    direction: Vec,
    seen: Vec,
    bounces: int,
    forward: Vec,
    pending: Pending,
) -> None:
    """Let a ray from a hit wait, if enough of it would be seen."""
    if max(seen[0], seen[1], seen[2]) < LEAST:
        return
    error_scale = packet[ERROR_SCALE + hit]
    ray = Ray(
        load(packet, POINT, hit),
        direction,
        packet[PLANE_DEPTH + hit],
        dot(direction, forward),
        error_scale,
        ROUNDING * error_scale,
    )
    push_ray(pending, lane, Waiting(ray, seen, bounces))


@device
def follow_rays(
    packet: Packet,
    lanes: int,
    world: World,
    lights: Lights,
    surroundings: Surroundings,
    pending: Pending,
    work: Workspace,
) -> int:
    """Let the next ray of each lane that meets a surface take the lane; return how many rays go.

    The light of lamps that are met instead, or of skies, is added to that of the lane.
    """
    numbers, cast = packet.view(np.int64), 0
    for lane in range(lanes):
        numbers[PRIMITIVE + lane] = NO_PRIMITIVE
        while pending.waiting[lane] > 0 and numbers[PRIMITIVE + lane] == NO_PRIMITIVE:
            ray, seen, bounces = pop_ray(pending, lane)
            hit, cast = nearest_hit(world, ray, work.stack), cast + 1
            lamp, distance = nearest_lamp(ray, hit.distance, lights.visible)
            if lamp != NOTHING:
                _gather(packet, lane, _times(seen, lamp_light(lights, lamp)))
            elif hit.primitive != NOTHING:
                packet[DISTANCE + lane] = distance
                numbers[PRIMITIVE + lane] = hit.primitive
                numbers[MET + lane] = join_met(hit.group, hit.slot)
                numbers[BOUNCES + lane] = bounces
                store(packet, THROUGHPUT, lane, seen)
                _store_ray(packet, lane, ray)
            else:
                _gather(packet, lane, _times(seen, far_light(surroundings, ray.direction)))
    return cast


@device
def _gather(packet: Packet, lane: int, light: Vec) -> None:
    """Add light to that of a lane."""
    store(packet, GATHERED, lane, add(load(packet, GATHERED, lane), light))


@device
def _store_ray(packet: Packet, lane: int, ray: Ray) -> None:
    """Set all that is known of a lane's ray."""
    store(packet, ORIGIN, lane, ray.origin)
    store(packet, DIRECTION, lane, ray.direction)
    packet[FORWARD + lane] = ray.forward
    packet[START_DEPTH + lane] = ray.plane_depth
    packet[START_SCALE + lane] = ray.error_scale
    packet[START_BOUND + lane] = ray.error_bound


@device
def end_bounces(packet: Packet, lanes: int) -> int:
    """Make one hit of all that each lane sees; return how many there are."""
    numbers, hits = packet.view(np.int64), 0
    for lane in range(lanes):
        packet[DISTANCE + lane] = packet[BEHIND_DISTANCE + lane]
        numbers[PRIMITIVE + lane] = numbers[BEHIND + lane]
        numbers[MET + lane] = numbers[BEHIND_MET + lane]
        if numbers[BEHIND + lane] > NO_PRIMITIVE:
            numbers[SOURCE + hits] = lane
            store(packet, VALUE, hits, load(packet, GATHERED, lane))
            packet[NOISE + hits] = packet[VARIANCE + lane]
            hits += 1
    return hits


@device
def _times(one: Vec, other: Vec) -> Vec:
    """Return the products of the parts of two vectors."""
    return one[0] * other[0], one[1] * other[1], one[2] * other[2]
