"""GSD files of HOOMD-blue.

References
----------
https://gsd.readthedocs.io/en/stable/schema-hoomd.html,
https://hoomd-blue.readthedocs.io/en/stable/hoomd/box.html
"""

from functools import partial
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.scene.particles.column_names import name_columns
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import Steps, frame_number
from vtray.scene.readers.libraries import told
from vtray.scene.readers.reader_table import Given

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Cell = NDArray[np.float64]

_COLUMNS = ("mass", "charge", "velocity", "orientation", "angmom", "body", "image")
"""What else a file may know of each particle."""


_ZERO: Any = (0.0, 0.0, 0.0)


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
    import numpy as np

    frame = trajectory[number]
    particles = frame.particles
    columns: dict[str, Array] = {}
    if particles.typeid is not None:
        names = np.array(particles.types or ["A"], np.str_)
        columns["type"] = names[np.asarray(particles.typeid, np.int64)]
    if particles.diameter is not None:
        columns["radius"] = np.asarray(particles.diameter, np.float64) / 2
    for name in _COLUMNS:
        if f"particles/{name}" in _chunks(trajectory, number):
            columns[name] = np.asarray(getattr(particles, name))
    cell = _cell_of(frame.configuration.box)
    bonds = frame.bonds.group if frame.bonds.N else None
    dimensions = frame.configuration.dimensions
    return Particles(
        np.asarray(particles.position),
        name_columns(columns),
        bonds=None if bonds is None else np.asarray(bonds, np.int64),
        cell=cell,
        origin=_ZERO if cell is None else (cell[0] + cell[1] + cell[2]) / -2,
        periodic=None if cell is None else (True, True, dimensions == 3),
        frame=number,
    )


def _chunks(trajectory: Any, number: int) -> set[str]:  # noqa: ANN401
    """Return what a frame has been given, or the first frame for it."""
    file = trajectory.file
    known = file.find_matching_chunk_names("particles/")
    return {
        name
        for name in known
        if file.chunk_exists(frame=number, name=name) or file.chunk_exists(frame=0, name=name)
    }


def _cell_of(box: Any) -> "Cell | None":  # noqa: ANN401
    """Return the edges of a box by its lengths and tilts."""
    import numpy as np

    if box is None or not np.any(box[:3]):
        return None
    x, y, z, xy, xz, yz = (float(entry) for entry in box)
    return np.array([(x, 0.0, 0.0), (xy * y, y, 0.0), (xz * z, yz * z, z)])
