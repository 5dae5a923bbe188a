"""Where compiled kernels are kept, and for how long."""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from vtray import kernel_folder


@pytest.fixture(autouse=True)
def forgotten() -> Iterator[None]:
    """Let each test find the folder anew."""
    kernel_folder.cache_folder.cache_clear()
    yield
    kernel_folder.cache_folder.cache_clear()


@pytest.mark.parametrize("variable", ["VTRAY_CACHE_DIR", "XDG_CACHE_HOME"])
def test_without_a_writable_home(variable: str, tmp_path: Path) -> None:
    environment = {"VTRAY_CACHE_DIR": "", "TMPDIR": str(tmp_path), variable: "/proc/nowhere"}
    script = "from vtray.kernel_folder import cache_folder; print(cache_folder())"
    done = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    if variable == "VTRAY_CACHE_DIR":  # what was asked for cannot be had: nothing is kept
        assert done.stdout == "None\n"
    else:
        assert done.stdout.startswith(str(tmp_path))


def test_folder_is_named_by_all_sources() -> None:
    folder = kernel_folder.cache_folder()
    assert folder is not None
    assert folder.name.startswith("kernels-")
    assert kernel_folder.is_compiled() == any(folder.rglob("*.kernel"))


def test_nothing_is_compiled_in_a_new_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path))
    assert not kernel_folder.is_compiled()
    folder = kernel_folder.cache_folder()
    assert folder is not None
    assert folder.stat().st_mode & 0o077 == 0
    (folder / "some.kernel").touch()
    assert kernel_folder.is_compiled()


def test_old_versions_are_deleted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path))
    for name, days in {"kernels-new": 29, "kernels-old": 31, "other-old": 31}.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / "some.kernel").touch()
        then = time.time() - days * 24 * 3600
        os.utime(tmp_path / name, (then, then))
    folder = kernel_folder.cache_folder()
    assert folder is not None
    assert {path.name for path in tmp_path.iterdir()} == {"kernels-new", "other-old", folder.name}


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="needs the owners of files")
@pytest.mark.parametrize(
    "prepare",
    [
        lambda home: home.mkdir() or home.chmod(0o777),
        lambda home: home.mkdir() or home.chmod(0o720),
        lambda home: home.touch(),
        lambda home: home.symlink_to(home.parent, target_is_directory=True),
    ],
)
def test_temporary_folder_of_others_is_not_trusted(
    prepare: Callable[[Path], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kernel_folder, "_user_home", lambda: Path("/proc/nowhere"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.delenv("VTRAY_CACHE_DIR", raising=False)
    home = tmp_path / f"vtray-cache-{os.getuid()}"
    prepare(home)
    assert kernel_folder.cache_folder() is None


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="needs the owners of files")
def test_temporary_folder_of_another_owner_is_not_trusted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kernel_folder, "_user_home", lambda: Path("/proc/nowhere"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.delenv("VTRAY_CACHE_DIR", raising=False)
    assert kernel_folder.cache_folder() is not None
    kernel_folder.cache_folder.cache_clear()
    # The folder keeps its name, and belongs to somebody else now.
    name = f"vtray-cache-{os.getuid()}"
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    (tmp_path / name).rename(tmp_path / "vtray-cache-12345")
    assert kernel_folder.cache_folder() is None
