"""Where compiled kernels are kept, for how long, and whose they must be."""

import os
import shutil
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from vtray.base.compiler import kernel_folder
from vtray.base.compiler.compiled import Kernel, was_compiled
from vtray.base.compiler.kernel_folder import MARK
from vtray.base.compiler.object_code import ObjectCode, read_object_code, write_object_code

needs_owners = pytest.mark.skipif(not hasattr(os, "geteuid"), reason="needs the owners of files")


@pytest.fixture(autouse=True)
def forgotten() -> Iterator[None]:
    """Let each test find the folder anew, and warn anew."""
    kernel_folder.cache_folder.cache_clear()
    kernel_folder._warned.clear()
    yield
    kernel_folder.cache_folder.cache_clear()
    kernel_folder._warned.clear()


@pytest.mark.parametrize("variable", ["VTRAY_CACHE_DIR", "XDG_CACHE_HOME"])
def test_without_a_writable_home(variable: str, tmp_path: Path) -> None:
    environment = {"VTRAY_CACHE_DIR": "", "TMPDIR": str(tmp_path), variable: "/proc/nowhere"}
    script = "from vtray.base.compiler.kernel_folder import cache_folder; print(cache_folder())"
    done = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    if variable == "VTRAY_CACHE_DIR":  # what was asked for cannot be had: nothing is kept
        assert done.stdout == "None\n"
        assert "/proc/nowhere cannot be written to" in done.stderr
    else:
        assert done.stdout.startswith(str(tmp_path))
        assert done.stderr == ""


@needs_owners
@pytest.mark.parametrize("is_old", [False, True])
def test_user_whom_the_system_does_not_know(
    is_old: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unknown(user: int) -> None:
        raise KeyError(user)

    for name in ("VTRAY_CACHE_DIR", "XDG_CACHE_HOME", "HOME"):  # as in some containers
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("pwd.getpwuid", unknown)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    if is_old:
        monkeypatch.setattr("platformdirs.user_cache_path", Path("~/.cache").joinpath)
    folder = kernel_folder.cache_folder()
    assert folder is not None
    assert folder.parent == tmp_path / f"vtray-cache-{os.geteuid()}"
    assert list(tmp_path.iterdir()) == [folder.parent]


def test_folder_is_named_by_all_sources() -> None:
    folder = kernel_folder.cache_folder()
    assert folder is not None
    assert folder.name.startswith("kernels-")


def test_an_edit_anywhere_in_the_package_is_noticed(tmp_path: Path) -> None:
    package = tmp_path / "vtray"
    inner = package / "geometry" / "shapes"
    inner.mkdir(parents=True)
    (package / "a.py").write_text("a = 1")
    (inner / "b.py").write_text("b = 1")
    hashes = [kernel_folder._source_hash(package)]
    (inner / "b.py").write_text("b = 2")
    hashes.append(kernel_folder._source_hash(package))
    (inner / "b.py").rename(package / "b.py")
    hashes.append(kernel_folder._source_hash(package))
    assert len(set(hashes)) == 3
    (inner / "b.pyc").write_bytes(b"no source")
    assert kernel_folder._source_hash(package) == hashes[-1]


def test_what_is_made_is_private(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path / "home"))
    mask = os.umask(0o002)  # as many systems have it
    try:
        folder = kernel_folder.cache_folder()
        assert folder is not None
        write_object_code(folder / "some.kernel", ObjectCode("f", "f8", b""))
    finally:
        os.umask(mask)
    for path in (folder.parent, folder, folder / MARK, folder / "some.kernel"):
        assert path.stat().st_mode & 0o077 == 0
    assert read_object_code(folder / "some.kernel") is not None


def test_old_versions_are_deleted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kernel = "vtray.transport.film.f-0123456789abcdef.kernel"
    make_folder(tmp_path / "kernels-new", 29, MARK, kernel)
    make_folder(tmp_path / "kernels-old", 31, MARK, kernel, f"{kernel}.unfinished")
    make_folder(tmp_path / "other-old", 31, MARK, kernel)
    monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path))
    folder = kernel_folder.cache_folder()
    assert folder is not None
    assert {path.name for path in tmp_path.iterdir()} == {"kernels-new", "other-old", folder.name}


