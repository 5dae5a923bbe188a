"""The scratch memory of a thread."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.bvh import STACK
from vtray.packet import LANES, PART
from vtray.scene_arrays import SceneArrays

TABLE = 2 * LANES
"""Places of the hash table in which lanes are grouped."""


class Workspace(NamedTuple):
    """A thread's notes on the packet at hand.

    Attributes
    ----------
    near
        Which spheres may be met, one per sphere; nothing if there is a hierarchy.
    above, below
        Whether any point lies on that side of a plane, clear of rounding, one per plane.
    rows
        For each row of a part of a block the normal of the plane of its rays, and its square.
    stack, stack_enter
        Nodes that wait on a way through the hierarchy, and where the beam enters them.
    order
        The lanes with a hit in the order of their groups.
    group
        How many groups there are, and then the first hit of each, and the end of the last.
    table, owner, member, size
        The hash table of what is hit: a number for each, what it is, which lanes hit it, how many.
    """

    near: NDArray[np.bool_]
    above: NDArray[np.bool_]
    below: NDArray[np.bool_]
    rows: NDArray[np.float64]
    stack: NDArray[np.int64]
    stack_enter: NDArray[np.float64]
    order: NDArray[np.int64]
    group: NDArray[np.int64]
    table: NDArray[np.int64]
    owner: NDArray[np.int64]
    member: NDArray[np.int64]
    size: NDArray[np.int64]


def new_workspace(scene: SceneArrays) -> Workspace:
    """Return the scratch memory of one thread for a scene."""
    planes = scene.planes.x.shape[0]
    few = len(scene.spheres.number) if len(scene.bvh.child) == 0 else 0

    def integers(size: int) -> NDArray[np.int64]:
        return np.zeros(size, np.int64)

    return Workspace(
        near=np.zeros(few, np.bool_),
        above=np.zeros(planes, np.bool_),
        below=np.zeros(planes, np.bool_),
        rows=np.zeros(4 * PART),
        stack=integers(STACK),
        stack_enter=np.zeros(STACK),
        order=integers(LANES),
        group=integers(LANES + 2),
        table=integers(TABLE),
        owner=integers(LANES),
        member=integers(LANES),
        size=integers(LANES),
    )
