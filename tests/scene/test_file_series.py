"""Frames in several files, by a pattern, and what the command is told of files of data."""

import os
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import MDAnalysis
import numpy as np
import pytest

import vtray
from vtray.base.errors import OutputError, SceneError
from vtray.base.file_series import files_of

Command = Callable[..., CompletedProcess[str]]


def dump(*steps: int) -> str:
    """Return frames of a dump, whose particle is where its number says."""
    return "".join(
        f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id x y z\n1 {step} 0 0\n"
        for step in steps
    )


@pytest.fixture
def series(tmp_path: Path) -> Path:
    """Return a pattern for four files, one of two frames, and other names around them."""
    for name, steps in {"0": (0,), "50": (50, 75), "100": (100,), "1000": (1000,)}.items():
        (tmp_path / f"dump.{name}").write_text(dump(*steps))
    (tmp_path / "dump.folder").mkdir()
    (tmp_path / "adump.7").write_text(dump(7))
    return tmp_path / "dump.*"


STEPS = [0, 50, 75, 100, 1000]


def test_files_come_by_their_numbers(tmp_path: Path) -> None:
    names = ["a2b10", "a2b9", "a10b1", "a02b1", "a", "ab", "a1", "A3", "a2c"]
    for name in names:
        (tmp_path / name).touch()
    found = [os.path.basename(path) for path in files_of(str(tmp_path / "a*"))]
    assert found == ["a", "a1", "a02b1", "a2b9", "a2b10", "a2c", "a10b1", "ab"]
    assert files_of(str(tmp_path / "a?")) == [str(tmp_path / name) for name in ("a1", "ab")]


def test_only_patterns_stand_for_several(tmp_path: Path) -> None:
    for name in ("run[1].xyz", "run[2].xyz", "run1.xyz", "run*.xyz"):
        (tmp_path / name).touch()
    for name in ("run[1].xyz", "run*.xyz", "none.xyz", "none*.xyz", "a\0*"):
        assert files_of(str(tmp_path / name)) == [str(tmp_path / name)]
    for pattern in ("run[[]*.xyz", "run[*.xyz"):
        found = [os.path.basename(path) for path in files_of(str(tmp_path / pattern))]
        assert found == ["run[1].xyz", "run[2].xyz"]
    found = [os.path.basename(path) for path in files_of(str(tmp_path / "run[0-3].xyz"))]
    assert found == ["run1.xyz"]


@pytest.mark.parametrize("frame", range(-5, 5))
def test_each_frame(series: Path, frame: int) -> None:
    found = vtray.read(series, frame)
    assert (found.positions.tolist(), found.frame) == ([[STEPS[frame], 0, 0]], frame % 5)
    assert found.source == series.with_name(f"dump.{ {75: 50}.get(STEPS[frame], STEPS[frame]) }")


@pytest.mark.parametrize("frames", [None, "::2", "1:4", [3, 0, -1, 0], slice(None, None, -1)])
def test_frames_follow_each_other(series: Path, frames: object) -> None:
    given = vtray.read_frames(series, frames)  # type: ignore[arg-type]
    found = [particles.positions[0, 0] for particles in given]
    wanted = frames if isinstance(frames, list) else range(5)
    if isinstance(frames, str):
        wanted = range(5)[slice(*(int(part) if part else None for part in frames.split(":")))]
    elif isinstance(frames, slice):
        wanted = range(5)[frames]
    assert found == [STEPS[k] for k in wanted]


def test_what_is_wrong_names_the_file(series: Path) -> None:
    series.with_name("dump.200").write_text(dump(200).replace(" 0 0\n", " 0 nan\n"))
    with pytest.raises(SceneError, match=r"dump.200: line 6: z must be finite, got nan$"):
        list(vtray.read_frames(series))
    with pytest.raises(SceneError, match=r"dump.\*: frame 6: there are 6 frames; expected -6 to"):
        vtray.read(series, 6)
    with pytest.raises(SceneError, match="none.\\*: no such file; expected one of data, or a patt"):
        vtray.read(series.with_name("none.*"))
    series.with_name("dump.300").write_text("words\n")
    with pytest.raises(SceneError, match="dump.300: the ending '.300' is not known; expected one"):
        vtray.read(series, -1)


def test_files_of_different_kinds(tmp_path: Path) -> None:
    (tmp_path / "run1.xyz").write_text("1\n\nO 1 0 0\n1\n\nO 2 0 0\n")
    (tmp_path / "run2.csv").write_text("x,y,z\n3,0,0\n")
    found = [particles.positions[0, 0] for particles in vtray.read_frames(tmp_path / "run*")]
    assert found == [1, 2, 3]


