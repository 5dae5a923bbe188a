"""The nearest image: by how many edges of the cell the end of a bond is moved to its start."""

from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.scene.particles.lattice import Lattice
from vtray.scene.placing.directions import Vec, dot

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

SLACK = 1e-9
"""What is nearer by less than this part is as near but for rounding."""

Step = tuple[Integers, Vec]
"""How many of each edge of a cell, (3,), and where they lead."""


def nearest_shifts(lattice: Lattice, points: Sequence[Floats], pairs: Integers) -> Integers:
    """Return by how many edges the second of two points is moved to stand nearest to the first.

    Rounded fractions of the edges tell it in most cells. They do not where a cell leans and is
    small, so what is farther away than half the shortest way between two images is moved along all
    short ways until none leads nearer.

    Parameters
    ----------
    lattice
        What repeats.
    points
        The coordinates of n points, three of shape (n,).
    pairs
        Which points, (m, 2).

    Returns
    -------
    shifts
        (m, 3), 0 along edges that do not repeat.

    Raises
    ------
    SceneError
        A point is too many edges away from the cell.

    References
    ----------
    P. Q. Nguyen and D. Stehlé, "Low-dimensional lattice basis reduction revisited", ACM
    Transactions on Algorithms 5, 2009: which ways are short ones.
    """
    one, two = pairs.T
    moves = lattice.outside(points)
    shifts: Integers = moves[one] - moves[two]
    for k, fraction in enumerate(lattice.fractions(points)):
        if lattice.periodic[k]:
            inside = fraction - moves[:, k]
            shifts[:, k] -= np.rint(inside[two] - inside[one]).astype(np.int64)
    steps = _short_steps(lattice)
    apart = [column[two] - column[one] for column in points]
    apart = lattice.moved(apart, [shifts[:, k] for k in range(3)])
    shortest = min(dot(way, way) for _, way in steps)
    far = np.flatnonzero(4.0 * _along(apart, apart) > (1.0 - SLACK) * shortest)
    apart = [column[far] for column in apart]
    is_moved = len(far) > 0
    while is_moved:
        is_moved = False
        for edges, way in steps:
            count = -np.rint((1.0 - SLACK) * _along(apart, way) / dot(way, way))
            if count.any():
                is_moved = True
                apart = [column + count * part for column, part in zip(apart, way, strict=True)]
                shifts[far] += count.astype(np.int64)[:, None] * edges
    return shifts


def _along(columns: Sequence[Floats], way: Sequence[Any]) -> Floats:
    """Return the products of vectors, as three columns, with one or with others."""
    found: Floats = columns[0] * way[0] + columns[1] * way[1] + columns[2] * way[2]
    return found


def _short_steps(lattice: Lattice) -> list[Step]:
    """Return the ways between images of which one leads nearer to wherever is not nearest.

    These are the sums and differences of the shortest edges that make the same lattice.
    """
    unit = np.eye(3, dtype=np.int64)
    edges = [_step(lattice, unit[k]) for k in range(3) if lattice.periodic[k]]
    is_shorter = True
    while is_shorter:
        is_shorter = False
        for k in range(len(edges)):
            for steps, way in _sums(lattice, edges[:k] + edges[k + 1 :]):
                own, edge = edges[k]
                count = -round((1.0 - SLACK) * dot(edge, way) / dot(way, way))
                if count:
                    is_shorter = True
                    edges[k] = _step(lattice, own + count * steps)
    return _sums(lattice, edges)


def _sums(lattice: Lattice, edges: Sequence[Step]) -> list[Step]:
    """Return all sums and differences of edges, of two that are opposite one."""
    found = []
    for signs in product((-1, 0, 1), repeat=len(edges)):
        if signs > (0,) * len(edges):
            steps = np.zeros(3, np.int64)
            for sign, (each, _) in zip(signs, edges, strict=True):
                steps = steps + sign * each
            found.append(_step(lattice, steps))
    return found


def _step(lattice: Lattice, steps: Integers) -> Step:
    """Return a way between images, given how many of each edge it has."""
    x, y, z = lattice.moved([np.zeros(1)] * 3, steps.tolist())
    return steps, (float(x[0]), float(y[0]), float(z[0]))
