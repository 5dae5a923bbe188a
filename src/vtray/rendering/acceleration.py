"""The bounded shapes of a scene, ready for tracing: what is kept with it from render to render."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.geometry.bvh.tree import Bvh, Frame, node_count
from vtray.geometry.shapes.columns import Columns
from vtray.rendering.numbering import Ranges
from vtray.rendering.placed import Placed
from vtray.rendering.shape_kinds import Kind, Source, collect
from vtray.scene.copies import Copies
from vtray.scene.objects import Object


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
        For each of the `Copies` the shapes that these place, of the kinds that there are; none if
        there is no place.
    columns
        All shapes of each kind: in the order of the leaves, or, where there are few, as given. The
        number of a shape is that among its kind, or, if it is copied, in its copy.
    bvh
        The hierarchies of all.
    placed
        Where copies stand; None if there are none.
    ranges
        The numbers of all, by ranges.
    count
        How many shapes there are, with all copies.
    items
        The objects that have them.
    fingerprint
        What the contents of their arrays came to.
    """

    shapes: tuple[Shapes, ...]
    copied: tuple[tuple[Shapes, ...], ...]
    columns: tuple[Columns, ...]
    bvh: Bvh
    placed: Placed | None
    ranges: Ranges
    count: int
    items: list[Any]
    fingerprint: bytes

    @property
    def nodes(self) -> int:
        """How many nodes the hierarchies have."""
        return node_count(self.bvh)

    @property
    def tree_depth(self) -> int:
        """How many nodes lie one below the other at the most."""
        below = max((one.tree_depth for one in chain.from_iterable(self.copied)), default=0)
        above = self.placed.tree_depth if self.placed else 0
        return max(above + below, *(one.tree_depth for one in self.shapes))

    @property
    def largest(self) -> float:
        """A length that no coordinate or radius is far above."""
        copied = [one.largest for one in chain.from_iterable(self.copied)]
        # Not their sum with this, which can be beyond the largest double.
        moved = float(np.abs(self.placed.shift).max()) if self.placed else 0.0
        return max(moved, *(one.largest for one in self.shapes), *copied)

    @property
    def memory(self) -> int:
        """Bytes that are used beside the arrays that were given."""
        arrays: list[NDArray[Any]] = [*self.bvh, *(self.placed.arrays if self.placed else ())]
        arrays += [array for columns in self.columns for array in columns]
        for one in (*self.shapes, *chain.from_iterable(self.copied)):
            geometry, *rest = one.source
            arrays += [*geometry, *(column for column in rest if column is not None)]
        return sum(array.nbytes for array in arrays if array.base is None)

    def with_colors_of(self, objects: Sequence[Object]) -> "Acceleration":
        """Return the same shapes with the colours of other objects, which are alike but for these.

        Parameters
        ----------
        objects
            The objects of the scene, in the same order.
        """
        copies = [item.objects for item in objects if isinstance(item, Copies)]
        copied = (
            tuple(_recollected(one, given) for one in shapes)
            for shapes, given in zip(self.copied, copies, strict=True)
        )
        shapes = tuple(_recollected(one, objects) for one in self.shapes)
        return replace(self, shapes=shapes, copied=tuple(copied))


def _recollected(shapes: Shapes, objects: Sequence[Object]) -> Shapes:
    """Return shapes that look as other objects do."""
    return replace(shapes, source=collect(shapes.kind, shapes.kind.items_of(objects)))
