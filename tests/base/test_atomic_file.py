"""Files are written whole or not at all."""

import os
import stat
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import BinaryIO

import pytest

from vtray.base.atomic_file import check_spares, check_writable, write_whole
from vtray.base.errors import OutputError


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


def test_links_in_a_loop(tmp_path: Path) -> None:
    (tmp_path / "a").symlink_to("b")
    (tmp_path / "b").symlink_to("a")
    for attempt in (check_writable, lambda path: write_whole(path, put(b"data"))):
        with pytest.raises(OutputError, match="a: cannot be written: too many levels of symbolic"):
            attempt(tmp_path / "a")


def test_read_only_file_stays(tmp_path: Path) -> None:
    path = tmp_path / "old"
    path.write_bytes(b"old")
    path.chmod(0o444)
    for attempt in (check_writable, lambda path: write_whole(path, put(b"new"))):
        with pytest.raises(OutputError, match="old: is read-only; make it writable, or choose"):
            attempt(path)
    assert path.read_bytes() == b"old"
    assert [item.name for item in tmp_path.iterdir()] == ["old"]


@pytest.mark.skipif(os.geteuid() != 0, reason="only root may give files away")
def test_root_keeps_the_owner(tmp_path: Path) -> None:
    path = tmp_path / "old"
    path.write_bytes(b"old")
    path.chmod(0o640)
    os.chown(path, 1234, 2345)
    before = path.stat()
    write_whole(path, put(b"new"))
    after = path.stat()
    assert (after.st_uid, after.st_gid, after.st_mode) == (1234, 2345, before.st_mode)
    assert after.st_ino != before.st_ino
    assert path.read_bytes() == b"new"


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can become somebody else")
def test_file_of_somebody_else_keeps_its_owner() -> None:
    code = "write_whole(Path(sys.argv[1]), lambda file: file.write(b'new'))"
    user = "import fcntl, os, sys, vtray.base.atomic_file; os.setgid(1234); os.setuid(1234)"
    imports = "from pathlib import Path; from vtray.base.atomic_file import write_whole"
    with tempfile.TemporaryDirectory() as folder:  # not in pytest's, which is closed to others
        path = Path(folder) / "shared"
        path.write_bytes(b"a long old text")
        path.chmod(0o666)
        Path(folder).chmod(0o777)
        subprocess.run([sys.executable, "-c", f"{user}; {imports}; {code}", path], check=True)
        assert (path.stat().st_uid, path.read_bytes()) == (0, b"new")
        assert [item.name for item in Path(folder).iterdir()] == ["shared"]


@pytest.mark.parametrize("new", [b"new", b"a text that is longer than the old one"])
def test_hard_links_stay(new: bytes, tmp_path: Path) -> None:
    path = tmp_path / "old"
    path.write_bytes(b"a long old text")
    os.link(path, tmp_path / "other")
    write_whole(path, put(new))
    assert (tmp_path / "other").read_bytes() == path.read_bytes() == new
    assert path.stat().st_nlink == 2
    assert len(list(tmp_path.iterdir())) == 2


def test_hard_links_stay_whole_on_a_full_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "old"
    path.write_bytes(b"old")
    os.link(path, tmp_path / "other")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "posix_fallocate", full)
    with pytest.raises(OutputError, match="no space left on device"):
        write_whole(path, put(b"longer than before"))
    assert path.read_bytes() == b"old"


def test_null_character(tmp_path: Path) -> None:
    for attempt in (check_writable, lambda path: write_whole(path, put(b"data"))):
        with pytest.raises(OutputError, match=r"a\\x00b: cannot be written: no file name may"):
            attempt(tmp_path / "a\0b")


def test_long_names(tmp_path: Path) -> None:
    path = tmp_path / ("語" * 85)  # 255 bytes
    write_whole(path, put(b"data"))
    assert [item.name for item in tmp_path.iterdir()] == [path.name]


def test_a_link_planted_in_the_way_is_not_followed(tmp_path: Path) -> None:
    target = tmp_path / "a.png"
    names: list[Path] = []
    write_whole(target, lambda file: names.extend(tmp_path.iterdir()))
    (temporary,) = (name for name in names if name.name != "a.png")
    (tmp_path / "precious").write_bytes(b"precious")
    temporary.symlink_to(tmp_path / "precious")
    write_whole(target, put(b"data"))
    assert (tmp_path / "precious").read_bytes() == b"precious"
    assert target.read_bytes() == b"data"
    assert not target.is_symlink()


def test_what_is_read_is_spared(tmp_path: Path) -> None:
    source, link, other = tmp_path / "source", tmp_path / "link", tmp_path / "other"
    source.write_bytes(b"source")
    link.symlink_to("source")
    other.hardlink_to(source)
    for path in (source, link, other):
        with pytest.raises(OutputError, match=f"{path.name}: is the source; choose another"):
            check_spares(path, [tmp_path / "missing", source], "is the source", "choose another")
    check_spares(tmp_path / "new", [source], "is the source", "choose another")
    check_spares(Path("/dev/null"), [Path("/dev/null")], "is the source", "choose another")
