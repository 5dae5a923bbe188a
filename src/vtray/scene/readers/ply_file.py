"""Point clouds in PLY files, by plyfile.

References
----------
https://python-plyfile.readthedocs.io
"""

from typing import Any

from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.scene.particles.from_columns import from_columns
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import frame_number
from vtray.scene.readers.libraries import check_room, told
from vtray.scene.readers.reader_table import Given

_TIMES = 8
"""Bytes of memory for a byte of a file."""

_COLORS = {"red", "green", "blue"}


def read(given: Given) -> Particles:
    """Read the vertices of a PLY file, with their properties as columns.

    ``red``, ``green`` and ``blue`` become ``color``, of which colours of 16 bits lose the lower
    eight; ``nx``, ``ny`` and ``nz`` become ``normal``.

    Raises
    ------
    SceneError
        plyfile cannot read it, or there are no vertices.
    ExtraError
        plyfile is not installed.
    """
    import numpy as np

    library: Any = need("plyfile", "points", "reading PLY files")
    frame_number(given.frame, 1)
    check_room(given.file, _TIMES)
    with told("plyfile", "a PLY file"):
        found = library.PlyData.read(given.file)
        if "vertex" not in found:
            raise SceneError("expected an element vertex; there is none")
        vertices = found["vertex"].data
        columns = {
            name: np.ascontiguousarray(vertices[name])
            for name in vertices.dtype.names
            if vertices.dtype[name].kind != "O"
        }
    for name in _COLORS & columns.keys():
        if columns[name].dtype == np.uint16:
            columns[name] = (columns[name] >> 8).astype(np.uint8)
    return from_columns(columns, given.columns)
