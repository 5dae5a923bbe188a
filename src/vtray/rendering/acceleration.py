"""The bounded shapes of a scene, ready for tracing: what is kept with it from render to render."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.geometry.bvh.tree import Bvh, Frame, node_count
from vtray.geometry.shapes.columns import Columns
from vtray.rendering.bodies import FadedBodies
from vtray.rendering.numbering import Ranges
from vtray.rendering.placed import Placed
from vtray.rendering.rooms import Rooms
from vtray.rendering.shape_kinds import Kind, Source, collect
from vtray.scene.objects import Object, Plane
from vtray.scene.stars import Stars


@dataclass(frozen=True)
class Shapes:
    """Shapes of a kind that stand together, ready for tracing.

    Attributes
    ----------
    kind
        Their kind.
    source
        The shapes as they are given.
    first
        The number of the first; if they are copied, in their first copy.
    begin, count
        The first of their slots, and how many there are.
    place
        The place of the copies that they belong to among the objects; -1 if they are not copied.
    is_placed
        Whether they stand where `Placed` says; else where they are given.
    root
        The root of their hierarchy, or ``NO_TREE`` if there are few.
    frame
        The space of its boxes.
    tree_depth
        How many nodes lie one below the other at the most.
    largest
        A length that no coordinate or radius is far above.
    """

    kind: Kind
    source: Source
    first: int
    begin: int
    count: int
    place: int
    is_placed: bool
    root: int
    frame: Frame
    tree_depth: int
    largest: float


@dataclass(frozen=True)
class Acceleration:
    """The bounded shapes of a scene, ready for tracing.

    Attributes
    ----------
    shapes
        Those that stand where they are given, of each kind in the order of ``KINDS``.
    copied
        Those that `Copies` place, of each of these and each kind that it has.
    faded
        Those of all these through which some light passes; the others hold what none passes.
    columns
        All shapes of each kind: in the order of the leaves, or, where there are few, as given. The
        number of a shape is that among its kind, or, if it is copied, in its copy.
    bvh
        The hierarchies of all.
    placed
        Where copies stand; None if there are none.
    faded_placed
        The same for faded shapes.
    ranges
        The numbers of all, by ranges.
    count
        How many shapes there are, with all copies.
    bodies
        What the faded ones make up, the sources being those of `shapes` and then of `copied`; None
        if there are none.
    items
        The objects that have them.
    fingerprint
        What the contents of their arrays came to.
    rooms, room_of
        What clip planes leave, and the room of each of the objects that have shapes; empty if all
        have the first. `shapes`, `faded`, `placed` and `faded_placed` are then what is left whole.
        At places with an item beyond those that there are, shapes may be cut. None and nothing
        where there are no clip planes.
    cut, faded_cut
        The shapes that these cut where they are given, each with its room.
    """

    shapes: tuple[Shapes, ...]
    copied: tuple[Shapes, ...]
    faded: tuple[Shapes, ...]
    columns: tuple[Columns, ...]
    bvh: Bvh
    placed: Placed | None
    faded_placed: Placed | None
    ranges: Ranges
    count: int
    bodies: FadedBodies | None
    items: list[Any]
    fingerprint: bytes
    rooms: Rooms | None = None
    room_of: tuple[int, ...] = ()
    cut: tuple[tuple[int, Shapes], ...] = ()
    faded_cut: tuple[tuple[int, Shapes], ...] = ()

    @property
    def nodes(self) -> int:
        """How many nodes the hierarchies have."""
        return node_count(self.bvh)

    @property
    def all_shapes(self) -> tuple[Shapes, ...]:
        """All of them."""
        return *self.shapes, *self.copied, *self.faded

    @property
    def all_placed(self) -> list[Placed]:
        """Where all copies stand."""
        return [placed for placed, _ in self.placed_shapes]

    @property
    def placed_shapes(self) -> list[tuple[Placed, tuple[Shapes, ...]]]:
        """Where copies stand, and what stands there, first of shapes that no light passes."""
        pairs = (self.placed, self.copied), (self.faded_placed, self.faded)
        return [(placed, shapes) for placed, shapes in pairs if placed]

    def items_of(self, shapes: Sequence[Shapes]) -> list[tuple[Shapes, ...]]:
        """Return those of some shapes that are placed, together by the copies that they are of."""
        return [
            tuple(one for one in shapes if one.place == place and one.is_placed and one.count)
            for place in used_places(shapes)
        ]

    @property
    def tree_depth(self) -> int:
        """How many nodes lie one below the other at the most."""
        given = (one.tree_depth for one in self.all_shapes if not one.is_placed)
        below = max((one.tree_depth for one in self.all_shapes if one.is_placed), default=0)
        above = max((placed.tree_depth for placed in self.all_placed), default=0)
        return max(above + below, *given)

    @property
    def largest(self) -> float:
        """A length that no coordinate or radius is far above."""
        # Not the sum of both, which can be beyond the largest double.
        moved = (float(np.abs(placed.shift).max()) for placed in self.all_placed)
        return max(*moved, *(one.largest for one in self.all_shapes))

    @property
    def is_cut(self) -> bool:
        """Whether a clip plane may cut any shape."""
        return any(one.count for _, one in (*self.cut, *self.faded_cut)) or any(
            (placed.item >= len(used_places(shapes))).any() for placed, shapes in self.placed_shapes
        )

    @property
    def memory(self) -> int:
        """Bytes that are used beside the arrays that were given."""
        arrays: list[NDArray[Any]] = [*self.bvh]
        arrays += [array for placed in self.all_placed for array in placed.arrays]
        arrays += [array for columns in self.columns for array in columns]
        for one in (*self.shapes, *self.copied):
            geometry, *rest, made = one.source
            arrays += [*geometry, *(column for column in rest if column is not None), made.which]
        return sum(array.nbytes for array in arrays if array.base is None)

    def with_colors_of(self, objects: Sequence[Object]) -> "Acceleration":
        """Return the same shapes with the colours of other objects, which are alike but for these.

        Parameters
        ----------
        objects
            The objects of the scene, in the same order.
        """
        items = [item for item in objects if not isinstance(item, (Plane, Stars))]
        copied: list[Any] = [items[one.place] for one in self.copied]
        return replace(
            self,
            shapes=tuple(_recollected(one, items) for one in self.shapes),
            copied=tuple(map(_recollected, self.copied, (item.objects for item in copied))),
        )


def _recollected(shapes: Shapes, objects: Sequence[Object]) -> Shapes:
    """Return shapes that look as other objects do."""
    return replace(shapes, source=collect(shapes.kind, shapes.kind.items_of(objects)))


def used_places(shapes: Iterable[Shapes]) -> list[int]:
    """Return the places of the copies of which any of some shapes are placed, in their order."""
    return sorted({one.place for one in shapes if one.is_placed and one.count})
