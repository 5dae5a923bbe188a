"""Which objects the pixels of a picture show, those within copies too."""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.scene.arrays import Arrays
from vtray.scene.copies import Copies
from vtray.scene.objects import Object


class Seen(NamedTuple):
    """An object, and which of some pixels show it.

    Attributes
    ----------
    item
        The object, never copies.
    pixels
        The places of its pixels among all of them, (n,).
    rows
        What is seen there, as a place in the arrays of the object; 0 for a single one, (n,).
    copies
        The copies that it is part of, None if it stands alone.
    """

    item: Any
    pixels: NDArray[np.intp]
    rows: NDArray[np.int32]
    copies: Copies | None = None


def objects_seen(objects: Sequence[Object], ids: NDArray[np.int32]) -> Iterator[Seen]:
    """Give the objects that are seen in pixels with these ids, (n, 2), which are no empty ones."""
    places, counts = np.unique(ids[:, 0], return_counts=True)
    of_each = np.split(np.argsort(ids[:, 0], kind="stable"), np.cumsum(counts)[:-1])
    for place, mine in zip(places.tolist(), of_each, strict=True):
        item, index = objects[place], ids[mine, 1]
        if isinstance(item, Copies):
            for part in objects_seen(item.objects, _ids_within(item, index)):
                yield part._replace(pixels=mine[part.pixels], copies=item)
        else:
            yield Seen(item, mine, index)


def _ids_within(item: Copies, index: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return, as `Copies.locate`, what indices lead to: places and those in arrays, (n, 2)."""
    counts = [len(one) if isinstance(one, Arrays) else 1 for one in item.objects]
    first = np.cumsum(counts) - counts
    # Of objects that begin at the same, only the last has any.
    place = np.searchsorted(first, index, side="right") - 1
    return np.stack([place, index - first[place]], axis=1).astype(np.int32)
