"""Movies whose pictures a Dask cluster takes."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import vtray
from conftest import JIT, compiled_only, once
from vtray.animation import cluster as cluster_module
from vtray.animation.stored import Stored
from vtray.base.errors import RenderError, SceneError

distributed = pytest.importorskip("distributed")
local_cluster = Path(__file__).parents[1] / "reference" / "local_cluster.py"
VTRAY = Path(sys.executable).with_name("vtray")

COUNT = 12
SIZE = (14, 10) if JIT else (4, 3)
FRAME = "3\nTime={}\nC {} 0 0\nO 1 {} 2\nH 0 1 {}\n"


@contextlib.contextmanager
def running(workers: int) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Give the process of a cluster of processes, and its address."""
    with subprocess.Popen(
        [sys.executable, str(local_cluster), str(workers)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    ) as process:
        assert process.stdout is not None
        try:
            yield process, process.stdout.readline().strip()
        finally:
            assert process.stdin is not None
            process.stdin.close()


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with running(2) as (_, found):
        yield found


@pytest.fixture
def client(address: str) -> Iterator[Any]:
    with distributed.Client(address, set_as_default=False) as found:
        found.wait_for_workers(2)
        yield found


@pytest.fixture
def run_file(tmp_path: Path) -> Path:
    path = tmp_path / "run.xyz"
    frames = (FRAME.format(k, k / COUNT, k / COUNT, k / 3) for k in range(COUNT))
    path.write_text("".join(frames))
    return path


def make(k: int) -> vtray.Scene:
    scene = vtray.Scene()
    scene.add_spheres([(0.3 * k, 0, 0)], 1.0, color="white")
    scene.lights = [vtray.Light((0, -9, 0), max(k - 1, 0))]  # the first two are black
    scene.camera = vtray.Camera.look_at((0, -6, 0), (0, 0, 0), up=(0, 0, 1), size=(12, 9))
    return scene


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def take(scenes: Any, path: Path, **options: Any) -> dict[str, bytes]:
    """Return the pictures of a movie; that some are black is no surprise."""
    vtray.animate(scenes, path, **options, warn=print)
    return contents(path.parent)


def both(folder: Path, client: Any, scenes: Any, **options: Any) -> list[dict[str, bytes]]:
    """Return the pictures that are taken here, and by a cluster."""
    here = take(scenes, folder / "here" / "%d.png", **options)
    return [here, take(scenes, folder / "there" / "%d.png", client=client, **options)]


@once
def test_the_same_bytes(tmp_path: Path, client: Any) -> None:
    here, there = both(tmp_path, client, make, frames=COUNT)
    assert len(here) == COUNT
    assert here == there


@once
def test_the_same_bytes_of_a_trajectory(tmp_path: Path, client: Any, run_file: Path) -> None:
    options = {"size": SIZE, "samples": 1, "exposure": 1, "color": "x", "frames": "::-1"}
    here, there = both(tmp_path, client, run_file, **options)
    assert len(here) == COUNT
    assert here == there


def test_particles_travel_where_the_file_is_not_seen(
    tmp_path: Path, client: Any, run_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Stored, "_marks_here", lambda _: [(1, 1)])
    here, there = both(tmp_path, client, run_file, size=SIZE, samples=1)
    assert len(here) == COUNT
    assert here == there


@once
def test_the_same_turntable(tmp_path: Path, client: Any) -> None:
    scene = make(3)
    for name, given in (("here.gif", None), ("there.gif", client)):
        vtray.turntable(scene, tmp_path / name, seconds=1, fps=COUNT, client=given)
    assert (tmp_path / "here.gif").read_bytes() == (tmp_path / "there.gif").read_bytes()


@once
def test_a_worker_that_dies(tmp_path: Path, client: Any) -> None:
    killed = []

    def progress(_: str, done: int, total: int) -> None:
        assert total == COUNT
        if done == COUNT // 2 and not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    options = {"frames": COUNT, "client": client, "progress": progress}
    there = take(make, tmp_path / "there" / "%d.png", **options)
    assert killed
    assert there == take(make, tmp_path / "here" / "%d.png", frames=COUNT)


def test_pictures_that_are_done_stay(tmp_path: Path, client: Any) -> None:
    def failing(k: int) -> vtray.Scene:
        if k == 9:
            raise ZeroDivisionError
        return make(k)

    path = tmp_path / "there" / "%d.png"
    with pytest.raises(ZeroDivisionError) as error:
        take(failing, path, frames=COUNT, client=client)
    assert "pictures done; --resume (in Python, resume=True) goes on" in error.value.__notes__[0]
    assert (path.parent / "2.png").exists()
    there = take(make, path, frames=COUNT, client=client, resume=True)
    assert there == take(make, tmp_path / "here" / "%d.png", frames=COUNT)


def test_what_is_wrong_comes_back(tmp_path: Path, client: Any, run_file: Path) -> None:
    with run_file.open("a") as file:
        file.write("3\n\nC 0 0 0\nC 0 0 never\nC 0 0 0\n" + FRAME.format(1, 1, 1, 1))
    with pytest.raises(SceneError, match=r"run.xyz: line 6[0-9]: .*never"):
        vtray.animate(run_file, tmp_path / "a%d.png", frames=[0, 1, 12, 13], client=client)
    with pytest.raises(SceneError, match="scenes: frame 1: expected a Scene, got 3"):
        vtray.animate([make(3), 3], tmp_path / "b%d.png", client=client)


def test_other_versions(tmp_path: Path, client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster_module, "__version__", "0.0.1")
    with pytest.raises(RenderError, match=r"^tcp:.*: this worker has vtray .*, and here is 0.0.1$"):
        vtray.animate(make, tmp_path / "%d.png", frames=2, client=client)
    monkeypatch.setattr(cluster_module, "check_client", lambda _: None)
    monkeypatch.setattr("vtray.animation.animate.check_client", lambda _: None)
    with pytest.raises(RenderError, match=r"^a worker has vtray .*, and this is 0.0.1$"):
        vtray.animate(make, tmp_path / "%d.png", frames=2, client=client)


def test_what_is_no_cluster(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match=r"^client: expected a distributed.Client, .* got str$"):
        vtray.animate(make, tmp_path / "%d.png", frames=2, client="tcp://")  # type: ignore[arg-type]
    with (
        running(0) as (_, found),
        distributed.Client(found, set_as_default=False) as client,
        pytest.raises(RenderError, match=r"^tcp:.*: the cluster has no workers; start some"),
    ):
        vtray.animate(make, tmp_path / "%d.png", frames=2, client=client)


def vtray_command(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(VTRAY), *map(str, arguments)], capture_output=True, text=True, check=False
    )


