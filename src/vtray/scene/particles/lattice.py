"""The cell of periodic particles as a lattice: fractions of its edges, images, heights."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from vtray.base.errors import SceneError
from vtray.base.exact_math import hypotenuse
from vtray.scene.placing.directions import Vec, cross, dot, unit
from vtray.scene.vectors import Direction

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vtray.scene.particles.particles import Particles

    Floats = NDArray[np.float64]
    Integers = NDArray[np.int64]
else:
    Floats = Integers = Any

FLAT = 1e-9
"""Volume of a cell below which its edges count as lying in one plane, in parts of their product."""

FARTHEST = 2.0**62
"""Edges that a point may be away from the cell, as integers of 64 bits can tell."""

LONGEST = 1e100
"""No edge is longer, and none shorter than its inverse: their product is the volume."""


class Lattice(NamedTuple):
    """What repeats: three edges from an origin, and along which of them.

    Attributes
    ----------
    edges
        The edges, in the unit of the positions. One along which nothing repeats may be made up.
    inverse
        Rows whose products with a point relative to the origin are its fractions of the edges.
    origin
        The cell's corner.
    periodic
        Along which edges the cell repeats.
    """

    edges: tuple[Vec, Vec, Vec]
    inverse: tuple[Vec, Vec, Vec]
    origin: Vec
    periodic: tuple[bool, bool, bool]

    @property
    def heights(self) -> Vec:
        """The distances between opposite faces of the cell."""
        a, b, c = (1.0 / hypotenuse(*row) for row in self.inverse)
        return a, b, c

    def fractions(self, columns: Sequence[Floats]) -> list[Floats]:
        """Return the fractions of the edges that points are at, as three columns.

        Parameters
        ----------
        columns
            The coordinates of n points, three of shape (n,).
        """
        x, y, z = (column - start for column, start in zip(columns, self.origin, strict=True))
        return [x * row[0] + y * row[1] + z * row[2] for row in self.inverse]

    def moved(self, columns: Sequence[Floats], shifts: Sequence[Any]) -> list[Floats]:
        """Return points, as three columns, moved by whole edges.

        Parameters
        ----------
        columns
            Their coordinates, three of shape (n,).
        shifts
            How many of each edge to move them, three of shape (n,) or numbers.
        """
        (a, b, c), (i, j, k) = self.edges, shifts
        return [
            column + (i * a[axis] + j * b[axis] + k * c[axis])
            for axis, column in enumerate(columns)
        ]

    def outside(self, columns: Sequence[Floats], slack: float = 0.0) -> Integers:
        """Return how many edges points are away from the cell, (n, 3); 0 where nothing repeats.

        Those that are before a face by such a part of an edge count as beyond it.

        Raises
        ------
        SceneError
            A point is too many edges away.
        """
        import numpy as np

        found = np.zeros((len(columns[0]), 3), np.int64)
        for k, fraction in enumerate(self.fractions(columns)):
            if self.periodic[k]:
                edges = np.floor(fraction + slack)
                lost = np.flatnonzero(~(np.abs(edges) < FARTHEST))
                if len(lost):
                    words = f"is {edges[lost[0]]:g} edges away from the cell that repeats"
                    raise SceneError(f"Particles.positions[{lost[0]}]: {words}; leave it out")
                found[:, k] = edges
        return found


def lattice_of(particles: "Particles") -> Lattice | None:
    """Return the lattice of particles; None where nothing repeats.

    Raises
    ------
    SceneError
        The edges lie in one plane.
    """
    if particles.cell is None or not any(particles.periodic or ()):
        return None
    return lattice_from(particles)


def lattice_from(particles: "Particles") -> Lattice:
    """Return the lattice of particles with a cell, whether it repeats or not.

    Raises
    ------
    SceneError
        The edges lie in one plane, or are too long or too short.
    """
    periodic = particles.periodic or (False, False, False)
    given = [_triple(row) for row in particles.cell]  # type: ignore[union-attr]
    a, b, c = edges = _completed(given)
    volume, lengths = dot(a, cross(b, c)), [hypotenuse(*edge) for edge in edges]
    shown = [list(edge) for edge in given]
    if not (min(lengths) >= 1 / LONGEST and max(lengths) <= LONGEST):
        words = f"its edges must be from {1 / LONGEST:g} to {LONGEST:g} long"
        raise SceneError(f"Particles.cell: {words}, got {shown}")
    if not abs(volume) > FLAT * math.prod(lengths):
        raise SceneError(f"Particles.cell: its edges must not lie in one plane, got {shown}")
    one, two, three = (_divided(row, volume) for row in (cross(b, c), cross(c, a), cross(a, b)))
    return Lattice(edges, (one, two, three), _triple(particles.origin), periodic)


def columns_of(positions: "NDArray[Any]") -> list[Floats]:
    """Return the coordinates of points, (n, 3), as three columns of doubles."""
    import numpy as np

    return [np.ascontiguousarray(positions[:, axis], np.float64) for axis in range(3)]


def _completed(edges: Sequence[Vec]) -> tuple[Vec, Vec, Vec]:
    """Return edges with others, square to them, in place of those that have no length."""
    known = [edge for edge in edges if any(edge)]
    found = []
    for edge in edges:
        if any(edge):
            found.append(edge)
            continue
        if len(known) == 2:
            made = cross(known[0], known[1])
        else:
            start = known[0] if known else (0.0, 0.0, 1.0)
            least = min(range(3), key=lambda k: abs(start[k]))
            x, y, z = (float(k == least) for k in range(3))
            made = cross(start, (x, y, z))
        made = unit(Direction(*made)) if any(made) else (0.0, 0.0, 1.0)
        known.append(made)
        found.append(made)
    a, b, c = found
    return a, b, c


def _triple(row: Any) -> Vec:  # noqa: ANN401
    x, y, z = (float(value) for value in row)
    return x, y, z


def _divided(row: Vec, volume: float) -> Vec:
    return row[0] / volume, row[1] / volume, row[2] / volume
