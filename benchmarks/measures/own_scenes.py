"""How long vtray takes for several scenes, of which the first is what others are compared with."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from timing import vtray_process
from timing.jobs import Job, Timing, run_interleaved, run_once

ByThreads = dict[int, Timing]


def time_own_scenes(
    scenes: Mapping[str, Path], threads: Sequence[int], repeats: int
) -> dict[str, ByThreads]:
    """Time vtray on scene files, by what these are, with numbers of threads."""
    jobs = {
        (name, count): _job(name, path, count) for name, path in scenes.items() for count in threads
    }
    # What is compiled for the first picture is on disk afterwards.
    for name in scenes:
        run_once(jobs[name, threads[0]])
    timings = run_interleaved(list(jobs.values()), repeats)
    return {name: {count: timings[jobs[name, count].name] for count in threads} for name in scenes}


def _job(name: str, scene: Path, threads: int) -> Job:
    return Job(
        f"{name}, {threads} threads",
        vtray_process.command(scene, scene.with_suffix(".png"), threads),
        inner_seconds=vtray_process.trace_seconds,
        phases=vtray_process.phases,
    )
