"""A thread's notes on the faded bodies that rays go through."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.geometry.packets.fan import FAN
from vtray.geometry.packets.packet import LANES

MOST = 64
"""So many chords are collected at once; what is farther is asked for when these are done with."""

ALONE = FAN
"""The list of the chords of a ray that is none of a fan."""

AT_ONCE = 32
"""So many layers of a ray are listed at once."""

SIDE_BY_SIDE = 16
"""So many rays go through a hierarchy side by side, at the most: fewer bits than an integer has."""

STRIPS, CELLS = 16, 32
"""Of what a light sees: so many strips at the most, each of so many cells."""

FIELDS = 11
"""Numbers of each of these."""

ROOM = 256
"""So many chords of each of these are collected; rays that have more go alone."""


class Chords(NamedTuple):
    """The chords of the rays of a fan, and last those of a ray alone, a list for each ray.

    They are in the order of where they begin, and of their numbers where that is the same.

    Attributes
    ----------
    near, far
        As in `Stay`, (lists * ``MOST``,).
    number
        The numbers of the primitives, likewise.
    met
        What leads to them, as `join_met` gives it, likewise.
    found
        How many there are, (lists,).
    """

    near: NDArray[np.float64]
    far: NDArray[np.float64]
    number: NDArray[np.int64]
    met: NDArray[np.int64]
    found: NDArray[np.int64]


class SideBySide(NamedTuple):
    """Rays that go through a hierarchy side by side.

    Attributes
    ----------
    rays
        Their fields, one after the other, as those of a packet; see `side_by_side`.
    hit
        The hits of a packet that they start from, or will, when it is their turn, (``LANES``,).
    sorted, cell
        Scratch memory to sort these, (``LANES``,).
    begins
        Where those of each cell begin, (``STRIPS * CELLS + 1``,).
    chords
        Their chords, a list of ``ROOM`` for each ray, in no order.
    body
        The bodies of the chords of one of them, (``ROOM``,).
    """

    rays: NDArray[np.float64]
    hit: NDArray[np.int64]
    sorted: NDArray[np.int64]
    cell: NDArray[np.int64]
    begins: NDArray[np.int64]
    chords: Chords
    body: NDArray[np.int64]


class Walk(NamedTuple):
    """A thread's notes on the bodies that a ray goes through.

    Attributes
    ----------
    chords
        The chords of the ray.
    beside
        Those of rays that go side by side.
    leaves
        Where it leaves each body, (bodies,).
    number, met
        The primitive by which it does, as in `Chords`, (bodies,).
    ray
        The number of the ray that these are of, (bodies,).
    inside
        The bodies in which it starts, (bodies,).
    rays
        The number of the last ray, (1,).
    """

    chords: Chords
    beside: SideBySide
    leaves: NDArray[np.float64]
    number: NDArray[np.int64]
    met: NDArray[np.int64]
    ray: NDArray[np.int64]
    inside: NDArray[np.int64]
    rays: NDArray[np.int64]


class Layers(NamedTuple):
    """What the rays of a packet see of faded bodies and behind them, (``LANES`` * ``AT_ONCE``,).

    Attributes
    ----------
    distance
        How far each layer is along its ray.
    number, met
        The primitive, as in `Chords`.
    share
        What it counts: the share of light that comes from there.
    listed
        How many there are of each lane, (``LANES``,).
    passed
        The share of light that passes all layers of a lane, (``LANES``,).
    """

    distance: NDArray[np.float64]
    number: NDArray[np.int64]
    met: NDArray[np.int64]
    share: NDArray[np.float64]
    listed: NDArray[np.int64]
    passed: NDArray[np.float64]


def new_walk(bodies: int) -> Walk:
    """Return the scratch memory of one thread for so many bodies, little where there are none."""
    number, met, ray, inside = np.zeros((4, bodies), np.int64)
    chords = _new_chords(ALONE + 1 if bodies else 0, MOST)
    rays = SIDE_BY_SIDE if bodies else 0
    beside = SideBySide(
        np.zeros(FIELDS * rays),
        np.zeros(LANES, np.int64),
        np.zeros(LANES, np.int64),
        np.zeros(LANES, np.int64),
        np.zeros(STRIPS * CELLS + 1, np.int64),
        _new_chords(rays, ROOM),
        np.zeros(ROOM, np.int64),
    )
    return Walk(chords, beside, np.zeros(bodies), number, met, ray, inside, np.zeros(1, np.int64))


def _new_chords(lists: int, most: int) -> Chords:
    """Return the memory of so many lists of so many chords."""
    near, far = np.zeros((2, lists * most))
    number, met = np.zeros((2, lists * most), np.int64)
    return Chords(near, far, number, met, np.zeros(lists, np.int64))


def new_layers(bodies: int) -> Layers:
    """Return the scratch memory of one thread, none where there are no bodies."""
    lanes = LANES if bodies else 0
    distance, share = np.zeros((2, lanes * AT_ONCE))
    number, met = np.zeros((2, lanes * AT_ONCE), np.int64)
    return Layers(distance, number, met, share, np.zeros(lanes, np.int64), np.zeros(lanes))
