"""Where copies stand: a hierarchy over the places of all `Copies` of a scene."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.geometry.bvh.build import Tree, build
from vtray.geometry.bvh.primitives import GivenBoxes
from vtray.geometry.bvh.tree import Frame
from vtray.geometry.vector import Vec
from vtray.geometry.world import NO_TREE
from vtray.scene.copies import Copies

Floats = NDArray[np.float64]

SPREAD = 2.0**-40
"""By how much boxes of copies are wider than rounding could explain, relative to their places."""


@dataclass(frozen=True)
class Placed:
    """The places of copies, in the order of the leaves of the hierarchy over them.

    Attributes
    ----------
    shift
        By how much what stands there is moved, in world space, (n, 3).
    item
        Which of the `Copies` it is, (n,).
    copy
        Which of its places, (n,).
    root
        The root of the hierarchy, or ``NO_TREE``.
    frame
        The space of its boxes.
    tree_depth
        How many nodes lie one below the other at the most.
    """

    shift: Floats
    item: NDArray[np.int32]
    copy: NDArray[np.int32]
    root: int
    frame: Frame
    tree_depth: int

    @property
    def arrays(self) -> tuple[NDArray[Any], ...]:
        """What it holds."""
        return self.shift, self.item, self.copy


def count_places(placed: Placed | None) -> int:
    """Return how many places there are; where those of what fades begin, given the others."""
    return len(placed.shift) if placed else 0


def place_copies(
    copies: Sequence[Copies], boxes: Sequence[tuple[Vec, Vec]], threads: int
) -> tuple[Placed, Tree | None]:
    """Return the places of copies, and the hierarchy over them, whose root is not yet known.

    Parameters
    ----------
    copies
        What is placed, each at one place at least.
    boxes
        The corners of a box that holds the shapes of each where they are given.
    threads
        How many threads to use.

    Returns
    -------
    placed, tree
        Without a hierarchy, if the boxes reach beyond the largest double.
    """
    counts = [len(item) for item in copies]
    shift = np.concatenate([np.asarray(item.at, np.float64) for item in copies])
    which = np.repeat(np.arange(len(copies), dtype=np.int32), counts)
    copy = np.concatenate([np.arange(count, dtype=np.int32) for count in counts])
    with np.errstate(over="ignore"):
        low, high = _corners(shift, counts, boxes)
    if not (np.isfinite(low).all() and np.isfinite(high).all()):
        return Placed(shift, which, copy, NO_TREE, Frame(1.0, (0.0, 0.0, 0.0)), 0), None
    tree = build(GivenBoxes(low, high), threads)
    order = tree.numbers
    placed = Placed(shift[order], which[order], copy[order], 0, tree.frame, tree.tree_depth)
    return placed, tree


def _corners(
    shift: Floats, counts: list[int], boxes: Sequence[tuple[Vec, Vec]]
) -> tuple[Floats, Floats]:
    """Return the corners of the boxes around copies, wider than rounding could explain."""
    given = np.array(boxes).transpose(1, 0, 2)
    own = np.abs(given).max(axis=(0, 2))
    low, high = (shift + np.repeat(corner, counts, axis=0) for corner in given)
    wider = SPREAD * (np.repeat(own, counts) + np.abs(shift).max(axis=1))[:, np.newaxis]
    return low - wider, high + wider