@once
def test_command(tmp_path: Path, address: str, run_file: Path) -> None:
    given = ["--size", "14x10", "--samples", "1", "--bonds", run_file]
    there = vtray_command("--dask", address, *given, tmp_path / "there.gif")
    assert (there.returncode, there.stderr) == (0, "")
    vtray_command(*given, tmp_path / "here.gif")
    assert (tmp_path / "here.gif").read_bytes() == (tmp_path / "there.gif").read_bytes()


WRONG = [
    ("nowhere", "--dask: nowhere: no scheduler of Dask can be reached there: "),
    ("none.json", "--dask: none.json: there is no such scheduler file"),
]


@pytest.mark.parametrize(("given", "message"), WRONG)
def test_command_without_cluster(given: str, message: str, tmp_path: Path, run_file: Path) -> None:
    found = vtray_command("--dask", given, run_file, tmp_path / "a.gif")
    assert found.returncode == 1
    assert found.stderr.startswith(f"Error: {message}")
    assert found.stderr.count("\n") == 1


@compiled_only
def test_scheduler_that_dies(tmp_path: Path) -> None:
    data = tmp_path / "run.xyz"
    data.write_text("".join(FRAME.format(k, k / 400, 0, 0) for k in range(400)))
    with running(1) as (process, found):
        command = subprocess.Popen(
            [str(VTRAY), "--dask", found, "--size", "60x45", "-t1", "run.xyz", "a.gif"],
            cwd=tmp_path,
            stderr=subprocess.PIPE,
            text=True,
        )
        first, second = (tmp_path / "a.gif.frames" / f"{k:06d}.png" for k in range(2))
        while not (first.exists() and second.exists()):  # either may be done before the other
            assert command.poll() is None
            time.sleep(0.01)
        process.kill()
        _, error = command.communicate(timeout=60)
    assert command.returncode == 1
    note, _, message = error.strip().partition("\n")
    assert note.endswith("done; --resume (in Python, resume=True) goes on")
    assert message == f"Error: {found}: the cluster has ended"
