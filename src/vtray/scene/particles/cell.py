"""The cell of particles: its edges, particles brought into it, molecules made whole, images."""

from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.base.exact_math import hypotenuse
from vtray.base.memory import lack_of_memory
from vtray.scene.checks.scene_words import show
from vtray.scene.particles.bonds import Bonds
from vtray.scene.particles.boundary import TOLERANCE
from vtray.scene.particles.column_names import IMAGE, IMAGES
from vtray.scene.particles.lattice import columns_of, lattice_from, lattice_of

if TYPE_CHECKING:
    from vtray.scene.particles.particles import Particles

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

THIN = 0.0035
"""Radius of a cell's edges, in parts of the longest one that is drawn."""

HELD = 0.25
"""The share of all particles that a cell holds at least which tells where they are."""

ROUNDED = 2.0**-40
"""What is before a face of the cell by less than this part of an edge is on it but for rounding."""

_BYTES = 100
"""Of memory for each copy of a cell while they are placed."""

_CORNERS = tuple(product((0.0, 1.0), repeat=3))
_EDGES = tuple(
    (one, two)
    for one in range(8)
    for two in range(one + 1, 8)
    if [a != b for a, b in zip(_CORNERS[one], _CORNERS[two], strict=True)].count(True) == 1
)


def wrapped(particles: "Particles") -> tuple[Floats, Integers]:
    """Return particles brought into the cell, and by how many edges each was moved back.

    Returns
    -------
    positions, moves
        Both (n, 3). Along edges that do not repeat, nothing moves.

    Raises
    ------
    SceneError
        Nothing repeats.
    """
    lattice = lattice_of(particles)
    if lattice is None:
        raise SceneError("wrap: there is no cell that repeats")
    columns = columns_of(particles.positions)
    moves = lattice.outside(columns, ROUNDED)
    moved = lattice.moved(columns, [-moves[:, k] for k in range(3)])
    return np.stack(moved, axis=1), moves


def unwrapped(particles: "Particles", bonds: Bonds | None) -> tuple[Floats, Integers]:
    """Return particles where their molecules are whole, and by how many edges each moved back.

    Columns that count the cells a particle has come through, ``ix``, ``iy`` and ``iz``, or
    ``image``, are used where they are there: then each stands where it would be if it had never
    been wrapped. Without them, bonds are followed from the particle with the least index of each
    molecule. In what is bound without end, such as a crystal, some bonds go on crossing the border.

    Raises
    ------
    SceneError
        Nothing repeats, or there are neither such columns nor bonds.
    """
    lattice = lattice_of(particles)
    if lattice is None:
        raise SceneError("unwrap: there is no cell that repeats")
    images = _images_of(particles)
    if images is not None:
        moves = -images
    elif bonds is not None and len(bonds):
        moves = -_ahead(bonds, len(particles))
    else:
        raise SceneError("unwrap: needs bonds, or the columns ix, iy and iz, or image")
    columns = lattice.moved(columns_of(particles.positions), [-moves[:, k] for k in range(3)])
    return np.stack(columns, axis=1), moves


def _images_of(particles: "Particles") -> Integers | None:
    """Return how many cells each particle has come through, (n, 3), None if that is not known."""
    columns = particles.columns
    if all(name in columns for name in IMAGES):
        return np.stack([columns[name] for name in IMAGES], axis=1).astype(np.int64)
    whole = columns.get(IMAGE)
    if whole is not None and whole.dtype.kind in "iu" and whole.shape == (len(particles), 3):
        return whole.astype(np.int64)
    return None


def molecules(bonds: Bonds, count: int) -> Integers:
    """Return for each of `count` particles the least index in its molecule, (count,)."""
    least = np.arange(count)
    one, two = bonds.pairs.T
    while True:
        before = least.copy()
        both = np.minimum(least[one], least[two])
        np.minimum.at(least, least[one], both)
        np.minimum.at(least, least[two], both)
        least = least[least]
        if (least == before).all():
            return least


