"""Files of VTK, which ParaView shows: points with their data, and collections of such files.

No library reads them that is light and takes broken ones: VTK's own takes 560 MB, and ends the
process where a file claims more than there is memory for; meshio reads no .vtp.
"""

import os
import re
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError, why_unreadable
from vtray.base.input_file import open_input, read_stream
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.column_names import name_columns
from vtray.scene.particles.joined_groups import joined_columns
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import Steps, frame_number
from vtray.scene.readers.libraries import check_room
from vtray.scene.readers.reader_table import Given
from vtray.scene.readers.vtk_array import Part
from vtray.scene.readers.vtk_legacy_file import read_legacy
from vtray.scene.readers.vtk_xml_file import Document, Link, read_document

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_TIMES = 3
"""Bytes of memory for a byte of a file."""

_DEPTH = 4
"""How often a file may name others that name others."""

_LEGACY = re.compile(rb"# vtk DataFile", re.IGNORECASE)


def read(given: Given) -> Particles:
    """Read the points of a file with what is known of each, or of all files that it names.

    A collection (.pvd) has frames, each with its time.

    Raises
    ------
    SceneError
        A file is not right, has no points, or there is no such frame.
    ExtraError
        It is compressed by LZ4, and lz4 is not installed.
    """
    readers = _readers(given)
    return readers[frame_number(given.frame, len(readers))]()


def steps(given: Given) -> Steps:
    """Give what reads each frame, one after the other."""
    yield from _readers(given)


def _readers(given: Given) -> list[Callable[[], Particles]]:
    """Return what reads each frame: one for each time of a collection."""
    content = _content_of(given.file)
    document = _document_of(content)
    times: dict[float | None, dict[str, Link]] = {}
    for link in document.links:
        # A run that was started again may have named a file twice.
        times.setdefault(_time_of(link), {}).setdefault(link.path, link)

    def read_frame(number: int, time: float | None, links: dict[str, Link]) -> Particles:
        whole = Document(document.parts, [*links.values()])
        return _particles_of(_parts_of(whole, given.path, 0), number, time)

    ordered = sorted(times.items(), key=lambda one: (one[0] is not None, one[0] or 0.0))
    return [partial(read_frame, number, *one) for number, one in enumerate(ordered or [(None, {})])]


def _content_of(file: Any) -> bytes:  # noqa: ANN401
    """Read a file as a whole."""
    check_room(file, _TIMES)
    return read_stream(file)


def _document_of(content: bytes) -> Document:
    """Return what is in a file, of either kind."""
    if _LEGACY.match(content):
        return Document([read_legacy(content)], [])
    if not content.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        raise SceneError("expected a file of VTK, which begins with # vtk DataFile or <VTKFile")
    return read_document(content)


def _parts_of(document: Document, path: str, depth: int) -> list[Part]:
    """Return all parts of a file, of those that it names, and so on."""
    parts = [*document.parts]
    for link in document.links:
        if depth == _DEPTH:
            raise SceneError(f"{short(link.path)}: expected points, got files of files of files")
        beside = os.path.join(os.path.dirname(path), link.path)
        try:
            with open_input(beside) as file:
                parts += _parts_of(_document_of(_content_of(file)), beside, depth + 1)
        except SceneError as error:
            raise SceneError(f"{link.path}: {error}") from None
        except (OSError, ValueError) as error:
            raise SceneError(f"{link.path}: {why_unreadable(error, 'file of VTK')}") from None
    return parts


def _particles_of(parts: Sequence[Part], number: int, time: float | None) -> Particles:
    """Return the points of all parts together."""
    import numpy as np

    some = [part for part in parts if len(part.positions)] or [*parts[:1]]
    positions = np.concatenate([part.positions for part in some] or [np.zeros((0, 3))])
    columns = joined_columns(
        [part.columns for part in some], [len(part.positions) for part in some]
    )
    known = [part.time for part in some if part.time is not None]
    if time is None and known:
        time = known[0]
    return Particles(positions, name_columns(columns), frame=number, time=time)


def _time_of(link: Link) -> float | None:
    """Return the time that a collection tells; None if it tells none."""
    if not link.time.strip():
        return None
    try:
        return float(link.time)
    except ValueError:
        raise SceneError(f"timestep: expected a number, got {short(link.time)!r}") from None
