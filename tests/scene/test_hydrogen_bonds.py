"""Hydrogen bonds, beside a plain loop over all images and MDAnalysis."""

import itertools
import re
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import once
from vtray.base.errors import SceneError
from vtray.scene.particles import drawing
from vtray.scene.particles.hydrogen_bonds import Criterion, find_hydrogen_bonds
from vtray.scene.particles.particles import Particles

SKEW = np.array([[7.0, 0, 0], [2, 6.5, 0], [-1, 1.5, 6]])


def water(places: Any, cell: Any) -> Particles:
    """Return molecules of water at places in a cell, turned at random."""
    generator, count = np.random.default_rng(5), len(places)
    molecule = np.array([(0, 0, 0), (0.76, 0.59, 0), (-0.76, 0.59, 0)])
    turns = [np.linalg.qr(generator.normal(size=(3, 3)))[0] for _ in range(count)]
    positions = np.concatenate(
        [molecule @ turn + place for turn, place in zip(turns, places, strict=True)]
    )
    wrapped = positions @ np.linalg.inv(cell) % 1.0 @ cell
    bonds = [(3 * k, 3 * k + j) for k in range(count) for j in (1, 2)]
    columns = {"element": np.array(["O", "H", "H"] * count)}
    return Particles(wrapped, columns, bonds=bonds, cell=cell)


def by_loops(particles: Particles, length: float, angle: float) -> set[tuple[int, ...]]:
    """Return hydrogen, acceptor and image of hydrogen bonds by looking at all that there are."""
    positions, found = particles.positions, set()
    images = np.array(list(itertools.product((-2, -1, 0, 1, 2), repeat=3)))
    for oxygen, hydrogen in particles.bonds.tolist():
        back = positions[oxygen] + images @ particles.cell - positions[hydrogen]
        back = back[np.linalg.norm(back, axis=1).argmin()]
        for taker in np.flatnonzero(particles["element"] == "O").tolist():
            for image in images:
                away = positions[taker] + image @ particles.cell - positions[hydrogen]
                far = np.linalg.norm(away)
                cosine = away @ back / far / np.linalg.norm(back)
                if far <= length and np.degrees(np.arccos(np.clip(cosine, -1, 1))) >= angle:
                    found.add((hydrogen, taker, *image.tolist()))
    return found


@once
@pytest.mark.parametrize(
    ("cell", "length", "angle"),
    [(np.eye(3) * 6.0, 2.5, 120.0), (SKEW, 2.5, 120.0), (SKEW, 3.2, 150.0)],
)
def test_hydrogen_bonds_are_those_of_plain_loops(cell: Any, length: float, angle: float) -> None:
    particles = water(np.random.default_rng(1).uniform(size=(9, 3)) @ cell, cell)
    pairs, shifts = find_hydrogen_bonds(particles, Criterion(length, angle))
    found = {(*pair, *shift) for pair, shift in zip(pairs.tolist(), shifts.tolist(), strict=True)}
    assert found == by_loops(particles, length, angle)
    assert len(found) == len(pairs) > 2
    assert any(any(shift) for *_, shift in zip(pairs, shifts.tolist(), strict=True))


