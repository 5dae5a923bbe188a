"""What a hierarchy is built over: primitives, of which the builder sees boxes only.

Boxes are asked for by some thousands at a time, so that those of 10^8 primitives take no memory.
"""

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Boxes = NDArray[np.float64]
"""Boxes in world space: x, y, z of their centres, then x, y, z of half their extents, (6, n).

Not their corners, which can be beyond the largest double.
"""

Numbers = NDArray[np.int32]
"""Numbers of primitives, in the order in which they are given."""

PADDING = 8
"""Numbers of a cache line."""


def new_boxes(count: int) -> Boxes:
    """Return room for so many boxes, and some more."""
    # If the rows lay a power of two apart, caches could hold few lines of them at a time.
    return np.empty((6, count + PADDING))


class Primitives(Protocol):
    """Any number of primitives, of whatever shape. Several threads call it at once."""

    @property
    def count(self) -> int:
        """How many there are."""

    def bound(self, begin: int, end: int, boxes: Boxes) -> None:
        """Set boxes to those of a range of primitives.

        Parameters
        ----------
        begin, end
            The range, in numbers.
        boxes
            Out: their boxes are the first, (6, m), m >= end - begin. They need be no wider for
            rounding errors, up to `MARGIN` times the magnitude of centre and largest half extent.
        """

    def gather(self, numbers: Numbers, slot: int, boxes: Boxes) -> None:
        """Bring primitives to their places in the order of the leaves, and set boxes to theirs.

        Called again for places where a better order is found; the last call counts.

        Parameters
        ----------
        numbers
            Which primitives, (n,).
        slot
            The place of the first; the others follow.
        boxes
            Out: as in `bound`.
        """


class GivenBoxes:
    """Boxes given by their corners, such as those of objects that stand in several places.

    Parameters
    ----------
    low, high
        Corners in world space, (n, 3).
    """

    def __init__(self, low: NDArray[Any], high: NDArray[Any]) -> None:
        # Halves first: a sum could overflow.
        half_low, half_high = (np.asarray(corners, float).T * 0.5 for corners in (low, high))
        self._boxes = np.concatenate([half_low + half_high, half_high - half_low])

    @property
    def count(self) -> int:
        """How many there are."""
        count: int = self._boxes.shape[1]
        return count

    def bound(self, begin: int, end: int, boxes: Boxes) -> None:
        """Copy a range of boxes."""
        boxes[:, : end - begin] = self._boxes[:, begin:end]

    def gather(self, numbers: Numbers, slot: int, boxes: Boxes) -> None:  # noqa: ARG002
        """Copy boxes; whoever has the objects goes by their numbers."""
        boxes[:, : len(numbers)] = self._boxes[:, numbers]
