"""Which share of light passes faded bodies, by the chords of a ray in no order."""

import math

import numpy as np

from vtray.base.compiler.compiled import device
from vtray.geometry.faded.chords import put_in_place
from vtray.geometry.faded.layers import LEAST, share_of_chords
from vtray.geometry.packets.layer_notes import ROOM, Chords, SideBySide, Walk
from vtray.geometry.packets.packet import OCTET
from vtray.geometry.world import Bodies, load_body


@device
def share_beside(bodies: Bodies, k: int, walk: Walk) -> float:
    """Return which share of light passes the bodies along one of the rays side by side."""
    chords, begin = walk.beside.chords, k * ROOM
    count = chords.found[k]
    if count == 0:
        return 1.0
    if _are_alike(bodies, walk.beside, begin, count):
        opacity = bodies.opacity[load_body(bodies, chords.number[begin])]
        is_one = bodies.opacity.shape[0] == 1
        return _share_of_layers(opacity, _count_layers(walk.beside, begin, count, is_one))
    _sort(chords, begin, count)
    return share_of_chords(bodies, chords, begin, count, walk)


@device
def _are_alike(bodies: Bodies, beside: SideBySide, begin: int, count: int) -> bool:
    """Tell whether the order of chords does not matter; set the bodies of all of them.

    It does not if all take the same share, and none is of a body within which the ray may both
    start and end.
    """
    chords = beside.chords
    starts, ends, first = False, False, bodies.opacity[load_body(bodies, chords.number[begin])]
    is_same, is_one = True, bodies.opacity.shape[0] == 1
    for k in range(count):
        starts |= chords.near[begin + k] == -math.inf
        ends |= chords.far[begin + k] == math.inf
        body = 0 if is_one else load_body(bodies, chords.number[begin + k])
        beside.body[k] = body
        is_same &= bodies.opacity[body] == first
    return is_same and not (starts and ends)


@device
def _count_layers(beside: SideBySide, begin: int, count: int, is_one: bool) -> int:
    """Return how many layers chords make up: those that begin within no other of their body."""
    chords = beside.chords
    whole = (count + OCTET - 1) // OCTET * OCTET
    for k in range(count, whole):
        chords.near[begin + k], chords.far[begin + k] = math.inf, -math.inf
    found = 0
    for k in range(count):
        found += 0 if _is_within(beside, begin, whole, k, is_one) else 1
    return found


@device
def _is_within(beside: SideBySide, begin: int, count: int, k: int, is_one: bool) -> bool:
    """Tell whether a chord begins within one of the same body that comes before it."""
    chords, body, near = beside.chords, beside.body, beside.chords.near[begin + k]
    # Without branches, so that the compiler takes several at once.
    holding, level = np.int64(0), np.int64(0)
    if is_one:
        for other in range(count):
            begins = chords.near[begin + other]
            holding += (begins <= near) & (chords.far[begin + other] >= near)
            level += begins == near
    else:
        for other in range(count):
            begins = chords.near[begin + other]
            holds = (begins <= near) & (chords.far[begin + other] >= near)
            holding += holds & (body[other] == body[k])
            level += begins == near
    if level == 1:
        return bool(holding > 1)
    for other in range(count):
        begins, number = chords.near[begin + other], chords.number[begin + other]
        is_first = begins < near or (begins == near and number < chords.number[begin + k])
        if is_first and chords.far[begin + other] >= near and (is_one or body[other] == body[k]):
            return True
    return False


@device
def _share_of_layers(opacity: float, count: int) -> float:
    """Return which share of light passes so many layers, one by one."""
    share = 1.0
    for _ in range(count):
        share *= 1.0 - opacity
        if share < LEAST:
            return 0.0
    return share


@device
def _sort(chords: Chords, begin: int, count: int) -> None:
    """Sort the chords of a list."""
    for k in range(begin + 1, begin + count):
        near, far, number, met = chords.near[k], chords.far[k], chords.number[k], chords.met[k]
        put_in_place(chords, begin, k, near, far, number, met)
