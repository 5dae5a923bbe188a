"""Point clouds of laser scans, .las and .laz, by laspy.

References
----------
https://laspy.readthedocs.io, https://www.asprs.org/divisions-committees/lidar-division
"""

from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.base.memory import lack_of_memory
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import frame_number
from vtray.scene.readers.libraries import told
from vtray.scene.readers.reader_table import Given

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_BYTES = 200
"""Of memory for a point."""

_LEFT_OUT = {"X", "Y", "Z", "red", "green", "blue"}


def read(given: Given) -> Particles:
    """Read a point cloud.

    Columns are ``color`` (from 0 to 255, where the file has colours), ``intensity``,
    ``classification`` and all others that it has. Colours of 16 bits lose the lower eight; where a
    file has used only 8 of them, all are taken.

    Raises
    ------
    SceneError
        laspy cannot read it.
    ExtraError
        laspy or lazrs is not installed.
    """
    import numpy as np

    laspy: Any = need("laspy", "points", "reading point clouds")
    if given.path.lower().endswith(".laz") or given.format == "laz":
        need("lazrs", "points", "reading .laz files")
    frame_number(given.frame, 1)
    with told("laspy", "a LAS file"), laspy.open(given.file, closefd=False) as reader:
        count = reader.header.point_count
        lack = lack_of_memory(count * _BYTES)
        if lack:
            raise SceneError(f"{count} points need {lack}")
        points = reader.read()
        if len(points) < count:
            raise SceneError(f"holds {len(points)} of {count} points; expected all")
        names = list(points.point_format.dimension_names)
        columns: dict[str, Array] = {}
        if {"red", "green", "blue"} <= set(names):
            colors = np.stack([np.asarray(points[name]) for name in ("red", "green", "blue")], 1)
            in_bytes = not len(colors) or colors.max() < 256
            columns["color"] = (colors if in_bytes else colors >> 8).astype(np.uint8)
        for name in names:
            if name not in _LEFT_OUT:
                columns[name] = np.array(points[name])
        positions = np.array(points.xyz)
    return Particles(positions, columns)