def test_nothing_but_vtrays_own_is_deleted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kernel = "vtray.transport.film.f-0123456789abcdef.kernel"
    make_folder(tmp_path / "kernels-unmarked", 31, kernel)
    make_folder(tmp_path / "kernels-marked by another", 31, kernel)
    (tmp_path / "kernels-marked by another" / MARK).write_text("Signature: another")
    mixed = make_folder(tmp_path / "kernels-mixed", 31, MARK, kernel, "thesis.txt", "my.kernel")
    make_folder(mixed / "vtray.folder-0123456789abcdef.kernel", 31, "inside")
    elsewhere = make_folder(tmp_path / "elsewhere", 31, MARK, kernel)
    (tmp_path / "kernels-link").symlink_to(elsewhere)
    age(elsewhere, 31)
    age(mixed, 31)
    before = sorted(tmp_path.rglob("*"))
    monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path))
    folder = kernel_folder.cache_folder()
    assert folder is not None
    after = [path for path in sorted(tmp_path.rglob("*")) if folder not in (path, path.parent)]
    assert [path for path in before if path not in after] == [mixed / kernel]


def test_folder_that_is_deleted_meanwhile_is_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path / "home"))
    folder = kernel_folder.cache_folder()
    assert folder is not None
    kernel, code = folder / "some.kernel", ObjectCode("f", "f8", b"")
    shutil.rmtree(folder.parent)
    assert not was_compiled(Kernel(lambda: None))
    assert read_object_code(kernel) is None
    write_object_code(kernel, code)
    assert read_object_code(kernel) == code
    assert (folder / MARK).exists()


def make_folder(folder: Path, days: int, *names: str) -> Path:
    """Make a folder of files as old as that, and as vtray would mark it."""
    folder.mkdir()
    for name in names:
        (folder / name).write_bytes(kernel_folder._MARK if name == MARK else b"")
    age(folder, days)
    return folder


def age(folder: Path, days: int) -> None:
    """Let a folder be as old as that."""
    then = time.time() - days * 24 * 3600
    os.utime(folder, (then, then))


def belong_to_another(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let one file or folder belong to another user; nobody but root could really do so."""
    file, fstat = path.stat(), os.fstat

    def found(descriptor: int) -> os.stat_result:
        seen = fstat(descriptor)
        if not os.path.samestat(seen, file):
            return seen
        return os.stat_result([*seen[:4], seen.st_uid + 1, *seen[5:]])

    monkeypatch.setattr(os, "fstat", found)


def turn(path: Path, _: object) -> None:
    """Put a link in the place of a file or a folder."""
    path.rename(path.with_name("moved"))
    path.symlink_to("moved")


FAULTS: dict[str, Callable[[Path, pytest.MonkeyPatch], object]] = {
    "may be written to by others": lambda path, _: path.chmod(0o777),
    "may be written to by others ": lambda path, _: path.chmod(0o720),
    "belongs to another user": belong_to_another,
    "is a link": turn,
}


@needs_owners
@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("home", ["chosen", "user", "temporary"])
@pytest.mark.parametrize("part", ["home", "folder", "kernel"])
def test_what_others_may_have_made_is_not_used(
    part: str, home: str, fault: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if home == "chosen":
        monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path / "chosen"))
    else:
        monkeypatch.delenv("VTRAY_CACHE_DIR", raising=False)
        user = tmp_path / "user" if home == "user" else Path("/proc/nowhere")
        monkeypatch.setattr(kernel_folder, "_user_home", lambda: user)
        monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    folder = kernel_folder.cache_folder()
    assert folder is not None
    kernel, code = folder / "some.kernel", ObjectCode("f", "f8", b"")
    write_object_code(kernel, code)
    assert read_object_code(kernel) == code

    kernel_folder.cache_folder.cache_clear()
    path = {"home": folder.parent, "folder": folder, "kernel": kernel}[part]
    FAULTS[fault](path, monkeypatch)
    with warnings.catch_warnings(record=True, action="always") as warned:
        again = kernel_folder.cache_folder()
        assert read_object_code(kernel) is None
    assert [str(one.message).startswith(f"{path} {fault.strip()}") for one in warned] == [True]
    if part == "kernel":
        assert again == folder
    elif home == "user":
        assert again is not None
        assert again.parent == tmp_path / f"vtray-cache-{os.geteuid()}"
    else:
        assert again is None


@needs_owners
def test_file_in_place_of_a_folder_is_not_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path / "file"))
    with pytest.warns(UserWarning, match="file is no folder, so compiled kernels are not kept"):
        assert kernel_folder.cache_folder() is None


@needs_owners
def test_parents_may_be_shared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tmp_path.chmod(0o777)
    (tmp_path / "link").symlink_to(tmp_path)
    monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path / "link" / "home"))
    folder = kernel_folder.cache_folder()
    assert folder is not None
    write_object_code(folder / "some.kernel", ObjectCode("f", "f8", b""))
    assert read_object_code(folder / "some.kernel") is not None
