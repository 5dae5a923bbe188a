"""What clip planes leave of the shapes that are kept with a scene.

Shapes wholly inside stay as they are, those wholly outside are left out of their columns and of
their hierarchies, and those that a plane cuts become groups of their own. Only what is in these is
asked anything else than without clip planes. All of it is taken from what is there for the whole
scene: nothing is hashed or built anew, so that planes may move.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.bvh.join import join_trees
from vtray.geometry.bvh.prune import prune
from vtray.geometry.bvh.tree import Bvh, no_bvh
from vtray.geometry.rounding import MARGIN
from vtray.geometry.shapes.columns import Columns, Place
from vtray.geometry.shapes.cone import load_cone
from vtray.geometry.shapes.cylinder import load_cylinder
from vtray.geometry.shapes.room import ACROSS, BEYOND, WITHIN, relation_to
from vtray.geometry.shapes.sphere import load_sphere
from vtray.geometry.vector import Vec, dot
from vtray.geometry.world import CYLINDER, NO_TREE, SPHERE
from vtray.rendering.acceleration import Acceleration, Shapes
from vtray.rendering.numbering import number_objects
from vtray.rendering.placed import Placed, count_places
from vtray.rendering.rooms import Rooms, Wall, is_plane_left
from vtray.rendering.shape_kinds import KINDS
from vtray.scene.objects import Object, Plane

Floats = NDArray[np.float64]
Codes = NDArray[np.int8]
RoomNumbers = NDArray[np.int16]


class Pruned(NamedTuple):
    """Shapes with the tree over them, if they have one, whose root is not yet known."""

    shapes: Shapes
    bvh: Bvh | None


def clip_shapes(kept: Acceleration, rooms: Rooms, room_of: Sequence[int]) -> Acceleration:
    """Return what is left of shapes, at whose numbers nothing changes.

    Parameters
    ----------
    kept
        The shapes of the whole scene.
    rooms
        What clip planes leave.
    room_of
        The room of each of the objects that have the shapes; empty if all have the first.
    """
    scale, columns = _scale_of(kept, rooms), list(kept.columns)
    standing = [one for one in kept.all_shapes if not one.is_placed]
    halves: list[tuple[Pruned, list[Pruned]]] = []
    for shapes in standing:
        k = KINDS.index(shapes.kind)
        room = _rooms_of_shapes(kept, shapes, room_of)
        relations = _relations(shapes, kept.columns[k], rooms, room, scale)
        columns[k] = _in_order(shapes, columns[k], relations, room)
        halves.append(_split(shapes, kept.bvh, relations, room, len(rooms.walls)))
    opaque_places = _clip_places(kept, kept.placed, rooms, room_of, scale, 0, 0)
    begin, slot = count_places(kept.placed), count_places(opaque_places[0])
    fading_places = _clip_places(kept, kept.faded_placed, rooms, room_of, scale, begin, slot)
    placed = opaque_places, fading_places
    # Those of what is copied stay as they are.
    pruned = [*(one for one, _ in halves), *(one for _, cut in halves for one in cut)]
    trees = [*(one.bvh for one in pruned), *(bvh for _, bvh in placed)]
    bvh, roots = _join([kept.bvh if any(where for where, _ in placed) else no_bvh()], trees)
    made = iter([replace(one.shapes, root=root) for one, root in zip(pruned, roots, strict=False)])
    left = {id(shapes): next(made) for shapes in standing}
    cut = [
        (shapes, [next(made) for _ in parts])
        for shapes, (_, parts) in zip(standing, halves, strict=True)
    ]
    faded = set(map(id, kept.faded))
    places, faded_places = (
        where and replace(where, root=root)
        for (where, _), root in zip(placed, roots[-2:], strict=True)
    )
    return replace(
        kept,
        shapes=tuple(left[id(one)] for one in kept.shapes),
        copied=tuple(left.get(id(one), one) for one in kept.copied),
        faded=tuple(left.get(id(one), one) for one in kept.faded),
        cut=_cut_by_room(parts for shapes, parts in cut if id(shapes) not in faded),
        faded_cut=_cut_by_room(parts for shapes, parts in cut if id(shapes) in faded),
        columns=tuple(columns),
        bvh=bvh,
        placed=places,
        faded_placed=faded_places,
        rooms=rooms,
        room_of=tuple(room_of),
    )


def _split(
    shapes: Shapes, bvh: Bvh, relations: Codes, room: RoomNumbers, rooms: int
) -> tuple[Pruned, list[Pruned]]:
    """Return those shapes that stay whole, and those that are cut, room by room."""
    is_left, slot = relations == WITHIN, shapes.begin
    plain, cut = _pruned(shapes, bvh, is_left, slot), []
    for by in range(rooms):
        slot += int(np.count_nonzero(is_left))
        is_left = (relations == ACROSS) & (room == by)
        cut.append(_pruned(shapes, bvh, is_left, slot))
    return plain, cut


def _cut_by_room(parts: Iterable[Sequence[Shapes]]) -> tuple[tuple[int, Shapes], ...]:
    """Return shapes that are cut with the rooms that cut them, given those of each room."""
    return tuple((room, one) for by_room in parts for room, one in enumerate(by_room))


def _rooms_of_shapes(kept: Acceleration, shapes: Shapes, room_of: Sequence[int]) -> RoomNumbers:
    """Return the room of each of some shapes, in the order of their slots, or (1,) for all."""
    if not room_of:
        return np.zeros(1, np.int16)
    if shapes.place >= 0:
        return np.array([room_of[shapes.place]], np.int16)
    numbering, columns = number_objects(kept.items), kept.columns[KINDS.index(shapes.kind)]
    mine = columns.number[shapes.begin : shapes.begin + shapes.count] + shapes.first
    rows = np.searchsorted(numbering.first, mine, side="right") - 1
    return np.asarray(room_of, np.int16)[numbering.place[rows]]


def _scale_of(kept: Acceleration, rooms: Rooms) -> float:
    """Return a power of two by which lengths are multiplied, so that no square overflows."""
    largest = max(kept.largest, rooms.largest)
    return math.ldexp(1.0, min(-math.frexp(largest)[1], 1000)) if largest else 1.0


def _relations(
    shapes: Shapes, columns: Columns, rooms: Rooms, room: RoomNumbers, scale: float
) -> Codes:
    """Return how shapes lie to their rooms, in the order of their slots."""
    relations = np.empty(shapes.count, np.int8)
    if shapes.count:
        kind, planes = shapes.kind.shape, rooms.planes
        find_relations(kind, columns, shapes.begin, planes, rooms.begin, room, scale, relations)
    return relations


@kernel
def find_relations(
    kind: int,
    columns: Columns,
    begin: int,
    planes: Columns,
    rooms: NDArray[np.int64],
    room_of: RoomNumbers,
    scale: float,
    relations: Codes,
) -> None:
    """Set how shapes lie to their rooms.

    Parameters
    ----------
    kind, columns, begin
        The shapes, from this slot on.
    planes, rooms
        The planes of rooms, and the first of each room.
    room_of
        Which room that is for each shape, (n,), or (1,) for all.
    scale
        What lengths are multiplied by.
    relations
        Out: as of `relation_to`, (n,).
    """
    nowhere = (0.0, 0.0, 0.0)
    place = Place(nowhere, scale, nowhere)
    for k in range(relations.shape[0]):
        own = room_of[k if room_of.shape[0] > 1 else 0]
        center, radius = _ball(kind, columns, begin + k, place)
        relations[k] = relation_to(planes, rooms[own], rooms[own + 1], place, center, radius)


@kernel
def find_reach(
    kind: int, columns: Columns, begin: int, end: int, normal: Vec, scale: float
) -> tuple[float, float, float]:
    """Return how far balls of shapes reach along a direction, least and most, and from the origin.

    Lengths are multiplied by `scale`.
    """
    nowhere = (0.0, 0.0, 0.0)
    low, high, far = math.inf, -math.inf, 0.0
    for slot in range(begin, end):
        center, radius = _ball(kind, columns, slot, Place(nowhere, scale, nowhere))
        side = dot(center, normal)
        low, high = min(low, side - radius), max(high, side + radius)
        far = max(far, abs(center[0]) + abs(center[1]) + abs(center[2]) + radius)
    return low, high, far


@device
def _ball(kind: int, columns: Columns, slot: int, place: Place) -> tuple[Vec, float]:
    """Return the ball around a shape."""
    if kind == SPHERE:
        sphere = load_sphere(columns, slot, place)
        return sphere.center, sphere.radius
    if kind == CYLINDER:
        cylinder = load_cylinder(columns, slot, place)
        return cylinder.center, cylinder.radius
    cone = load_cone(columns, slot, place)
    return cone.center, cone.radius


def _in_order(shapes: Shapes, columns: Columns, relations: Codes, room: RoomNumbers) -> Columns:
    """Return columns with the shapes that stay first, then those that are cut, then others."""
    cut = np.flatnonzero(relations == ACROSS)
    if len(room) > 1:
        cut = cut[np.argsort(room[cut], kind="stable")]
    stay, go = (np.flatnonzero(relations == k) for k in (WITHIN, BEYOND))
    order = np.concatenate([stay, cut, go])
    data, number = columns.data.copy(), columns.number.copy()
    begin, end = shapes.begin, shapes.begin + shapes.count
    if shapes.count:
        rows = data.reshape(len(number), -1)
        rows[begin:end] = columns.data.reshape(len(number), -1)[begin:end][order]
        number[begin:end] = columns.number[begin:end][order]
    return Columns(data, number)


def _pruned(shapes: Shapes, bvh: Bvh, is_left: NDArray[np.bool_], slot: int) -> Pruned:
    """Return those shapes that are left, which begin at a slot."""
    count = int(np.count_nonzero(is_left))
    made = replace(shapes, begin=slot, count=count)
    if shapes.root == NO_TREE or not count:
        return Pruned(made, None)
    return Pruned(made, prune(bvh, shapes.root, is_left, shapes.begin, slot))


def _clip_places(
    kept: Acceleration,
    placed: Placed | None,
    rooms: Rooms,
    room_of: Sequence[int],
    scale: float,
    begin: int,
    slot: int,
) -> tuple[Placed | None, Bvh | None]:
    """Return the places at which something is left, and the nodes above them, if there are any.

    The slots of the places begin at `begin`, and those of what is left of them at `slot`.
    """
    if placed is None:
        return None, None
    relations = np.full(len(placed.item), WITHIN, np.int8)
    items = kept.items_of(kept.copied if placed is kept.placed else kept.faded)
    for item, parts in enumerate(items):
        mine = placed.item == item
        walls = rooms.walls[room_of[parts[0].place] if room_of else 0]
        relations[mine] = _relations_of_places(
            placed.shift[mine], parts, kept.columns, walls, scale
        )
    is_left = relations != BEYOND
    if not is_left.any():
        return None, None
    made = replace(
        placed,
        shift=placed.shift[is_left],
        # As shapes that may be cut, the same shapes are an item of their own.
        item=(placed.item + len(items) * (relations == ACROSS))[is_left].astype(np.int32),
        copy=placed.copy[is_left],
    )
    if placed.root == NO_TREE:
        return made, None
    return made, prune(kept.bvh, placed.root, is_left, begin, slot)


def _relations_of_places(
    shift: Floats,
    parts: Sequence[Shapes],
    columns: Sequence[Columns],
    walls: Sequence[Wall],
    scale: float,
) -> Codes:
    """Return how all that stands at places lies to a room."""
    relations = np.full(len(shift), WITHIN, np.int8)
    shift = shift * scale
    x, y, z = shift.T
    around = np.abs(x) + np.abs(y) + np.abs(z)
    for wall in walls:
        (a, b, c), normal = (coordinate * scale for coordinate in wall[:3]), wall[3:]
        reach = [
            find_reach(
                one.kind.shape,
                columns[KINDS.index(one.kind)],
                one.begin,
                one.begin + one.count,
                normal,
                scale,
            )
            for one in parts
        ]
        low, high = min(one[0] for one in reach), max(one[1] for one in reach)
        side = (x - a) * normal[0] + (y - b) * normal[1] + (z - c) * normal[2]
        far = abs(a) + abs(b) + abs(c) + max(one[2] for one in reach)
        margin = 8 * MARGIN * (around + far)
        relations[~(side + high < -margin) & (relations == WITHIN)] = ACROSS
        relations[side + low > margin] = BEYOND
    return relations


def _join(first: Sequence[Bvh], trees: Sequence[Bvh | None]) -> tuple[Bvh, list[int]]:
    """Return all nodes, and the root of each tree after the first ones, ``NO_TREE`` for none."""
    rows = [row for row, tree in enumerate(trees) if tree]
    roots = [NO_TREE] * len(trees)
    bvh, firsts = join_trees([*first, *(tree for tree in trees if tree)])
    for row, root in zip(rows, firsts[len(first) :].tolist(), strict=True):
        roots[row] = root
    return bvh, roots


def is_nothing_left(kept: Acceleration, objects: Sequence[Object]) -> bool:
    """Tell whether clip planes leave none of the bounded shapes, of which there are some.

    What is cut at all counts as left, and so does a plane of which anything is.

    Parameters
    ----------
    kept
        The shapes of the scene as they are clipped.
    objects
        The objects of the scene.
    """
    rooms = kept.rooms
    if rooms is None or not kept.count:
        return False
    standing = [one for one in kept.all_shapes if not one.is_placed]
    cut = [one for _, one in (*kept.cut, *kept.faded_cut)]
    if any(one.count for one in (*standing, *cut)) or kept.placed_shapes:
        return False
    return not any(
        isinstance(item, Plane) and is_plane_left(item, rooms.walls_of(place))
        for place, item in enumerate(objects)
    )
