"""Topologies, and trajectories beside them, that MDAnalysis reads.

References
----------
https://docs.mdanalysis.org/stable/documentation_pages/topology/init.html
"""

import gc
import sys
import warnings
from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

from vtray.base.errors import SceneError, why_unreadable
from vtray.base.extras import need
from vtray.base.input_file import open_input
from vtray.scene.particles.from_objects import from_mdanalysis
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import Steps, frame_number
from vtray.scene.readers.libraries import check_room, told
from vtray.scene.readers.reader_table import READERS, Given

Result = TypeVar("Result")

_TIMES = 30
"""Bytes of memory for a byte of a topology."""

_GUESSED = ("types", "masses", "elements")
"""What MDAnalysis finds out by the names of atoms where a topology does not say it."""


def read(given: Given) -> Particles:
    """Read a frame of a topology, or of the trajectory that belongs to it.

    Where the topology does not name the elements, they are those that MDAnalysis takes the names of
    the atoms for.

    Raises
    ------
    SceneError
        MDAnalysis cannot read it, or there is no such frame.
    ExtraError
        MDAnalysis is not installed.
    """
    universe, expected = _open(given)
    number = frame_number(given.frame, len(universe.trajectory))
    return _read_frame(universe, expected, number)


def steps(given: Given) -> Steps:
    """Give what reads each frame, one after the other."""
    universe, expected = _open(given)
    for number in range(len(universe.trajectory)):
        yield partial(_read_frame, universe, expected, number)


def _open(given: Given) -> tuple[Any, str]:
    """Return what MDAnalysis makes of files, and what they were expected to be."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        library: Any = need("MDAnalysis", "atoms", "reading topologies and trajectories")
    check_room(given.file, _TIMES)
    what = READERS[given.format].what
    second = [] if given.trajectory is None else [given.trajectory]
    expected = what
    if given.trajectory is not None:
        expected = f"{what} and its trajectory {given.trajectory}"
        _check_trajectory(given.trajectory)

    def open_both() -> Any:  # noqa: ANN401
        with told("MDAnalysis", expected):
            return library.Universe(given.path, *second, to_guess=_GUESSED)

    universe = _quietly(open_both)
    if not hasattr(universe, "trajectory"):
        remedy = 'as in trajectory="run.xtc", or by --trajectory run.xtc'
        raise SceneError(f"has no places; name the file that has some, {remedy}")
    return universe, expected


def _read_frame(universe: Any, expected: str, number: int) -> Particles:  # noqa: ANN401
    """Read a frame of what MDAnalysis has opened."""

    def take() -> Particles:
        with told("MDAnalysis", f"frame {number} of {expected}"):
            universe.trajectory[number]
            return from_mdanalysis(universe)

    return _quietly(take)


def _check_trajectory(path: str) -> None:
    """Raise SceneError if a trajectory is no file that can be read."""
    try:
        open_input(path).close()
    except (OSError, ValueError) as error:
        raise SceneError(f"trajectory: {path}: {why_unreadable(error, 'trajectory')}") from None


def _quietly(step: Callable[[], Result]) -> Result:
    """Do a step; if it fails, let its objects end without a word.

    Readers of MDAnalysis that could not be opened raise another error as they are deleted, which
    Python would print.
    """
    hook = sys.unraisablehook
    sys.unraisablehook = lambda _: None
    try:
        try:
            return step()
        except SceneError as error:
            words = str(error)
        gc.collect()
        raise SceneError(words)
    finally:
        sys.unraisablehook = hook
