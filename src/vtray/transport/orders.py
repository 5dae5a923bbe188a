"""Light in orders: how often surfaces have scattered it on its way to the camera.

Not at all: a lamp that is seen, or a surface that shines. Once: light of lamps and skies from the
first surface, be that matt, glossy, a mirror or glass. Or more often. What an order has of the
light of a lane is added up beside it, where that is asked. The code is the same for all films.

References
----------
Heckbert, "Adaptive Radiosity Textures for Bidirectional Ray Tracing", SIGGRAPH 1990 (paths of light
as words: emission is LE, direct is L.E, indirect is L..+E).
"""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    BOUNCES,
    EMISSION,
    LANES,
    LIGHT,
    NO_PRIMITIVE,
    PRIMITIVE,
    SOURCE,
    VALUE,
    WEIGHT,
    Block,
    Packet,
    integers,
    load,
    store,
)
from vtray.geometry.packets.workspace import Pixels, Sums
from vtray.geometry.vector import Vec, add
from vtray.transport.film import place_of
from vtray.transport.fog import FogFrame, lane_share

MOST = 2
"""Light that was scattered so often or more often has the last order."""

ROWS = 9
"""Numbers of a lane: three channels for each order."""


OrderRows = NDArray[np.float64]
"""What a film holds of them, (height, width, ``ROWS``); of no size where they are not wanted."""


@device
def are_wanted(orders: OrderRows) -> bool:
    """Tell whether light is added in its order, too."""
    wanted: bool = orders.shape[0] > 0
    return wanted


@device
def clear_orders(packet: Packet, lanes: int, orders: OrderRows) -> None:
    """Begin with no light in any order, and no surface between the lanes and the camera."""
    if not are_wanted(orders):
        return
    numbers = integers(packet)
    for lane in range(lanes):
        numbers[BOUNCES + lane] = 0
        for row in range(ROWS):
            packet[EMISSION + row * LANES + lane] = 0.0


@device
def add_in_order(packet: Packet, lane: int, light: Vec, number: int, orders: OrderRows) -> None:
    """Add light that was scattered so often to that of a lane."""
    if not are_wanted(orders):
        return
    field = EMISSION + 3 * LANES * min(number, MOST)
    store(packet, field, lane, add(load(packet, field, lane), light))


@device
def order_hits(packet: Packet, hits: int, orders: OrderRows) -> None:
    """Add the light of hits to that of their lanes: their surfaces have scattered it, too."""
    if not are_wanted(orders):
        return
    numbers = integers(packet)
    for hit in range(hits):
        lane = numbers[SOURCE + hit]
        number = numbers[BOUNCES + lane] + 1
        add_in_order(packet, lane, load(packet, VALUE, hit), number, orders)


@device
def order_lamps(packet: Packet, lanes: int, orders: OrderRows) -> None:
    """Set the light of the lanes in which a lamp is seen."""
    if not are_wanted(orders):
        return
    numbers = integers(packet)
    for lane in range(lanes):
        if numbers[PRIMITIVE + lane] < NO_PRIMITIVE:
            store(packet, EMISSION, lane, load(packet, LIGHT, lane))


@device
def limit_orders(
    packet: Packet, lane: int, brightest: float, peak: float, orders: OrderRows
) -> None:
    """Let all orders of a lane become darker alike if its peak is brighter than it may be."""
    if not are_wanted(orders):
        return
    if peak > brightest:
        for row in range(ROWS):
            packet[EMISSION + row * LANES + lane] *= brightest / peak


@device
def veil_orders(packet: Packet, lanes: int, orders: OrderRows, fog: FogFrame | None) -> None:
    """Take from all orders of the light of surfaces what fog hides of it, as `fog.veil` does."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if fog is not None:  # noqa: SIM102
        if are_wanted(orders):
            for lane in range(lanes):
                clear = 1.0 - lane_share(packet, lane, fog)
                for row in range(ROWS):
                    packet[EMISSION + row * LANES + lane] *= clear


@device
def clear_sums_of_orders(sums: Sums, pixels: int, orders: OrderRows) -> None:
    """Start to add up the orders of the samples of some pixels."""
    if not are_wanted(orders):
        return
    for k in range(pixels):
        for row in range(ROWS):
            sums.orders[row * LANES + k] = 0.0


@device
def add_orders(packet: Packet, lanes: int, samples: int, sums: Sums, orders: OrderRows) -> None:
    """Add the orders of the samples of a packet to their pixels, as `film.add_samples` does."""
    if not are_wanted(orders):
        return
    for k in range(lanes // samples):
        for row in range(ROWS):
            total = sums.orders[row * LANES + k]
            for lane in range(k * samples, (k + 1) * samples):
                total += packet[WEIGHT + lane] * packet[EMISSION + row * LANES + lane]
            sums.orders[row * LANES + k] = total


@device
def write_sums_of_orders(
    block: Block, begin: int, end: int, pixels: Pixels, sums: Sums, orders: OrderRows
) -> None:
    """Write the orders of pixels of a block's list to the film, as `film.write_pixels` does."""
    if not are_wanted(orders):
        return
    for k in range(end - begin):
        at, column = place_of(block, pixels[begin + k])
        for row in range(ROWS):
            orders[at, column, row] = sums.orders[row * LANES + k] / sums.weight[k]


@device
def write_orders(
    packet: Packet, block: Block, begin: int, end: int, pixels: Pixels, orders: OrderRows
) -> None:
    """Write the orders of pixels with one ray to the film, as `film.write_middles` does."""
    if not are_wanted(orders):
        return
    for lane in range(end - begin):
        at, column = place_of(block, pixels[begin + lane])
        for row in range(ROWS):
            orders[at, column, row] = packet[EMISSION + row * LANES + lane]
