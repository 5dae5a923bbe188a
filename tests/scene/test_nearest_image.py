"""Bonds that are known go to the nearest image of their second end, in any cell."""

from itertools import product

import numpy as np
import pytest
from ase.geometry import find_mic

import vtray
from vtray.base.errors import SceneError
from vtray.scene.particles.bonds import bonds_between
from vtray.scene.particles.particles import Particles

ALL = (True, True, True)
REACH = 12
"""Images that the plain search looks at, along each edge."""

KINDS = ["leaning", "any", "far"]


def cell_of(kind: str, random: np.random.Generator) -> np.ndarray:
    """Return edges of some lengths: leaning as LAMMPS lets them, in any way, or by many edges."""
    while True:
        cell = np.diag(random.uniform(1, 8, 3))
        if kind == "leaning":
            cell[1, 0], cell[2, 0] = random.uniform(-0.5, 0.5, 2) * cell[0, 0]
            cell[2, 1] = random.uniform(-0.5, 0.5) * cell[1, 1]
        if kind == "any":
            cell += random.normal(0, 3, (3, 3))
        if kind == "far":
            cell[1] += random.integers(-3, 4) * cell[0]
            cell[2] += random.integers(-3, 4) * cell[1]
        if abs(np.linalg.det(cell)) > 0.1 * np.prod(np.linalg.norm(cell, axis=1)):
            return cell


def lengths(particles: Particles, pairs: np.ndarray) -> np.ndarray:
    """Return how long bonds are, which move nothing along edges that do not repeat."""
    shifts = bonds_between(particles, pairs).shifts
    assert not shifts[:, ~np.array(particles.periodic)].any()
    positions, cell = np.asarray(particles.positions), np.asarray(particles.cell)
    ways = positions[pairs[:, 1]] - positions[pairs[:, 0]] + shifts @ cell
    return np.linalg.norm(ways, axis=1)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(8))
def test_is_that_of_ase(kind: str, seed: int) -> None:
    random = np.random.default_rng(seed)
    cell, positions = cell_of(kind, random), random.uniform(-20, 20, (12, 3))
    pairs = np.array([(a, b) for a in range(12) for b in range(a)])
    found = lengths(Particles(positions, cell=cell, periodic=ALL), pairs)
    _, expected = find_mic(positions[pairs[:, 1]] - positions[pairs[:, 0]], cell)
    np.testing.assert_allclose(found, expected, rtol=1e-9)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("periodic", [p for p in product((False, True), repeat=3) if any(p)])
def test_is_the_nearest_of_all(kind: str, periodic: tuple[bool, bool, bool]) -> None:
    random = np.random.default_rng(sum(2**k for k in range(3) if periodic[k]))
    cell, positions = cell_of(kind, random), random.uniform(0, 4, (8, 3))
    pairs = np.array([(a, b) for a in range(8) for b in range(a)])
    steps = [range(-REACH, REACH + 1) if repeats else (0,) for repeats in periodic]
    images = np.array(list(product(*steps))) @ cell
    ways = positions[pairs[:, 1]] - positions[pairs[:, 0]]
    expected = np.linalg.norm(ways[:, None] + images, axis=2).min(axis=1)
    found = lengths(Particles(positions, cell=cell, periodic=periodic), pairs)
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_molecules_are_made_whole_in_a_leaning_cell() -> None:
    # As it is written in a file of LAMMPS that leans by half an edge.
    particles = Particles(
        [(2, 0.2, 5), (0.5, 2.1, 5)], cell=[[4, 0, 0], [2, 4, 0], [0, 0, 10]], bonds=[(0, 1)]
    )
    scene = vtray.Scene()
    scene.add_particles(particles, radii=0.3, bonds="file", unwrap=True)
    balls = next(each for each in scene.objects if isinstance(each, vtray.Spheres))
    one, two = np.asarray(balls.center)
    assert np.linalg.norm(one - two) == pytest.approx(2.1587, abs=1e-4)


def test_of_two_that_are_as_near_rounding_chooses_none() -> None:
    particles = Particles([(0, 0, 0), (4, 0, 0), (4, 4, 4)], cell=8 * np.eye(3))
    assert not bonds_between(particles, [(0, 1), (0, 2)]).shifts.any()


def test_what_is_nowhere_near_the_cell() -> None:
    particles = Particles([(0, 0, 0), (1e300, 0, 0)], cell=np.eye(3))
    with pytest.raises(SceneError, match=r"positions\[1\]: is 1e\+300 edges away from the cell"):
        bonds_between(particles, [(0, 1)])
