"""Frames of trajectories that other libraries have at hand."""

import sys
import threading
import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from ase.build import molecule
from ase.io.trajectory import Trajectory

import vtray
from vtray.animation.sources import source_of
from vtray.base.errors import SceneError

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import MDAnalysis
    from MDAnalysis.coordinates.memory import MemoryReader


def universe() -> "MDAnalysis.Universe":
    made = MDAnalysis.Universe.empty(2, trajectory=True)
    made.add_TopologyAttr("elements", ["O", "H"])
    places = np.arange(24.0).reshape(4, 2, 3)
    return made.load_new(places, format=MemoryReader, dt=2.0)


def test_frames_of_mdanalysis() -> None:
    found = list(source_of(universe(), "1::2").start(0))
    assert [one.frame for one in found] == [1, 3]
    assert [one.time for one in found] == [2, 6]
    assert [one.positions[0, 0] for one in found] == [6, 18]
    source = source_of(universe().atoms[[1]])
    assert source.count == 4
    assert source.some is not None
    (last,) = source.some([3])
    assert (last["element"].tolist(), last.positions.tolist()) == (["H"], [[21, 22, 23]])


def test_a_movie_of_mdanalysis_is_that_of_its_frames(tmp_path: Path) -> None:
    look = {"size": (24, 16), "view": "x"}
    vtray.animate(universe(), tmp_path / "a" / "%d.png", **look)
    made = universe()
    frames = [vtray.from_mdanalysis(made) for _ in made.trajectory]
    vtray.animate(frames, tmp_path / "b" / "%d.png", **look)
    for k in range(4):
        name = f"{k}.png"
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


@pytest.mark.parametrize("chosen", [slice(None), slice(0, 3), [0, 2]])
def test_trajectories_of_mdanalysis_do_not_know_their_universe(chosen: object) -> None:
    trajectory = universe().trajectory
    given = trajectory if chosen == slice(None) else trajectory[chosen]
    with pytest.warns(UserWarning, match="^the trajectory of a universe of MDAnalysis knows no el"):
        source = source_of(given)
    assert source.count == len(given)


def test_a_universe_without_places_has_no_frames() -> None:
    with pytest.raises(
        SceneError, match="^scenes: expected scenes, a function that makes them, or"
    ):
        source_of(MDAnalysis.Universe.empty(2))


@pytest.mark.parametrize("one", [vtray.Particles([(0, 0, 0)]), molecule("H2O")])
def test_one_frame_is_no_trajectory(one: object) -> None:
    with pytest.raises(
        SceneError, match="^scenes: expected scenes, a function that makes them, or"
    ):
        source_of(one)


def test_frames_of_a_pipeline_of_ovito() -> None:
    pipeline = SimpleNamespace(source=SimpleNamespace(num_frames=3), compute=lambda k: [(k, 0, 0)])
    assert list(source_of(pipeline, "::-2").start(0)) == [[(2, 0, 0)], [(0, 0, 0)]]


@pytest.mark.parametrize("has_ovito", [True, False])
def test_ovito_computes_in_the_main_thread(
    has_ovito: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ovito", None)
    if not has_ovito:
        monkeypatch.delitem(sys.modules, "ovito")
    threads = set()

    def compute(k: int) -> list[tuple[int, int, int]]:
        threads.add(threading.current_thread())
        if k == 3:
            raise RuntimeError("no such frame")
        return [(k, 0, 0), (0, 1, 0)]

    pipeline = SimpleNamespace(source=SimpleNamespace(num_frames=3), compute=compute)
    vtray.animate(pipeline, tmp_path / "%d.png", size=(12, 9))
    assert ({threading.main_thread()} == threads) == has_ovito
    with pytest.raises(RuntimeError, match="^no such frame"):
        vtray.animate(compute, tmp_path / "%d.png", frames=4, size=(12, 9), view="x")


def test_frames_may_be_had_by_their_numbers_alone() -> None:
    class Run:
        def __len__(self) -> int:
            return 4

        def __getitem__(self, number: int) -> list[tuple[int, int, int]]:
            return [(number, 0, 0)]

    source = source_of(Run(), "1::2")
    assert list(source.start(0)) == [[(1, 0, 0)], [(3, 0, 0)]]
    with pytest.raises(SceneError, match="^frame 4: there are 4 frames; expected -4 to 3"):
        source_of(Run(), [4])


def test_arrays_have_frames_by_their_numbers() -> None:
    places = np.arange(24.0).reshape(4, 2, 3)
    source = source_of(places, "1::2")
    assert [one.tolist() for one in source.start(0)] == [places[1].tolist(), places[3].tolist()]
    assert source.some is not None


def test_trajectories_of_ase_have_frames_by_their_numbers(tmp_path: Path) -> None:
    atoms = molecule("H2O")
    with Trajectory(tmp_path / "a.traj", "w") as file:
        for k in range(3):
            atoms.positions[0, 0] = k
            file.write(atoms)
    with Trajectory(tmp_path / "a.traj") as file:
        assert [one.positions[0, 0] for one in source_of(file, "::-1").start(0)] == [2, 1, 0]
