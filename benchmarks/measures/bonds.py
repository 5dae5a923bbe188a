"""What bonds cost: vtray with the atoms of a ball-and-stick model alone, and with their bonds."""

from collections.abc import Sequence
from pathlib import Path

import vtray
from scenes.ball_and_stick import make_scenes, write_scenes
from timing import vtray_process
from timing.jobs import Job, Timing, run_interleaved


def time_bonds(count: int, threads: Sequence[int], folder: Path, repeats: int) -> dict[str, Timing]:
    """Time vtray on both scenes with numbers of threads, by `job_name`."""
    # What is compiled for the first picture is on disk afterwards.
    for scene in make_scenes(1000, 8).values():
        vtray.render(scene)
    scenes = write_scenes(count, folder)
    jobs = [
        Job(
            job_name(name, number),
            vtray_process.command(path, path.with_suffix(".png"), number),
            inner_seconds=vtray_process.trace_seconds,
            phases=vtray_process.phases,
        )
        for number in threads
        for name, path in scenes.items()
    ]
    return run_interleaved(jobs, repeats)


def job_name(scene: str, threads: int) -> str:
    """Return what a scene on a number of threads is called."""
    return f"{scene}, {threads} threads"
