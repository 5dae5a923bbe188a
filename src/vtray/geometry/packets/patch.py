"""Patches: the parts of surfaces that belong to pixels, and what stands between them and a light.

Shadow rays from all of a patch are a bundle, as the rays are in which it is seen. What a light does
there is settled where one shape is in the way of the whole bundle; where nothing touches it, all of
it is lit; else it may be lit in part. The result does not depend on the order of shapes.
"""

import math
from collections.abc import Callable
from typing import Any

from vtray.base.compiler.compiled import device
from vtray.geometry.bundle import Bundle, Crossing
from vtray.geometry.packets.packet import (
    AIM,
    AIM_LENGTH,
    ALL_IN_FRONT,
    BLOCKED,
    IN_FRONT,
    NORMAL,
    OWNER,
    PATCH,
    POINT,
    REACH,
    SETTLED,
    STRETCH,
    THICKEST,
    TOUCHED,
    TOWARDS,
    UNEVEN,
    Packet,
    integers,
    load,
)
from vtray.geometry.shapes.plane import PlaneShape, plane_crossing
from vtray.geometry.vector import Vec, dot, scale, sub

OPEN, MIDDLE, DARK, UNEVEN_ALREADY = 0.0, 1.0, 2.0, 3.0
"""What is known in field ``SETTLED``: nothing; that all but the hit itself does not matter, as it
faces away or nearly so; that no light arrives; that the pixel gets samples anyway."""

TINY = 1e-300
"""In place of 0, whose inverse must be a number."""

NEAR_END = 1.0 - 2.0**-30
"""What is nearer to a light than the rest of this share of the way is not in the way."""


@device
def is_open(packet: Packet, lane: int, is_wide: bool | None) -> bool:
    """Tell whether it is worth asking what else stands between a hit or its patch and a light."""
    is_hit_open: bool = packet[BLOCKED + lane] == 0.0
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            settled = packet[SETTLED + lane]
            is_asked: bool = (settled == OPEN) | ((settled == MIDDLE) & is_hit_open)
            return is_asked
    return is_hit_open


@device
def widest_reach(packet: Packet, begin: int, end: int, is_wide: bool | None) -> float:
    """Return how far the patches of some lanes reach at the most: of those that are still asked.

    Towards the horizon of a plane they have no end, and are settled before anything is looked for.
    """
    most = 0.0
    for lane in range(begin, end):
        if is_open(packet, lane, is_wide):
            most = max(most, packet[REACH + lane])
    return most


@device
def load_bundle(packet: Packet, lane: int, skips_own: bool) -> Bundle:
    """Return the rays from a patch to a light; if so, without what is met where they start."""
    stretch, width = packet[STRETCH + lane], packet[PATCH + lane]
    start = 4.0 * width * stretch if skips_own else 0.0
    return Bundle(
        load(packet, POINT, lane),
        load(packet, AIM, lane),
        width,
        -width / packet[AIM_LENGTH + lane],
        stretch,
        load(packet, TOWARDS, lane),
        # The normal is on the side that the ray came from.
        scale(-stretch, load(packet, NORMAL, lane)),
        start,
        start,
        True,
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
    number: int,
    shape: Any,  # noqa: ANN401
    is_outside_of: Callable[[Any, Vec, Vec], bool],
    crossing_of: Callable[[Any, Bundle], Crossing],
) -> None:
    """Note of the patches of some lanes what a solid does to the light that they are asked for."""
    numbers = integers(packet)
    for lane in range(begin, end):
        is_own = numbers[OWNER + lane] == number
        is_outside = is_outside_of(shape, load(packet, POINT, lane), load(packet, NORMAL, lane))
        near, far = crossing_of(shape, load_bundle(packet, lane, is_own))
        # Above its horizon, a solid is not in its own way.
        hides_nothing = (is_own & is_outside) | _is_aside(packet, lane, shape.center, shape.radius)
        _note_lane(packet, lane, near, far, hides_nothing, packet[THICKEST + lane] > 0.0)


@device
def _is_aside(packet: Packet, lane: int, center: Vec, radius: float) -> bool:
    """Tell whether a ball is beside all that is between a patch and a light.

    That is the ball that the patch reaches, and all balls that are smaller as they are nearer to
    the light. What searches leave out is beside these, and `Crossing` may say that it touches: what
    is found would depend on which patches are searched for together.
    """
    way = sub(center, load(packet, POINT, lane))
    length, reach = packet[AIM_LENGTH + lane], packet[REACH + lane]
    aim, slope = load(packet, AIM, lane), reach / length
    along = dot(way, aim)
    beside = sub(way, scale(along, aim))
    gap = math.sqrt(dot(beside, beside))
    # The nearest of these balls: where it is seen from the centre square to the side of their cone.
    nearest = along - gap * slope / math.sqrt(max(1.0 - slope * slope, TINY))
    at = min(max(nearest, 0.0), length)
    apart = math.sqrt(gap * gap + (at - along) * (at - along))
    is_aside: bool = apart > radius + reach - slope * at
    return is_aside


@device
def note_plane(packet: Packet, hits: int, number: int, plane: PlaneShape) -> None:
    """Note of all patches what a plane does to the light that they are asked for."""
    numbers = integers(packet)
    for lane in range(hits):
        near, far = plane_crossing(plane, load_bundle(packet, lane, False))
        _note_lane(packet, lane, near, far, numbers[OWNER + lane] == number, True)


@device
def _note_lane(
    packet: Packet, lane: int, near: float, far: float, hides_nothing: bool, may_hide: bool
) -> None:
    """Note of a patch where its shadow rays first meet something, which may hide all of it."""
    touches = (near < packet[IN_FRONT + lane]) & (not hides_nothing)
    settled = packet[SETTLED + lane]
    is_dark = touches & (far < packet[ALL_IN_FRONT + lane])
    found = DARK if is_dark else OPEN
    # Where nothing can hide all of it, what touches it is enough.
    found = found if may_hide else UNEVEN_ALREADY if touches else OPEN
    packet[TOUCHED + lane] = 1.0 if touches else packet[TOUCHED + lane]
    packet[SETTLED + lane] = found if settled == OPEN else settled


@device
def judge_patches(packet: Packet, hits: int) -> None:
    """Find the patches on which a light does not do the same everywhere as at the hit."""
    for lane in range(hits):
        settled, is_hit_dark = packet[SETTLED + lane], packet[BLOCKED + lane] != 0.0
        in_part = (settled == OPEN) & ((packet[TOUCHED + lane] != 0.0) | is_hit_dark)
        wrong = (settled == DARK) & (not is_hit_dark)
        is_uneven = in_part | wrong | (settled == UNEVEN_ALREADY)
        packet[UNEVEN + lane] = 1.0 if is_uneven else packet[UNEVEN + lane]