def test_movies_of_several_files(series: Path, vtray_command: Command) -> None:
    folder = series.parent
    whole, parts = folder / "whole.dump", folder / "parts.gif"
    whole.write_text(dump(*STEPS))
    look = {"size": (16, 12), "samples": 1, "radii": 40.0}
    vtray.animate(series, parts, **look)
    vtray.animate(whole, folder / "whole.gif", **look)
    assert parts.read_bytes() == (folder / "whole.gif").read_bytes()
    options = ("--size", "16x12", "--samples", "1", "--radii", "40")
    done = vtray_command(*options, "dump.*", "again.gif", cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
    assert parts.read_bytes() == (folder / "again.gif").read_bytes()


def test_no_file_of_several_is_lost(tmp_path: Path, vtray_command: Command) -> None:
    for k in range(2):
        np.savez(tmp_path / f"a.{k}.npz", x=[0.0, k], y=[0.0, 0.0], z=[0.0, 0.0])
    before = [path.read_bytes() for path in sorted(tmp_path.iterdir())]
    with pytest.raises(OutputError, match="a.0.npz: is what the movie is made from"):
        vtray.animate(tmp_path / "a.*.npz", tmp_path / "a.%d.npz", size=(8, 8))
    for output in ("a.%d.npz", "a.1.npz"):
        done = vtray_command("--size", "8x8", "a.*.npz", output, cwd=tmp_path)
        assert done.returncode == 1
        assert "is what the movie is made from" in done.stderr or "data file itself" in done.stderr
    assert [path.read_bytes() for path in sorted(tmp_path.iterdir())] == before


def test_a_pattern_that_the_shell_has_replaced(series: Path, vtray_command: Command) -> None:
    done = vtray_command("dump.0", "dump.50", "dump.100", "a.gif", cwd=series.parent)
    assert done.returncode == 1
    assert "; a pattern for frames in several files needs quotes, as in 'dump.*'" in done.stderr


def test_a_trajectory_beside_its_topology(tmp_path: Path, vtray_command: Command) -> None:
    (tmp_path / "top.xyz").write_text("2\n\nO 0 0 0\nH 0 0 1\n")
    universe = MDAnalysis.Universe(str(tmp_path / "top.xyz"))
    universe.dimensions = [9, 9, 9, 90, 90, 90]
    with MDAnalysis.Writer(str(tmp_path / "run.dcd"), n_atoms=2) as writer:
        for step in range(3):
            universe.atoms.positions = [(0, 0, 0), (step, 0, 1)]
            writer.write(universe.atoms)
    files = ("--trajectory", "run.dcd", "top.xyz")
    done = vtray_command("--frame", "2", "--columns", *files, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("2 particles, frame 2\n")
    assert "from 0 to 2\n" in done.stdout
    small = ("--size", "16x12", "--samples", "1")
    done = vtray_command(*small, *files, "a.gif", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    done = vtray_command(*small, *files, "run.dcd", cwd=tmp_path)
    assert done.returncode != 0
    done = vtray_command("--trajectory", "a.dcd", "a.json", "a.png", cwd=tmp_path)
    assert done.returncode == 1


def test_what_a_table_calls_the_places(tmp_path: Path, vtray_command: Command) -> None:
    (tmp_path / "a.csv").write_text("px,py,pz,m\n1,2,3,4\n5,6,7,8\n")
    (tmp_path / "b.dat").write_text("9 1 2 3\n9 5 6 7\n")
    np.savez(tmp_path / "c.npz", r=[[1.0, 2.0, 3.0], [5.0, 6.0, 7.0]])
    for name, position in {"a.csv": "px, py,pz", "b.dat": "2,3,4", "c.npz": "r"}.items():
        done = vtray_command("--columns", "--position", position, name, cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")
        assert "from 3 to 7\n" in done.stdout
    done = vtray_command("--position", "px,py", "a.csv", "a.png", cwd=tmp_path)
    assert done.stderr.startswith("Error: argument --position: expected three names of col")
    done = vtray_command("a.csv", "a.png", cwd=tmp_path)
    assert "or --position px,py,pz" in done.stderr
    done = vtray_command("--position", "px,py,q", "a.csv", "a.png", cwd=tmp_path)
    assert "no column 'q'; there are" in done.stderr
