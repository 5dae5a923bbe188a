"""Bonds by distance, beside the neighbour list of ASE."""

from typing import Any

import numpy as np
import pytest
from ase import Atoms
from ase.neighborlist import neighbor_list

from conftest import once
from vtray.base.errors import SceneError
from vtray.scene.particles import bonds as module
from vtray.scene.particles import elements
from vtray.scene.particles.bonds import Bonds, bonds_between, find_bonds
from vtray.scene.particles.particles import Particles

CUBE = np.eye(3) * 8.0
SKEW = [[8.0, 0, 0], [5.5, 7, 0], [-4, 5, 6]]
LEANING = [[10.0, 0, 0], [70, 9, 0], [-5, 60, 8]]
THIN = [[1.0, 0.3, 0], [0.2, 1.1, 0], [0.5, 0.3, 0.8]]
ALL, NONE = (True, True, True), (False, False, False)


def both_ways(pairs: Any, shifts: Any) -> set[tuple[int, ...]]:
    """Return bonds as they are seen from both of their ends."""
    one = {(a, b, *s) for (a, b), s in zip(pairs.tolist(), shifts.tolist(), strict=True)}
    assert len(one) == len(pairs)
    both = one | {(b, a, *(-k for k in s)) for a, b, *s in one}
    assert len(both) == 2 * len(one)
    return both


@once
@pytest.mark.parametrize(
    ("cell", "periodic", "count", "cutoff", "spread"),
    [
        (CUBE, ALL, 100, 2.0, 1.0),
        (CUBE, ALL, 100, 2.0, 3.0),  # far outside of the cell
        (CUBE, (False, True, False), 60, 2.0, 1.0),
        (SKEW, ALL, 120, 2.0, 1.0),
        (SKEW, (True, False, True), 120, 2.0, 1.0),
        (LEANING, ALL, 60, 2.0, 1.0),
        (THIN, ALL, 3, 2.5, 1.0),  # thinner than a bond
        (THIN, NONE, 3, 2.5, 1.0),
        ([[8, 0, 0], [0, 8, 0], [0, 0, 0]], (True, True, False), 60, 2.0, 1.0),
    ],
)
def test_bonds_are_those_of_ase(
    cell: Any, periodic: tuple[bool, bool, bool], count: int, cutoff: float, spread: float
) -> None:
    generator = np.random.default_rng(count)
    whole = np.array(cell, float) + np.diag(8.0 * ~np.any(cell, axis=1))
    positions = generator.uniform(-spread, spread, (count, 3)) @ whole
    found = find_bonds(Particles(positions, cell=cell, periodic=periodic), cutoff=cutoff)
    atoms = Atoms(["X"] * count, positions=positions, cell=cell, pbc=periodic)
    one, two, shift = neighbor_list("ijS", atoms, cutoff)
    theirs = {
        (a, b, *s) for a, b, s in zip(one.tolist(), two.tolist(), shift.tolist(), strict=True)
    }
    assert both_ways(*found) == theirs


def test_bonds_reach_as_far_as_radii_say(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "CANDIDATES", 7)  # a few at a time
    generator = np.random.default_rng(3)
    positions, radii = generator.uniform(0, 5, (80, 3)), generator.uniform(0.1, 0.6, 80)
    found = find_bonds(Particles(positions), 1.5, radii)
    apart = np.sqrt(((positions[:, None] - positions) ** 2).sum(axis=2))
    expected = np.argwhere(np.triu(apart <= 1.5 * (radii[:, None] + radii), 1))
    assert {*map(tuple, found.pairs.tolist())} == {*map(tuple, expected.tolist())}
    assert not found.shifts.any()


def test_hydrogen_is_bound_in_water_and_to_itself_alone_in_a_molecule_of_it() -> None:
    places = [(0, 0, 0), (0.76, 0.59, 0), (-0.76, 0.59, 0), (5, 0, 0), (5.735, 0, 0)]
    water = Particles(places, {"element": np.array(list("OHHHH"))})
    assert sorted(find_bonds(water).pairs.tolist()) == [[0, 1], [0, 2], [3, 4]]


def test_ions_of_metals_are_bound_to_anions_alone() -> None:
    u, a, c = 0.305, 4.594, 2.959
    places = [(0, 0, 0), (0.5, 0.5, 0.5), (u, u, 0), (-u, -u, 0)]
    places += [(0.5 + u, 0.5 - u, 0.5), (0.5 - u, 0.5 + u, 0.5)]
    element = np.array(["Ti", "Ti", "O", "O", "O", "O"])
    cell = np.diag([a, a, c])
    rutile = Particles(places @ cell, {"element": element}, cell=cell)
    ends = [sorted(pair) for pair in element[find_bonds(rutile).pairs].tolist()]
    assert ends == [["O", "Ti"]] * 12
    near = len(find_bonds(rutile, radii=elements.radii_of(element)))
    assert near > 12, "by distance alone, there are bonds between metals"


