"""What the rays of a packet see of faded bodies: layer by layer, and behind them what is opaque.

Each layer of each ray is a hit. Its colour counts as much as light from there passes the layers
before it, so that all that lights add to it is what is seen of that.
"""

import math

from vtray.base.compiler.compiled import device
from vtray.geometry.faded.chords import End
from vtray.geometry.faded.layers import Slot, list_layers
from vtray.geometry.faded.nearby import Tube, touches_faded
from vtray.geometry.packets.layer_notes import AT_ONCE, Layers
from vtray.geometry.packets.packet import (
    BEHIND,
    BEHIND_DISTANCE,
    BEHIND_MET,
    COLOR,
    COVER,
    DISTANCE,
    FOGGED,
    GATHERED,
    LAMBERT,
    LIGHT,
    MET,
    MIXED,
    NEXT_LAYER,
    NO_PRIMITIVE,
    NOISE,
    PASSED_LAYERS,
    PRIMITIVE,
    SHARE,
    SOURCE,
    VALUE,
    VARIANCE,
    Packet,
    Sheaf,
    integers,
    load,
    load_ray,
    store,
)
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import Footprint, growth_of, width_at
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import add, scale
from vtray.geometry.world import Faded, World, load_body
from vtray.transport.fog import FogFrame, lane_share
from vtray.transport.orders import OrderRows, add_in_order


