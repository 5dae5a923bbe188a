"""GSD files of HOOMD-blue.

References
----------
https://gsd.readthedocs.io/en/stable/schema-hoomd.html
"""

from functools import partial
from typing import Any

from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.scene.particles.from_simulation import HOOMD, of_hoomd
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import Steps, frame_number
from vtray.scene.readers.libraries import told
from vtray.scene.readers.reader_table import Given


def read(given: Given) -> Particles:
    """Read a frame of a GSD file.

    Columns are ``type`` (the names of the types), ``radius`` (half the diameter), and, where the
    file has them, ``mass``, ``charge``, ``velocity``, ``orientation``, ``angmom``, ``body`` and
    ``image``. The middle of the box is the origin of the places.

    Raises
    ------
    SceneError
        The file is not right, or has no such frame.
    ExtraError
        gsd is not installed.
    """
    hoomd: Any = need("gsd.hoomd", "atoms", "reading GSD files")
    with told("gsd", "a GSD file"), hoomd.open(given.path, "r") as trajectory:
        if not len(trajectory):
            raise SceneError("holds no frame; expected at least one")
        return _read_frame(trajectory, frame_number(given.frame, len(trajectory)))


def steps(given: Given) -> Steps:
    """Give what reads each frame, one after the other."""
    hoomd: Any = need("gsd.hoomd", "atoms", "reading GSD files")
    with told("gsd", "a GSD file"):
        trajectory = hoomd.open(given.path, "r")
    with trajectory:
        for number in range(len(trajectory)):
            yield partial(_told_frame, trajectory, number)


def _told_frame(trajectory: Any, number: int) -> Particles:  # noqa: ANN401
    """Read a frame; what gsd raises becomes a SceneError."""
    with told("gsd", f"frame {number} of a GSD file"):
        return _read_frame(trajectory, number)


def _read_frame(trajectory: Any, number: int) -> Particles:  # noqa: ANN401
    """Read a frame of an open file."""
    known = _chunks(trajectory, number)
    names = [name for name in HOOMD if f"particles/{name}" in known]
    return of_hoomd(trajectory[number], names, number)


def _chunks(trajectory: Any, number: int) -> set[str]:  # noqa: ANN401
    """Return what a frame has been given, or the first frame for it."""
    file = trajectory.file
    known = file.find_matching_chunk_names("particles/")
    return {
        name
        for name in known
        if file.chunk_exists(frame=number, name=name) or file.chunk_exists(frame=0, name=name)
    }
