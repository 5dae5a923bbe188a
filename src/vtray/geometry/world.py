"""What rays can meet, as arrays: groups of shapes, their columns, and their hierarchies.

Lengths are divided by a power of two, which changes no digit, so that the largest is about 2**200.
Then no square of a square overflows, not even at points a billion times farther away, and those of
parts 1e130 times smaller do not vanish. The origin moves to the centre of the image plane, so that
a scene far from the world's origin loses no digits. The shapes, which can be many, stay in world
space in memory; each is brought into the kernels' space where it is used.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.tree import Bvh
from vtray.geometry.shapes.columns import Columns, Place
from vtray.geometry.vector import Vec

PLANE, SPHERE, CYLINDER = 0, 1, 2
"""The kinds of shape."""

NO_TREE = -1
"""In place of the root of a group's hierarchy: it has none, as planes and few shapes do not."""


class Groups(NamedTuple):
    """Groups of shapes of one kind, all (n,) but for the last; those of planes come first.

    Attributes
    ----------
    kind
        Their kind.
    begin, end
        Their slots, from the first to before the last.
    root
        The root of their hierarchy, or ``NO_TREE``.
    number
        What their numbers in the columns are counted from.
    frame
        Where they stand: by how much they are moved, in world space, along x, y and z; then what
        leads from the kernels' space to that of their boxes, as in `ToBoxes`, (n, 7).
    """

    kind: NDArray[np.int64]
    begin: NDArray[np.int64]
    end: NDArray[np.int64]
    root: NDArray[np.int64]
    number: NDArray[np.int64]
    frame: NDArray[np.float64]


class ToBoxes(NamedTuple):
    """What leads from the kernels' space to that of the boxes: ``point * ratio + offset``."""

    ratio: float
    offset: Vec


class World(NamedTuple):
    """What rays can meet.

    Primitives are numbered: spheres, then cylinders, then planes, and each of these in the order of
    the scene. At exactly the same distance the lower number is hit.

    Attributes
    ----------
    groups
        The groups.
    planes, spheres, cylinders
        The columns of each kind; None for cylinders where there are none, so that no code is
        compiled for them.
    bvh
        The nodes of all hierarchies.
    scale, origin
        What leads from world space to the kernels', as in `Place`.
    """

    groups: Groups
    planes: Columns
    spheres: Columns
    cylinders: Columns | None
    bvh: Bvh
    scale: float
    origin: Vec


class Group(NamedTuple):
    """One of the groups: its row, and what that says; see `Groups`."""

    row: int
    kind: int
    begin: int
    end: int
    root: int
    number: int
    place: Place
    to_boxes: ToBoxes


@device
def load_group(world: World, row: int) -> Group:
    """Return one of the groups."""
    groups, frame = world.groups, world.groups.frame
    shift = frame[row, 0], frame[row, 1], frame[row, 2]
    offset = frame[row, 4], frame[row, 5], frame[row, 6]
    return Group(
        row,
        groups.kind[row],
        groups.begin[row],
        groups.end[row],
        groups.root[row],
        groups.number[row],
        Place(shift, world.scale, world.origin),
        ToBoxes(frame[row, 3], offset),
    )


@device
def group_count(world: World) -> int:
    """Return how many groups there are."""
    count: int = world.groups.kind.shape[0]
    return count


@device
def has_trees(world: World) -> bool:
    """Tell whether any shapes have a hierarchy."""
    nodes: int = world.bvh.child.shape[0]
    return nodes > 0
