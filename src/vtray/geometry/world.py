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
from vtray.geometry.bvh.tree import EMPTY, Bvh, leaf_range
from vtray.geometry.shapes.columns import Columns, Place
from vtray.geometry.vector import Vec, magnitude, scale, sub

PLANE, SPHERE, CYLINDER, CONE = 0, 1, 2, 3
"""The kinds of shape."""

NO_TREE = EMPTY
"""In place of the root of a group's hierarchy: it has none, as planes and few shapes do not."""


class Groups(NamedTuple):
    """Groups of shapes of one kind, all (n,) but for the last.

    First come those of planes, then the others that stand where they are given, and last those that
    are placed, as `Places` says.

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
        What leads from the kernels' space to that of their boxes where they are given: ratio and
        offset, as in `ToBoxes`, (n, 4).
    """

    kind: NDArray[np.int64]
    begin: NDArray[np.int64]
    end: NDArray[np.int64]
    root: NDArray[np.int64]
    number: NDArray[np.int64]
    frame: NDArray[np.float64]


class ToBoxes(NamedTuple):
    """What leads from the kernels' space to that of the boxes: ``point * ratio + offset``.

    Attributes
    ----------
    ratio, offset
        These.
    moved
        How far what is in the boxes is moved, in their space: what the rounding of its places is
        relative to, beside what they are.
    """

    ratio: float
    offset: Vec
    moved: float


class Places(NamedTuple):
    """Where groups stand that are placed many times, in the order of the leaves of a hierarchy.

    At each place stand the groups of one object, all moved by the same.

    Attributes
    ----------
    shift
        By how much they are moved, in world space, side by side, (3 * n,).
    item
        Whose groups these are: a place in `rows`, (n,).
    copy
        Which of the places of that object this is, counted from 0, (n,).
    rows
        The first row of the groups of each object, and after all of them the end, (objects + 1,).
    root
        The root of the hierarchy over the places, or ``NO_TREE``.
    to_boxes
        What leads to the space of its boxes.
    """

    shift: NDArray[np.float64]
    item: NDArray[np.int32]
    copy: NDArray[np.int32]
    rows: NDArray[np.int64]
    root: int
    to_boxes: ToBoxes


class World(NamedTuple):
    """What rays can meet.

    Primitives are numbered: spheres, then cylinders, then cones, then planes, and each of these in
    the order of the scene, where copies stand one after the other. At exactly the same distance the
    lower number is hit.

    Attributes
    ----------
    groups
        The groups.
    planes, spheres, cylinders, cones
        The columns of each kind; None for cylinders and for cones where there are none, so that no
        code is compiled for them.
    bvh
        The nodes of all hierarchies.
    places
        Where those groups stand that are placed; None where there are none, likewise.
    scale, origin
        What leads from world space to the kernels', as in `Place`.
    """

    groups: Groups
    planes: Columns
    spheres: Columns
    cylinders: Columns | None
    cones: Columns | None
    bvh: Bvh
    places: Places | None
    scale: float
    origin: Vec


class Group(NamedTuple):
    """One of the groups, where it stands; see `Groups`.

    Attributes
    ----------
    row
        What `load_group` finds it by: its row, or for one that is placed what `placed_row` gives.
    kind, begin, end, root, number
        As in `Groups`; the numbers are those of this copy.
    place, to_boxes
        What leads to where it stands.
    """

    row: int
    kind: int
    begin: int
    end: int
    root: int
    number: int
    place: Place
    to_boxes: ToBoxes


class Hierarchy(NamedTuple):
    """What leads to the shapes of a group, or to places.

    Attributes
    ----------
    root
        The root, or ``NO_TREE``: then all are visited as one leaf.
    begin, end
        The slots of all.
    to_boxes
        What leads to the space of the boxes.
    """

    root: int
    begin: int
    end: int
    to_boxes: ToBoxes


@device
def load_group(world: World, row: int) -> Group:
    """Return one of the groups."""
    return _load_group(world, world.places, row)


@device
def _load_group(world: World, places: Places | None, row: int) -> Group:
    groups, number, shift, moved = world.groups, 0, (0.0, 0.0, 0.0), 0.0
    own = row
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:  # noqa: SIM102
        if row >= groups.kind.shape[0]:
            own, at = row % groups.kind.shape[0], row // groups.kind.shape[0] - 1
            shift = load_shift(places, at)
            number = places.copy[at] * (groups.end[own] - groups.begin[own])
    ratio = groups.frame[own, 0]
    offset = groups.frame[own, 1], groups.frame[own, 2], groups.frame[own, 3]
    if places is not None:
        in_boxes = scale(ratio * world.scale, shift)
        offset, moved = sub(offset, in_boxes), magnitude(in_boxes)
    return Group(
        row,
        groups.kind[own],
        groups.begin[own],
        groups.end[own],
        groups.root[own],
        groups.number[own] + number,
        Place(shift, world.scale, world.origin),
        ToBoxes(ratio, offset, moved),
    )


@device
def hierarchy_of(group: Group) -> Hierarchy:
    """Return what leads to the shapes of a group."""
    return Hierarchy(group.root, group.begin, group.end, group.to_boxes)


@device
def hierarchy_of_places(places: Places) -> Hierarchy:
    """Return what leads to the places."""
    return Hierarchy(places.root, 0, places.item.shape[0], places.to_boxes)


@device
def range_of(hierarchy: Hierarchy, child: int) -> tuple[int, int]:
    """Return the slots of a leaf, from the first to before the last; of all for ``NO_TREE``."""
    begin, end = leaf_range(child)
    if child == NO_TREE:
        begin, end = hierarchy.begin, hierarchy.end
    return begin, end


@device
def load_shift(places: Places, at: int) -> Vec:
    """Return by how much the groups at a place are moved."""
    return places.shift[3 * at], places.shift[3 * at + 1], places.shift[3 * at + 2]


@device
def placed_row(world: World, at: int, row: int) -> int:
    """Return what `load_group` finds the group of a row at a place by."""
    count: int = world.groups.kind.shape[0]
    return (at + 1) * count + row


@device
def group_count(world: World) -> int:
    """Return how many groups stand where they are given: the first ones."""
    return _group_count(world.groups, world.places)


@device
def _group_count(groups: Groups, places: Places | None) -> int:
    count: int = groups.kind.shape[0]
    if places is not None:
        count = places.rows[0]
    return count


@device
def has_trees(world: World) -> bool:
    """Tell whether any shapes have a hierarchy."""
    nodes: int = world.bvh.child.shape[0]
    return nodes > 0
