"""Memory stays within bounds."""

import itertools
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from examples import light, one_sphere, plane, scene, sphere

import vtray
from conftest import compiled_only
from vtray.base import memory
from vtray.base.memory import readable

pytestmark = compiled_only


def run(script: str, *arguments: str, **environment: str) -> list[int]:
    """Run a script in a new process, and return the integers that it prints."""
    command = [sys.executable, "-W", "error", "-c", script, *arguments]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, env={**os.environ, **environment}
    )
    assert done.stderr == ""
    return [int(word) for word in done.stdout.split()]


def test_large_image_takes_at_most_twice_its_film(tmp_path) -> None:
    size, path = 4096, tmp_path / "scene.json"
    document = scene(
        [sphere((0, 0, 5), 3), plane((0, 5, 0), (0, -1, 0.2))],
        [light(5, -5, 0)],
        size=[size, size],
        resolution=[0.002, 0.002],
    )
    path.write_text(json.dumps(document))
    script = """
import sys, vtray
from vtray.base.memory import peak_memory
vtray.render(vtray.load(sys.argv[1]), threads=2).save(sys.argv[2])
print(peak_memory())
"""
    vtray.render(vtray.loads(json.dumps(one_sphere())))  # so that nothing is left to compile
    (peak,) = run(script, str(path), str(tmp_path / "picture.png"))
    film = size * size * 3 * 8
    assert film < peak < 2 * film


def test_any_count_of_threads_is_harmless() -> None:
    # Anything that is made for each thread asked for would not fit.
    script = """
import resource, sys
resource.setrlimit(resource.RLIMIT_AS, (6 * 10**9, 6 * 10**9))
import numpy as np, vtray
spheres = vtray.Spheres(np.random.default_rng(1).normal(size=(70_000, 3)), 0.01, (9, 9, 9), 1)
scene = vtray.loads(sys.argv[1])
scene.objects.append(spheres)
picture = vtray.render(scene, threads=10**9).pixels
print(int((picture != vtray.render(scene, threads=1).pixels).sum()))
"""
    assert run(script, json.dumps(one_sphere())) == [0]


def test_command_starts_no_threads_of_numpy(tmp_path: Path) -> None:
    # Where no more threads are allowed, NumPy's linear algebra would end the process.
    np.save(tmp_path / "c.npy", np.zeros((1, 3)))
    color = {"r": 1, "g": 2, "b": 3}
    spheres = {"type": "spheres", "data": "c.npy", "radius": 1, "color": color}
    (tmp_path / "scene.json").write_text(json.dumps({**one_sphere(), "objects": [spheres]}))
    script = """
import contextlib, io, os, sys
from vtray.commands import cli
with contextlib.redirect_stderr(io.StringIO()):
    print(cli.run([sys.argv[1], "picture.png"]))
import numpy
print(len(os.listdir("/proc/self/task")) if sys.platform == "linux" else 1)
"""
    assert run(script, str(tmp_path / "scene.json")) == [1, 1]


def test_thousand_renders_leak_nothing() -> None:
    document = one_sphere()
    script = """
import gc, sys, threading
import psutil, vtray
scene = vtray.loads(sys.argv[1])
process = psutil.Process()
for k in range(1001):
    vtray.render(scene, threads=2)
    if k % 100 == 0:
        gc.collect()
        print(process.memory_info().rss, process.num_fds(), threading.active_count())
"""
    # GNU's allocator keeps memory for each of some threads, a megabyte more now and then.
    numbers = run(script, json.dumps(document), MALLOC_ARENA_MAX="1")
    rows = [numbers[k : k + 3] for k in range(3, 33, 3)]  # without the first render
    early, late = rows[:5], rows[5:]
    # The least of several: the allocator goes up and down by 2 MB. A film of this scene has 70 kB.
    assert min(row[0] for row in late) - min(row[0] for row in early) < 2_000_000
    assert late[-1][1:] == early[0][1:]


def test_peak_is_that_of_the_process_alone() -> None:
    script = """
import subprocess, sys
held = b"x" * 300_000_000
command = "from vtray.base.memory import peak_memory; print(peak_memory())"
print(subprocess.check_output([sys.executable, "-c", command], text=True))
"""
    (peak,) = run(script)
    assert 1_000_000 < peak < 100_000_000


def test_sizes_are_readable() -> None:
    assert readable(0) == "0 MB"
    assert readable(23_456_789) == "23 MB"
    assert readable(1_234_567_890_123) == "1,234.6 GB"


