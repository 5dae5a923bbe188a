"""Mirrors and glass beside POV-Ray's, pixel by pixel in linear light, and what both take."""

import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import vtray as vt
from peers.povray import mirrors, program
from peers.povray.mirrors import Rules
from peers.programs import is_installed
from scenes.mirror_and_glass import make_scene
from timing import vtray_process
from timing.jobs import Job, Timing, run_interleaved

DEPTH = 8
STEP = 1 / 255
RULES = {
    "with vtray's rules": Rules(full_shadows=True, floor_ends=True),
    "where its glass lets light through": Rules(full_shadows=False, floor_ends=True),
    "where its floor goes on behind the eye": Rules(full_shadows=True, floor_ends=False),
}
"""What POV-Ray is asked for."""


class Apart(NamedTuple):
    """How far two pictures are apart, 1 for white.

    Attributes
    ----------
    mean, largest
        The mean difference of the channels, and the largest.
    share
        The share of pixels with a channel that is off by more than a step of 255.
    """

    mean: float
    largest: float
    share: float


@dataclass
class Whitted:
    """All that is measured here.

    Attributes
    ----------
    side
        That of the picture in pixels.
    apart
        For each of the rules, how far POV-Ray's picture is from vtray's; empty without POV-Ray.
    timings
        For each program, its times for numbers of threads.
    conditions
        What else is to be known of a run; "" for one as all others.
    """

    side: int
    apart: dict[str, Apart] = field(default_factory=dict)
    timings: dict[str, dict[int, Timing]] = field(default_factory=dict)
    conditions: str = ""


def measure_whitted(side: int, threads: Sequence[int], folder: Path, repeats: int) -> Whitted:
    """Compare the pictures, and time what makes them; files go into the folder."""
    scene = make_scene(side)
    scene.render = vt.RenderSettings(integrator="whitted", depth=DEPTH, exposure=1)
    scene.save(folder / "whitted.json")
    found = Whitted(side)
    is_there = is_installed(program.PEER)
    if is_there:
        light = vt.render(scene).linear / 255
        for name, rules in RULES.items():
            found.apart[name] = apart(light, povray_light(scene, rules, folder))
        mirrors.write_scene(scene, folder / "timed.pov", DEPTH, next(iter(RULES.values())))
    jobs = {
        (name, count): job
        for count in threads
        for name, job in _jobs(folder, side, count).items()
        if is_there or name == vtray_process.NAME
    }
    timings = run_interleaved(list(jobs.values()), repeats)
    for (name, count), job in jobs.items():
        found.timings.setdefault(name, {})[count] = timings[job.name]
    return found


def povray_light(scene: vt.Scene, rules: Rules, folder: Path) -> NDArray[np.float64]:
    """Return the light of POV-Ray's picture."""
    path, picture, side = folder / "mirrors.pov", folder / "mirrors.ppm", int(scene.camera.size[0])
    mirrors.write_scene(scene, path, DEPTH, rules)
    command = mirrors.fine_command(path, picture, side)
    subprocess.run(command, check=True, capture_output=True)
    return mirrors.read_fine(picture, side)


def apart(ours: NDArray[np.float64], theirs: NDArray[np.float64]) -> Apart:
    """Return how far two pictures are apart."""
    off = np.abs(theirs - ours)
    share = (off.max(axis=2) > STEP).mean()
    return Apart(float(off.mean()), float(off.max()), float(share))


def _jobs(folder: Path, side: int, threads: int) -> Mapping[str, Job]:
    """Return what makes a PNG with so many threads, by the name of the program."""
    ours, theirs = (folder / f"{name}-whitted-{threads}.png" for name in ("ours", "theirs"))
    own = vtray_process.command(folder / "whitted.json", ours, threads)
    other = program.command(folder / "timed.pov", theirs, threads, (side, side))
    return {
        vtray_process.NAME: Job(f"ours-{threads}", own, vtray_process.trace_seconds),
        program.PEER.name: Job(f"theirs-{threads}", other, program.trace_seconds),
    }
