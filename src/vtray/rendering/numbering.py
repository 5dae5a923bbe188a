"""Which numbers the primitives of a scene have, and what a number leads to.

Spheres come first, then cylinders, then cones, then planes, each in the order of the scene; those
of `Copies` stand where these stand among the objects, copy by copy.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.capacity import MAX_NUMBERS
from vtray.rendering.shape_kinds import KINDS, Kind, count_of
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.copies import Copies
from vtray.scene.objects import Object
from vtray.scene.stars import Stars

Integers = NDArray[np.int64]

PLANES = len(KINDS)
"""In place of a kind of bounded shapes: planes."""

COPIED = PLANES + 1
"""In place of a kind: copies, which may be of several."""

UNMET = PLANES + 2
"""In place of a kind: what no ray meets."""


class Numbering(NamedTuple):
    """The numbers of the primitives of objects, a row for each object and each of its kinds.

    Attributes
    ----------
    kind
        Places in ``KINDS``, or ``PLANES``.
    place
        The places of the objects in the list of all.
    first
        The number of the first primitive of each row.
    size
        How many there are.
    each
        How many of these one copy has; 0 for objects that are no copies.
    """

    kind: Integers
    place: Integers
    first: Integers
    size: Integers
    each: Integers

    def among_kind(self, kind: int, given: NDArray[np.int32]) -> NDArray[np.int32]:
        """Return the numbers that shapes of a kind have among all of that kind.

        Parameters
        ----------
        kind
            The kind.
        given
            Their numbers among those that are not copied, (n,).
        """
        rows = self.kind == kind
        own = rows & (self.each == 0)
        if rows.sum() == own.sum():
            return given
        first = self.first[own] - self.first[rows][0]
        begin = np.cumsum(self.size[own]) - self.size[own]
        if len(first) == 0 or first[-1] == begin[-1]:
            return given
        ahead = (first - begin)[np.searchsorted(begin, given, side="right") - 1]
        numbers: NDArray[np.int32] = (given + ahead).astype(np.int32)
        return numbers


class Found(NamedTuple):
    """What a number leads to.

    Attributes
    ----------
    place
        The place of the object in the list of all.
    copy
        Which of its copies; -1 if it is not copied.
    member
        Which of its primitives, 0 for a single one; those of a copy are counted through all the
        objects that are copied.
    """

    place: int
    copy: int
    member: int


class Ranges(NamedTuple):
    """Runs of numbers: those of a kind between copies, and all copies of the same shapes.

    Attributes
    ----------
    first
        The number of the first primitive of each.
    each
        How many of these one copy has, or more than there are.
    copied
        Which of the copied shapes they are, counted as by `copied_rows`; -1 for those that are not.
    kind
        Their kind.
    begin
        Which of the shapes of their kind that are not copied the first is; 0 for copies.
    """

    first: Integers
    each: Integers
    copied: Integers
    kind: Integers
    begin: Integers


def number_objects(objects: Sequence[Object]) -> Numbering:
    """Return the numbers of objects: kind by kind, and in the order of the scene."""
    # Of a million single objects, none is looked at but for its type.
    types = list(map(type, objects))
    kind_of = {found: _kind_of(found) for found in set(types)}
    kind = np.array([kind_of[found] for found in types], np.int64)
    place, size, each = np.arange(len(types)), np.ones(len(types), np.int64), np.zeros_like(kind)
    held = {found for found in kind_of if issubclass(found, ArrayHolder)}
    for k in (k for k, found in enumerate(types) if found in held):
        size[k] = len(objects[k])  # type: ignore[arg-type]
    rows = np.stack([kind, place, size, each])[:, kind < COPIED]
    copied = [_rows_of(k, objects[k]) for k in np.flatnonzero(kind == COPIED).tolist()]
    rows = np.concatenate([rows, *copied], axis=1)
    kind, place, size, each = rows[:, np.lexsort(rows[1::-1])]
    return Numbering(kind, place, np.cumsum(size) - size, size, each)


def _kind_of(found: type) -> int:
    """Return the place of a type of objects in ``KINDS``, ``PLANES``, ``COPIED`` or ``UNMET``."""
    if issubclass(found, Stars):
        return UNMET
    kinds = (k for k, kind in enumerate(KINDS) if issubclass(found, (kind.single, kind.arrays)))
    return COPIED if issubclass(found, Copies) else next(kinds, PLANES)


def _rows_of(place: int, copies: Any) -> Integers:  # noqa: ANN401
    """Return kind, place, size and each of the rows of copies, (4, m); none without a place."""
    counts = [sum(map(count_of, kind.items_of(copies.objects))) for kind in KINDS]
    times = len(copies)
    rows = [(k, place, times * each, each) for k, each in enumerate(counts) if times and each]
    return np.array(rows, np.int64).reshape(-1, 4).T


def copied_rows(numbering: Numbering) -> Integers:
    """Return the rows of copied shapes: in the order of the objects, and then of their kinds."""
    rows = np.flatnonzero(numbering.each)
    return rows[np.lexsort((numbering.kind[rows], numbering.place[rows]))]


def find_ranges(numbering: Numbering) -> Ranges:
    """Return the ranges of numbers."""
    kind, each, rows = numbering.kind, numbering.each, copied_rows(numbering)
    is_first = np.ones(len(kind), np.bool_)
    is_first[1:] = (kind[1:] != kind[:-1]) | (each[1:] > 0) | (each[:-1] > 0)
    copied, begin = np.full(len(kind), -1), np.zeros(len(kind), np.int64)
    copied[rows] = np.arange(len(rows))
    for k in range(len(KINDS)):
        given = (kind == k) & (each == 0)
        begin[given] = np.cumsum(numbering.size[given]) - numbering.size[given]
    columns = numbering.first, np.where(each > 0, each, MAX_NUMBERS), copied, kind, begin
    return Ranges(*(column[is_first] for column in columns))


def locate(numbering: Numbering, number: int) -> tuple[int, int]:
    """Return the place of the object that a primitive belongs to, and which of its own it is."""
    row = _row_of(numbering, number)
    return int(numbering.place[row]), number - int(numbering.first[row])


def find(objects: Sequence[Object], numbering: Numbering, number: int) -> Found:
    """Return what a number leads to."""
    row = _row_of(numbering, number)
    place, inside = locate(numbering, number)
    each = int(numbering.each[row])
    if not each:
        return Found(place, -1, inside)
    copy, inside = divmod(inside, each)
    index = _places_in(objects[place], KINDS[numbering.kind[row]], np.array([inside]))
    return Found(place, copy, int(index[0]))


def _row_of(numbering: Numbering, number: int) -> int:
    """Return the row of a number; of rows that begin at the same, only the last has any."""
    return int(np.searchsorted(numbering.first, number, side="right")) - 1


def find_all(
    objects: Sequence[Object], primitives: NDArray[np.int32]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return what many numbers lead to, as `find` does.

    Parameters
    ----------
    objects
        The objects of the scene.
    primitives
        Numbers of primitives, -1 for none, of any shape.

    Returns
    -------
    ids, copies
        Of the same shape with two numbers for each, place and index; and with one, the copy. All
        are -1 for none, and the copy of what is not copied, too.
    """
    numbering = number_objects(objects)
    rows = np.searchsorted(numbering.first, primitives, side="right") - 1
    rows[primitives < 0] = -1
    ids = np.empty((*primitives.shape, 2), np.int32)
    copies = np.full(primitives.shape, -1, np.int32)
    ids[..., 0] = np.append(numbering.place, -1)[rows]
    ids[..., 1] = np.where(rows < 0, -1, primitives - np.append(numbering.first, 0)[rows])
    for row in np.flatnonzero(numbering.each).tolist():
        mine = rows == row
        item, kind = objects[int(numbering.place[row])], KINDS[numbering.kind[row]]
        copies[mine], inside = np.divmod(ids[mine, 1], numbering.each[row])
        ids[mine, 1] = _places_in(item, kind, inside)
    return ids, copies


def _places_in(item: Any, kind: Kind, inside: NDArray[Any]) -> NDArray[Any]:  # noqa: ANN401
    """Return which primitives of a copy those of one kind are, counted through all its objects."""
    counts = np.array([count_of(one) for one in item.objects])
    mine = [isinstance(one, (kind.single, kind.arrays)) for one in item.objects]
    begin, own = (np.cumsum(counts) - counts)[mine], counts[mine]
    first = np.cumsum(own) - own
    which = np.searchsorted(first, inside, side="right") - 1
    places: NDArray[Any] = inside + (begin - first)[which]
    return places
