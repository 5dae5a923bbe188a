"""The whitted integrator: mirrors and smooth glass followed exactly, without chance.

Each ray that meets a mirror goes on; each that meets glass goes on as two. What they meet is lit as
by the direct integrator. Rays of which less than ``LEAST`` would be seen are not followed.

References
----------
Whitted, "An Improved Illumination Model for Shaded Display", Communications of the ACM 23, 1980.
"""

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    BOUNCES,
    COLOR,
    NOISE,
    NORMAL,
    PRIMITIVE,
    SOURCE,
    THROUGHPUT,
    TOWARDS,
    WITHIN,
    Packet,
    integers,
    load,
    store,
)
from vtray.geometry.packets.pending import Pending
from vtray.geometry.vector import Vec, dot, scale
from vtray.geometry.world import World
from vtray.transport.integrators.bounces import (
    comes_from_within,
    mirrored_share,
    push_from,
    shine,
    times,
)
from vtray.transport.materials.look import EMISSIVE, EMPTY, GLASS, MATT, Looks, first_number
from vtray.transport.materials.material import Materials, load_look
from vtray.transport.materials.optics import mirrored, split_at

LEAST = 2.0**-10
"""Rays of which no channel would be seen by more than that are not followed: less than a quarter of
a step of 255, for light that is white."""


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
    numbers = integers(packet)
    for hit in range(hits):
        lane = numbers[SOURCE + hit]
        look = load_look(materials, looks, numbers[PRIMITIVE + lane])
        seen, color = load(packet, THROUGHPUT, lane), load(packet, COLOR, hit)
        packet[NOISE + hit] = 0.0
        is_matt = look.kind == MATT
        store(packet, COLOR, hit, times(seen, color) if is_matt else (0.0, 0.0, 0.0))
        tinted = times(seen, scale(1.0 / 255.0, color))
        if look.kind == EMISSIVE:
            shine(packet, lane, looks, look, tinted)
        bounces, within = numbers[BOUNCES + lane] + 1, numbers[WITHIN + lane]
        if is_matt or look.kind == EMISSIVE or bounces > most:
            continue
        direction, normal = load(packet, TOWARDS, hit), load(packet, NORMAL, hit)
        if look.kind == GLASS:
            is_inner = comes_from_within(packet, hit, lane, world)
            ior = first_number(looks, look)
            split = split_at(direction, normal, 1.0 / ior if is_inner else ior)
            way, share = mirrored(direction, normal), scale(split.reflected, seen)
            passed, beyond = scale(1.0 - split.reflected, tinted), EMPTY if is_inner else look.row
            _push(packet, hit, lane, way, share, bounces, within, forward, pending)
            _push(packet, hit, lane, split.refracted, passed, bounces, beyond, forward, pending)
        else:
            share = mirrored_share(looks, look, -dot(direction, normal), seen, tinted)
            way = mirrored(direction, normal)
            _push(packet, hit, lane, way, share, bounces, within, forward, pending)


@device
def _push(
    packet: Packet,
    hit: int,
    lane: int,
    direction: Vec,
    seen: Vec,
    bounces: int,
    within: int,
    forward: Vec,
    pending: Pending,
) -> None:
    """Let a ray from a hit wait, if enough of it would be seen; see `push_from`."""
    if max(seen[0], seen[1], seen[2]) >= LEAST:
        push_from(packet, hit, lane, direction, seen, bounces, True, within, forward, pending)
