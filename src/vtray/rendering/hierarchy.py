"""What is kept with a scene from render to render: its bounded shapes, ready for tracing.

The shapes of a kind are numbered in the order of the scene, put into the order of the leaves of a
hierarchy, and kept until they change. A new camera, light or plane costs no new build.
"""

import operator
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain, islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.capacity import MAX_NUMBERS, MAX_SPHERES
from vtray.base.compiler.compiled import uncompiled
from vtray.base.errors import RenderError
from vtray.base.memory import check_memory_of_spheres
from vtray.base.pool import Progress
from vtray.geometry.bvh.build import Tree, bounds_of, build
from vtray.geometry.bvh.join import join_trees
from vtray.geometry.bvh.tree import LEAF, Bvh, Frame, no_bvh
from vtray.geometry.shapes.columns import Columns
from vtray.geometry.vector import Vec, lower, upper
from vtray.geometry.world import NO_TREE
from vtray.rendering.acceleration import Acceleration, Shapes
from vtray.rendering.numbering import Numbering, copied_rows, find_ranges, number_objects
from vtray.rendering.placed import Placed, place_copies
from vtray.rendering.shape_kinds import KINDS, Kind, Source, collect
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.copies import Copies
from vtray.scene.default_light import has_default_light
from vtray.scene.fingerprint import hash_arrays
from vtray.scene.light_types import Light
from vtray.scene.objects import Plane
from vtray.scene.scene import Scene
from vtray.scene.stars import Stars

FEW = 128
"""Up to so many shapes, no hierarchy is needed: testing each for a whole packet is faster.

The crossing was measured at 115 spheres with one light and at 200 with 64. The fans of soft lights
are faster through a hierarchy wherever there can be one.
"""


def accelerate(scene: Scene, threads: int = 1, progress: Progress | None = None) -> Acceleration:
    """Return what is kept with a scene, made anew if its bounded shapes have changed.

    Raises
    ------
    RenderError
        There are more than a hierarchy or the memory can hold.
    """
    items = [item for item in scene.objects if not isinstance(item, (Plane, Stars))]
    few = LEAF if _has_soft_light(scene) else FEW
    fingerprint = _fingerprint(items, threads) + few.to_bytes(8, "little")
    kept: Acceleration | None = scene.__dict__.get(_KEPT)
    if kept and kept.fingerprint == fingerprint and _are_same(kept.items, items):
        return kept
    made = _make(items, few, fingerprint, threads, progress)
    scene.__dict__[_KEPT] = made
    return made


_KEPT = "_acceleration"


def _has_soft_light(scene: Scene) -> bool:
    """Tell whether a scene has lights that are no points, its own or by default."""
    return has_default_light(scene) or not all(isinstance(light, Light) for light in scene.lights)


def _are_same(these: list[Any], those: list[Any]) -> bool:
    """Tell whether two lists hold the same objects."""
    return len(these) == len(those) and all(map(operator.is_, these, those))


@dataclass(frozen=True)
class _Part:
    """Shapes of a kind that stand together, before they are built.

    Attributes
    ----------
    kind, source
        The shapes.
    few
        Up to so many get no hierarchy.
    """

    kind: Kind
    source: Source
    few: int

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.source.geometry[0])


@dataclass(frozen=True)
class _Built:
    """Shapes ready for tracing, on their own.

    Attributes
    ----------
    columns
        In the order of the leaves, or, where there are few, as given.
    tree
        The hierarchy, if there is one.
    """

    columns: Columns
    tree: Tree | None


def _make(
    items: list[Any], few: int, fingerprint: bytes, threads: int, progress: Progress | None
) -> Acceleration:
    """Give numbers to shapes, build their hierarchies, and join all."""
    numbering = number_objects(items)
    copies = [item for item in items if isinstance(item, Copies)]
    given = [_part(kind, items, few) for kind in KINDS]
    copied = [
        [part for kind in KINDS if len(item) and (part := _part(kind, item.objects, LEAF)).count]
        for item in copies
    ]
    parts = [*given, *chain.from_iterable(copied)]
    _check_counts(parts, sum(map(len, copies)), numbering)
    built = [_build(part, threads, progress) for part in parts]
    placed, places = _place(copies, copied, threads)
    columns, begins = _join_columns(parts, built, numbering)
    trees = [*(one.tree for one in built), places]
    bvh, roots = _join_trees(trees, [*begins, 0], threads)
    firsts = [*_first_of_kinds(numbering), *numbering.first[copied_rows(numbering)].tolist()]
    shapes = map(_shapes, parts, built, firsts, begins, roots)
    return Acceleration(
        tuple(islice(shapes, len(given))),
        tuple(tuple(islice(shapes, len(of_one))) for of_one in copied),
        columns,
        bvh,
        placed and replace(placed, root=roots[-1]),
        find_ranges(numbering),
        int(numbering.size.sum()),
        items,
        fingerprint,
    )


