"""What is kept with a scene from render to render: its bounded shapes, ready for tracing.

The shapes of a kind are numbered in the order of the scene, put into the order of the leaves of a
hierarchy, and kept until they change. A new camera, light or plane costs no new build.
"""

import operator
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.capacity import MAX_SPHERES
from vtray.base.errors import RenderError
from vtray.base.memory import check_memory_of_spheres
from vtray.base.pool import Progress
from vtray.geometry.bvh.build import build
from vtray.geometry.bvh.join import join_trees
from vtray.geometry.bvh.tree import Bvh, Frame, no_bvh, node_count
from vtray.geometry.shapes.columns import Columns
from vtray.geometry.world import NO_TREE
from vtray.rendering.shape_kinds import KINDS, Kind, Source, collect, count_of
from vtray.scene.arrays import Arrays
from vtray.scene.fingerprint import arrays_of, hash_arrays
from vtray.scene.scene import Scene

FEW = 128
"""Up to so many shapes, no hierarchy is needed: testing each for a whole packet is faster.

The crossing was measured at 115 spheres with one light and at 200 with 64.
"""


@dataclass(frozen=True)
class Shapes:
    """All shapes of a kind, ready for tracing.

    Attributes
    ----------
    kind
        Their kind.
    source
        The shapes by their numbers.
    columns
        In the order of the leaves, or, if there are few, of their numbers.
    root
        The root of their hierarchy, or ``NO_TREE`` if there are few.
    frame
        The space of its boxes.
    depth
        How many nodes lie one below the other at the most.
    largest
        A length that no coordinate or radius is far above.
    """

    kind: Kind
    source: Source
    columns: Columns
    root: int
    frame: Frame
    depth: int
    largest: float

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.columns.number)


@dataclass(frozen=True)
class Acceleration:
    """The bounded shapes of a scene, ready for tracing.

    Attributes
    ----------
    shapes
        Those of each kind, in the order of their numbers.
    bvh
        The hierarchies of all kinds.
    items
        The objects that have them.
    fingerprint
        What the contents of their arrays came to.
    """

    shapes: tuple[Shapes, ...]
    bvh: Bvh
    items: list[Any]
    fingerprint: bytes

    @property
    def nodes(self) -> int:
        """How many nodes the hierarchies have."""
        return node_count(self.bvh)

    @property
    def depth(self) -> int:
        """How many nodes lie one below the other at the most."""
        return max(shapes.depth for shapes in self.shapes)

    @property
    def largest(self) -> float:
        """A length that no coordinate or radius is far above."""
        return max(shapes.largest for shapes in self.shapes)

    @property
    def count(self) -> int:
        """How many shapes there are."""
        return sum(shapes.count for shapes in self.shapes)

    @property
    def memory(self) -> int:
        """Bytes that are used beside the arrays that were given."""
        arrays: list[NDArray[Any]] = [*self.bvh]
        for shapes in self.shapes:
            geometry, *rest = shapes.source
            arrays += [
                *shapes.columns,
                *geometry,
                *(column for column in rest if column is not None),
            ]
        return sum(array.nbytes for array in arrays if array.base is None)


def accelerate(scene: Scene, threads: int = 1, progress: Progress | None = None) -> Acceleration:
    """Return what is kept with a scene, made anew if its bounded shapes have changed.

    Raises
    ------
    RenderError
        There are more than a hierarchy or the memory can hold.
    """
    sorted_items = [kind.items_of(scene.objects) for kind in KINDS]
    items = [item for of_kind in sorted_items for item in of_kind]
    fingerprint = _fingerprint(items, threads)
    kept: Acceleration | None = scene.__dict__.get(_KEPT)
    if kept and kept.fingerprint == fingerprint and _are_same(kept.items, items):
        return kept
    made = _make(sorted_items, fingerprint, threads, progress)
    scene.__dict__[_KEPT] = made
    return made


_KEPT = "_acceleration"


def _are_same(these: list[Any], those: list[Any]) -> bool:
    """Tell whether two lists hold the same objects."""
    return len(these) == len(those) and all(map(operator.is_, these, those))


def _make(
    sorted_items: list[list[Any]], fingerprint: bytes, threads: int, progress: Progress | None
) -> Acceleration:
    """Give numbers to the shapes of each kind of objects, and build their hierarchies."""
    counts = [sum(map(count_of, items)) for items in sorted_items]
    for kind, count in zip(KINDS, counts, strict=True):
        if count > MAX_SPHERES:
            message = f"objects: expected at most {MAX_SPHERES} {kind.name}, got {count}"
            raise RenderError(message)
    check_memory_of_spheres(sum(counts))
    trees: list[Bvh] = []
    shapes = [
        _prepare(kind, items, trees, threads, progress)
        for kind, items in zip(KINDS, sorted_items, strict=True)
    ]
    if len(trees) > 1:
        bvh, roots = join_trees(trees, threads)
        shapes = [
            one if one.root == NO_TREE else replace(one, root=int(roots[one.root]))
            for one in shapes
        ]
    else:
        bvh = trees[0] if trees else no_bvh()
    items = [item for of_kind in sorted_items for item in of_kind]
    return Acceleration(tuple(shapes), bvh, items, fingerprint)


def _prepare(
    kind: Kind,
    items: Sequence[Any],
    trees: list[Bvh],
    threads: int,
    progress: Progress | None,
) -> Shapes:
    """Return the shapes of a kind; their tree is added to others, and their root says where."""
    source = collect(kind, items)
    count = len(source.geometry[0])
    if count <= FEW:
        columns = Columns(_in_order(source), np.arange(count, dtype=np.int32))
        frame = Frame(1.0, (0.0, 0.0, 0.0))
        return Shapes(kind, source, columns, NO_TREE, frame, 0, _largest(source))
    given = kind.given(*source.geometry)
    tree = build(given, threads, progress)
    trees.append(tree.bvh)
    columns = Columns(given.data, tree.numbers)
    return Shapes(kind, source, columns, len(trees) - 1, tree.frame, tree.depth, tree.largest)


def _in_order(source: Source) -> NDArray[np.float64]:
    """Return the columns of shapes in the order of their numbers."""
    count = len(source.geometry[0])
    parts = [column if column.ndim > 1 else column[:, np.newaxis] for column in source.geometry]
    rows = [np.broadcast_to(part, (count, part.shape[1])) for part in parts]
    return np.concatenate(rows, axis=1, dtype=np.float64).reshape(-1)


def _largest(source: Source) -> float:
    """Return the largest coordinate or radius, 0 if there is none."""
    return max(
        (float(max(-column.min(), column.max())) for column in source.geometry if column.size),
        default=0.0,
    )


def _fingerprint(items: list[Any], threads: int) -> bytes:
    """Return what changes if a number in the arrays does, which may be written to."""
    arrays = [array for item in items if isinstance(item, Arrays) for array in arrays_of(item)]
    return hash_arrays(arrays, threads)
