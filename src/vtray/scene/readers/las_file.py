"""Point clouds of laser scans, .las and .laz, by laspy.

References
----------
https://laspy.readthedocs.io, https://www.asprs.org/divisions-committees/lidar-division
"""

import io
import struct
from typing import TYPE_CHECKING, Any, BinaryIO

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

_HEAD = 247
"""Bytes of the longest head that is looked at."""

_COMPRESSED = 0x80
"""Of the kind of the points: whether they are compressed."""

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
    _check_head(given.file)
    with told("laspy", "a LAS file"), laspy.open(given.file, closefd=False) as reader:
        count = reader.header.point_count
        lack = lack_of_memory(count * _BYTES)
        if lack:
            raise SceneError(f"{count} points need {lack}")
        if reader.header.are_points_compressed:
            _check_chunks(given.file, reader.header)
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


def _check_head(file: BinaryIO) -> None:
    """Raise SceneError if a file is no LAS file, or claims more than it has bytes for.

    laspy would make an empty record for each that there is not, and lazrs would end the process
    where it gets no memory.
    """
    head = file.read(_HEAD).ljust(_HEAD, b"\0")
    size = file.seek(0, io.SEEK_END)
    if not head.startswith(b"LASF"):
        raise SceneError("expected a LAS file, which begins with LASF")
    start, records, kind = struct.unpack_from("<IIB", head, 96)
    (further,) = struct.unpack_from("<I", head, 243) if head[25] >= 4 else (0,)
    chunks = _chunks(file, start, size) if kind & _COMPRESSED else 0
    if records * 54 + further * 60 + chunks > size:
        parts = f"{records + further} records and {chunks} chunks"
        raise SceneError(f"claims {parts}, which do not fit into its {size} bytes; write it again")
    file.seek(0)


def _check_chunks(file: BinaryIO, header: Any) -> None:  # noqa: ANN401
    """Raise SceneError if there is no memory for the largest chunk of compressed points.

    A chunk is unpacked as a whole, and lazrs would end the process where it gets no memory for it.
    """
    lazrs: Any = need("lazrs", "points", "reading .laz files")
    place = file.tell()
    file.seek(header.offset_to_point_data)
    (record,) = (one for one in header.vlrs if type(one).__name__ == "LasZipVlr")
    packing = lazrs.LazVlr(record.record_data)
    if not (packing.chunk_size() and packing.item_size()):
        raise SceneError("claims chunks without points; write it again")
    points, size = zip(*lazrs.read_chunk_table(file, packing), strict=True)
    lack = lack_of_memory(max(points) * packing.item_size() + max(size))
    file.seek(place)
    if lack:
        raise SceneError(f"has chunks of {max(points)} points, which need {lack}")


def _chunks(file: BinaryIO, start: int, size: int) -> int:
    """Return how many chunks of compressed points a file claims to have."""
    file.seek(start)
    (table,) = struct.unpack("<q", file.read(8).ljust(8, b"\0"))
    if table == -1:  # was not known when the file was begun, and stands at its end
        file.seek(max(size - 8, 0))
        (table,) = struct.unpack("<q", file.read(8).ljust(8, b"\0"))
    if not 0 <= table <= size:
        return size + 1
    file.seek(table)
    _, chunks = struct.unpack("<II", file.read(8).ljust(8, b"\0"))
    return int(chunks)
