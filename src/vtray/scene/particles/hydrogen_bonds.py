"""Hydrogen bonds: which hydrogens of N, O and F point at another N, O or F, and their dashes."""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.base.exact_math import cosine
from vtray.scene.checks.scene_words import show
from vtray.scene.cylinders import Cylinders
from vtray.scene.particles.bonds import Bonds, bonds_between, find_bonds
from vtray.scene.particles.lattice import columns_of, lattice_of
from vtray.scene.particles.made_of import MadeOf, remember
from vtray.scene.particles.shown_bonds import Standing

if TYPE_CHECKING:
    from vtray.scene.particles.particles import Particles

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

LENGTH = 2.5
"""How far a hydrogen and its acceptor are apart at the most, in ångström."""

ANGLE = 120.0
"""The least angle at the hydrogen between its donor and the acceptor, in degrees."""

ELECTRONEGATIVE = ("N", "O", "F")
"""Elements that give and take hydrogen bonds."""

HYDROGEN = ("H", "D", "T")

DASHES = 3
"""Dashes of each half of a hydrogen bond, as far from each other as they are long."""

SLIM = 0.5
"""Radius of the dashes, in radii of bonds."""

COLOR = (120, 120, 120)


class Criterion(NamedTuple):
    """What counts as a hydrogen bond.

    Attributes
    ----------
    length
        How far hydrogen and acceptor are apart at the most, in the unit of the positions.
    angle
        The least angle donor-hydrogen-acceptor, in degrees, from 0 to 180.
    """

    length: float = LENGTH
    angle: float = ANGLE


def criterion_of(given: Any) -> Criterion | None:  # noqa: ANN401
    """Return the criterion that `Scene.add_particles` was given; None for no hydrogen bonds.

    Raises
    ------
    SceneError
        It is neither True, False nor two numbers.
    """
    if given is None or given is False:
        return None
    if given is True:
        return Criterion()
    try:
        length, angle = (float(value) for value in given)
    except (TypeError, ValueError):
        length = angle = -1.0
    if not (0.0 < length < np.inf and 0.0 <= angle <= 180.0):
        words = f"the longest H...A and the least angle in degrees, such as ({LENGTH}, {ANGLE:g})"
        raise SceneError(f"hydrogen_bonds: expected True, False, or {words}, got {show(given)}")
    return Criterion(length, angle)


def find_hydrogen_bonds(
    particles: "Particles",
    criterion: Criterion = Criterion(),  # noqa: B008
    *,
    by_distance: bool = False,
) -> Bonds:
    """Return the hydrogen bonds of atoms: D-H...A with D and A of nitrogen, oxygen and fluorine.

    By default, H and A are at most 2.5 Å apart, and the angle at H is at least 120 degrees. Donors
    are known by covalent bonds. In a cell that repeats, bonds cross its borders.

    Parameters
    ----------
    particles
        The particles, with the column ``element``.
    criterion
        How long, and how straight.
    by_distance
        Whether covalent bonds are those of `find_bonds`. By default they are those of the
        particles, and only without any those of `find_bonds`.

    Returns
    -------
    Bonds
        Hydrogen and acceptor of each, and by how many edges of the cell the acceptor is to be
        moved to stand beside the hydrogen.

    Raises
    ------
    SceneError
        The elements are not known.

    References
    ----------
    E. N. Baker and R. E. Hubbard, "Hydrogen bonding in globular proteins", Progress in Biophysics
    and Molecular Biology 44, 1984.
    """
    if "element" not in particles.columns:
        raise SceneError("hydrogen_bonds: are those of elements, and there is no column element")
    elements = particles["element"]
    hydrogen, taker = np.isin(elements, HYDROGEN), np.isin(elements, ELECTRONEGATIVE)
    donor_of = _toward(hydrogen, taker, _covalent(particles, by_distance))
    near = _toward(hydrogen, taker, _near(particles, hydrogen | taker, criterion.length))
    # Each pair with each of the donors that its hydrogen has.
    order = np.argsort(donor_of.pairs[:, 0], kind="stable")
    donor_of = donor_of.some(order)
    first = np.searchsorted(donor_of.pairs[:, 0], near.pairs[:, 0], side="left")
    count = np.searchsorted(donor_of.pairs[:, 0], near.pairs[:, 0], side="right") - first
    one = np.repeat(np.arange(len(near)), count)
    two = np.arange(len(one)) - np.repeat(np.cumsum(count) - count - first, count)
    far_enough = _are_straight(particles, near.some(one), donor_of.some(two), criterion.angle)
    return near.some(np.unique(one[far_enough]))


def _covalent(particles: "Particles", by_distance: bool) -> Bonds:
    """Return the covalent bonds of atoms."""
    if by_distance or particles.bonds is None or not len(particles.bonds):
        return find_bonds(particles)
    return bonds_between(particles, particles.bonds)


