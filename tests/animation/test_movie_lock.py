"""Two movies at once to the same file."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import vtray
from conftest import compiled_only
from vtray.base.errors import OutputError
from vtray.base.file_lock import FileLock, HeldError

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no locks")


def make(k: int) -> vtray.Scene:
    scene = vtray.Scene()
    scene.add_spheres([(0.3 * k, 0, 0)], 1.0, color="white")
    scene.lights = [vtray.Light((0, -9, 0))]
    scene.camera = vtray.Camera.look_at((0, -6, 0), (0, 0, 0), up=(0, 0, 1), size=(12, 9))
    return scene


@pytest.mark.parametrize("name", ["movie.gif", "%d.png"])
@pytest.mark.parametrize("resume", [False, True])
def test_second_run(tmp_path: Path, name: str, resume: bool) -> None:
    path = tmp_path / name
    refused = []

    def scenes(k: int) -> vtray.Scene:
        if k == 3:
            with pytest.raises(OutputError) as error:
                vtray.animate(make, path, frames=2, resume=resume)
            refused.append((str(error.value), getattr(error.value, "__notes__", [])))
        return make(k)

    vtray.animate(scenes, path, frames=5)
    words = "is being made by another run; wait for that, or choose another name"
    assert refused == [(f"{path}: {words}", [])]
    assert not [*tmp_path.glob("*.frames")]
    assert not [*tmp_path.glob(".*")]


def test_two_names_in_a_folder(tmp_path: Path) -> None:
    def scenes(k: int) -> vtray.Scene:
        if k == 1:
            vtray.animate(make, tmp_path / "b%d.png", frames=2)
        return make(k)

    vtray.animate(scenes, tmp_path / "a%d.png", frames=2)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "a0.png",
        "a1.png",
        "b0.png",
        "b1.png",
    ]


HOLDS = "import sys, vtray.base.file_lock as f; f.FileLock({!r}); print(1, flush=True); input()"


def test_killed_process_holds_nothing(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    code = f"from pathlib import Path as P; {HOLDS.replace('{!r}', 'P(sys.argv[1])')}"
    with subprocess.Popen(
        [sys.executable, "-c", code, str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        with pytest.raises(HeldError):
            FileLock(path)
        process.kill()
    lock = FileLock(path)
    with pytest.raises(HeldError):
        FileLock(path)
    lock.release()
    lock.release()
    assert not path.exists()


def test_file_that_cannot_be_made(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"lock: cannot be made: no such file"):
        FileLock(tmp_path / "none" / "lock")
    (tmp_path / "link").symlink_to(tmp_path / "other")
    with pytest.raises(OutputError, match=r"link: cannot be made: too many levels"):
        FileLock(tmp_path / "link")


@compiled_only
def test_second_command(tmp_path: Path) -> None:
    frame = "2\n\nC {} 0 0\nO 1 0 2\n"
    (tmp_path / "run.xyz").write_text("".join(frame.format(k / 150) for k in range(150)))
    given = [str(Path(sys.executable).with_name("vtray")), "--size", "80x60", "-t1", "run.xyz"]
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_DISABLE_JIT"}
    with subprocess.Popen([*given, "a.gif"], cwd=tmp_path, env=environment) as first:
        while not (tmp_path / "a.gif.frames" / "000001.png").exists():
            assert first.poll() is None
        second = subprocess.run(
            [*given, "--resume", "a.gif"],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        first.kill()
    words = "is being made by another run; wait for that, or choose another name"
    assert (second.returncode, second.stderr) == (1, f"Error: a.gif: {words}\n")
    third = subprocess.run(
        [*given, "--resume", "--frames", ":150", "a.gif"], cwd=tmp_path, env=environment, check=True
    )
    assert third.returncode == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.gif", "run.xyz"]