def _part(kind: Kind, items: Sequence[Any], few: int) -> _Part:
    """Return those shapes of a kind that objects have and that are not copied."""
    return _Part(kind, collect(kind, kind.items_of(items)), few)


def _check_counts(parts: Sequence[_Part], places: int, numbering: Numbering) -> None:
    """Raise RenderError if there are more shapes or places than can be held, or numbered."""
    for kind in KINDS:
        count = sum(part.count for part in parts if part.kind is kind)
        if count > MAX_SPHERES:
            message = f"objects: expected at most {MAX_SPHERES} {kind.name}, got {count}"
            raise RenderError(message)
    if places > MAX_SPHERES:
        message = f"objects: expected at most {MAX_SPHERES} places of copies, got {places}"
        raise RenderError(message)
    check_memory_of_spheres(sum(part.count for part in parts) + places)
    numbers = sum(map(int, numbering.size))
    if numbers > MAX_NUMBERS:
        words = f"expected at most {MAX_NUMBERS} spheres, cylinders and cones, copies counted"
        message = f"objects: {words}, got {numbers}"
        raise RenderError(message)


def _build(part: _Part, threads: int, progress: Progress | None) -> _Built:
    """Build the hierarchy of shapes, if there are enough."""
    source = part.source
    if part.count <= part.few:
        return _Built(Columns(_in_order(source), np.arange(part.count, dtype=np.int32)), None)
    given = part.kind.given(*source.geometry)
    tree = build(given, threads, progress)
    return _Built(Columns(given.data, tree.numbers), tree)


def _first_of_kinds(numbering: Numbering) -> list[int]:
    """Return the number of the first shape of each kind."""
    return [int(numbering.size[numbering.kind < k].sum()) for k in range(len(KINDS))]


def _shapes(part: _Part, built: _Built, first: int, begin: int, root: int) -> Shapes:
    """Return shapes with what their hierarchy says, if they have one."""
    tree = built.tree
    frame = tree.frame if tree else Frame(1.0, (0.0, 0.0, 0.0))
    tree_depth, largest = (tree.tree_depth, tree.largest) if tree else (0, _largest(part.source))
    return Shapes(
        part.kind, part.source, first, begin, part.count, root, frame, tree_depth, largest
    )


def _place(
    copies: Sequence[Copies], copied: Sequence[Sequence[_Part]], threads: int
) -> tuple[Placed | None, Tree | None]:
    """Return where copies stand, and the hierarchy over them, if there are any."""
    used = [k for k, parts in enumerate(copied) if parts]
    if not used:
        return None, None
    boxes = [_box_around(copied[k], threads) for k in used]
    return place_copies([copies[k] for k in used], boxes, threads)


def _box_around(parts: Sequence[_Part], threads: int) -> tuple[Vec, Vec]:
    """Return the corners of a box that holds shapes of several kinds."""
    boxes = [bounds_of(part.kind.given(*part.source.geometry), threads) for part in parts]
    low, high = boxes[0]
    for corners in boxes[1:]:
        low, high = uncompiled(lower)(low, corners[0]), uncompiled(upper)(high, corners[1])
    return low, high


def _join_columns(
    parts: Sequence[_Part], built: Sequence[_Built], numbering: Numbering
) -> tuple[tuple[Columns, ...], list[int]]:
    """Return all shapes of each kind, and at which slot each part of them begins."""
    begins = [0] * len(parts)
    joined = []
    for k, kind in enumerate(KINDS):
        mine = [row for row, part in enumerate(parts) if part.kind is kind]
        own = [built[row].columns for row in mine]
        own[0] = own[0]._replace(number=numbering.among_kind(k, own[0].number))
        slots = np.cumsum([0] + [len(columns.number) for columns in own])
        for row, slot in zip(mine, slots.tolist(), strict=False):
            begins[row] = slot
        filled = [columns for columns in own if len(columns.number)] or own[:1]
        joined.append(
            filled[0]
            if len(filled) == 1
            else Columns(*(np.concatenate(arrays) for arrays in zip(*filled, strict=True)))
        )
    return tuple(joined), begins


def _join_trees(
    trees: Sequence[Tree | None], slots: Sequence[int], threads: int
) -> tuple[Bvh, list[int]]:
    """Return all nodes, and the root of each hierarchy, ``NO_TREE`` where there is none."""
    rows = [row for row, tree in enumerate(trees) if tree]
    bvhs = [tree.bvh for tree in trees if tree]
    begins = [slots[row] for row in rows]
    roots = [NO_TREE] * len(trees)
    if not rows:
        return no_bvh(), roots
    if len(rows) == 1 and not begins[0]:
        roots[rows[0]] = 0
        return bvhs[0], roots
    bvh, firsts = join_trees(bvhs, threads, begins)
    for row, first in zip(rows, firsts.tolist(), strict=True):
        roots[row] = first
    return bvh, roots


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
    found = [item for item in items if isinstance(item, ArrayHolder)]
    return hash_arrays((array for item in found for array in item.arrays()), threads)
