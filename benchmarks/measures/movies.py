"""How many frames a second become a movie: vtray with threads and with processes, and OVITO."""

import sys
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from peers.ovito import program as ovito
from peers.peer import python_of_peers
from peers.programs import is_installed
from timing import vtray_process
from timing.jobs import Job, Spread, run_once, seconds_after

BENCHMARKS = Path(__file__).resolve().parents[1]
THREADS = 2
PROCESSES = 4
FEWER = 10
"""OVITO makes one frame in so many: each takes as long."""


class MovieRow(NamedTuple):
    """One program.

    Attributes
    ----------
    program
        Which one.
    frames
        How many frames it made.
    seconds
        For a frame.
    of_cores
        The same, added up over all cores.
    """

    program: str
    frames: int
    seconds: Spread
    of_cores: Spread


def time_movies(count: int, frames: int, side: int, folder: Path, repeats: int) -> list[MovieRow]:
    """Time movies of so many balls."""
    ours = [sys.executable, str(BENCHMARKS / "measures" / "movie_vtray.py")]
    theirs = [python_of_peers(), str(BENCHMARKS / "peers" / "ovito" / "movie_ovito.py")]
    runs = [(vtray_process.NAME, ours, frames, [])]
    if find_spec("distributed"):
        name = f"{vtray_process.NAME}, {PROCESSES} processes of a Dask cluster"
        runs.append((name, ours, frames, [str(PROCESSES)]))
    if is_installed(ovito.TACHYON):
        runs.append((ovito.TACHYON.name, theirs, max(frames // FEWER, 2), []))
    rows = []
    for name, script, times, more in runs:
        movie = folder / "movie.mp4"
        given = [str(count), str(times), str(side), str(THREADS), str(movie), *more]
        job = Job(name, [*script, *given])
        outputs = [run_once(job).output for _ in range(repeats)]
        movie.unlink()
        spreads = [
            Spread(tuple(seconds_after(rf"^{word} +([0-9.]+) s$", out) / times for out in outputs))
            for word in ("movie", "cores")
        ]
        rows.append(MovieRow(name, times, *spreads))
    return rows