def _ahead(bonds: Bonds, count: int) -> Integers:
    """Return by how many edges each particle is to be moved so that its molecule is whole."""
    pairs = np.concatenate([bonds.pairs, bonds.pairs[:, ::-1]])
    steps = np.concatenate([bonds.shifts, -bonds.shifts])
    order = np.argsort(pairs[:, 0], kind="stable")
    start, end, steps = pairs[order, 0], pairs[order, 1], steps[order]
    first = np.searchsorted(start, np.arange(count + 1))
    ahead = np.zeros((count, 3), np.int64)
    known = molecules(bonds, count) == np.arange(count)
    front = np.flatnonzero(known)
    # From all molecules at once, one bond farther each time.
    while len(front):
        lengths = first[front + 1] - first[front]
        ends = lengths.cumsum()
        rows: Integers = np.arange(int(ends[-1]))
        rows = rows + np.repeat(first[front] - (ends - lengths), lengths)
        rows = rows[~known[end[rows]]]
        front, chosen = np.unique(end[rows], return_index=True)
        rows = rows[chosen]
        ahead[front] = ahead[start[rows]] + steps[rows]
        known[front] = True
    return ahead


def holds_particles(particles: "Particles", positions: NDArray[Any]) -> bool:
    """Tell whether enough particles are within their cell, or on its faces, if there are any.

    Where the cell has no edge, all are within.

    Parameters
    ----------
    particles
        The particles, which have a cell.
    positions
        Where they are drawn, (n, 3).
    """
    assert particles.cell is not None  # noqa: S101
    inside = np.ones(len(positions), np.bool_)
    fractions = lattice_from(particles).fractions(columns_of(positions))
    for edge, along in zip(particles.cell, fractions, strict=True):
        if edge.any():
            inside &= (along >= -TOLERANCE) & (along <= 1.0 + TOLERANCE)
    return bool(np.count_nonzero(inside) >= HELD * len(positions))


def cell_edges(
    particles: "Particles", times: tuple[int, int, int] = (1, 1, 1)
) -> tuple[Floats, Floats, Floats, float]:
    """Return the edges of a cell, or of a block of cells.

    Returns
    -------
    corners, starts, ends, longest
        The 8 corners, (8, 3); where the 12 edges begin and end, (12, 3); and the longest edge.

    Raises
    ------
    SceneError
        There is no cell, or its edges lie in one plane.
    """
    if particles.cell is None:
        raise SceneError("cell: there is none")
    lattice = lattice_from(particles)
    edges = [
        tuple(part * count for part in edge)
        for edge, count in zip(particles.cell.tolist(), times, strict=True)
    ]
    steps = [np.array(column) for column in zip(*_CORNERS, strict=True)]
    corners = np.stack(
        [
            lattice.origin[axis]
            + (steps[0] * edges[0][axis] + steps[1] * edges[1][axis] + steps[2] * edges[2][axis])
            for axis in range(3)
        ],
        axis=1,
    )
    one, two = np.array(_EDGES).T
    return corners, corners[one], corners[two], max(hypotenuse(*edge) for edge in edges)


def times_of(replicate: Any) -> tuple[int, int, int]:  # noqa: ANN401
    """Return how many times a cell stands along each of its edges.

    Raises
    ------
    SceneError
        It is not three integers of at least 1.
    """
    words = "expected three integers ≥ 1, such as (3, 3, 1)"
    try:
        a, b, c = given = [int(count) for count in replicate]
        right = given == list(replicate) and min(given) >= 1
    except (TypeError, ValueError):
        right = False
    if not right:
        raise SceneError(f"replicate: {words}, got {show(replicate)}")
    return a, b, c


def translations(particles: "Particles", times: tuple[int, int, int]) -> Floats:
    """Return where the copies of a cell stand, relative to it, (m, 3); itself is the first.

    Raises
    ------
    SceneError
        There is no cell, it does not repeat along an edge, or there is no memory for so many.
    """
    lattice = lattice_of(particles)
    if lattice is None and max(times) > 1:
        raise SceneError("replicate: there is no cell that repeats")
    for k, count in enumerate(times):
        if count > 1 and lattice is not None and not lattice.periodic[k]:
            raise SceneError(f"replicate[{k}]: the cell does not repeat along this edge")
    if lattice is None:
        return np.zeros((1, 3))
    count = times[0] * times[1] * times[2]
    lack = lack_of_memory(_BYTES * count)
    if lack:
        raise SceneError(f"replicate: {count} cells need about {lack}")
    steps = list(np.indices(times).reshape(3, -1))
    zeros = [np.zeros(len(steps[0]))] * 3
    return np.stack(lattice.moved(zeros, steps), axis=1)
