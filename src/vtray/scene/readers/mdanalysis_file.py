"""Topologies, and trajectories beside them, that MDAnalysis reads.

References
----------
https://docs.mdanalysis.org/stable/documentation_pages/topology/init.html
"""

from typing import Any

from vtray.base.extras import need
from vtray.scene.particles.from_objects import from_mdanalysis
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import frame_number
from vtray.scene.readers.libraries import check_room, told
from vtray.scene.readers.reader_table import READERS, Given

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
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        library: Any = need("MDAnalysis", "atoms", "reading topologies and trajectories")
    check_room(given.path, _TIMES)
    second = [] if given.trajectory is None else [given.trajectory]
    what = READERS[given.format].what
    expected = f"{what} and its trajectory {given.trajectory}" if second else what
    with told("MDAnalysis", expected):
        universe = library.Universe(given.path, *second, to_guess=_GUESSED)
        count = len(universe.trajectory)
    number = frame_number(given.frame, count)
    with told("MDAnalysis", f"frame {number} of {expected}"):
        universe.trajectory[number]
        return from_mdanalysis(universe)
