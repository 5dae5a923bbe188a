"""Movies that end before they are whole, and go on."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import vtray
from conftest import compiled_only, once
from vtray.base.errors import OutputError

COUNT = 6
ENDED = "movie.gif.frames"


def make(k: int, dark: bool = False) -> vtray.Scene:
    scene = vtray.Scene()
    scene.add_spheres([(0.3 * k, 0, 0)], 1.0, color="red" if dark else "white")
    scene.lights = [vtray.Light((0, -9, 0), 1 + k)]
    scene.camera = vtray.Camera.look_at((0, -6, 0), (0, 0, 0), up=(0, 0, 1), size=(12, 9))
    return scene


def failing(k: int) -> vtray.Scene:
    if k == 3:
        raise ZeroDivisionError
    return make(k)


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture
def ended(tmp_path: Path) -> Path:
    """Return a movie of which three of six pictures are done."""
    path = tmp_path / "movie.gif"
    with pytest.raises(ZeroDivisionError) as error:
        vtray.animate(failing, path, frames=COUNT)
    assert "3 pictures done; --resume (in Python, resume=True) goes on" in error.value.__notes__[0]
    names = {path.name for path in tmp_path.joinpath(ENDED).iterdir()} - {"movie.part"}
    assert names == {"000000.png", "000001.png", "000002.png", "movie.json"}
    return path


def in_one_go(folder: Path, name: str) -> dict[str, bytes]:
    folder.mkdir()
    vtray.animate(make, folder / name, frames=COUNT)
    return contents(folder)


@once
def test_goes_on_to_the_same_bytes(ended: Path) -> None:
    made = []

    def noted(k: int) -> vtray.Scene:
        made.append(k)
        return make(k)

    vtray.animate(noted, ended, frames=COUNT, resume=True)
    assert made == [0, 2, 3, 4, 5]  # the first for the exposure, the last done to be compared
    assert contents(ended.parent) == in_one_go(ended.parent / "whole", "movie.gif")


@once
def test_later_pictures_that_are_done_stay(ended: Path) -> None:
    whole = in_one_go(ended.parent / "whole", "%d.png")
    folder = ended.parent / ENDED
    folder.joinpath("000004.png").write_bytes(whole["4.png"])
    record = folder / "movie.json"
    record.write_text(json.dumps({**json.loads(record.read_text()), "further": [4, 5]}))
    with pytest.raises(OutputError, match="holds 4 pictures that an earlier run has done"):
        vtray.animate(make, ended, frames=COUNT)
    told = []
    vtray.animate(
        make, ended, frames=COUNT, resume=True, progress=lambda _, done, total: told.append(done)
    )
    assert told == [4, 5, 6]
    assert ended.read_bytes() == in_one_go(ended.parent / "again", "movie.gif")["movie.gif"]


@once
def test_numbered_pictures_go_on_too(tmp_path: Path) -> None:
    path = tmp_path / "made" / "%d.png"
    with pytest.raises(ZeroDivisionError):
        vtray.animate(failing, path, frames=COUNT)
    with pytest.raises(OutputError, match=r"\.\.png\.vtray-movie: holds 3 pictures that an earli"):
        vtray.animate(make, path, frames=COUNT)
    vtray.animate((make(k) for k in range(COUNT)), path, resume=True)
    assert contents(path.parent) == in_one_go(tmp_path / "whole", "%d.png")
    vtray.animate(make, path, frames=2, resume=True)  # nothing is left to go on from


@once
def test_pictures_of_a_run_before_do_not_count(tmp_path: Path) -> None:
    path = tmp_path / "made" / "%d.png"
    vtray.animate(lambda k: make(k, dark=True), path, frames=COUNT)
    with pytest.raises(ZeroDivisionError):
        vtray.animate(failing, path, frames=COUNT)
    vtray.animate(make, path, frames=COUNT, resume=True)
    assert contents(path.parent) == in_one_go(tmp_path / "whole", "%d.png")


@once
def test_nothing_to_go_on_from(tmp_path: Path) -> None:
    vtray.animate(make, tmp_path / "movie.gif", frames=COUNT, resume=True)
    assert contents(tmp_path) == in_one_go(tmp_path / "whole", "movie.gif")


WRONG = [
    ({}, "holds 3 pictures that an earlier run has done; --resume "),
    ({"resume": True, "samples": 4}, "its 3 pictures were made with samples 1, not 4; do the same"),
    ({"resume": True, "size": (4, 3)}, "were made with size 12x9, not 4x3; do the same again, or"),
    ({"resume": True, "exposure": 2.0}, "were made with exposure that of the first, not 2.0"),
    ({"resume": True, "annotate": {"title": "a"}}, "its 3 pictures have other annotations"),
    ({"resume": True, "frames": range(1, 7)}, "its 3 pictures are of other scenes, as 000002.png"),
    ({"resume": True, "frames": 2}, "more pictures are done than there are"),
]


@pytest.mark.parametrize(("more", "message"), WRONG)
def test_other_movies(more: dict[str, object], message: str, ended: Path) -> None:
    before = contents(ended.parent / ENDED)
    with pytest.raises(OutputError, match=message):
        vtray.animate(make, ended, **{"frames": COUNT, **more})
    after = contents(ended.parent / ENDED)
    for found in (before, after):
        found.pop("movie.part", None)
    assert after == before


def test_one_picture_of_another_movie(tmp_path: Path) -> None:
    path = tmp_path / "movie.gif"
    with pytest.raises(vtray.SceneError):
        vtray.animate([make(0), 3], path)
    with pytest.raises(OutputError, match="its 1 picture was made with size 12x9, not 4x3; do"):
        vtray.animate(make, path, frames=2, resume=True, size=(4, 3))
    with pytest.raises(OutputError, match="its 1 picture is of other scenes, as 000000.png is;"):
        vtray.animate(make, path, frames=[4, 5], resume=True)


def test_folders_that_are_not_ours(ended: Path) -> None:
    record = ended.parent / ENDED / "movie.json"
    told = json.loads(record.read_text())
    record.write_text(json.dumps({**told, "version": "0.0.1"}))
    with pytest.raises(OutputError, match=r"pictures were made by vtray 0.0.1, and this is"):
        vtray.animate(make, ended, frames=COUNT, resume=True)
    record.write_text("{}")
    with pytest.raises(OutputError, match=r"movie.json: is not understood: .*; remove it"):
        vtray.animate(make, ended, frames=COUNT, resume=True)
    record.unlink()
    with pytest.raises(OutputError, match=r"gif.frames: is in the way: pictures are kept there"):
        vtray.animate(make, ended, frames=COUNT, resume=True)
    shutil.rmtree(record.parent)
    vtray.animate(make, ended, frames=COUNT)


def test_nothing_is_left_where_nothing_is_done(tmp_path: Path) -> None:
    def failing_at_first(*_: object) -> None:
        assert (tmp_path / ENDED / "movie.json").exists()
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        vtray.animate(make, tmp_path / "movie.gif", frames=COUNT, progress=failing_at_first)
    assert contents(tmp_path) == {}


@pytest.mark.parametrize("is_there", [False, True])
def test_no_folder_is_left_for_numbered_pictures(tmp_path: Path, is_there: bool) -> None:
    folder = tmp_path / "made"
    if is_there:
        folder.mkdir()
    dark = make(0)
    dark.lights = [vtray.Light((0, 0, 9), 1e306)]
    for scenes in ([3], [dark]):
        with pytest.raises((vtray.SceneError, vtray.RenderError)):
            vtray.animate(scenes, folder / "%d.png")
        assert folder.exists() == is_there
    vtray.animate([make(0)], folder / "%d.png")
    assert [*contents(folder)] == ["0.png"]


def test_damaged_picture(ended: Path) -> None:
    (ended.parent / ENDED / "000002.png").write_bytes(b"")
    with pytest.raises(OutputError, match=r"000002.png: .*; remove it to go on"):
        vtray.animate(make, ended, frames=COUNT, resume=True)


def test_what_else_is_in_the_folder_stays(ended: Path) -> None:
    (ended.parent / ENDED / "notes.txt").write_text("mine")
    vtray.animate(make, ended, frames=COUNT, resume=True)
    assert contents(ended.parent / ENDED) == {"notes.txt": b"mine"}


def test_ctrl_c_in_python(tmp_path: Path) -> None:
    def scenes() -> Iterator[vtray.Scene]:
        yield make(0)
        yield make(1)
        while not (tmp_path / ENDED / "000000.png").exists():
            time.sleep(0.01)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        vtray.animate(scenes(), tmp_path / "movie.gif")
    assert (tmp_path / ENDED / "000000.png").exists()
    assert not (tmp_path / "movie.gif").exists()


FRAME = "2\n\nC {} 0 0\nO 1 {} 2\n"


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@compiled_only
def test_ctrl_c_of_the_command(tmp_path: Path) -> None:
    pytest.importorskip("imageio_ffmpeg")
    count = 30
    data = tmp_path / "run.xyz"
    data.write_text("".join(FRAME.format(k / count, k / count) for k in range(count)))
    vtray_command = Path(sys.executable).with_name("vtray")
    given = [str(vtray_command), "--size", "60x45", "-t1", str(data)]
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_DISABLE_JIT"}
    movie = tmp_path / "movie.mp4"
    started = subprocess.Popen([*given, str(movie)], stderr=subprocess.PIPE, env=environment)
    third = tmp_path / "movie.mp4.frames" / "000002.png"
    while not third.exists():
        assert started.poll() is None
        time.sleep(0.005)
    started.send_signal(signal.SIGINT)
    _, error = started.communicate(timeout=60)
    assert started.returncode == 130
    assert b" pictures done; --resume (in Python, resume=True) goes on\n" in error
    assert error.count(b"\n") == 1
    assert not movie.exists()
    done = sorted(path.name for path in third.parent.glob("*.png"))
    assert 3 <= len(done) < count
    before = {name: third.with_name(name).read_bytes() for name in done}
    ended = subprocess.run([*given, str(movie)], capture_output=True, env=environment, check=False)
    assert ended.returncode == 1
    assert b"pictures that an earlier run has done" in ended.stderr
    numbered = tmp_path / "whole" / "%06d.png"
    subprocess.run([*given, str(numbered)], env=environment, check=True)
    for name, content in before.items():
        assert numbered.with_name(name).read_bytes() == content
    ended = subprocess.run(
        [*given, "--resume", str(movie)], capture_output=True, env=environment, check=False
    )
    assert (ended.returncode, ended.stderr) == (0, b"")
    again = tmp_path / "again.mp4"
    subprocess.run([*given, str(again)], env=environment, check=True)
    assert again.read_bytes() == movie.read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "again.mp4",
        "movie.mp4",
        "run.xyz",
        "whole",
    ]
