"""Files are written whole or not at all."""

import os
import stat
import threading
from pathlib import Path
from typing import BinaryIO

import pytest

from vtray.atomic_file import check_writable, write_whole
from vtray.errors import OutputError


def put(data: bytes):
    def write(file: BinaryIO) -> None:
        file.write(data)

    return write


def test_new_file_has_the_usual_permissions(tmp_path: Path) -> None:
    path = tmp_path / "new"
    (tmp_path / "usual").touch()
    write_whole(path, put(b"data"))
    assert path.read_bytes() == b"data"
    assert path.stat().st_mode == (tmp_path / "usual").stat().st_mode


def test_old_file_keeps_its_permissions(tmp_path: Path) -> None:
    path = tmp_path / "old"
    path.write_bytes(b"old")
    path.chmod(0o640)
    write_whole(path, put(b"new"))
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_failure_leaves_everything_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "old"
    path.write_bytes(b"old")

    def fail(file: BinaryIO) -> None:
        file.write(b"half")
        raise OSError(28, "No space left on device")

    with pytest.raises(OutputError, match="old: cannot be written: no space left on device"):
        write_whole(path, fail)
    assert [item.name for item in tmp_path.iterdir()] == ["old"]
    assert path.read_bytes() == b"old"


def test_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    target, link = tmp_path / "folder" / "target", tmp_path / "link"
    link.symlink_to(target)
    write_whole(link, put(b"data"))
    assert link.is_symlink()
    assert target.read_bytes() == b"data"


def test_pipe_is_written_to(tmp_path: Path) -> None:
    path = tmp_path / "pipe"
    os.mkfifo(path)
    got: list[bytes] = []
    reader = threading.Thread(target=lambda: got.append(path.read_bytes()))
    reader.start()
    check_writable(path)
    write_whole(path, put(b"data"))
    reader.join()
    assert got == [b"data"]
    assert stat.S_ISFIFO(path.stat().st_mode)


def test_check_finds_what_cannot_be_written(tmp_path: Path) -> None:
    check_writable(tmp_path / "new")
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(OutputError, match="is a folder; give the name of a file"):
        check_writable(tmp_path)
    with pytest.raises(OutputError, match="there is no folder .*/missing"):
        check_writable(tmp_path / "missing" / "new")
    with pytest.raises(OutputError, match="cannot be written: file name too long"):
        check_writable(tmp_path / ("x" * 300))
