"""A thread's notes on the faded bodies that rays go through."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.geometry.packets.fan import FAN
from vtray.geometry.packets.packet import LANES

MOST = 32
"""So many chords are collected at once; what is farther is asked for when these are done with."""

ALONE = FAN
"""The list of the chords of a ray that is none of a fan."""

AT_ONCE = 32
"""So many layers of a ray are listed at once."""


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


class Walk(NamedTuple):
    """A thread's notes on the bodies that a ray goes through.

    Attributes
    ----------
    chords
        The chords of the ray.
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
    lists = ALONE + 1 if bodies else 0
    near, far = np.zeros((2, lists * MOST))
    of_chords = np.zeros((2, lists * MOST), np.int64)
    chords = Chords(near, far, of_chords[0], of_chords[1], np.zeros(lists, np.int64))
    number, met, ray, inside = np.zeros((4, bodies), np.int64)
    return Walk(chords, np.zeros(bodies), number, met, ray, inside, np.zeros(1, np.int64))


def new_layers(bodies: int) -> Layers:
    """Return the scratch memory of one thread, none where there are no bodies."""
    lanes = LANES if bodies else 0
    distance, share = np.zeros((2, lanes * AT_ONCE))
    number, met = np.zeros((2, lanes * AT_ONCE), np.int64)
    return Layers(distance, number, met, share, np.zeros(lanes, np.int64), np.zeros(lanes))
