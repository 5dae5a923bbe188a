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
from vtray.rendering.bodies import BodyCount, FadedBodies, number_bodies
from vtray.rendering.clipping import clip_shapes
from vtray.rendering.numbering import Numbering, copied_rows, find_ranges, number_objects
from vtray.rendering.placed import Placed, count_places, place_copies
from vtray.rendering.rooms import rooms_of
from vtray.rendering.shape_kinds import KINDS, Kind, Source, collect
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.copies import Copies
from vtray.scene.default_light import has_default_light
from vtray.scene.fingerprint import hash_arrays
from vtray.scene.light_types import Light
from vtray.scene.objects import Plane
from vtray.scene.scene import Scene
from vtray.scene.stars import Stars
from vtray.scene.style import Style

FEW = 128
"""Up to so many shapes, no hierarchy is needed: testing each for a whole packet is faster.

The crossing was measured at 115 spheres with one light and at 200 with 64. The fans of soft lights
are faster through a hierarchy wherever there can be one.
"""

SOON = 1_000_000
"""Up to so many shapes are put together a second time within some hundredths of a second."""


def accelerate(
    scene: Scene,
    threads: int = 1,
    progress: Progress | None = None,
    style: Style | None = None,
) -> Acceleration:
    """Return what is kept with a scene, made anew if its bounded shapes have changed.

    Parameters
    ----------
    scene
        The scene.
    threads
        How many threads to use.
    progress
        Called from time to time with the number of tasks done and the number of all.
    style
        That of the picture, which may have clip planes; None for the scene's own. The hierarchy of
        the whole scene stays when these change.

    Raises
    ------
    RenderError
        There are more than a hierarchy or the memory can hold.
    """
    whole = _accelerate_whole(scene, threads, progress)
    rooms = rooms_of(scene.style if style is None else style, scene)
    if rooms is None:
        return whole
    kept: tuple[Acceleration, Acceleration] | None = scene.__dict__.get(_CLIPPED)
    if kept and kept[0] is whole and kept[1].rooms == rooms:
        return kept[1]
    bounded = [k for k, item in enumerate(scene.objects) if not isinstance(item, (Plane, Stars))]
    clipped = clip_shapes(whole, rooms, [rooms.room_of(k) for k in bounded] if rooms.of else [])
    scene.__dict__[_CLIPPED] = whole, clipped
    return clipped


def without_hierarchy(scene: Scene) -> Acceleration | None:
    """Return what `accelerate` does without clip planes, but of the same types with no hierarchy.

    None where `accelerate` builds none either, and where that takes long or builds one: where there
    are copies, faded or very many shapes.
    """
    items = [item for item in scene.objects if not isinstance(item, (Plane, Stars))]
    numbering, few = number_objects(items), _few_of(scene)
    if numbering.size.sum() <= few:
        return None
    wholes = _wholes(items, numbering, few)
    is_simple = not any(part.place >= 0 or _faded(part).count for part in wholes)
    is_built = any(part.count > part.few for part in wholes)
    if is_built and is_simple and sum(part.count for part in wholes) <= SOON:
        return _make(items, MAX_SPHERES, b"", 1, None)
    return None


def _accelerate_whole(scene: Scene, threads: int, progress: Progress | None) -> Acceleration:
    """Return what is kept with a scene as it is without clip planes."""
    items = [item for item in scene.objects if not isinstance(item, (Plane, Stars))]
    few = _few_of(scene)
    fingerprint = _fingerprint(items, threads) + few.to_bytes(8, "little")
    kept: Acceleration | None = scene.__dict__.get(_KEPT)
    if kept and kept.fingerprint == fingerprint and are_same(kept.items, items):
        return kept
    made = _make(items, few, fingerprint, threads, progress)
    scene.__dict__[_KEPT] = made
    return made


_KEPT, _CLIPPED = "_acceleration", "_clipped"


