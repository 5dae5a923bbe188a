"""What a run of the benchmarks has measured, and keeping it on disk."""

import json
from dataclasses import dataclass, field
from pathlib import Path

import msgspec

from measures.from_arrays import ArraysRow
from measures.movies import MovieRow
from measures.own_scenes import ByThreads
from measures.paths import Paths
from measures.rendering import Row
from measures.soft_light import SoftLight
from measures.whitted import Whitted
from timing.jobs import Timing


@dataclass
class Results:
    """All that a run has measured.

    Attributes
    ----------
    machine
        Name and value of all that bears on the numbers.
    repeats
        How often each process ran.
    startup
        What costs the same for every scene.
    scenes
        For each scene, by what it is, the times of all renderers.
    threads
        For numbers of threads, vtray's times for the first scene.
    cube
        As `scenes`, for a cube of many spheres.
    cube_threads
        As `threads`, for this cube.
    scaling
        For numbers of spheres in the cube, the times of all renderers with one thread.
    samples
        For numbers of samples and of threads, vtray's times for this cube.
    soft_light
        Whether soft light is right, and what it costs; None if that was not measured.
    whitted
        Whether mirrors and glass are right, and what they cost; None if that was not measured.
    paths
        What paths cost, and how noisy they are; None if that was not measured.
    arrays
        As `cube`, from arrays in memory to a PNG.
    bonds
        For a ball-and-stick model without and with bonds, vtray's times for numbers of threads.
    copies
        As `bonds`, for spheres at one place and at many.
    movies
        For each movie, what a frame takes.
    """

    machine: dict[str, str]
    repeats: int
    startup: dict[str, Timing] = field(default_factory=dict)
    scenes: dict[str, list[Row]] = field(default_factory=dict)
    threads: dict[int, Timing] = field(default_factory=dict)
    cube: dict[str, list[Row]] = field(default_factory=dict)
    cube_threads: dict[int, Timing] = field(default_factory=dict)
    scaling: dict[int, list[Row]] = field(default_factory=dict)
    samples: dict[str, Timing] = field(default_factory=dict)
    soft_light: SoftLight | None = None
    whitted: Whitted | None = None
    paths: Paths | None = None
    arrays: dict[str, list[ArraysRow]] = field(default_factory=dict)
    bonds: dict[str, ByThreads] = field(default_factory=dict)
    copies: dict[str, ByThreads] = field(default_factory=dict)
    movies: dict[str, list[MovieRow]] = field(default_factory=dict)


def save_results(results: Results, path: Path) -> None:
    """Write results to a file."""
    # The module json writes NaN, which stands for what a program does not tell.
    parts = msgspec.to_builtins(results, str_keys=True).items()
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(part)}" for name, part in parts)
    path.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")


def load_results(path: Path) -> Results:
    """Read results from a file."""
    data = json.loads(path.read_text(encoding="utf-8"))
    return msgspec.convert(data, Results, str_keys=True)
