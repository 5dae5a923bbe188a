"""No movie takes the place of what it is made from."""

import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vtray
from vtray.animation.output import Output
from vtray.base.errors import OutputError, SceneError
from vtray.commands.cli import run

XYZ = "2\n\nH 0 0 0\nO 1 0 0\n"
REFUSED = "is what the movie is made from; choose another name for the movie"
SMALL: dict[str, Any] = {"size": (12, 9), "samples": 1}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    np.savez(tmp_path / "0000.npz", x=np.arange(3.0), y=np.zeros(3), z=np.zeros(3))
    (tmp_path / "run.gif").write_text(XYZ)
    (tmp_path / "7.png").write_text(XYZ)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("data", "movie", "written"),
    [
        ("0000.npz", "%04d.npz", "0000.npz"),
        ("run.gif", "run.gif", "run.gif"),
        ("./run.gif", "run.gif", "run.gif"),
        ("7.png", "%d.png", "7.png"),
        ("link", "%d.png", "7.png"),
    ],
)
@pytest.mark.parametrize("more", [[], ["--turntable", "0.2"]])
def test_what_is_read_is_spared(
    data: str,
    movie: str,
    written: str,
    more: list[str],
    folder: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    if data == "link":
        os.symlink("7.png", "link")
    before = Path(data).read_bytes()
    form = [] if data.endswith(".npz") else ["--format", "xyz"]
    assert run(["--size", "12x9", *form, *more, data, movie]) == 1
    assert capsys.readouterr().err == f"Error: {written}: {REFUSED}\n"
    if not more:
        how = {"format": "xyz"} if form else {}
        with pytest.raises(OutputError, match=REFUSED):
            vtray.animate(data, movie, **SMALL, **how)
    assert Path(data).read_bytes() == before
    assert not [path for path in folder.iterdir() if path.name.endswith(("frames", "movie"))]


def test_the_trajectory_beside_it_is_spared(folder: Path) -> None:
    shutil.copy("run.gif", "3.png")
    with pytest.raises(OutputError, match=f"3.png: {REFUSED}"):
        vtray.animate("run.gif", "%d.png", trajectory="3.png", **SMALL)


def test_others_beside_it_are_no_matter(folder: Path) -> None:
    for name in ("%d.npz", "%05d.npz", "a%04d.npz", "%04d.png", "other.gif"):
        Output(Path(name)).check_spares(["0000.npz", None])
    Output(Path("%04d.png")).check_spares(["7.png"])


@pytest.mark.parametrize("frames", [[7], [0, 3]])
def test_frames_that_a_list_does_not_have(frames: Any, folder: Path) -> None:
    words = f"frame {max(frames)}: there are 3 frames; expected -3 to 2"
    with pytest.raises(SceneError, match=words):
        vtray.animate([np.eye(3)] * 3, "a.gif", frames=frames, **SMALL)


def test_more_pictures_than_any_movie_has(folder: Path) -> None:
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 0), 1)
    camera = vtray.Camera.fit(scene, size=(12, 9))
    words = "frames: expected at most 1000000 pictures, got"
    for how in ({"camera": {0: camera, 10**9: camera}}, {"frames": 10**7}):
        with pytest.raises(SceneError, match=words):
            vtray.animate(scene, "a.gif", **how)
    assert not Path("a.gif.frames").exists()
