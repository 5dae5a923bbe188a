"""What paths cost at equal error, beside Embree, Mitsuba and Cycles."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from peers.cycles import program as cycles
from peers.embree import program as embree
from peers.host import host
from peers.host.soft_scene import SoftScene, write_scene
from peers.mitsuba import program as mitsuba
from peers.peer import python_of_peers
from scenes.lamps import for_mitsuba, lamps, sky_scene
from timing import vtray_process
from timing.jobs import Job, Spread, run_interleaved, run_once

Floats = NDArray[np.floating]

SURFACES = 4
"""How many surfaces a path goes over at the most; from each, light comes from the sky."""
SAMPLES, MORE = 16, 64
"""How many samples all are timed with, and with how many more vtray is, too."""
PICTURES = 2
"""How many pictures with other random numbers tell the error."""
WHITE = 255.0


class Host(NamedTuple):
    """Another program, as one of ours renders with it.

    Attributes
    ----------
    is_installed
        Tells whether it is there.
    command
        Returns what is run, before the arguments that `cycles_paths.py` takes.
    write_scene
        Writes a scene as it reads it.
    """

    is_installed: Callable[[], object]
    command: Callable[[], list[str]]
    write_scene: Callable[[SoftScene, Path], None] = write_scene


HOSTS = {
    "Embree": Host(
        embree.version,
        lambda: [str(embree.program(embree.PATHS))],
        embree.write_paths_scene,
    ),
    "Embree, single rays": Host(
        embree.version,
        lambda: [str(embree.program(embree.PATHS)), "--single"],
        embree.write_paths_scene,
    ),
    mitsuba.PEER.name: Host(
        mitsuba.PEER.version,
        lambda: [python_of_peers(), str(mitsuba.SCRIPT.with_name("mitsuba_paths.py"))],
    ),
    cycles.NAME: Host(cycles.version, lambda: [cycles.python(), str(cycles.SCRIPT)]),
}


class PathsRow(NamedTuple):
    """One program with so many samples.

    Attributes
    ----------
    program
        Which one.
    samples
        How many a pixel.
    light
        The mean of the picture, 1 for the light of the sky.
    error
        The standard error of a channel: root of the mean square, in such light.
    tracing
        For numbers of threads, the seconds.
    """

    program: str
    samples: int
    light: float
    error: float
    tracing: dict[int, Spread]


@dataclass
class Paths:
    """All that is measured here.

    Attributes
    ----------
    cubes
        For each scene, all programs.
    conditions
        What else is to be known of a run; "" for one as all others.
    """

    cubes: dict[str, list[PathsRow]] = field(default_factory=dict)
    conditions: str = ""


def time_paths(
    count: int, side: int, threads: Sequence[int], folder: Path, repeats: int
) -> list[PathsRow]:
    """Time paths among so many spheres in a cube over a floor, by all that is installed."""
    scene = sky_scene(count, side)
    scene.render = scene.render.replace(integrator="path", depth=SURFACES - 1, filter="box")
    ours = folder / f"paths-{count}.json"
    scene.save(ours)
    hosts = {name: other for name, other in HOSTS.items() if other.is_installed()}
    given = for_mitsuba(scene, lamps()["sky"])
    for name, other in hosts.items():
        other.write_scene(given, _their_scene(folder, name))
    own = [(vtray_process.NAME, SAMPLES), (vtray_process.NAME, MORE)]
    timed = [*own, *((name, SAMPLES) for name in hosts)]
    jobs = {
        (name, samples, n): _their_job(name, folder, n)
        if name in hosts
        else _own_job(ours, samples, n)
        for name, samples in timed
        for n in threads
    }
    # The other picture; what is compiled for it is on disk afterwards.
    for _, samples in own:
        run_once(_own_job(ours, samples, threads[-1], seed=1))
    timings = run_interleaved(list(jobs.values()), repeats)
    rows = []
    for name, samples in timed:
        if name in hosts:
            pictures = np.load(_their_picture(folder, name))
        else:
            pictures = [_own_light(ours, samples, seed) for seed in range(PICTURES)]
        tracing = {n: timings[jobs[name, samples, n].name].inner for n in threads}
        rows.append(PathsRow(name, samples, *light_and_error(*pictures), tracing))
    return rows


def light_and_error(one: Floats, other: Floats) -> tuple[float, float]:
    """Return the mean of two pictures with other random numbers, and the error of one of them."""
    mean = float(np.mean((one, other), dtype=np.float64))
    return mean, math.sqrt(float(np.mean(np.square(one - other), dtype=np.float64)) / 2)


def _own_job(scene: Path, samples: int, threads: int, seed: int = 0) -> Job:
    picture = _own_picture(scene, samples, seed)
    command = vtray_process.command(scene, picture, threads)
    return Job(
        f"{picture.stem}, {threads}",
        [*command, "--samples", str(samples), "--seed", str(seed)],
        inner_seconds=vtray_process.trace_seconds,
    )


def _own_picture(scene: Path, samples: int, seed: int) -> Path:
    return scene.with_name(f"{scene.stem} {samples} {seed}.npz")


def _own_light(scene: Path, samples: int, seed: int) -> Floats:
    with np.load(_own_picture(scene, samples, seed)) as picture:
        light: Floats = picture["linear"] / WHITE
    return light


def _their_job(name: str, folder: Path, threads: int) -> Job:
    picture, numbers = _their_picture(folder, name), (SAMPLES, PICTURES, SURFACES)
    command = [*HOSTS[name].command(), str(threads), str(_their_scene(folder, name)), str(picture)]
    return Job(
        f"{picture.stem}, {threads}",
        [*command, *map(str, numbers)],
        inner_seconds=host.trace_seconds,
    )


def _their_scene(folder: Path, name: str) -> Path:
    return folder / f"paths, {name}.npz"


def _their_picture(folder: Path, name: str) -> Path:
    return folder / f"paths, {name}.npy"
