"""From arrays in memory to a PNG: what the programs that are timed for it share.

    python measures/arrays_vtray.py THREADS ARRAYS OUTPUT SIDE PICTURES

Such a script loads the arrays and what it imports, and then makes the picture several times, each
time as if it were the first: from the arrays, with nothing kept from before but compiled code. What
took how long goes to standard output.

Needs only NumPy, as the peers' own Python environment has no vtray.
"""

import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

EYE = (0.0, 0.0, -4.2)
"""Where the camera is. It looks along z at the cube from -1 to 1; x points right and y down."""
FIELD_OF_VIEW_DEGREES = 40.0
"""Across, and down as well: pictures are square."""
TO_LIGHT = (-0.5, -0.65, -0.75)
"""Where the light comes from, from so far away that its rays are parallel."""


class Arrays(NamedTuple):
    """Spheres.

    Attributes
    ----------
    center
        Centres, float64, (n, 3).
    radius
        The radius of them all.
    color
        Colours, uint8, (n, 3).
    """

    center: NDArray[np.float64]
    radius: float
    color: NDArray[np.uint8]


class Task(NamedTuple):
    """A picture to be made.

    Attributes
    ----------
    arrays
        Its spheres.
    side
        Its width and height in pixels.
    output
        The PNG to write.
    threads
        How many threads may work on it.
    """

    arrays: Arrays
    side: int
    output: str
    threads: int


def save_arrays(arrays: Arrays, path: Path) -> None:
    """Write arrays to a .npz file."""
    np.savez(path, **arrays._asdict())


def time_pictures(prepare: Callable[[int], Callable[[Task], None]]) -> None:
    """Make a picture several times, as the arguments of the command say, and print the seconds.

    Parameters
    ----------
    prepare
        Imports what is needed, from the number of threads; returns what makes a picture.
    """
    threads, path, output, side, pictures = sys.argv[1:]
    with np.load(path) as found:
        arrays = Arrays(found["center"], float(found["radius"]), found["color"])
    task = Task(arrays, int(side), output, int(threads))
    start = time.perf_counter()
    draw = prepare(task.threads)
    print(f"import  {time.perf_counter() - start:8.4f} s")
    for number in range(int(pictures)):
        Path(output).unlink(missing_ok=True)
        start = time.perf_counter()
        draw(task)
        print(f"picture {time.perf_counter() - start:8.4f} s")
        if not Path(output).exists():
            sys.exit(f"picture {number} was not written")


def hold_to_cores(threads: int) -> None:
    """Hold this process to as many cores as it may have threads, where the system can."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:threads])
