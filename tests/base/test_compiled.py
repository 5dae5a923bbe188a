"""Compiled kernels are kept, found again, and replaced when they do not fit."""

import hashlib
import importlib
import os
import shutil
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from conftest import compiled_only
from vtray.base.compiler import compiled, kernel_folder

pytestmark = compiled_only

# The kernel that compiles the fastest.
EXPOSE = """
import numpy as np
from vtray.base.compiler.compiled import loading_seconds
from vtray.image.exposure import develop
pixels = develop(np.full((2, 3, 3), 0.5), 1.0, "black", lambda: None)
assert (pixels == 127).all()
print(loading_seconds())
"""

# One that calls functions of other modules.
MEASURE = """
import numpy as np
from vtray.base.compiler.compiled import loading_seconds
from vtray.geometry.bvh.nodes import find_extent
assert find_extent(np.ones((6, 2)), 2).low == (1, 1, 1)
print(loading_seconds())
"""

# A process forks while another thread of it compiles; what the child does would never end.
FORK = """
import os, signal, threading, time
import numpy as np
from llvmlite.binding.ffi import lib
from numba.core.compiler_lock import global_compiler_lock
from vtray.base.compiler import compiled, helpers
from vtray.image.exposure import develop

is_at_work = threading.Event()

def work():
    helpers.ask("some part", b"", print)
    with {lock}:
        is_at_work.set()
        time.sleep(0.5)
        ended.append(True)

def expose():
    return develop(np.full((2, 3, 3), 0.5), 1.0, "black", lambda: None)

ended = []
helpers.MOST, helpers._hand_over = 1, lambda *_: time.sleep(60)
helpers.available_cores = lambda: 2
threading.Thread(target=work).start()
is_at_work.wait()
while not helpers.is_at_work_on("some part"):
    time.sleep(0.01)
child = os.fork()
if not child:
    signal.alarm(60)
    assert not helpers.is_at_work_on("some part")
    assert (expose() == 127).all()
    with global_compiler_lock, lib._lock:
        os._exit(0)
assert ended
assert os.waitpid(child, 0)[1] == 0
assert (expose() == 127).all()
assert helpers.is_at_work_on("some part")
os._exit(0)
"""


def start(
    package: Path | None, script: str = EXPOSE, **environment: str
) -> "subprocess.Popen[str]":
    """Start a process that uses a kernel and prints the seconds of compiling."""
    extra = {"PYTHONPATH": str(package)} if package else {}
    return subprocess.Popen(
        [sys.executable, "-c", script],
        env={**os.environ, **extra, **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def finish(process: "subprocess.Popen[str]") -> float:
    """Return the seconds of compiling of a process that must succeed in silence."""
    out, err = process.communicate(timeout=300)
    assert (process.returncode, err) == (0, "")
    return float(out)


def test_compiled_once_and_found_again_by_two_at_once(tmp_path: Path) -> None:
    cache = {"VTRAY_CACHE_DIR": str(tmp_path)}
    both = [start(None, **cache), start(None, **cache)]
    first = max(finish(process) for process in both)
    files = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.kernel")}
    again = finish(start(None, **cache))
    assert again < first / 5
    assert files == {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.kernel")}

    # A damaged file is compiled again, not trusted and not a crash.
    for path in files:
        path.write_bytes(b"damaged")
    assert finish(start(None, **cache)) > again * 5
    assert finish(start(None, **cache)) < first / 5

    # So is one that others may have written.
    path.chmod(0o666)
    out, err = start(None, **cache).communicate(timeout=300)
    assert float(out) > again * 5
    assert err.count("Warning") == 1
    assert f"{path} may be written to by others, so this kernel is compiled anew" in err
    assert finish(start(None, **cache)) < first / 5


def test_change_in_any_source_is_noticed(tmp_path: Path) -> None:
    package = tmp_path / "site"
    sources, no_bytecode = Path(kernel_folder.__file__).parents[2], "__pycache__"
    shutil.copytree(sources, package / "vtray", ignore=shutil.ignore_patterns(no_bytecode))
    # Python itself would not notice an edit that leaves length and time as they were.
    cache = {"VTRAY_CACHE_DIR": str(tmp_path / "cache"), "PYTHONDONTWRITEBYTECODE": "1"}
    finish(start(package, MEASURE, **cache))
    vectors = package / "vtray" / "geometry" / "vector.py"
    times = vectors.stat()
    # The kernel calls this from another module; length and time stay as they were.
    text = vectors.read_text()
    lower = "min(a[0], b[0]), min(a[1], b[1]), min(a[2], b[2])"
    assert lower in text
    vectors.write_text(text.replace(lower, lower.replace("min", "max")))
    os.utime(vectors, ns=(times.st_atime_ns, times.st_mtime_ns))
    changed = start(package, MEASURE, **cache)
    _, err = changed.communicate(timeout=300)
    assert "AssertionError" in err  # nothing is larger than infinity


def test_picture_is_the_same_on_a_processor_without_wide_vectors(tmp_path: Path) -> None:
    scene = Path(__file__).parents[2] / "scenes" / "room.json"
    command = [Path(sys.executable).with_name("vtray"), "--size", "120x90", scene]
    plain = {"NUMBA_CPU_NAME": "generic", "VTRAY_CACHE_DIR": str(tmp_path / "cache")}
    subprocess.run([*command, tmp_path / "this.png"], check=True)
    subprocess.run([*command, tmp_path / "plain.png"], env={**os.environ, **plain}, check=True)
    assert (tmp_path / "this.png").read_bytes() == (tmp_path / "plain.png").read_bytes()


@pytest.mark.parametrize("library", ["math", "polars"])  # Polars handles the signal, too
def test_interrupt_does_not_wait_for_the_compiler(
    library: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    importlib.import_module(library)
    ended = threading.Event()

    def long_work_in_c(*_: object) -> None:
        hashlib.pbkdf2_hmac("sha256", b"", b"", 4_000_000)
        ended.set()

    monkeypatch.setattr("vtray.base.compiler.compiled.compile_object", long_work_in_c)
    threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        compiled.kernel(lambda value: value)(1.0)
    assert not ended.is_set()
    assert ended.wait(20)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs forks")
@pytest.mark.parametrize("lock", ["compiled._COMPILING", "global_compiler_lock", "lib._lock"])
def test_fork_waits_for_the_compiler(lock: str) -> None:
    process = start(None, FORK.format(lock=lock), PYTHONWARNINGS="ignore")
    _, err = process.communicate(timeout=120)
    assert (process.returncode, err) == (0, "")