def _few_of(scene: Scene) -> int:
    """Return up to how many shapes of a scene need no hierarchy."""
    return LEAF if _has_soft_light(scene) else FEW


def _has_soft_light(scene: Scene) -> bool:
    """Tell whether a scene has lights that are no points, its own or by default."""
    return has_default_light(scene) or not all(isinstance(light, Light) for light in scene.lights)


def are_same(these: list[Any], those: list[Any]) -> bool:
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
    first
        The number of the first; if they are copied, in their first copy.
    which
        Those of the source that are meant, (n,); None for all.
    place
        The place of the copies among the objects of the scene; -1 for what is not copied.
    is_placed
        Whether it stands elsewhere than where it is given.
    """

    kind: Kind
    source: Source
    few: int
    first: int
    which: NDArray[np.int32] | None
    place: int
    is_placed: bool

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.source.geometry[0] if self.which is None else self.which)

    @property
    def geometry(self) -> tuple[NDArray[Any], ...]:
        """The columns that they are made of, as those of a `Source`."""
        if self.which is None:
            return self.source.geometry
        return tuple(c[self.which] if len(c) > 1 else c for c in self.source.geometry)


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
    wholes = _wholes(items, numbering, few)
    given = [_opaque(part) for part in wholes if part.place < 0]
    copied = [_opaque(part) for part in wholes if part.place >= 0]
    faded = [part for whole in wholes if (part := _faded(whole)).count]
    parts = [*given, *copied, *faded]
    _check_counts(parts, sum(len(item) for item in items if isinstance(item, Copies)), numbering)
    built = [_build(part, threads, progress) for part in parts]
    placed, places = _place(items, copied, threads)
    faded_placed, faded_places = _place(items, faded, threads)
    columns, begins = _join_columns(parts, built, numbering)
    trees = [*(one.tree for one in built), places, faded_places]
    bvh, roots = _join_trees(trees, [*begins, 0, count_places(placed)], threads)
    shapes = list(map(_shapes, parts, built, begins, roots))
    after = len(given) + len(copied)
    return Acceleration(
        tuple(shapes[: len(given)]),
        tuple(shapes[len(given) : after]),
        tuple(shapes[after:]),
        columns,
        bvh,
        placed and replace(placed, root=roots[-2]),
        faded_placed and replace(faded_placed, root=roots[-1]),
        find_ranges(numbering),
        int(numbering.size.sum()),
        _find_bodies(items, wholes) if faded else None,
        items,
        fingerprint,
    )


def _find_bodies(items: Sequence[Any], wholes: Sequence[_Part]) -> FadedBodies:
    """Return the bodies of all shapes."""
    count, places = BodyCount(), range(len(items))
    found = [
        number_bodies(part.kind, items, places, count)
        if part.place < 0
        else number_bodies(
            part.kind,
            items[part.place].objects,
            [part.place] * len(items[part.place].objects),
            count,
        )
        for part in wholes
    ]
    return FadedBodies(tuple(found), count.opacity)


def _wholes(items: Sequence[Any], numbering: Numbering, few: int) -> list[_Part]:
    """Return all shapes: those of each kind, and then those of each of the copies that there are.

    They are in the order of ``KINDS`` and in that of `copied_rows`.
    """
    firsts = _first_of_kinds(numbering)
    wholes = [
        _Part(kind, collect(kind, kind.items_of(items)), few, first, None, -1, False)
        for kind, first in zip(KINDS, firsts, strict=True)
    ]
    for row in copied_rows(numbering).tolist():
        kind, place = KINDS[numbering.kind[row]], int(numbering.place[row])
        source = collect(kind, kind.items_of(items[place].objects))
        first, is_placed = int(numbering.first[row]), _is_placed(items[place])
        wholes.append(_Part(kind, source, LEAF, first, None, place, is_placed))
    return wholes


def _is_placed(copies: Copies) -> bool:
    """Tell whether copies stand elsewhere than where they are given."""
    return len(copies) != 1 or bool(copies.at.any())


def _opaque(part: _Part) -> _Part:
    """Return those shapes of a part through which no light passes."""
    opacity = part.source.opacity
    if len(opacity) == 0 or (opacity == 1.0).all():
        return part
    return replace(part, which=_where(opacity == 1.0, part.count))


def _faded(part: _Part) -> _Part:
    """Return those shapes of a part through which some of it passes."""
    opacity = part.source.opacity
    is_faded = (opacity > 0.0) & (opacity < 1.0)
    return replace(part, which=_where(is_faded, part.count), few=LEAF)


def _where(mask: NDArray[np.bool_], count: int) -> NDArray[np.int32]:
    """Return the places at which a mask is set, which may be one for all."""
    return np.flatnonzero(np.broadcast_to(mask, count)).astype(np.int32)


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
    if part.count <= part.few:
        numbers = np.arange(part.count, dtype=np.int32) if part.which is None else part.which
        return _Built(Columns(_in_order(part), numbers), None)
    given = part.kind.given(*part.geometry)
    tree = build(given, threads, progress)
    numbers = tree.numbers if part.which is None else part.which[tree.numbers]
    return _Built(Columns(given.data, numbers), tree)


def _first_of_kinds(numbering: Numbering) -> list[int]:
    """Return the number of the first shape of each kind."""
    return [int(numbering.size[numbering.kind < k].sum()) for k in range(len(KINDS))]


def _shapes(part: _Part, built: _Built, begin: int, root: int) -> Shapes:
    """Return shapes with what their hierarchy says, if they have one."""
    tree = built.tree
    frame = tree.frame if tree else Frame(1.0, (0.0, 0.0, 0.0))
    tree_depth, largest = (tree.tree_depth, tree.largest) if tree else (0, _largest(part))
    return Shapes(
        part.kind,
        part.source,
        part.first,
        begin,
        part.count,
        part.place,
        part.is_placed,
        root,
        frame,
        tree_depth,
        largest,
    )


def _place(
    items: Sequence[Any], parts: Sequence[_Part], threads: int
) -> tuple[Placed | None, Tree | None]:
    """Return where copies of some shapes stand, and the hierarchy over them, if there are any."""
    used = sorted({part.place for part in parts if part.is_placed and part.count})
    if not used:
        return None, None
    boxes = [
        _box_around([part for part in parts if part.place == place and part.count], threads)
        for place in used
    ]
    return place_copies([items[place] for place in used], boxes, threads)


def _box_around(parts: Sequence[_Part], threads: int) -> tuple[Vec, Vec]:
    """Return the corners of a box that holds shapes of several kinds."""
    boxes = [bounds_of(part.kind.given(*part.geometry), threads) for part in parts]
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
        own = [_numbered(built[row].columns, parts[row], k, numbering) for row in mine]
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


def _numbered(columns: Columns, part: _Part, kind: int, numbering: Numbering) -> Columns:
    """Return shapes with their numbers among all of their kind, unless they are copied."""
    if part.place >= 0:
        return columns
    return columns._replace(number=numbering.among_kind(kind, columns.number))


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


def _in_order(part: _Part) -> NDArray[np.float64]:
    """Return the columns of shapes in the order of their numbers."""
    columns = [c if c.ndim > 1 else c[:, np.newaxis] for c in part.geometry]
    rows = [np.broadcast_to(column, (part.count, column.shape[1])) for column in columns]
    return np.concatenate(rows, axis=1, dtype=np.float64).reshape(-1)


def _largest(part: _Part) -> float:
    """Return the largest coordinate or radius, 0 if there is none."""
    return max(
        (float(max(-column.min(), column.max())) for column in part.geometry if column.size),
        default=0.0,
    )


def _fingerprint(items: list[Any], threads: int) -> bytes:
    """Return what changes if a number in the arrays does, which may be written to."""
    found = [item for item in items if isinstance(item, ArrayHolder)]
    return hash_arrays((array for item in found for array in item.arrays()), threads)