def test_metals_are_bound_where_they_are_no_ions() -> None:
    places = [(0, 0, 0), (2.7, 0, 0), (5.4, 0, 0), (-2.2, 0, 0)]
    gold = Particles(places, {"element": np.array(["Au", "Au", "Au", "S"])})
    assert sorted(find_bonds(gold).pairs.tolist()) == [[0, 1], [0, 3], [1, 2]]


def test_what_is_no_element_is_bound_by_a_length_alone() -> None:
    places = [(0, 0, 0), (0.76, 0.59, 0), (-0.76, 0.59, 0), (0, 0.15, 0)]
    water = Particles(places, {"element": np.array([*"OHHX"])})
    assert pairs_of(find_bonds(water)) == {(0, 1), (0, 2)}
    assert len(find_bonds(water, cutoff=1.0)) == 5


def test_few_and_equal_places() -> None:
    assert len(find_bonds(Particles(np.zeros((0, 3))), cutoff=1)) == 0
    assert len(find_bonds(Particles(np.zeros((3, 3))), cutoff=1)) == 0
    assert len(find_bonds(Particles([(0, 0, 0), (1e9, 0, 0), (1e9, 1, 0)]), cutoff=1)) == 1


def test_known_bonds_go_to_the_nearest_image() -> None:
    particles = Particles([(0.5, 4, 4), (7.5, 4, 4)], cell=CUBE)
    found = bonds_between(particles, [(0, 1)])
    assert found.shifts.tolist() == [[-1, 0, 0]]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "find_bonds: radii: covalent radii are those of elements, and there is no column"),
        ({"radii": "radus"}, "got \"?'?radus"),
        ({"cutoff": 0}, "find_bonds: cutoff: expected a number > 0, got 0"),
        ({"factor": "2", "radii": 1.0}, "find_bonds: factor: expected a number > 0, got '2'"),
        ({"radii": [1.0]}, "expected one number, or 300, one for each particle"),
        ({"radii": -1.0}, "find_bonds: radii: expected a number ≥ 0, got -1.0"),
        ({"cutoff": 1e3}, "more than 64 bonds for each particle"),
    ],
)
def test_wrong_arguments(options: dict[str, Any], message: str) -> None:
    particles = Particles(np.random.default_rng(0).uniform(0, 8, (300, 3)), cell=CUBE)
    with pytest.raises(SceneError, match=message):
        find_bonds(particles, **options)


@pytest.mark.parametrize("length", [1e-101, 1e101])
def test_edges_too_long_or_short(length: float) -> None:
    words = "Particles.cell: its edges must be from 1e-100 to 1e\\+100 long, got "
    with pytest.raises(SceneError, match=words):
        find_bonds(Particles([(0, 0, 0)], cell=np.eye(3) * length), cutoff=1)


def test_edges_in_one_plane() -> None:
    with pytest.raises(SceneError, match="its edges must not lie in one plane"):
        find_bonds(Particles([(0, 0, 0)], cell=[[1, 0, 0], [1, 1, 0], [2, 1, 0]]), cutoff=1)


@once
@pytest.mark.parametrize("axes", [[0], [1], [2], [0, 1, 2]])
@pytest.mark.parametrize("far", [1e7, -1e12, 1e300])
def test_particles_that_are_lost_cost_nothing(far: float, axes: list[int]) -> None:
    places = np.random.default_rng(3).uniform(0, 45, (9000, 3))
    known = pairs_of(find_bonds(Particles(places), cutoff=1.5))
    lost = np.full((3, 3), 20.0)
    lost[:, axes] = [[far], [far], [-2 * far]]
    lost[1, 1] += 1.0
    every = np.concatenate([places, lost])
    expected = known if far == 1e300 and 1 in axes else known | {(9000, 9001)}
    assert pairs_of(find_bonds(Particles(every), cutoff=1.5)) == expected
    # Boxes as large as the way to them would hold all others.
    assert module._Grid.build(every.T, 1.5).sides == [0.5, 1.5, 1.5]


def test_particles_too_far_from_a_cell_are_told() -> None:
    places = [(1, 1, 1), (1, 1e300, 1)]
    with pytest.raises(SceneError, match=r"^Particles.positions\[1\]: is 1.25e\+299 edges away"):
        find_bonds(Particles(places, cell=CUBE, periodic=ALL), cutoff=1.5)


def pairs_of(bonds: Bonds) -> set[tuple[int, ...]]:
    return set(map(tuple, bonds.pairs.tolist()))
