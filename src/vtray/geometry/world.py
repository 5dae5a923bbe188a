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
from vtray.base.compiler.unseen import apart
from vtray.geometry.bvh.tree import EMPTY, Bvh, leaf_range
from vtray.geometry.shapes.columns import Columns, Place
from vtray.geometry.shapes.room import Room, load_room
from vtray.geometry.vector import Vec, add, magnitude, scale, sub

PLANE, SPHERE, CYLINDER, CONE = 0, 1, 2, 3
"""The kinds of shape."""

CUT = 4
"""What is added to the kind of those that clip planes may cut."""

NO_TREE = EMPTY
"""In place of the root of a group's hierarchy: it has none, as planes and few shapes do not."""


class Groups(NamedTuple):
    """Groups of shapes of one kind, all (n,) but for the last.

    First come those of planes, then the others that stand where they are given, those of faded
    shapes last, and then those that are placed, as `Places` says.

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
    each
        For groups that are placed, how many numbers one copy takes.
    frame
        What leads from the kernels' space to that of their boxes where they are given: ratio and
        offset, as in `ToBoxes`, (n, 4).
    """

    kind: NDArray[np.int64]
    begin: NDArray[np.int64]
    end: NDArray[np.int64]
    root: NDArray[np.int64]
    number: NDArray[np.int64]
    each: NDArray[np.int64]
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


@device
def to_box_space(to_boxes: ToBoxes, point: Vec) -> Vec:
    """Return a point in the space of boxes."""
    return add(scale(to_boxes.ratio, point), to_boxes.offset)


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
    end
        How many places there are, without those of faded shapes, which follow.
    """

    shift: NDArray[np.float64]
    item: NDArray[np.int32]
    copy: NDArray[np.int32]
    rows: NDArray[np.int64]
    root: int
    to_boxes: ToBoxes
    end: int


class Bodies(NamedTuple):
    """How opaque faded primitives are, and which of them are one body, by ranges of their numbers.

    The body of the k-th primitive of a range stands in row ``row + k * step``, as in `Materials`.

    Attributes
    ----------
    first
        The number of the first primitive of each range, from 0 on, (ranges,).
    each
        How many primitives one copy has, or more than there are in the range, (ranges,).
    row, step
        The rows of their bodies, (ranges,).
    body
        Numbers of bodies, (rows,).
    opacity
        The share of light that a body takes, between 0 and 1, (bodies,).
    """

    first: NDArray[np.int64]
    each: NDArray[np.int64]
    row: NDArray[np.int64]
    step: NDArray[np.int64]
    body: NDArray[np.int32]
    opacity: NDArray[np.float64]


class Faded(NamedTuple):
    """The shapes that light passes in part: rows of `Groups`, and places of `Places`.

    Attributes
    ----------
    begin, end
        The rows of those groups that stand where they are given, from the first to before the last.
    places
        The hierarchy over the places of those that are placed; without places if there are none.
    bodies
        What they make up.
    least
        Depth, numbers and normals are those of the first surface that is more opaque than that.
    """

    begin: int
    end: int
    places: "Hierarchy"
    bodies: Bodies
    least: float


class Clip(NamedTuple):
    """What clip planes leave of groups of shapes.

    Attributes
    ----------
    planes
        The planes of all rooms, as in `Room`.
    begin
        The first plane of each room, and after all of them the end, (rooms + 1,).
    room
        Which room the group of each row is cut by; without meaning for those that are not, (rows,).
    is_capped
        Whether what is cut of the group of each row is closed, as faded shapes always are, (rows,).
    flat
        The columns of planes that are cut; None where there are none.
    """

    planes: Columns
    begin: NDArray[np.int64]
    room: NDArray[np.int64]
    is_capped: NDArray[np.bool_]
    flat: Columns | None


@apart
class Solids(NamedTuple):
    """The shapes of a world that are no whole planes, and what cuts them.

    What depends on these alone is compiled once for worlds that differ in other things, and what
    only passes them on once for all worlds.

    Attributes
    ----------
    spheres, cylinders, cones
        The columns of each kind; None for cylinders and for cones where there are none, so that no
        code is compiled for them.
    clip
        What clip planes leave; None where there are none, likewise.
    """

    spheres: Columns
    cylinders: Columns | None
    cones: Columns | None
    clip: Clip | None


class World(NamedTuple):
    """What rays can meet.

    Primitives are numbered: spheres, then cylinders, then cones, then planes, and each of these in
    the order of the scene, where copies stand one after the other. At exactly the same distance the
    lower number is hit.

    Attributes
    ----------
    groups
        The groups.
    planes, spheres
        The columns of these kinds, which all worlds have, for code that does not look into others.
    solids
        Those of all that are no whole planes, and what cuts them.
    bvh
        The nodes of all hierarchies.
    places
        Where those groups stand that are placed; None where there are none, so that no code is
        compiled for them.
    given
        How many groups stand where they are given: the first ones, without faded shapes.
    faded
        The faded shapes; None where there are none, likewise.
    scale, origin
        What leads from world space to the kernels', as in `Place`.
    """

    groups: Groups
    planes: Columns
    spheres: Columns
    solids: Solids
    bvh: Bvh
    places: Places | None
    given: int
    faded: Faded | None
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
            number = places.copy[at] * groups.each[own]
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
    return Hierarchy(places.root, 0, places.end, places.to_boxes)


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
def room_of(world: World, clip: Clip, group: Group) -> Room:
    """Return the room that clip planes leave to a group that they cut, in the kernels' space."""
    row = clip.room[group.row % clip.room.shape[0]]
    place = Place((0.0, 0.0, 0.0), world.scale, world.origin)
    return load_room(clip.planes, clip.begin[row], clip.begin[row + 1], place)


@device
def group_count(world: World) -> int:
    """Return how many groups stand where they are given: the first ones, without faded shapes."""
    return world.given


@device
def has_trees(world: World) -> bool:
    """Tell whether any shapes have a hierarchy."""
    nodes: int = world.bvh.child.shape[0]
    return nodes > 0


@device
def load_body(bodies: Bodies, primitive: int) -> int:
    """Return the body that a faded primitive belongs to."""
    k = bodies.first.shape[0] - 1
    while primitive < bodies.first[k]:
        k -= 1
    place = primitive - bodies.first[k]
    if place >= bodies.each[k]:
        place %= bodies.each[k]
    body: int = bodies.body[bodies.row[k] + place * bodies.step[k]]
    return body


def body_count(world: World) -> int:
    """Return how many bodies faded shapes make up."""
    return 0 if world.faded is None else len(world.faded.bodies.opacity)
