"""What is read: files, and pipes that are given on purpose; nothing else, and never without end."""

import json
import os
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from examples import one_sphere
from pictures import hand_made

import vtray
from vtray.base import input_file
from vtray.base.errors import UnfitFileError
from vtray.base.input_file import open_input, read_input, read_stream

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs pipes with names")

SPHERES = {"type": "spheres", "radius": 1, "color": {"r": 1, "g": 2, "b": 3}, "lambert": 1}


@pytest.fixture
def pipe() -> Iterator[Callable[[bytes], str]]:
    """Return a function that gives the name of a pipe with some content, as ``<(command)`` does."""
    ends: list[int] = []

    def make(content: bytes) -> str:
        reader, writer = os.pipe()
        ends.append(reader)

        def write() -> None:
            with os.fdopen(writer, "wb") as file:
                file.write(content)

        threading.Thread(target=write, daemon=True).start()
        return f"/dev/fd/{reader}"

    yield make
    for end in ends:
        os.close(end)


def test_files_and_pipes_that_are_given(tmp_path: Path, pipe: Callable[[bytes], str]) -> None:
    content = os.urandom(100_000)  # more than a pipe holds
    (tmp_path / "a").write_bytes(content)
    (tmp_path / "b").symlink_to("a")
    for path in (tmp_path / "a", str(tmp_path / "b"), pipe(content)):
        with open_input(path) as file:
            assert file.read(3) == content[:3]
            assert file.seek(-3, os.SEEK_END) == 99_997
            assert file.read() == content[-3:]
    assert read_input(tmp_path / "a") == read_input(pipe(content)) == content
    assert read_input(pipe(b"")) == b""


def unfit(folder: Path) -> dict[str, Path]:
    """Return what is no file, by the words for it."""
    os.mkfifo(folder / "fifo.png")
    (folder / "link.png").symlink_to("fifo.png")
    (folder / "zero.png").symlink_to("/dev/zero")
    socket.socket(socket.AF_UNIX).bind(str(folder / "s.png"))
    return {
        "is a pipe, which is read only as /dev/stdin": folder / "fifo.png",
        "is a pipe": folder / "link.png",
        "is a device": folder / "zero.png",
        "is a socket": folder / "s.png",
    }


@pytest.mark.filterwarnings("ignore::ResourceWarning")  # the socket
def test_what_is_no_file_is_an_error_at_once(tmp_path: Path) -> None:
    for words, path in unfit(tmp_path).items():
        with pytest.raises(UnfitFileError, match=words):
            open_input(path)
        with pytest.raises(vtray.SceneError, match=f"{path}: {words}.*; expected a scene file"):
            vtray.load(path)
        with pytest.raises(vtray.ProvenanceError, match=f"{path}: {words}.*; expected a picture"):
            vtray.read_provenance(path)
        with pytest.raises(vtray.VtrayError, match=f"{path}: {words}.*; expected a picture"):
            vtray.compare(path, path)
        data = path.with_suffix(".npz")
        data.symlink_to(path)
        scene = {**one_sphere(), "objects": [{**SPHERES, "data": str(data)}]}
        with pytest.raises(vtray.SceneError, match=f"{words}.*; expected a .npz file"):
            vtray.loads(json.dumps(scene))
    with pytest.raises(IsADirectoryError):
        open_input(tmp_path)


def test_a_file_that_becomes_a_pipe_is_not_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a").touch()
    os.mkfifo(tmp_path / "b")
    found = os.stat(tmp_path / "a")
    with monkeypatch.context() as patch:
        patch.setattr(input_file.os, "stat", lambda _: found)
        with pytest.raises(UnfitFileError, match="is a pipe"):
            open_input(str(tmp_path / "b"))


def test_what_is_too_large_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(input_file, "SMALL", 1000)
    monkeypatch.setattr(input_file, "available_memory", lambda: 10**10)
    with (tmp_path / "a").open("wb") as file:
        file.truncate(10**13)
    problem = r"is larger than 2\.5 GB, a quarter of the memory that is available"
    with pytest.raises(vtray.SceneError, match=f"a: {problem}; expected a scene file"):
        vtray.load(tmp_path / "a")
    # A pipe that never ends.
    monkeypatch.setattr(input_file, "available_memory", lambda: 4 * 10**7)
    command = [sys.executable, "-c", "while True: print('x' * 10**6)"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as endless:
        with pytest.raises(OSError, match="is larger than 10 MB"):
            read_stream(endless.stdout)
        endless.kill()


def test_pictures_scenes_and_arrays_from_pipes(
    tmp_path: Path, pipe: Callable[[bytes], str]
) -> None:
    image = hand_made()
    image.save(tmp_path / "a.png")
    picture = (tmp_path / "a.png").read_bytes()
    assert vtray.read_provenance(pipe(picture)) == vtray.read_provenance(tmp_path / "a.png")
    assert vtray.compare(pipe(picture), tmp_path / "a.png").differing == 0
    np.save(tmp_path / "c.npy", np.zeros((5, 3)))
    data = {**SPHERES, "data": str(tmp_path / "c.npy")}
    scene = vtray.load(pipe(json.dumps({**one_sphere(), "objects": [data]}).encode()))
    assert len(scene.objects[0]) == 5


def test_command_with_pipes(tmp_path: Path) -> None:
    # An error within the scene tells that it was read.
    wrong = json.dumps(one_sphere()).replace('"radius": 1', '"radius": -1')
    (tmp_path / "scene.json").write_text(wrong)
    command = f"{Path(sys.executable).with_name('vtray')} --pixel 1,1"
    for shell in (f"{command} <(cat scene.json)", f"cat scene.json | {command} /dev/stdin"):
        done = subprocess.run(
            ["bash", "-c", shell], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert "objects[0].radius: expected a number ≥ 0, got -1\n" in done.stderr
