"""The whitted integrator: mirrors and smooth glass followed exactly, without chance.

Each ray that meets a mirror goes on; each that meets glass goes on as two. What they meet is lit as
by the direct integrator: so is the base of plastic by what its coat does not mirror. Rough surfaces
are taken for smooth ones. Rays of which less than ``LEAST`` would be seen are not followed.

References
----------
Whitted, "An Improved Illumination Model for Shaded Display", Communications of the ACM 23, 1980.
"""

from vtray.base.compiler.compiled import device, part, passing_on
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
from vtray.geometry.vector import Vec, add, dot, scale
from vtray.geometry.world import Solids, World
from vtray.transport.integrators.bounces import (
    mirrored_share,
    push_from,
    shine,
    times,
)
from vtray.transport.interaction import comes_from_within
from vtray.transport.materials.look import (
    EMISSIVE,
    EMPTY,
    GLASS,
    MATT,
    PLASTIC,
    Look,
    Looks,
    first_number,
    index_ratio,
    is_thin,
    nth_of_blend,
    parts_of,
)
from vtray.transport.materials.material import Materials, Paints, load_look
from vtray.transport.materials.optics import (
    Split,
    mirrored,
    mirrored_part,
    split_at,
    through_both,
)
from vtray.transport.orders import OrderRows

LEAST = 2.0**-10
"""Rays of which no channel would be seen by more than that are not followed: less than a quarter of
a step of 255, for light that is white."""


@part
@passing_on(Solids, Paints)
def split_hits(
    packet: Packet,
    hits: int,
    world: World,
    materials: Materials,
    looks: Looks,
    forward: Vec,
    pending: Pending,
    most: int,
    orders: OrderRows,
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
    orders
        Where light is added in its order, too, if that is wanted.
    """
    numbers = integers(packet)
    for hit in range(hits):
        lane = numbers[SOURCE + hit]
        look = load_look(materials, looks, numbers[PRIMITIVE + lane])
        seen, color = load(packet, THROUGHPUT, lane), load(packet, COLOR, hit)
        packet[NOISE + hit] = 0.0
        matt = (0.0, 0.0, 0.0)
        for number in range(parts_of(look)):
            one, share = nth_of_blend(looks, look, number)
            scattered = _split_part(
                packet,
                hit,
                world,
                looks,
                one,
                scale(share, seen),
                color,
                forward,
                pending,
                most,
                orders,
            )
            matt = add(matt, times(scattered, color))
        store(packet, COLOR, hit, matt)


@device
def _split_part(
    packet: Packet,
    hit: int,
    world: World,
    looks: Looks,
    look: Look,
    seen: Vec,
    color: Vec,
    forward: Vec,
    pending: Pending,
    most: int,
    orders: OrderRows,
) -> Vec:
    """Let the rays that go on from one material wait; return how much is seen of it as matt."""
    numbers = integers(packet)
    lane, nothing = numbers[SOURCE + hit], (0.0, 0.0, 0.0)
    if look.kind == MATT:
        return seen
    tinted = times(seen, scale(1.0 / 255.0, color))
    if look.kind == EMISSIVE:
        shine(packet, lane, looks, look, tinted, orders)
        return nothing
    direction, normal = load(packet, TOWARDS, hit), load(packet, NORMAL, hit)
    cosine, matt = -dot(direction, normal), nothing
    bounces, within = numbers[BOUNCES + lane] + 1, numbers[WITHIN + lane]
    if look.kind == PLASTIC:
        coat = mirrored_part(cosine, first_number(looks, look))
        matt, share = scale(1.0 - coat, seen), scale(coat, seen)
    else:
        share = mirrored_share(looks, look, cosine, seen, tinted)
    split, beyond, passed = Split(1.0, direction), within, nothing
    if look.kind == GLASS:
        is_inner = comes_from_within(packet, hit, lane, world)
        split = split_at(direction, normal, index_ratio(looks, look, is_inner))
        if is_thin(looks, look):
            split = through_both(split, direction)
        else:
            beyond = EMPTY if is_inner else look.row
        share, passed = scale(split.reflected, seen), scale(1.0 - split.reflected, tinted)
    if bounces <= most:
        way = mirrored(direction, normal)
        _push(packet, hit, lane, way, share, bounces, within, forward, pending)
        _push(packet, hit, lane, split.refracted, passed, bounces, beyond, forward, pending)
    return matt


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
        push_from(packet, hit, lane, direction, seen, bounces, True, within, 0.0, forward, pending)
