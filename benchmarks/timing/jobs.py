"""Running processes and timing them."""

import json
import math
import re
import statistics
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

LAUNCHER = Path(__file__).with_name("launch.py")
NOT_SAID = math.nan


class Phases(NamedTuple):
    """The seconds of the parts of a render, as a program reports them; NaN if it does not.

    Attributes
    ----------
    load
        Reading the scene.
    build
        Making what finds hits fast.
    trace
        Tracing rays.
    """

    load: float = NOT_SAID
    build: float = NOT_SAID
    trace: float = NOT_SAID


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
    phases
        Finds all parts of a render in what the process prints.
    """

    name: str
    command: Sequence[str]
    inner_seconds: Callable[[str], float] = field(default=lambda _: math.nan)
    status: int = 0
    environment: Mapping[str, str] | None = None
    phases: Callable[[str], Phases] = field(default=lambda _: Phases())


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
    """What several runs of a job took.

    Attributes
    ----------
    whole
        The whole process.
    inner
        The part of it that it reports.
    load, build
        Two more parts of it that it reports.
    memory
        The most memory that it had, in bytes, the median of all runs.
    """

    whole: Spread
    inner: Spread
    load: Spread = Spread((NOT_SAID,))
    build: Spread = Spread((NOT_SAID,))
    memory: float = NOT_SAID


class Run(NamedTuple):
    """What one run of a job took: as `Timing`, each part once; and all that it printed."""

    whole: float
    inner: float
    phases: Phases
    memory: float
    output: str


def run_interleaved(jobs: Sequence[Job], repeats: int) -> dict[str, Timing]:
    """Run all jobs in turn, several times over, so that a slow minute hits all of them alike."""
    rounds = [{job.name: run_once(job) for job in jobs} for _ in range(repeats)]
    return {job.name: _timing([runs[job.name] for runs in rounds]) for job in jobs}


def run_once(job: Job) -> Run:
    """Run a job."""
    launcher = [sys.executable, "-I", "-S", str(LAUNCHER)]
    process = subprocess.run(
        [*launcher, *job.command], stdout=subprocess.PIPE, env=job.environment, check=True
    )
    found = json.loads(process.stdout)
    output = found["output"]
    if found["status"] != job.status:
        sys.exit(f"{' '.join(job.command)}\nended with {found['status']}:\n{output[-2000:]}")
    inner, phases = job.inner_seconds(output), job.phases(output)
    return Run(found["seconds"], inner, phases, found["memory"], output)


def seconds_after(pattern: str, output: str) -> float:
    """Return the number that the group of a pattern finds in what a program printed, or NaN."""
    found = re.search(pattern, output, re.MULTILINE)
    return float(found[1]) if found else NOT_SAID


def _timing(runs: Sequence[Run]) -> Timing:
    return Timing(
        whole=Spread(tuple(run.whole for run in runs)),
        inner=Spread(tuple(run.inner for run in runs)),
        load=Spread(tuple(run.phases.load for run in runs)),
        build=Spread(tuple(run.phases.build for run in runs)),
        memory=statistics.median(run.memory for run in runs),
    )


def in_seconds(value: float) -> str:
    """Write seconds, with three digits where they mean something."""
    if math.isnan(value):
        return "-"
    decimals = 2 if value >= 1 else 3 if value >= 0.1 else 4
    return f"{value:.{decimals}f}"
