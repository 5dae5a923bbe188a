"""Files of openPMD, written by hand as the standard has them."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import vtray
from vtray.base.errors import SceneError
from vtray.scene.readers import openpmd_file

RANDOM = np.random.default_rng(3)


def component(group: Any, name: str, values: Any, unit: float = 1.0, rows: int = 0) -> None:
    """Write a component: an array, or one number for so many particles."""
    if rows:
        made = group.create_group(name)
        made.attrs["value"], made.attrs["shape"] = values, [rows]
    else:
        made = group.create_dataset(name, data=values)
    made.attrs["unitSI"] = unit


def species(iteration: Any, name: str, places: dict[str, Any], offset: float = 2.0) -> Any:
    """Write a species with its places in micrometres, and return its group."""
    group = iteration.create_group(f"particles/{name}")
    for axis, values in places.items():
        component(group, f"position/{axis}", values, 1e-6)
        component(group, f"positionOffset/{axis}", offset, 1e-3, len(values))
    return group


def iteration(file: Any, number: int, time: float = 0.0) -> Any:
    """Write an iteration, and return its group."""
    file.attrs["openPMD"], file.attrs["basePath"] = b"1.1.0", b"/data/%T/"
    group = file.create_group(f"data/{number}")
    group.attrs["time"], group.attrs["timeUnitSI"] = time, 1e-15
    return group


def test_iterations_and_species(tmp_path: Path) -> None:
    places = {axis: RANDOM.random(3) for axis in "xyz"}
    momenta = RANDOM.random((3, 3))
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for number in (10, 2):
            made = iteration(file, number, number)
            electrons = species(made, "electrons", places)
            for k, axis in enumerate("xyz"):
                component(electrons, f"momentum/{axis}", momenta[:, k], 2.0)
            component(electrons, "charge", -1.5, 2.0, 3)
            component(electrons, "id", np.arange(3, dtype=">u8"))
            electrons.create_group("particlePatches/numParticles")
            component(species(made, "ions", {a: [float(number)] for a in "xyz"}), "weighting", [7])
        iteration(file, 5)  # which has no particles
    frames = list(vtray.read_frames(tmp_path / "a.h5"))
    assert [frame.frame for frame in frames] == [0, 1]
    assert [frame.time for frame in frames] == pytest.approx([2e-15, 1e-14], rel=1e-15)
    last = vtray.read(tmp_path / "a.h5", -1)
    assert np.array_equal(last.positions, frames[1].positions)
    expected = np.stack([places[axis] for axis in "xyz"], axis=1) * 1e-6 + 2e-3
    assert np.allclose(last.positions[:3], expected, rtol=1e-15, atol=0)
    assert np.allclose(last.positions[3], 1e-5 + 2e-3, rtol=1e-15, atol=0)
    assert [*last.columns] == ["type", "charge", "id", "momentum", "weighting"]
    assert last["type"].tolist() == ["electrons"] * 3 + ["ions"]
    assert np.array_equal(last["momentum"][:3], 2 * momenta)
    assert np.isnan(last["momentum"][3]).all()
    assert last["charge"][:3].tolist() == [-3.0] * 3
    assert last["weighting"][3] == 7
    assert last.cell is None


def test_one_species_of_a_plane(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        beam = species(iteration(file, 0), "beam", {"x": [1.0, 2.0], "z": [3.0, 4.0]}, 0.0)
        component(beam, "id", np.array([5, 6], ">u8"))
    found = vtray.read(tmp_path / "a.h5")
    assert np.array_equal(found.positions, np.array([[1, 0, 3], [2, 0, 4]]) * 1e-6)
    assert [*found.columns] == ["id"]
    assert (found["id"].dtype, found["id"].tolist()) == (np.uint64, [5, 6])


def test_numbered_files_are_frames(tmp_path: Path) -> None:
    for number in (2, 10):
        with h5py.File(tmp_path / f"run_{number}.h5", "w") as file:
            species(iteration(file, number, number), "beam", {a: [1.0] for a in "xyz"})
    times = [frame.time for frame in vtray.read_frames(tmp_path / "run_*.h5")]
    assert times == pytest.approx([2e-15, 1e-14], rel=1e-15)


WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "lengths": ({"x": [1.0], "y": [1.0, 2.0], "z": [1.0]}, "expected positions x, y and z, got x"),
    "axes": ({"r": [1.0], "t": [1.0]}, "expected positions x, y and z, got r, t"),
    "none": ({}, "expected arrays x, y and z, or position, in the file"),
}


@pytest.mark.parametrize(("places", "words"), WRONG.values(), ids=WRONG)
def test_wrong_places(places: dict[str, Any], words: str, tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        species(iteration(file, 0), "beam", places)
    with pytest.raises(SceneError, match=words):
        vtray.read(tmp_path / "a.h5")


def test_constants_that_claim_to_be_many(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        group = iteration(file, 0).create_group("particles/beam")
        for axis in "xyz":
            component(group, f"position/{axis}", 1.0, rows=2**42)
    with pytest.raises(SceneError, match="a.h5: reading it needs about 316,659.3 GB of memory"):
        vtray.read(tmp_path / "a.h5")


def test_iterations_are_looked_for_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for number in range(20):
            species(iteration(file, number), "beam", {axis: [1.0] for axis in "xyz"})
    calls, look = [0], openpmd_file._species_of

    def counted(given: Any) -> dict[str, Any]:
        calls[0] += 1
        return look(given)

    monkeypatch.setattr(openpmd_file, "_species_of", counted)
    assert len(list(vtray.read_frames(tmp_path / "a.h5"))) == 20
    assert calls[0] <= 60  # frames are counted, then found, then read


@pytest.mark.parametrize("name", ["data", "data/0", "data/0/particles", "data/0/particles/beam"])
def test_arrays_in_the_place_of_groups(name: str, tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.attrs["openPMD"], file[name] = b"1.1.0", [1.0]
    with pytest.raises(SceneError, match="expected arrays x, y and z, or position, in the file"):
        vtray.read(tmp_path / "a.h5")
