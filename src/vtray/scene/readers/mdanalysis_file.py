"""Topologies, and trajectories beside them, that MDAnalysis reads.

References
----------
https://docs.mdanalysis.org/stable/documentation_pages/topology/init.html
"""

import gc
import sys
import warnings
from collections.abc import Callable
from typing import Any, TypeVar

from vtray.base.errors import SceneError, why_unreadable
from vtray.base.extras import need
from vtray.base.input_file import open_input
from vtray.scene.particles.from_objects import from_mdanalysis
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import frame_number
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

    def take() -> Particles:
        with told("MDAnalysis", f"frame {number} of {expected}"):
            universe.trajectory[number]
            return from_mdanalysis(universe)

    universe = _quietly(open_both)
    if not hasattr(universe, "trajectory"):
        remedy = 'name the file that has some, as in trajectory="run.xtc"'
        raise SceneError(f"has no places; {remedy}")
    number = frame_number(given.frame, len(universe.trajectory))
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