def limited(scene_file: Path, option: str, *arguments: str) -> str:
    """Run the command with a limit of the shell's; return its error, which is one line."""
    shell = f'ulimit {option}; exec "$@"'
    exe = Path(sys.executable).with_name("vtray")
    picture = scene_file.with_name("picture.png")
    script = ["bash", "-c", shell, "bash", exe, *arguments, scene_file, picture]
    done = subprocess.run(script, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    return done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="needs limits of memory")
@pytest.mark.parametrize(
    ("option", "arguments", "message"),
    [
        (
            "-v 50000",
            [],
            r"vtray needs 3\d\d MB of memory, \d+ MB is available \(the limit of this ",
        ),
        ("-v 300000", [], r"vtray needs .* is 307 MB, ulimit -v\); expected more memory for this"),
        ("-d 50000", [], r"vtray needs .* is 51 MB, ulimit -d\); expected more memory"),
        (
            "-v 3000000",
            ["--size", "10000x10000"],
            r"camera.size: an image of 10000 x 10000 pixels needs 3.\d GB of memory, \d.\d GB is "
            r"available \(the limit of this process is 3.1 GB, ulimit -v\); expected a smaller",
        ),
        (
            "-v 3000000",
            ["--size", "5000x5000", "--bits", "16"],
            r"camera.size: an image of 5000 x 5000 pixels needs 3.\d GB of memory, ",
        ),
        (
            "-v 3000000",
            ["--size", "5000x5000", "--alpha"],
            r"camera.size: an image of 5000 x 5000 pixels needs 4.\d GB of memory, ",
        ),
    ],
)
def test_limits_of_the_process(
    option: str, arguments: list[str], message: str, tmp_path: Path
) -> None:
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(one_sphere()))
    assert re.match(f"Error: {message}", limited(path, option, *arguments))
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(sys.platform != "linux", reason="needs limits of memory")
def test_no_memory_to_compile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # LLVM would end the process.
    monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path / "none"))
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(one_sphere()))
    error = limited(path, "-v 500000")
    assert error.startswith("Error: compiling for this machine, only this once, needs ")


def test_limits_of_control_groups(tmp_path: Path) -> None:
    groups, root = tmp_path / "cgroup", tmp_path / "fs"
    two, one = root / "a" / "b", root / "memory" / "c"
    for folder, values in {
        two: {"memory.max": "max"},
        two.parent: {
            "memory.max": "900000000",
            "memory.current": "500000000",
            "memory.stat": "anon 5\nactive_file 20000000\ninactive_file 80000000",
        },
        one: {"memory.limit_in_bytes": str(2**63 - 4096)},
        root / "memory": {
            "memory.limit_in_bytes": "100000000",
            "memory.usage_in_bytes": "90000000",
            "memory.stat": "total_active_file 1\ntotal_inactive_file 2\ninactive_file 9999",
        },
    }.items():
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in values.items():
            (folder / name).write_text(f"{text}\n")
    groups.write_text("9:cpu:/x\n4:memory:/c\n0::/a/b\n")
    assert [str(limit) for limit in memory._limits_of_groups(groups, root)] == [
        "10 MB is available (the limit of its control group is 100 MB)",
        "500 MB is available (the limit of its control group is 900 MB)",
    ]
    # Within a container the path may be one that only the machine knows.
    groups.write_text("4:memory:/../../machine/c\n")
    assert len(list(memory._limits_of_groups(groups, root))) == 1
    assert list(memory._limits_of_groups(tmp_path / "none", root)) == []


def raised(*chain: Exception) -> Exception:
    """Return the last of errors, each of which led to the next."""
    for cause, error in itertools.pairwise(chain):
        error.__cause__ = cause
    return chain[-1]


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (MemoryError(), "out of memory: "),
        (MemoryError("Unable to allocate 2 GiB"), "out of memory (unable to allocate 2 GiB): "),
        (ImportError("libx.so: failed to map segment from shared object"), "out of memory: "),
        (raised(OSError(12, "Cannot allocate memory"), ImportError("PLEASE")), "out of memory: "),
        (ImportError("libx.so: cannot open shared object file"), None),
        (OSError(28, "No space left on device"), None),
        (raised(KeyError("a"), ValueError("b")), None),
    ],
)
def test_a_lack_of_memory_is_told_from_other_errors(error: Exception, words: str | None) -> None:
    said = memory.why_out_of_memory(error)
    assert (said is None) == (words is None)
    if words:
        assert said.startswith(words)
        assert said.endswith(
            "; expected a smaller picture or scene, or more memory for this process"
        )
