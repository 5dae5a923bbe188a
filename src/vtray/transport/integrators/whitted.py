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
    BOUNCES,
    COLOR,
    NOISE,
    NORMAL,
    PRIMITIVE,
    SOURCE,
    THROUGHPUT,
    TOWARDS,
    Packet,
    load,
    store,
)
from vtray.geometry.packets.pending import Pending
from vtray.geometry.vector import Vec, scale
from vtray.geometry.world import World
from vtray.transport.integrators.bounces import is_inner, push_from, times
from vtray.transport.materials.look import GLASS, MATT, MIRROR, Looks
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
    numbers = packet.view(np.int64)
    for hit in range(hits):
        lane = numbers[SOURCE + hit]
        look = load_look(materials, looks, numbers[PRIMITIVE + lane])
        seen, color = load(packet, THROUGHPUT, lane), load(packet, COLOR, hit)
        packet[NOISE + hit] = 0.0
        if look.kind == MATT:
            store(packet, COLOR, hit, times(seen, color))
            continue
        store(packet, COLOR, hit, (0.0, 0.0, 0.0))
        bounces = numbers[BOUNCES + lane] + 1
        if bounces > most:
            continue
        tinted = times(seen, scale(1.0 / 255.0, color))
        direction, normal = load(packet, TOWARDS, hit), load(packet, NORMAL, hit)
        if look.kind == MIRROR:
            way = mirrored(direction, normal)
            _push(packet, hit, lane, way, tinted, bounces, forward, pending)
        if look.kind == GLASS:
            ratio = 1.0 / look.ior if is_inner(packet, hit, lane, world) else look.ior
            split = split_at(direction, normal, ratio)
            way, share = mirrored(direction, normal), split.reflected
            _push(packet, hit, lane, way, scale(share, seen), bounces, forward, pending)
            passed = scale(1.0 - share, tinted)
            _push(packet, hit, lane, split.refracted, passed, bounces, forward, pending)


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
    """Let a ray from a hit wait, if enough of it would be seen; see `push_from`."""
    if max(seen[0], seen[1], seen[2]) >= LEAST:
        push_from(packet, hit, lane, direction, seen, bounces, True, forward, pending)
