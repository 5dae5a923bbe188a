"""Bonds between particles that are both shown: in one cell, in two, or on the boundary of all."""

from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.scene.particles.bonds import Bonds
from vtray.scene.particles.boundary import Images
from vtray.scene.particles.lattice import columns_of, lattice_of

if TYPE_CHECKING:
    from vtray.scene.particles.particles import Particles

Integers = NDArray[np.int64]
Times = tuple[int, int, int]
"""How many times a cell is shown along each of its edges."""


class Standing(NamedTuple):
    """Whole bonds where they stand.

    Attributes
    ----------
    bonds
        The bonds, m of them.
    cells
        By how many edges the first particle of each is moved, (m, 3); the second one is moved by
        as many and by its shift.
    copies
        In which copies of the cell the two are, or what they repeat, (m, 2).
    """

    bonds: Bonds
    cells: Integers
    copies: Integers

    def ends(
        self, particles: "Particles", positions: NDArray[Any]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return where the two particles of each are, both (m, 3), by where all are drawn."""
        lattice = lattice_of(particles)
        assert lattice is not None  # noqa: S101 - what is shown again repeats
        ends = zip(self.bonds.pairs.T, (self.cells, self.cells + self.bonds.shifts), strict=True)
        near, far = (
            np.stack(lattice.moved(columns_of(positions[rows]), list(cells.T)), axis=1)
            for rows, cells in ends
        )
        return near, far


def within_cell(bonds: Bonds) -> Bonds:
    """Return the bonds that do not cross the border of the cell."""
    return bonds.some((bonds.shifts == 0).all(axis=1))


def crossing(bonds: Bonds) -> Bonds:
    """Return the bonds that cross the border of the cell."""
    return bonds.some((bonds.shifts != 0).any(axis=1))


def between_cells(bonds: Bonds, times: Times) -> list[tuple[Bonds, Integers]]:
    """Return the bonds that join cells of a block, and which cells: those that join alike together.

    Returns
    -------
    list
        Bonds, and the cells that their first particles are in, (k, 3), for each step between cells.
    """
    across = crossing(bonds)
    steps, which = np.unique(across.shifts, axis=0, return_inverse=True)
    found = []
    for number, step in enumerate(steps.tolist()):
        ranges = (range(max(0, -s), min(n, n - s)) for s, n in zip(step, times, strict=True))
        cells = np.array(list(product(*ranges)), np.int64).reshape(-1, 3)
        if len(cells):
            found.append((across.some(which.ravel() == number), cells))
    return found


def standing(bonds: Bonds, cells: Integers, times: Times) -> Standing:
    """Return bonds in cells that are given for each, (m, 3)."""
    copies = [copies_of(cells, times), copies_of(cells + bonds.shifts, times)]
    return Standing(bonds, cells, np.stack(copies, axis=1))


def beyond_cells(bonds: Bonds, images: Images, times: Times, *, between: bool) -> Standing:
    """Return the bonds to particles that are shown again, and, if asked for, between cells."""
    found = [_to_images(bonds, images, times)]
    if between:
        for some, cells in between_cells(bonds, times):
            rows = np.tile(np.arange(len(some)), len(cells))
            found.append((some.some(rows), np.repeat(cells, len(some), axis=0)))
    pairs, shifts, cells = (
        np.concatenate(parts)
        for parts in zip(*((b.pairs, b.shifts, cells) for b, cells in found), strict=True)
    )
    return standing(Bonds(pairs, shifts), cells, times)


def copies_of(cells: Integers, times: Times) -> Integers:
    """Return which copy of a cell is at, or repeated at, steps of whole edges, (n, 3)."""
    found: Integers = np.ravel_multi_index((cells % times).T, times)
    return found


def _to_images(bonds: Bonds, images: Images, times: Times) -> tuple[Bonds, Integers]:
    """Return the bonds of particles that are shown again, and the cells of their first particles.

    Each of them leads to what is shown: in a cell of the block, or shown again as well.
    """
    bonds = bonds.some(np.isin(bonds.pairs, images.particles).any(axis=1))
    # From each image along all bonds of its particle, forward and backward.
    begin, end = bonds.pairs.T
    owner, other = np.concatenate([begin, end]), np.concatenate([end, begin])
    steps = np.concatenate([bonds.shifts, -bonds.shifts])
    order = np.argsort(owner, kind="stable")
    first, last = (
        np.searchsorted(owner[order], images.particles, side=side) for side in ("left", "right")
    )
    count = last - first
    image = np.repeat(np.arange(len(count)), count)
    rows = order[np.arange(len(image)) + np.repeat(last - np.cumsum(count), count)]
    near = images.shifts[image]
    far = near + steps[rows]
    in_block = ((far >= 0) & (far < times)).all(axis=1)
    # Those between two images are found from both, and kept once.
    forward = rows < len(bonds)
    kept = in_block | (forward & _are_images(other[rows], far, images, times))
    cells = np.where(forward[:, None], near, far)[kept]
    return bonds.some(rows[kept] % max(len(bonds), 1)), cells


def _are_images(
    particles: Integers, shifts: Integers, images: Images, times: Times
) -> NDArray[np.bool_]:
    """Tell which particles at which steps are shown again, (n,)."""
    sizes = np.array(times) + 2  # one cell before the block, and one after it
    near = ((shifts >= -1) & (shifts <= times)).all(axis=1)

    def numbers(which: Integers, at: Integers) -> Integers:
        i, j, k = (at + 1).T
        found: Integers = ((which * sizes[0] + i) * sizes[1] + j) * sizes[2] + k
        return found

    known = numbers(images.particles, images.shifts)
    found: NDArray[np.bool_] = near & np.isin(numbers(particles, shifts), known)
    return found
