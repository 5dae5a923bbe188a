"""The scratch memory of a thread."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.geometry.caps import Caps, new_caps
from vtray.geometry.packets.batch import Batch, new_batch
from vtray.geometry.packets.cone import Touching, new_touching
from vtray.geometry.packets.fan import FAN, MOST_RAYS, Fan, new_fan
from vtray.geometry.packets.layer_notes import Layers, Walk, new_layers, new_walk
from vtray.geometry.packets.packet import BLOCK, LANES
from vtray.geometry.packets.pending import Pending, new_pending
from vtray.geometry.packets.ray_bounds import Cones, new_cones
from vtray.geometry.packets.stack import Stack, new_stack
from vtray.geometry.world import NO_TREE, PLANE, World, body_count

TABLE = 2 * LANES
"""Places of the hash table in which lanes are grouped."""


Pixels = NDArray[np.int64]
"""Pixels of a block, as row * BLOCK + column."""


class Sums(NamedTuple):
    """What the samples of pixels add up to.

    Attributes
    ----------
    light, covered, weight
        Light times weight in three rows, coverage times weight, and weight.
    fogged
        What fog covers times weight, if there is any.
    plain, squares
        Light and its squares without weights, in three rows, from which its error is estimated.
    orders
        Light in orders times weight, in nine rows, if that is asked.
    """

    light: NDArray[np.float64]
    covered: NDArray[np.float64]
    fogged: NDArray[np.float64]
    weight: NDArray[np.float64]
    plain: NDArray[np.float64]
    squares: NDArray[np.float64]
    orders: NDArray[np.float64]


UNKNOWN = -1.0
"""Stands for how much arrives of a light that rays are cast to."""


class Shared(NamedTuple):
    """Notes on the rays that the lights of a crowd share.

    Attributes
    ----------
    sums
        What the lights before each of them would bring with nothing in the way, and at last all.
    known
        How much arrives of each light that was asked as a whole, ``UNKNOWN`` for others.
    light
        The light of each ray of a fan.
    brought
        What all rays bring, in three rows.
    """

    sums: NDArray[np.float64]
    known: NDArray[np.float64]
    light: NDArray[np.int64]
    brought: NDArray[np.float64]


def new_shared(lights: int) -> Shared:
    """Return the notes for so many lights, none where nothing is shared."""
    rays = MOST_RAYS if lights > 0 else 0
    numbers = np.zeros(FAN, np.int64)
    return Shared(np.zeros(lights + 1), np.zeros(lights), numbers, np.zeros(3 * rays))


class Workspace(NamedTuple):
    """A thread's notes on the packet at hand.

    Attributes
    ----------
    near
        Which shapes without a hierarchy may be met, one per slot.
    above, below
        How near points come to a plane on that side, clear of rounding; infinite without any.
    close
        Whether patches reach a plane on which they are not.
    cones
        The cones around the octets of rays.
    stack
        What waits on a way through a hierarchy.
    order
        The lanes with a hit in the order of their clusters.
    cluster
        How many clusters there are, and then the first hit of each, and the end of the last.
    curve
        The pixels of a block along a curve.
    pixels
        Those that are traced.
    sums
        The sums of the samples of the pixels of a packet.
    batch
        Hits that are near each other.
    fan, touching, own
        The shadow rays of a batch to one light, the shapes that touch their cone, and those of them
        that touch the one from a hit.
    caps
        The directions that what is around a hit leaves of a lamp.
    shared
        Notes on rays that many lights share.
    walk, layers
        The bodies that a ray goes through, and the layers of all lanes.
    pending
        The rays that go on from what the lanes meet.
    table, owner, member, size
        The hash table of what is hit: a number for each, what it is, which lanes hit it, how many.
    unasked
        Stands for light in orders where nobody asks for it, (0, 0, 9).
    """

    near: NDArray[np.bool_]
    above: NDArray[np.float64]
    below: NDArray[np.float64]
    close: NDArray[np.bool_]
    cones: Cones
    stack: Stack
    order: NDArray[np.int64]
    cluster: NDArray[np.int64]
    curve: Pixels
    pixels: Pixels
    sums: Sums
    batch: Batch
    fan: Fan
    touching: Touching
    own: Touching
    caps: Caps
    shared: Shared
    walk: Walk
    layers: Layers
    pending: Pending
    table: NDArray[np.int64]
    owner: NDArray[np.int64]
    member: NDArray[np.int64]
    size: NDArray[np.int64]
    unasked: NDArray[np.float64]


def curve_of_block() -> Pixels:
    """Return the pixels of a block, as row * BLOCK + column, in the order of Morton's curve.

    Those of an octet of lanes, and those of a part of a packet, are near each other: 4 by 2 and
    8 by 8 pixels, if all pixels are traced.
    """
    code = np.arange(BLOCK * BLOCK)
    column = code & 1 | code >> 1 & 2 | code >> 2 & 4 | code >> 3 & 8
    row = code >> 1 & 1 | code >> 2 & 2 | code >> 3 & 4 | code >> 4 & 8
    return row * BLOCK + column


def new_workspace(world: World, sharing: int = 0, bounces: int = -1) -> Workspace:
    """Return the scratch memory of one thread for what rays can meet.

    So many lights share their rays, and rays go on over so many surfaces.
    """
    groups = world.groups
    few = int(groups.end[(groups.kind != PLANE) & (groups.root == NO_TREE)].max(initial=0))
    planes = len(world.planes.number)

    def integers(size: int) -> NDArray[np.int64]:
        return np.zeros(size, np.int64)

    return Workspace(
        near=np.zeros(few, np.bool_),
        above=np.zeros(planes),
        below=np.zeros(planes),
        close=np.zeros(planes, np.bool_),
        cones=new_cones(),
        stack=new_stack(),
        order=integers(LANES),
        cluster=integers(LANES + 2),
        curve=curve_of_block(),
        pixels=integers(LANES),
        sums=Sums(*(np.zeros(size * LANES) for size in (3, 1, 1, 1, 3, 3, 9))),
        batch=new_batch(),
        fan=new_fan(),
        touching=new_touching(),
        own=new_touching(),
        caps=new_caps(),
        shared=new_shared(sharing),
        walk=new_walk(body_count(world)),
        layers=new_layers(body_count(world)),
        pending=new_pending(bounces),
        table=integers(TABLE),
        owner=integers(LANES),
        member=integers(LANES),
        size=integers(LANES),
        unasked=np.zeros((0, 0, 9)),
    )
