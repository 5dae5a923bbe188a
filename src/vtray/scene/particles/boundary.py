"""Particles on the boundary of the cell, which are shown on its far faces, too."""

from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.base.number import number_of
from vtray.scene.checks.scene_words import show
from vtray.scene.particles.lattice import columns_of, lattice_of

if TYPE_CHECKING:
    from vtray.scene.particles.particles import Particles

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

TOLERANCE = 0.001
"""How far from a face particles are that lie on it, in parts of the cell's edge: files round their
places to three digits or more."""

MOST = 0.5
"""How far that may be: half a cell on each side."""


class Images(NamedTuple):
    """Particles that are shown again.

    Attributes
    ----------
    particles
        Which ones, (n,).
    shifts
        By how many edges of the cell each is moved, (n, 3).
    steps
        The same in the unit of the positions.
    copies
        Where the cell is shown several times, in which of its copies the repeated one is, (n,).
    """

    particles: Integers
    shifts: Integers
    steps: Floats
    copies: Integers


def tolerance_of(given: Any) -> float | None:  # noqa: ANN401
    """Return how far from a face particles are that are repeated; None if none are.

    Raises
    ------
    SceneError
        It is neither True, False nor a part of the cell's edge.
    """
    if given is None or given is False:
        return None
    if given is True:
        return TOLERANCE
    number = number_of(given)
    if not 0.0 < number <= MOST:
        words = f"a part of the cell's edge above 0, and at most {MOST:g}"
        raise SceneError(f"boundary: expected True, False, or {words}, got {show(given)}")
    return number


def images_on_boundary(
    particles: "Particles",
    positions: NDArray[Any],
    rows: Integers,
    times: tuple[int, int, int],
    tolerance: float,
) -> Images:
    """Return the images of particles that lie on the boundary of a block of cells.

    They are within the tolerance of the block, and of particles that are within it of the cell. Of
    what is on one face there is one image, on an edge three, at a corner seven.

    Parameters
    ----------
    particles
        All particles.
    positions
        Where they are drawn, (n, 3).
    rows
        Which of them are drawn, (k,).
    times
        How many times the cell is shown along each of its edges.
    tolerance
        How far from a face counts as on it, in parts of the edge.

    Raises
    ------
    SceneError
        Nothing repeats.
    """
    lattice = lattice_of(particles)
    if lattice is None:
        raise SceneError("boundary: there is no cell that repeats")
    fractions = lattice.fractions(columns_of(positions[rows]))
    # Along each edge: which have an image in each cell, one before the block, and one after it.
    along: list[list[tuple[range, NDArray[np.bool_]]]] = []
    for fraction, count, repeats in zip(fractions, times, lattice.periodic, strict=True):
        inside = np.ones(len(rows), np.bool_)
        if repeats:
            inside = (fraction >= -tolerance) & (fraction <= 1.0 + tolerance)
        found = [(range(count), inside)]
        if repeats:
            found.append((range(-1, 0), inside & (fraction >= 1.0 - tolerance)))
            found.append((range(count, count + 1), inside & (fraction <= tolerance)))
        along.append(found)
    indices, shifts = [np.zeros(0, np.int64)], [np.zeros((0, 3), np.int64)]
    _in_the_block, *beside = product(*along)
    for (a, on_a), (b, on_b), (c, on_c) in beside:
        which = rows[on_a & on_b & on_c]
        cells = np.array(list(product(a, b, c)), np.int64)
        indices.append(np.repeat(which, len(cells)))
        shifts.append(np.tile(cells, (len(which), 1)))
    shift = np.concatenate(shifts)
    zeros = [np.zeros(len(shift))] * 3
    steps = np.stack(lattice.moved(zeros, list(shift.T)), axis=1)
    copies = np.ravel_multi_index((shift % times).T, times)
    return Images(np.concatenate(indices), shift, steps, copies)
