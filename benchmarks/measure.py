"""Running processes and timing them."""

import math
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Job:
    """A process to be timed.

    Attributes
    ----------
    name
        What the results call it; one of a kind among jobs that run together.
    command
        The program and its arguments.
    inner_seconds
        Finds, in what the process prints, how long a part of its work took.
    status
        The exit status that it must end with.
    environment
        All its environment variables; None for those of this process.
    """

    name: str
    command: Sequence[str]
    inner_seconds: Callable[[str], float] = field(default=lambda _: math.nan)
    status: int = 0
    environment: Mapping[str, str] | None = None


@dataclass(frozen=True)
class Spread:
    """The seconds that several runs took."""

    seconds: tuple[float, ...]

    @property
    def median(self) -> float:
        """The median."""
        return statistics.median(self.seconds)

    def __str__(self) -> str:
        """Write median, least and most: ``0.38 (0.37-0.41)``."""
        if math.isnan(self.median):
            return "-"
        shown = in_seconds(self.median)
        if len(self.seconds) == 1:
            return shown
        return f"{shown} ({in_seconds(min(self.seconds))}-{in_seconds(max(self.seconds))})"


@dataclass(frozen=True)
class Timing:
    """What several runs of a job took: the whole process, and the part of it that it reports."""

    whole: Spread
    inner: Spread


def run_interleaved(jobs: Sequence[Job], repeats: int) -> dict[str, Timing]:
    """Run all jobs in turn, several times over, so that a slow minute hits all of them alike."""
    rounds = [{job.name: run_once(job) for job in jobs} for _ in range(repeats)]
    return {
        job.name: Timing(
            Spread(tuple(results[job.name][0] for results in rounds)),
            Spread(tuple(results[job.name][1] for results in rounds)),
        )
        for job in jobs
    }


def run_once(job: Job) -> tuple[float, float]:
    """Run a job; return the seconds of the whole process and of the part that it reports."""
    start = time.perf_counter()
    process = subprocess.run(
        job.command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env=job.environment,
        check=False,
    )
    seconds = time.perf_counter() - start
    output = process.stdout.decode(errors="replace")
    if process.returncode != job.status:
        sys.exit(f"{' '.join(job.command)}\nended with {process.returncode}:\n{output[-2000:]}")
    return seconds, job.inner_seconds(output)


def in_seconds(value: float) -> str:
    """Write seconds, with three digits where they mean something."""
    decimals = 2 if value >= 1 else 3 if value >= 0.1 else 4
    return f"{value:.{decimals}f}"
