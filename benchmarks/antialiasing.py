"""What samples cost: vtray with more and more rays for the pixels that need them."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import vtray_process
from measure import Job, Timing, run_interleaved
from tables import ratio, table

SAMPLES = (1, 4, 16, 64)

NOTE = """\
With the default filter, Blackman-Harris. ÷ says how many times as long as with one ray a pixel:
tracing alone, and the whole process from scene file to PNG."""


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


def samples_table(timings: Mapping[str, Timing], threads: Iterable[int]) -> str:
    """Write what samples took."""
    rows = []
    for count in threads:
        one = timings[job_name(1, count)]
        for samples in SAMPLES:
            found = timings[job_name(samples, count)]
            rows.append(
                (
                    str(samples),
                    str(count),
                    str(found.inner),
                    str(found.whole),
                    ratio(found.inner.median, one.inner.median),
                    ratio(found.whole.median, one.whole.median),
                )
            )
    headings = ("samples", "threads", "tracing", "whole process", "tracing ÷", "whole ÷")
    return table(headings, rows)
