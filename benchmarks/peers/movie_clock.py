"""A movie of balls that move, from arrays to an .mp4: what the programs that are timed share.

    python measures/movie_vtray.py COUNT FRAMES SIDE THREADS OUTPUT [PROCESSES]

Such a script makes a short movie first, so that all is loaded and compiled, and then the whole one.
The seconds of that, and those of all cores, go to standard output.

Needs only NumPy, as the peers' own Python environment has no vtray.
"""

import sys
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

SHORT = 2
"""Frames of the movie that is made first."""
RADIUS = 0.5
SPACING = 1.0
"""The side of the cube that each ball has."""
STEP = 0.05
"""How far a ball moves from frame to frame along an axis, at the root of the mean square."""
COLOR = (70, 130, 180)
FPS = 30


class Movie(NamedTuple):
    """What is to be shown.

    Attributes
    ----------
    start, step
        Where balls are at first, and how they move from frame to frame, (n, 3).
    frames
        How many frames there are.
    side
        Width and height of the picture in pixels.
    threads
        How many threads may work on it.
    output
        The file to write.
    """

    start: NDArray[np.float64]
    step: NDArray[np.float64]
    frames: int
    side: int
    threads: int
    output: str


def time_movie(make: Callable[[Movie], Any], seconds_of_others: Callable[[], float]) -> None:
    """Make the movie that the arguments of the command ask for.

    Parameters
    ----------
    make
        Makes one.
    seconds_of_others
        Gives the seconds that cores have spent on it in other processes that live on.
    """
    count, frames, side, threads = map(int, sys.argv[1:5])
    random = np.random.default_rng(0)
    start = random.uniform(0.0, SPACING * np.cbrt(count), (count, 3))
    movie = Movie(start, random.normal(0.0, STEP, (count, 3)), frames, side, threads, sys.argv[5])
    make(movie._replace(frames=SHORT))
    began, spent = time.perf_counter(), _of_cores() + seconds_of_others()
    make(movie)
    print(f"movie   {time.perf_counter() - began:8.4f} s")
    print(f"cores   {_of_cores() + seconds_of_others() - spent:8.4f} s")


def _of_cores() -> float:
    """Return the seconds that cores have spent on this process, and on those that it waited for."""
    try:
        import resource
    except ImportError:  # in Windows
        return time.process_time()
    kinds = resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN
    return sum(sum(resource.getrusage(kind)[:2]) for kind in kinds)