@device
def mix_faded(
    packet: Packet,
    lanes: int,
    sheaf: Sheaf,
    footprint: Footprint | None,
    world: World,
    faded: Faded | None,
    work: Workspace,
) -> None:
    """Set field ``MIXED`` of the lanes whose pixels may see something of a faded body."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if faded is None:
        return
    for lane in range(lanes):
        ray = load_ray(packet, sheaf, lane)
        tube = Tube(
            ray.origin,
            ray.direction,
            width_at(footprint, 0.0),
            growth_of(footprint),
            packet[DISTANCE + lane],
            ray.error_scale,
        )
        if touches_faded(world, faded, tube, work.stack):
            packet[MIXED + lane] = 1.0


@device
def choose_surfaces(
    packet: Packet, lanes: int, sheaf: Sheaf, world: World, faded: Faded | None, work: Workspace
) -> None:
    """Let the first layers that are opaque enough take the lanes."""
    if faded is None:
        return
    numbers, layers = integers(packet), work.layers
    for lane in range(lanes):
        skipped, found = 0, AT_ONCE
        while skipped < found:
            found = _list_lane(packet, lane, skipped, sheaf, world, faded, work)
            for k in range(lane * AT_ONCE, lane * AT_ONCE + layers.listed[lane]):
                body = load_body(faded.bodies, layers.number[k])
                if faded.bodies.opacity[body] > faded.least:
                    packet[DISTANCE + lane] = layers.distance[k]
                    numbers[PRIMITIVE + lane] = layers.number[k]
                    numbers[MET + lane] = layers.met[k]
                    found = 0
                    break
            skipped += AT_ONCE


@device
def see_all(packet: Packet, lanes: int, fog: FogFrame | None) -> None:
    """Note that lanes see all of what they meet, and fog: those that see layers are left out."""
    numbers = integers(packet)
    for lane in range(lanes):
        packet[SHARE + lane] = 1.0
        packet[COVER + lane] = 1.0 if numbers[PRIMITIVE + lane] != NO_PRIMITIVE else 0.0
        packet[FOGGED + lane] = 0.0
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if fog is not None:
        for lane in range(lanes):
            packet[FOGGED + lane] = lane_share(packet, lane, fog)


@device
def begin_layers(packet: Packet, lanes: int) -> None:
    """Keep what is behind all layers, and start with no light."""
    numbers = integers(packet)
    for lane in range(lanes):
        packet[BEHIND_DISTANCE + lane] = packet[DISTANCE + lane]
        numbers[BEHIND + lane] = numbers[PRIMITIVE + lane]
        numbers[BEHIND_MET + lane] = numbers[MET + lane]
        numbers[PASSED_LAYERS + lane] = AT_ONCE
        packet[VARIANCE + lane] = 0.0
        packet[FOGGED + lane] = 0.0
        store(packet, GATHERED, lane, (0.0, 0.0, 0.0))


@device
def list_lanes(
    packet: Packet,
    lanes: int,
    skipped: int,
    sheaf: Sheaf,
    world: World,
    faded: Faded,
    work: Workspace,
) -> int:
    """List the layers of all lanes after so many; return how many there are, with what is behind.

    What is behind the layers of a lane is one more where all of them are listed.
    """
    numbers, waiting = integers(packet), 0
    for lane in range(lanes):
        numbers[NEXT_LAYER + lane] = 0
        if numbers[PASSED_LAYERS + lane] > skipped or skipped == 0:
            _restore(packet, lane)
            found = _list_lane(packet, lane, skipped, sheaf, world, faded, work)
            numbers[PASSED_LAYERS + lane] = found
            is_last = found - skipped <= AT_ONCE
            waiting += work.layers.listed[lane] + (1 if is_last else 0)
        else:
            work.layers.listed[lane] = 0
    return waiting


@device
def _list_lane(
    packet: Packet,
    lane: int,
    skipped: int,
    sheaf: Sheaf,
    world: World,
    faded: Faded,
    work: Workspace,
) -> int:
    """List the layers of a lane after so many; return how many there are."""
    primitive = integers(packet)[PRIMITIVE + lane]
    ray, end = load_ray(packet, sheaf, lane), End(packet[DISTANCE + lane], primitive, 0.0)
    slot = Slot(work.layers, lane, skipped)
    return list_layers(world, faded, ray, end, slot, work.walk, work.stack)


@device
def _restore(packet: Packet, lane: int) -> None:
    """Bring back what is behind all layers of a lane."""
    numbers = integers(packet)
    packet[DISTANCE + lane] = packet[BEHIND_DISTANCE + lane]
    numbers[PRIMITIVE + lane] = numbers[BEHIND + lane]
    numbers[MET + lane] = numbers[BEHIND_MET + lane]


@device
def take_round(
    packet: Packet,
    lanes: int,
    together: int,
    skipped: int,
    layers: Layers,
    fog: FogFrame | None,
    orders: OrderRows,
) -> int:
    """Let the next of what is listed take some lanes, or what is behind the last of it.

    Of so many lanes together, these are the ones in which that is nearer than on average: so what
    takes them is near each other, and so are the shadow rays from there. The light of lamps that
    are seen is added in its order, too, if that is wanted.

    Parameters
    ----------
    packet, lanes, together
        The lanes, and how many of them have a say in which are taken: no more than those of a pixel
        where what they are lit by depends on which others are.
    skipped, layers
        After how many layers of each lane the list begins, and the list.
    fog, orders
        What takes its share of all that is seen, and where light goes by its order.

    Returns
    -------
    int
        How many lanes were taken.
    """
    taken = 0
    for begin in range(0, lanes, together):
        end = min(begin + together, lanes)
        farthest = _mean_distance(packet, begin, end, skipped, layers)
        for lane in range(begin, end):
            distance = _next_distance(packet, lane, layers)
            is_now = distance <= farthest or distance == math.inf
            if is_now and _is_waiting(packet, lane, skipped, layers):
                _take(packet, lane, layers, fog, orders)
                taken += 1
            else:
                integers(packet)[PRIMITIVE + lane] = NO_PRIMITIVE
    return taken


@device
def _take(
    packet: Packet, lane: int, layers: Layers, fog: FogFrame | None, orders: OrderRows
) -> None:
    """Let the next of what is listed of a lane take it, or what is behind the last."""
    numbers = integers(packet)
    k = numbers[NEXT_LAYER + lane]
    numbers[NEXT_LAYER + lane] = k + 1
    if k < layers.listed[lane]:
        place = lane * AT_ONCE + k
        packet[DISTANCE + lane] = layers.distance[place]
        numbers[PRIMITIVE + lane] = layers.number[place]
        numbers[MET + lane] = layers.met[place]
        packet[SHARE + lane] = _clear_share(packet, lane, layers.share[place], fog)
    elif layers.passed[lane] > 0.0:
        _restore(packet, lane)
        packet[SHARE + lane] = _clear_share(packet, lane, layers.passed[lane], fog)
        if numbers[PRIMITIVE + lane] < NO_PRIMITIVE:
            light = scale(packet[SHARE + lane], load(packet, LIGHT, lane))
            store(packet, GATHERED, lane, add(load(packet, GATHERED, lane), light))
            add_in_order(packet, lane, light, 0, orders)
    else:
        numbers[PRIMITIVE + lane] = NO_PRIMITIVE


@device
def _is_waiting(packet: Packet, lane: int, skipped: int, layers: Layers) -> bool:
    """Tell whether any of what is listed of a lane, or what is behind, is not yet seen."""
    numbers = integers(packet)
    k, listed = numbers[NEXT_LAYER + lane], layers.listed[lane]
    found = numbers[PASSED_LAYERS + lane]
    is_last = (found > skipped) | (skipped == 0) and found - skipped <= AT_ONCE
    return bool((k < listed) | ((k == listed) & is_last))


@device
def _next_distance(packet: Packet, lane: int, layers: Layers) -> float:
    """Return how far the next of what is listed of a lane is, or what is behind."""
    k = integers(packet)[NEXT_LAYER + lane]
    if k < layers.listed[lane]:
        distance: float = layers.distance[lane * AT_ONCE + k]
        return distance
    behind: float = packet[BEHIND_DISTANCE + lane]
    return behind


@device
def _mean_distance(packet: Packet, begin: int, end: int, skipped: int, layers: Layers) -> float:
    """Return how far what is next in some lanes is on average, which is not nearer than all."""
    total, count, most = 0.0, 0, 0.0
    for lane in range(begin, end):
        if _is_waiting(packet, lane, skipped, layers):
            distance = _next_distance(packet, lane, layers)
            if distance < math.inf:
                total += distance
                most = max(most, distance)
                count += 1
    return min(total / max(count, 1) * (1.0 + MARGIN), most)


@device
def _clear_share(packet: Packet, lane: int, share: float, fog: FogFrame | None) -> float:
    """Return what fog leaves of a share of what a lane sees, and note what it takes."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if fog is not None:
        fogged = lane_share(packet, lane, fog)
        packet[FOGGED + lane] += share * fogged
        return share * (1.0 - fogged)
    return share