def test_hydrogen_bonds_are_those_of_mdanalysis() -> None:
    analysis = pytest.importorskip("MDAnalysis.analysis.hydrogenbonds.hbond_analysis")
    import MDAnalysis

    # So far apart that the donors that it finds by distance are those that are bound.
    grid = 2.75 * np.stack(np.meshgrid(*[np.arange(4.0)] * 3), axis=-1).reshape(-1, 3)
    particles = water(grid, np.eye(3) * 11.0)
    universe = MDAnalysis.Universe.empty(len(particles), trajectory=True)
    universe.add_TopologyAttr("name", particles["element"].tolist())
    universe.atoms.positions = particles.positions
    universe.dimensions = [11, 11, 11, 90, 90, 90]
    run = analysis.HydrogenBondAnalysis(
        universe,
        donors_sel="name O",
        hydrogens_sel="name H",
        acceptors_sel="name O",
        d_a_cutoff=3.2,
        d_h_a_angle_cutoff=130.0,
    )
    run.run()
    theirs = {(int(row[2]), int(row[3])) for row in run.results.hbonds}
    pairs, _ = find_hydrogen_bonds(particles, Criterion(4.0, 130.0))
    # Theirs are limited in the distance of the donor, not of the hydrogen.
    steps = particles.positions[pairs[:, 1]] - particles.positions[pairs[:, 0] // 3 * 3]
    far = np.linalg.norm(steps - 11 * np.rint(steps / 11), axis=1)
    assert {tuple(pair) for pair in pairs[far < 3.2].tolist()} == theirs
    assert len(theirs) > 10


PAIR = Particles(
    [(0.3, 1, 1), (5.3, 1, 1), (3.5, 1, 1)],
    {"element": np.array(["O", "H", "N"])},
    cell=np.eye(3) * 6,
)


def drawn(particles: Particles = PAIR, **options: Any) -> Any:
    return vtray.Scene().add_particles(particles, **{"hydrogen_bonds": True, **options})


def test_dashes_cross_borders() -> None:
    assert find_hydrogen_bonds(PAIR).pairs.tolist() == [[1, 2]]
    found = drawn(bonds=True)
    dashes = found.hydrogen_bonds
    assert len(dashes) == 6
    assert dashes.radius == 0.05
    # From 5.3 to 3.5, a half of each sixth.
    assert np.allclose(sorted(dashes.start[:3, 0]), [4.625, 4.925, 5.225])
    assert np.allclose(np.abs(dashes.end - dashes.start), [[0.15, 0, 0]] * 6)
    moved = Particles(PAIR.positions + np.array([1.5, 0, 0]), PAIR.columns, cell=PAIR.cell)
    far = vtray.Scene().add_particles(moved, wrap=True, hydrogen_bonds=True).hydrogen_bonds
    assert np.allclose(far.start[:3, 0], 0.8 - np.array([0.075, 0.375, 0.675]))
    assert np.allclose(far.start[3:, 0], 5 + np.array([0.075, 0.375, 0.675]))


def test_dashes_are_of_what_is_drawn() -> None:
    assert drawn(hydrogen_bonds=False).hydrogen_bonds is None
    assert len(drawn(select="element != 'N'").hydrogen_bonds) == 0
    assert len(drawn(hydrogen_bonds=(1.7, 120)).hydrogen_bonds) == 0
    assert len(drawn(replicate=(1, 2, 1)).hydrogen_bonds) == 12
    assert len(drawn(style="licorice").hydrogen_bonds) == 6


def test_balls_leave_dashes_room() -> None:
    found = drawn()
    assert (found.style, len(found.bonds)) == ("ball-and-stick", 2)
    assert drawn(bonds=False).style == "ball-and-stick"
    assert drawn(style="spacefill").style == "spacefill"
    assert drawn(hydrogen_bonds=False).style == "spacefill"


def test_truths_of_numpy_are_truths() -> None:
    for truth in (True, False):
        given = np.bool_(truth)
        one = drawn(bonds=truth, hydrogen_bonds=truth, boundary=truth)
        two = drawn(bonds=given, hydrogen_bonds=given, boundary=given)
        assert (one.bonds is None) == (two.bonds is None) == (not truth)
        assert (one.boundary is None) == (two.boundary is None) == (not truth)
        assert (one.hydrogen_bonds is None) == (two.hydrogen_bonds is None) == (not truth)
        assert one.style == two.style


def test_donors_are_bound_as_is_drawn() -> None:
    other = Particles(PAIR.positions, PAIR.columns, bonds=[(0, 2)], cell=PAIR.cell)
    assert len(drawn(other).hydrogen_bonds) == 0
    assert len(drawn(other, bonds=True).hydrogen_bonds) == 6
    empty = Particles(PAIR.positions, PAIR.columns, bonds=np.zeros((0, 2), int), cell=PAIR.cell)
    assert len(drawn(empty).hydrogen_bonds) == 6


def test_copies_have_dashes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drawing, "WRITTEN_OUT", 1)
    found = drawn(replicate=(2, 1, 1), bonds=True)
    assert found.copies.objects == (found.spheres, found.bonds, found.hydrogen_bonds)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ((2.5,), "expected True, False, or the longest H...A and the least angle in degrees"),
        ("yes", "expected True, False, or the longest"),
        ((2.5, 200), "got "),
    ],
)
def test_wrong_criterion(given: Any, message: str) -> None:
    with pytest.raises(SceneError, match=f"hydrogen_bonds: .*{re.escape(message)}"):
        drawn(hydrogen_bonds=given)


def test_elements_are_needed() -> None:
    with pytest.raises(SceneError, match="hydrogen_bonds: .* there is no column element"):
        drawn(Particles([(0, 0, 0)]))
