"""What a drawing wants to know of shapes, of whatever kind they are."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from vtray.figures.section import Section

if TYPE_CHECKING:
    from matplotlib.patches import Patch

Floats = NDArray[np.float64]


class Cuts(NamedTuple):
    """Where a plane cuts shapes.

    Attributes
    ----------
    middle
        Middles of what it cuts out, in the drawing, (n, 2).
    reach
        How far that goes from there at the most, (n,); NaN where the plane misses a shape.
    """

    middle: Floats
    reach: Floats


class DrawnShapes(ABC):
    """Some shapes of a kind.

    Parameters
    ----------
    points
        The points that they are made of, in world space, each (n, 3).
    radius
        Their radii in scene units, (n,), or at both ends, (n, 2).
    """

    def __init__(self, points: Sequence[Floats], radius: Floats) -> None:
        self.points = points
        self.radius = radius

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.radius)

    @property
    def middle(self) -> Floats:
        """Their middles in world space, (n, 3)."""
        return np.asarray(sum(point / len(self.points) for point in self.points))

    def some(self, rows: NDArray[np.int64]) -> Self:
        """Return those of some rows."""
        return type(self)([point[rows] for point in self.points], self.radius[rows])

    def moved(self, ways: Floats) -> Self:
        """Return them moved by a translation each, (n, 3)."""
        return type(self)([point + ways for point in self.points], self.radius)

    @property
    @abstractmethod
    def extent(self) -> Floats:
        """How far each goes from its middle at the most, (n,)."""

    @abstractmethod
    def cut(self, section: Section) -> Cuts:
        """Return where a plane cuts them."""

    @abstractmethod
    def sections(self, section: Section, **style: Any) -> "list[Patch]":  # noqa: ANN401
        """Return what a plane, which cuts all, cuts out of them."""

    @abstractmethod
    def share(self, section: Section) -> float:
        """Return the width of what a plane cuts out of the first, in parts of its outline."""

    @abstractmethod
    def outline(self, section: Section, **style: Any) -> "Patch":  # noqa: ANN401
        """Return the outline of the first of them, projected squarely onto a plane."""

    @abstractmethod
    def bounds(self, section: Section) -> tuple[Floats, Floats]:
        """Return the lower left and the upper right corner of a box around it, (2,)."""

    @abstractmethod
    def inside(self, start: Floats, way: Floats) -> tuple[float, float]:
        """Return from which distance to which a line is within the first of them, which it meets.

        Parameters
        ----------
        start, way
            A point of the line and its unit direction, in world space, (3,).
        """
