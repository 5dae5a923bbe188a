"""Cells: particles brought into them, molecules made whole, edges and copies."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vtray
from vtray.base.errors import SceneError
from vtray.scene.particles import drawing
from vtray.scene.particles.bonds import Bonds, find_bonds
from vtray.scene.particles.cell import cell_edges, molecules, translations, unwrapped, wrapped
from vtray.scene.particles.particles import Particles

SKEW = np.array([[8.0, 0, 0], [5.5, 7, 0], [-4, 5, 6]])


def chain(count: int = 9) -> Particles:
    """Return a chain that leaves a skew cell, with each particle brought into it."""
    whole = Particles((np.arange(count)[:, None] - 4) * [1.0, 0.8, 0.3], cell=SKEW)
    return Particles(wrapped(whole)[0], cell=SKEW)


def test_wrapped_particles_are_in_the_cell() -> None:
    generator = np.random.default_rng(1)
    particles = Particles(generator.uniform(-30, 30, (50, 3)), cell=SKEW, origin=(1, 2, 3))
    positions, moves = wrapped(particles)
    fractions = (positions - [1, 2, 3]) @ np.linalg.inv(SKEW)
    assert fractions.min() > -1e-9
    assert fractions.max() < 1 + 1e-9
    assert np.allclose(particles.positions - moves @ SKEW, positions)


@pytest.mark.parametrize("periodic", [None, (True, True, True), (True, True, False)])
def test_a_cell_without_height(periodic: Any) -> None:
    flat = Particles([(0.2, 1, 0), (3.8, 1, 0)], cell=np.diag([4.0, 4, 0]), periodic=periodic)
    assert flat.periodic == (True, True, False)
    drawn = vtray.Scene().add_particles(flat, radii=0.1, bonds=0.5, replicate=(2, 1, 1))
    assert len(drawn.spheres) == len(drawn.bonds) == 4
    assert drawn.bonds.start[:, 2].tolist() == [0] * 4
    with pytest.raises(SceneError, match=r"replicate\[2\]: the cell does not repeat along"):
        vtray.Scene().add_particles(flat, replicate=(1, 1, 2))


@pytest.mark.parametrize(
    ("origin", "message"),
    [
        ([0, 0], r"Particles.origin: must have shape \(3,\), got \(2,\)"),
        ([0, 0, np.nan], r"Particles.origin\[2\]: must be finite, got nan"),
    ],
)
def test_wrong_origins(origin: Any, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        Particles([(0, 0, 0)], cell=np.eye(3), origin=origin)


@pytest.mark.parametrize("given", [True, (True, True), "TTT", ("T", "T", "F")])
def test_along_which_edges_a_cell_repeats(given: Any) -> None:
    with pytest.raises(SceneError, match=r"Particles.periodic: expected three of True and False"):
        Particles([(0, 0, 0)], cell=np.eye(3), periodic=given)


def test_molecules_are_made_whole_by_their_bonds() -> None:
    particles = chain()
    bonds = find_bonds(particles, cutoff=1.4)
    assert len(bonds) == 8
    assert bonds.shifts.any()
    positions, moves = unwrapped(particles, bonds)
    steps = np.diff(positions, axis=0)
    assert np.allclose(steps, [1.0, 0.8, 0.3])
    assert not bonds.after(moves).shifts.any()


def test_molecules_are_made_whole_by_columns() -> None:
    columns = {"ix": np.array([0, 1]), "iy": np.array([0, -2]), "iz": np.array([0, 0])}
    particles = Particles([(1, 1, 1), (2, 2, 2)], columns, cell=np.eye(3) * 5)
    positions, moves = unwrapped(particles, None)
    assert positions.tolist() == [[1, 1, 1], [7, -8, 2]]
    assert moves.tolist() == [[0, 0, 0], [-1, 2, 0]]


def test_molecules_are_found() -> None:
    pairs = np.array([(5, 4), (4, 3), (3, 1), (0, 7)])
    bonds = Bonds(pairs, np.zeros((4, 3), np.int64))
    assert molecules(bonds, 8).tolist() == [0, 1, 2, 1, 1, 1, 6, 0]


def test_a_cell_without_any_edge_is_none(tmp_path: Path) -> None:
    nothing = Particles([(0, 0, 0)], cell=np.zeros((3, 3)), periodic=(True, True, True))
    assert nothing.cell is None
    assert nothing.periodic == (False, False, False)
    path = tmp_path / "atom.xyz"
    path.write_text('1\nLattice="0 0 0 0 0 0 0 0 0" pbc="T T T"\nO 0 0 0\n')
    assert vtray.read(path).cell is None


def test_edges_of_a_cell_and_of_a_block() -> None:
    particles = Particles([(0, 0, 0)], cell=SKEW, origin=(1, 1, 1))
    corners, starts, ends, longest = cell_edges(particles)
    assert np.allclose(corners[-1], SKEW.sum(axis=0) + 1)
    edges = sorted(map(tuple, (ends - starts).tolist()))
    assert edges == sorted(map(tuple, np.repeat(SKEW, 4, axis=0).tolist()))
    assert longest == np.sqrt((SKEW**2).sum(axis=1)).max()
    assert np.allclose(cell_edges(particles, (2, 1, 3))[0][-1], [2, 1, 3] @ SKEW + 1)


def test_places_of_copies() -> None:
    particles = Particles([(0, 0, 0)], cell=SKEW, periodic=(True, True, False))
    places = translations(particles, (2, 3, 1))
    assert places[0].tolist() == [0, 0, 0]
    expected = [i * SKEW[0] + j * SKEW[1] for i in range(2) for j in range(3)]
    assert np.allclose(places, expected)


def test_bonds_across_the_border_are_halves_that_meet_in_copies(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    particles = Particles([(0.5, 2, 2), (3.5, 2, 2)], cell=np.eye(3) * 4)
    scene = vtray.Scene()
    drawn = scene.add_particles(
        particles, "ball-and-stick", bonds=1.5, radii=0.3, color=["red", "blue"]
    )
    assert drawn.bonds is not None
    assert drawn.bonds.start.tolist() == [[0.5, 2, 2], [3.5, 2, 2]]
    assert drawn.bonds.end.tolist() == [[0, 2, 2], [4, 2, 2]]
    assert drawn.bonds.color.tolist() == [[255, 0, 0], [0, 0, 255]]
    assert len(scene.objects) == 4  # balls, bonds, edges and corners
    options: dict[str, Any] = {"bonds": 1.5, "radii": 0.3, "replicate": (2, 1, 1), "cell": False}
    drawn = scene.add_particles(particles, **options)
    assert drawn.copies is None
    assert drawn.spheres.center[:, 0].tolist() == [0.5, 3.5, 4.5, 7.5]
    assert drawn.bonds.end[:, 0].tolist() == [0, 4, 4, 8]
    del scene.objects[4:]
    monkeypatch.setattr(drawing, "WRITTEN_OUT", 7)
    drawn = scene.add_particles(particles, **options)
    assert drawn.copies is not None
    assert drawn.copies.at.tolist() == [[0, 0, 0], [4, 0, 0]]
    assert scene.objects[4:] == [drawn.copies]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"replicate": (2, 2)}, r"replicate: expected three integers ≥ 1, such as \(3, 3, 1\)"),
        ({"replicate": (1, 1, 0)}, "replicate: expected three integers"),
        ({"replicate": (1, 1, 2)}, r"replicate\[2\]: the cell does not repeat along this edge"),
        (
            {"replicate": (10**6, 10**6, 1)},
            "replicate: 1000000000000 cells need about 100,000.0 GB",
        ),
        ({"unwrap": True}, "unwrap: needs bonds, or the columns ix, iy and iz"),
        ({"wrap": True, "unwrap": True}, "unwrap: expected False with wrap=True"),
    ],
)
def test_wrong_arguments(options: dict[str, Any], message: str) -> None:
    particles = Particles([(0, 0, 0)], cell=SKEW, periodic=(True, True, False))
    with pytest.raises(SceneError, match=message):
        vtray.Scene().add_particles(particles, **options)


def test_sites_that_are_no_elements_stay_with_their_molecules() -> None:
    whole = np.array([(4.95, 4.9, 2), (5.71, 5.49, 2), (4.19, 5.49, 2), (4.95, 5.05, 2)])
    cut = Particles(whole % 5, {"element": np.array([*"OHHX"])}, cell=5 * np.eye(3))
    drawn = vtray.Scene().add_particles(cut, bonds=True, unwrap=True)
    assert np.allclose(drawn.spheres.center, whole)
    assert len(drawn.bonds) == 2


@pytest.mark.parametrize("option", ["wrap", "unwrap", "cell"])
def test_what_needs_a_cell(option: str) -> None:
    with pytest.raises(SceneError, match=f"{option}: there is "):
        vtray.Scene().add_particles([(0, 0, 0)], **{option: True})
