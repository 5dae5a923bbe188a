"""Memory stays within bounds."""

import json
import subprocess
import sys

import vtray
from conftest import compiled_only
from examples import light, one_sphere, plane, scene, sphere
from vtray.memory import in_gigabytes

pytestmark = compiled_only


def run(script: str, *arguments: str) -> list[int]:
    """Run a script in a new process, and return the integers that it prints."""
    command = [sys.executable, "-W", "error", "-c", script, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
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
from vtray.memory import peak_memory
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
    numbers = run(script, json.dumps(document))
    rows = [numbers[k : k + 3] for k in range(3, 33, 3)]  # without the first render
    early, late = rows[:5], rows[5:]
    # The least of several: the allocator goes up and down by 2 MB. A film of this scene has 70 kB.
    assert min(row[0] for row in late) - min(row[0] for row in early) < 2_000_000
    assert late[-1][1:] == early[0][1:]


def test_peak_is_that_of_the_process_alone() -> None:
    script = """
import subprocess, sys
held = b"x" * 300_000_000
command = "from vtray.memory import peak_memory; print(peak_memory())"
print(subprocess.check_output([sys.executable, "-c", command], text=True))
"""
    (peak,) = run(script)
    assert 1_000_000 < peak < 100_000_000


def test_gigabytes_are_readable() -> None:
    assert in_gigabytes(0) == "0.0 GB"
    assert in_gigabytes(1_234_567_890_123) == "1,234.6 GB"
