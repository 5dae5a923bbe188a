"""What samples cost: vtray with more and more rays for the pixels that need them."""

from collections.abc import Sequence
from pathlib import Path

from timing import vtray_process
from timing.jobs import Job, Timing, run_interleaved

SAMPLES = (1, 4, 16, 64)


def time_samples(scene: Path, threads: Sequence[int], repeats: int) -> dict[str, Timing]:
    """Time vtray on a scene file with numbers of samples and of threads, by `job_name`."""
    picture = scene.with_name("samples.png")
    jobs = [
        Job(
            job_name(samples, count),
            [*vtray_process.command(scene, picture, count), "--samples", str(samples)],
            inner_seconds=vtray_process.trace_seconds,
            phases=vtray_process.phases,
        )
        for count in threads
        for samples in SAMPLES
    ]
    return run_interleaved(jobs, repeats)


def job_name(samples: int, threads: int) -> str:
    """Return what a number of samples on a number of threads is called."""
    return f"{samples} samples, {threads} threads"