def _near(particles: "Particles", chosen: NDArray[np.bool_], length: float) -> Bonds:
    """Return the pairs among some of the particles that are no farther apart than a length."""
    rows = np.flatnonzero(chosen)
    found = find_bonds(particles.select(rows), cutoff=length)
    return Bonds(rows[found.pairs], found.shifts)


def _toward(one: NDArray[np.bool_], two: NDArray[np.bool_], bonds: Bonds) -> Bonds:
    """Return the bonds from particles of one kind to those of another, (n,) each, in that order."""
    begin, end = bonds.pairs.T
    ahead, back = one[begin] & two[end], one[end] & two[begin]
    return Bonds(
        np.concatenate([bonds.pairs[ahead], bonds.pairs[back, ::-1]]),
        np.concatenate([bonds.shifts[ahead], -bonds.shifts[back]]),
    )


def _are_straight(
    particles: "Particles", to_taker: Bonds, to_donor: Bonds, angle: float
) -> NDArray[np.bool_]:
    """Tell of hydrogens whether the angle between their two bonds is large enough, (n,)."""
    away, back = steps_of(particles, to_taker), steps_of(particles, to_donor)
    product, square, other = np.zeros(len(away[0])), np.zeros(len(away[0])), np.zeros(len(away[0]))
    for ahead, behind in zip(away, back, strict=True):
        product += ahead * behind
        square += ahead * ahead
        other += behind * behind
    # The acceptor is not the donor itself, whatever the angle.
    apart: NDArray[np.bool_] = to_taker.pairs[:, 1] != to_donor.pairs[:, 1]
    apart |= (to_taker.shifts != to_donor.shifts).any(axis=1)
    straight: NDArray[np.bool_] = product <= cosine(angle) * np.sqrt(square) * np.sqrt(other)
    return apart & straight


def steps_of(
    particles: "Particles", bonds: Bonds, positions: "NDArray[Any] | None" = None
) -> list[Floats]:
    """Return the way from the first to the second particle of each bond, three columns of (m,).

    Parameters
    ----------
    particles
        The particles.
    bonds
        The bonds.
    positions
        Where they are, (n, 3); by default where the particles say.
    """
    columns = columns_of(particles.positions if positions is None else positions)
    far = [column[bonds.pairs[:, 1]] for column in columns]
    lattice = lattice_of(particles)
    if lattice is not None:
        far = lattice.moved(far, list(bonds.shifts.T))
    return [end - column[bonds.pairs[:, 0]] for end, column in zip(far, columns, strict=True)]


def dashes(
    particles: "Particles", positions: NDArray[Any], bonds: Bonds, stick: float
) -> Cylinders:
    """Return hydrogen bonds as dashes; those that cross the border as halves at both of its sides.

    Parameters
    ----------
    particles
        The particles.
    positions
        Where they are drawn, (n, 3).
    bonds
        What is drawn.
    stick
        The radius of covalent bonds, in the unit of the positions.
    """
    ways = np.stack(steps_of(particles, bonds, positions), axis=1)
    near, far = (positions[rows] for rows in bonds.pairs.T)
    made, indices = _dashed(near, far, ways, bonds.pairs, stick)
    return remember(made, MadeOf(particles, indices, "hydrogen bond"))


def whole_dashes(
    particles: "Particles", positions: NDArray[Any], bonds: Standing, stick: float
) -> Cylinders:
    """Return hydrogen bonds as dashes, all of them whole, as `dashes` does."""
    near, far = bonds.ends(particles, positions)
    made, indices = _dashed(near, far, far - near, bonds.bonds.pairs, stick)
    copies = np.repeat(bonds.copies.T, DASHES, axis=0).ravel()
    return remember(made, MadeOf(particles, indices, "hydrogen bond", copies))


def _dashed(
    near: NDArray[Any], far: NDArray[Any], ways: Floats, pairs: Integers, stick: float
) -> tuple[Cylinders, Integers]:
    """Return dashes from both ends of bonds, and the particle that each belongs to, twice.

    Parameters
    ----------
    near, far
        Where the ends are, (m, 3).
    ways
        From the first particle to the second, (m, 3).
    pairs
        Which particles they are, (m, 2).
    stick
        The radius of covalent bonds.
    """
    starts, stops, indices = [], [], []
    for rows, points, way in zip(pairs.T, (near, far), (ways, -ways), strict=True):
        for k in range(DASHES):
            begin, end = ((k + share) / (2 * DASHES) for share in (0.25, 0.75))
            starts.append(points + begin * way)
            stops.append(points + end * way)
            indices.append(np.stack([rows, rows], axis=1))
    made = Cylinders(np.concatenate(starts), np.concatenate(stops), SLIM * stick, COLOR)
    return made, np.concatenate(indices)
