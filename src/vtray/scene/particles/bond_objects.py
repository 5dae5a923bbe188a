"""Bonds and hydrogen bonds of particles as objects."""

from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from vtray.scene.cylinders import Cylinders
from vtray.scene.particles.bonds import Bonds
from vtray.scene.particles.boundary import Images
from vtray.scene.particles.hydrogen_bonds import dashes, whole_dashes
from vtray.scene.particles.shown_bonds import (
    Standing,
    Times,
    between_cells,
    beyond_cells,
    copies_of,
    standing,
)
from vtray.scene.particles.sticks import sticks, whole_sticks

if TYPE_CHECKING:
    from vtray.scene.particles.particles import Particles

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Pair: TypeAlias = "tuple[Cylinders | None, Cylinders | None]"
"""Bonds and hydrogen bonds."""


class Between(NamedTuple):
    """What joins two cells of a block alike at many places.

    Attributes
    ----------
    part
        The bonds, with their first particles in the first cell.
    copies
        Which copies of the cell are joined, (k, 2).
    """

    part: Cylinders
    copies: Integers


class BondObjects(NamedTuple):
    """Makes objects of bonds and hydrogen bonds, each None if they are not drawn.

    Attributes
    ----------
    particles
        All particles.
    positions
        Where they are drawn, (n, 3).
    rows
        Which of them are drawn, (k,).
    thick
        The radius of bonds.
    radius, colors
        Those of the balls that are drawn, (k,) and (k, 3), or one for all.
    """

    particles: "Particles"
    positions: NDArray[Any]
    rows: Integers
    thick: float
    radius: Floats | float
    colors: NDArray[np.uint8]

    def of_cell(self, bonds: Bonds | None, hydrogen_bonds: Bonds | None) -> Pair:
        """Return those of one cell; halves, where they cross its border."""
        return (
            None if bonds is None else self._sticks(bonds),
            None if hydrogen_bonds is None else self._dashes(hydrogen_bonds),
        )

    def beyond(
        self,
        bonds: Bonds | None,
        hydrogen_bonds: Bonds | None,
        images: Images,
        times: Times,
        *,
        between: bool,
    ) -> Pair:
        """Return those to particles that are shown again, and, if asked for, between cells."""
        stand, dashed = (
            None if some is None else beyond_cells(some, images, times, between=between)
            for some in (bonds, hydrogen_bonds)
        )
        return (
            None if stand is None else self._whole(stand),
            None if dashed is None else self._whole_dashes(dashed),
        )

    def between(
        self, bonds: Bonds | None, hydrogen_bonds: Bonds | None, times: Times
    ) -> list[Between]:
        """Return those between cells, each kind of step once for all cells."""
        found = []
        for some, make in ((bonds, self._whole), (hydrogen_bonds, self._whole_dashes)):
            for alike, cells in [] if some is None else between_cells(some, times):
                part = make(standing(alike, np.zeros((len(alike), 3), np.int64), times))
                ends = copies_of(cells, times), copies_of(cells + alike.shifts[0], times)
                found.append(Between(part, np.stack(ends, axis=1)))
        return found

    def _sticks(self, bonds: Bonds) -> Cylinders:
        look = self.radius, self.colors
        return sticks(self.particles, self.positions, self.rows, bonds, self.thick, *look)

    def _dashes(self, bonds: Bonds) -> Cylinders:
        return dashes(self.particles, self.positions, bonds, self.thick)

    def _whole(self, bonds: Standing) -> Cylinders:
        look = self.radius, self.colors
        return whole_sticks(self.particles, self.positions, self.rows, bonds, self.thick, *look)

    def _whole_dashes(self, bonds: Standing) -> Cylinders:
        return whole_dashes(self.particles, self.positions, bonds, self.thick)
