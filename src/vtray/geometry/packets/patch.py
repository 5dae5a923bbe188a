"""Patches: the parts of surfaces that belong to pixels, and what stands between them and a light.

Shadow rays from all of a patch are a bundle, as the rays are in which it is seen. What a light does
there is settled where one shape is in the way of the whole bundle; where nothing touches it, all of
it is lit; else it may be lit in part. The result does not depend on the order of shapes.
"""

import math
from collections.abc import Callable

import numpy as np

from vtray.base.compiler.compiled import device
from vtray.geometry.bundle import Bundle, Crossing
from vtray.geometry.packets.packet import (
    BLOCKED,
    NORMAL,
    OWNER,
    PATCH,
    PLANE_DEPTH,
    POINT,
    REACH,
    SETTLED,
    TOUCHED,
    TOWARDS,
    UNEVEN,
    Packet,
    load,
)
from vtray.geometry.shapes.plane import PlaneShape, plane_crossing
from vtray.geometry.vector import Vec, dot, scale, sub

OPEN, MIDDLE, DARK, UNEVEN_ALREADY = 0.0, 1.0, 2.0, 3.0
"""What is known in field ``SETTLED``: nothing; that all but the hit itself does not matter, as it
faces away or nearly so; that no light arrives; that the pixel gets samples anyway."""

NEAR_END = 1.0 - 2.0**-30
"""What is nearer to a light than the rest of this share of the way is not in the way."""


@device
def is_open(packet: Packet, lane: int, is_wide: bool | None) -> bool:
    """Tell whether it is worth asking what else stands between a hit or its patch and a light."""
    is_hit_open: bool = packet[BLOCKED + lane] == 0.0
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            settled = packet[SETTLED + lane]
            return (settled == OPEN) | ((settled == MIDDLE) & is_hit_open)
    return is_hit_open


@device
def patch_bundle(packet: Packet, lane: int, end: Vec) -> tuple[Bundle, float]:
    """Return the rays from a patch to a point of light, and how far that is."""
    point, normal, view = load(packet, POINT, lane), load(packet, NORMAL, lane), load(
        packet, TOWARDS, lane
    )
    way = sub(end, point)
    length = math.sqrt(dot(way, way))
    direction = way[0] / length, way[1] / length, way[2] / length
    slant = scale(1.0 / dot(view, normal), normal)
    width = packet[PATCH + lane]
    stretch = packet[REACH + lane] / width
    bundle = Bundle(
        point, direction, width, -width / length, view, slant, stretch, 0.0, 0.0, False
    )
    return bundle, length


@device
def from_within(bundle: Bundle) -> Bundle:
    """Return the bundle with what is met near its start left out: the surface that it starts on."""
    start = 4.0 * bundle.width * bundle.stretch
    return Bundle(
        bundle.origin,
        bundle.direction,
        bundle.width,
        bundle.growth,
        bundle.sight,
        bundle.slant,
        bundle.stretch,
        start,
        start,
        False,
    )


@device
def crossed_share(start: float, reach: float, end: float) -> tuple[float, float]:
    """Return which share of the ways to a light is in front of the image plane: least and most.

    Parameters
    ----------
    start, reach
        The plane depth where they start, and by how much it may be more or less.
    end
        That of the light.
    """
    low, high = max(start - reach, 0.0), start + reach
    is_behind = end < 0.0
    return low / (low - end) if is_behind else 1.0, high / (high - end) if is_behind else 1.0


@device
def note_solid(
    packet: Packet,
    begin: int,
    end: int,
    light: Vec,
    light_plane_depth: float,
    number: int,
    shape: tuple,  # type: ignore[type-arg]
    crossing_of: Callable[..., Crossing],
) -> None:
    """Note of the patches of some lanes what a solid does to the light from a point."""
    numbers = packet.view(np.int64)
    for lane in range(begin, end):
        bundle, length = patch_bundle(packet, lane, light)
        is_own = numbers[OWNER + lane] == number
        outward = sub(load(packet, POINT, lane), shape.center)
        is_outside = dot(load(packet, NORMAL, lane), outward) > 0.0
        near, far = crossing_of(shape, from_within(bundle) if is_own else bundle)
        # Above its horizon, a solid is not in its own way.
        hides_nothing = is_own & is_outside
        near, far = math.inf if hides_nothing else near, math.inf if hides_nothing else far
        _note_lane(packet, lane, length, light_plane_depth, near, far)


@device
def note_plane(
    packet: Packet, hits: int, light: Vec, light_plane_depth: float, number: int, plane: PlaneShape
) -> None:
    """Note of all patches what a plane does to the light from a point."""
    numbers = packet.view(np.int64)
    for lane in range(hits):
        bundle, length = patch_bundle(packet, lane, light)
        near, far = plane_crossing(plane, bundle)
        is_own = numbers[OWNER + lane] == number
        near, far = math.inf if is_own else near, math.inf if is_own else far
        _note_lane(packet, lane, length, light_plane_depth, near, far)


@device
def _note_lane(
    packet: Packet, lane: int, length: float, light_plane_depth: float, near: float, far: float
) -> None:
    """Note of a patch where its shadow rays, of some length, first meet something."""
    reach = packet[REACH + lane]
    least, most = crossed_share(packet[PLANE_DEPTH + lane], reach, light_plane_depth)
    touches = near < NEAR_END * most * length
    settled = packet[SETTLED + lane]
    is_dark = (far < NEAR_END * least * length) & (settled == OPEN)
    packet[TOUCHED + lane] = 1.0 if touches else packet[TOUCHED + lane]
    packet[SETTLED + lane] = DARK if is_dark else settled


@device
def judge_patches(packet: Packet, hits: int) -> None:
    """Find the patches on which a light does not do the same everywhere as at the hit."""
    for lane in range(hits):
        settled, is_hit_dark = packet[SETTLED + lane], packet[BLOCKED + lane] != 0.0
        in_part = (settled == OPEN) & ((packet[TOUCHED + lane] != 0.0) | is_hit_dark)
        wrong = (settled == DARK) & (not is_hit_dark)
        packet[UNEVEN + lane] = 1.0 if in_part | wrong else packet[UNEVEN + lane]