@device
def weigh_colors(packet: Packet, hits: int) -> None:
    """Let the colours of hits count as much as is seen of them."""
    numbers = integers(packet)
    for hit in range(hits):
        share = packet[SHARE + numbers[SOURCE + hit]]
        store(packet, COLOR, hit, scale(share, load(packet, COLOR, hit)))
        packet[NOISE + hit] = 0.0


@device
def gather_light(packet: Packet, hits: int) -> None:
    """Add the light of hits to that of their lanes."""
    numbers = integers(packet)
    for hit in range(hits):
        lane = numbers[SOURCE + hit]
        light = add(load(packet, GATHERED, lane), load(packet, VALUE, hit))
        store(packet, GATHERED, lane, light)
        packet[VARIANCE + lane] += packet[NOISE + hit]


@device
def gather_albedos(packet: Packet, hits: int) -> None:
    """Add the share of light that hits send on, of colours that are weighed, to their lanes."""
    numbers = integers(packet)
    for hit in range(hits):
        lane = numbers[SOURCE + hit]
        shares = scale(packet[LAMBERT + hit] / 255.0, load(packet, COLOR, hit))
        store(packet, GATHERED, lane, add(load(packet, GATHERED, lane), shares))


@device
def leave_layers(packet: Packet, lanes: int, layers: Layers) -> None:
    """Bring back what is behind all layers, and note how much of what is behind all is covered."""
    numbers = integers(packet)
    for lane in range(lanes):
        _restore(packet, lane)
        is_open = numbers[BEHIND + lane] == NO_PRIMITIVE
        packet[COVER + lane] = 1.0 - layers.passed[lane] if is_open else 1.0


@device
def end_layers(packet: Packet, lanes: int, layers: Layers) -> int:
    """Make one hit of all that each lane sees; return how many there are."""
    numbers, hits = integers(packet), 0
    leave_layers(packet, lanes, layers)
    for lane in range(lanes):
        behind = numbers[BEHIND + lane]
        if numbers[PASSED_LAYERS + lane] > 0 or behind > NO_PRIMITIVE:
            numbers[PRIMITIVE + lane] = max(behind, 0)
            numbers[SOURCE + hits] = lane
            store(packet, VALUE, hits, load(packet, GATHERED, lane))
            packet[NOISE + hits] = packet[VARIANCE + lane]
            hits += 1
        elif behind < NO_PRIMITIVE:
            # A lamp with nothing before it: what fog leaves of its light.
            store(packet, LIGHT, lane, load(packet, GATHERED, lane))
    return hits
