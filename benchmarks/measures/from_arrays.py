"""How long programs take from arrays in memory to a PNG, each driven by a script in Python."""

import re
import statistics
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from peers.arrays_clock import Arrays, save_arrays
from peers.mitsuba import program as mitsuba
from peers.ovito import program as ovito
from peers.peer import Peer, python_of_peers
from peers.programs import is_installed
from scenes.cube import make_cube
from timing import vtray_process
from timing.jobs import Job, Run, Spread, run_once
from timing.same_picture import difference, is_same

BENCHMARKS = Path(__file__).resolve().parents[1]
LATER = 3
"""How many pictures a process makes after its first one."""


class Script(NamedTuple):
    """A program that is driven from Python.

    Attributes
    ----------
    name
        What the results call it.
    arguments
        Where our script is in `BENCHMARKS`, and what it is told before the other arguments.
    peer
        What tells whether the program is there, and why its picture is another; None for vtray.
    """

    name: str
    arguments: tuple[str, ...]
    peer: Peer | None = None


class ArraysRow(NamedTuple):
    """One program with one number of threads.

    Attributes
    ----------
    program, threads
        Which one.
    whole
        A process that makes one picture, with all its imports and loading the arrays.
    first
        From arrays to file, for the first picture of a process.
    later
        The same for later pictures of a process.
    memory
        The most memory of the process that makes one picture, in bytes.
    note
        How its picture compares.
    """

    program: str
    threads: int
    whole: Spread
    first: Spread
    later: Spread
    memory: float
    note: str


SCRIPTS = (
    Script(vtray_process.NAME, ("measures/arrays_vtray.py",)),
    Script("Mitsuba", ("peers/mitsuba/arrays_mitsuba.py",), mitsuba.PEER),
    Script("OVITO, OSPRay", ("peers/ovito/arrays_ovito.py", "ospray"), ovito.OSPRAY),
    Script("OVITO, Tachyon", ("peers/ovito/arrays_ovito.py", "tachyon"), ovito.TACHYON),
)


def time_arrays(
    count: int, side: int, threads: Sequence[int], folder: Path, repeats: int
) -> list[ArraysRow]:
    """Time all programs that are there on a cube of `count` spheres, in turn."""
    cube = make_cube(count)
    data = folder / "arrays.npz"
    save_arrays(Arrays(cube.center.astype("f8"), cube.radius, cube.color), data)
    there = [s for s in SCRIPTS if s.peer is None or is_installed(s.peer)]
    # What a program compiles on its first run is on disk afterwards.
    for script in there:
        run_once(_job(script, data, side, 1, 1))
    single: dict[tuple[str, int], list[Run]] = {}
    several: dict[tuple[str, int], list[Run]] = {}
    for _ in range(repeats):
        for script in there:
            for number in threads:
                key = script.name, number
                single.setdefault(key, []).append(run_once(_job(script, data, side, number, 1)))
                several.setdefault(key, []).append(
                    run_once(_job(script, data, side, number, 1 + LATER))
                )
    return [
        _row(script, number, single[script.name, number], several[script.name, number], folder)
        for script in there
        for number in threads
    ]


def picture_seconds(output: str) -> list[float]:
    """Return the seconds of each picture, as a script printed them."""
    return [float(found) for found in re.findall(r"^picture +([0-9.]+) s$", output, re.MULTILINE)]


def _job(script: Script, data: Path, side: int, threads: int, pictures: int) -> Job:
    name, *more = script.arguments
    python = python_of_peers() if script.peer else sys.executable
    picture = _picture(data.parent, script)
    arguments = [*more, str(threads), str(data), str(picture), str(side), str(pictures)]
    return Job(script.name, [python, str(BENCHMARKS / name), *arguments])


def _picture(folder: Path, script: Script) -> Path:
    return folder / f"arrays {script.name}.png"


def _row(
    script: Script, threads: int, single: Sequence[Run], several: Sequence[Run], folder: Path
) -> ArraysRow:
    """Return the times of a program, and how its last picture compares with vtray's."""
    found = difference(_picture(folder, SCRIPTS[0]), _picture(folder, script))
    note = str(found)
    if not is_same(found):
        note = f"another picture: {(script.peer and script.peer.apart) or found}"
    later = [seconds for run in several for seconds in picture_seconds(run.output)[1:]]
    return ArraysRow(
        script.name,
        threads,
        Spread(tuple(run.whole for run in single)),
        Spread(tuple(picture_seconds(run.output)[0] for run in single)),
        Spread(tuple(later)),
        statistics.median(run.memory for run in single),
        note,
    )
