"""VTK's files in XML: points with their data, and the names of other files.

References
----------
https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
"""

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple
from xml.parsers import expat

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.readers.vtk_array import (
    KINDS,
    TIMES,
    Coding,
    Part,
    Written,
    numbers_of_bytes,
    numbers_of_text,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_APPENDED = re.compile(rb'<AppendedData\s+encoding\s*=\s*["\'](\w+)["\']\s*>\s*_')
"""What stands before the bytes of all arrays, which need be no XML."""

_POINTS = {"PolyData", "UnstructuredGrid"}
"""The kinds of files that have points."""


class Link(NamedTuple):
    """The name of a file that holds a part.

    Attributes
    ----------
    path
        The name as it is written.
    time
        As it is written; "" if it is not.
    """

    path: str
    time: str


class Document(NamedTuple):
    """What is in a file.

    Attributes
    ----------
    parts
        The points in the file itself.
    links
        The files with other points.
    """

    parts: list[Part]
    links: list[Link]


@dataclass
class _Array:
    """An array as it is written: what is said of it, and its text."""

    said: dict[str, str]
    texts: list[str] = field(default_factory=list)


@dataclass
class _Piece:
    """A piece of a file as it is written."""

    said: dict[str, str]
    points: _Array | None = None
    columns: list[_Array] = field(default_factory=list)


class _Elements:
    """What the elements of a file say, as they are met."""

    def __init__(self) -> None:
        self.root: dict[str, str] = {}
        self.pieces: list[_Piece] = []
        self.links: list[Link] = []
        self.times: list[_Array] = []
        self._path: list[str] = []
        self._array: _Array | None = None

    def begin(self, name: str, said: dict[str, str]) -> None:
        """Take the beginning of an element."""
        around = self._path[-1] if self._path else ""
        if not self._path:
            if name != "VTKFile":
                raise SceneError(f"expected the element VTKFile, got {short(name)!r}")
            self.root = said
        elif name == "Piece" and "Source" not in said:
            self.pieces.append(_Piece(said))
        elif name in ("Piece", "DataSet") and (said.get("Source") or said.get("file")):
            self.links.append(Link(said.get("Source") or said["file"], said.get("timestep", "")))
        elif name == "DataArray":
            self._take(around, _Array(said))
        self._path.append(name)

    def _take(self, around: str, array: _Array) -> None:
        """Take an array that is wanted, by the name of the element around it."""
        if around == "Points" and self.pieces:
            self.pieces[-1].points = self._array = array
        elif around == "PointData" and self.pieces:
            self.pieces[-1].columns.append(array)
            self._array = array
        elif around == "FieldData" and array.said.get("Name") in TIMES:
            self.times.append(array)
            self._array = array

    def text(self, part: str) -> None:
        """Take a part of the text of an element."""
        if self._array is not None and self._path[-1] == "DataArray":
            self._array.texts.append(part)

    def end(self, name: str) -> None:
        """Take the end of an element."""
        self._path.pop()
        if name == "DataArray":
            self._array = None


def read_document(content: bytes) -> Document:
    """Read a file of VTK in XML.

    Cells, and what is known of these, are not looked at.

    Raises
    ------
    SceneError
        It is not right, or of a kind without points of their own.
    """
    mark = _APPENDED.search(content)
    elements = _elements_of(content if mark is None else content[: mark.start()], mark is None)
    kind = elements.root.get("type", "")
    if elements.links or (kind not in _POINTS and not elements.pieces):
        return Document([], _links_of(kind, elements))
    if kind not in _POINTS:
        known = " or ".join(sorted(_POINTS))
        raise SceneError(f"expected points, as {known} has, got {short(kind)!r}")
    coding = _coding_of(elements.root)
    appended = None
    if mark is not None:
        appended = Written(memoryview(content), mark.end(), mark[1] == b"base64")
    time = None
    for array in elements.times:
        time = float(_numbers_of(array, coding, appended, 1).ravel()[0])
    parts = [_part_of(piece, coding, appended, time) for piece in elements.pieces]
    return Document(parts, [])


def _links_of(kind: str, elements: _Elements) -> list[Link]:
    """Return the files that one names; raise SceneError if it names none."""
    if not elements.links:
        expected = "expected points, or the names of files with some"
        raise SceneError(f"{expected}; {short(kind) or 'the file'} has none")
    return elements.links


def _elements_of(content: bytes, is_whole: bool) -> _Elements:
    """Go through the elements of a file, or of its beginning."""
    found = _Elements()
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.buffer_size = 1 << 20
    parser.StartElementHandler = found.begin
    parser.CharacterDataHandler = found.text
    parser.EndElementHandler = found.end
    parser.StartDoctypeDeclHandler = _refuse
    try:
        parser.Parse(content, is_whole)
    except expat.ExpatError as error:
        words = expat.ErrorString(error.code)
        raise SceneError(f"line {error.lineno}: expected XML ({words})") from None
    return found


def _refuse(*_: object) -> None:
    """Refuse entities, which may stand for any number of others."""
    raise SceneError("expected a file of VTK, which has no DOCTYPE")


def _coding_of(root: dict[str, str]) -> Coding:
    """Return how bytes are written, as the first element says."""
    order = {"LittleEndian": "<", "BigEndian": ">"}.get(root.get("byte_order", "LittleEndian"))
    word = {"UInt32": "u4", "UInt64": "u8"}.get(root.get("header_type", "UInt32"))
    if order is None or word is None:
        got = short(f"{root.get('byte_order')}, {root.get('header_type')}")
        expected = "byte_order: LittleEndian or BigEndian, and header_type: UInt32 or UInt64"
        raise SceneError(f"expected {expected}, got {got}")
    return Coding(order, word, root.get("compressor", ""))


def _part_of(piece: _Piece, coding: Coding, appended: Written | None, time: float | None) -> Part:
    """Return the points of a piece."""
    import numpy as np

    count = _whole(piece.said, "NumberOfPoints", "0")
    positions = np.zeros((0, 3))
    if piece.points is not None:
        positions = _numbers_of(piece.points, coding, appended, count)
    if positions.shape != (count, 3):
        raise SceneError(f"expected {count} points of 3 numbers, got shape {positions.shape}")
    columns = {}
    for number, array in enumerate(piece.columns, 1):
        if array.said.get("type") in KINDS:
            name = array.said.get("Name") or f"array {number}"
            columns[name] = _numbers_of(array, coding, appended, count)
    return Part(positions, columns, time)


def _numbers_of(array: _Array, coding: Coding, appended: Written | None, rows: int) -> "Array":
    """Return an array, (rows,) or (rows, k); raise SceneError, with its name, if it is wrong."""
    name = array.said.get("Name", "Points")
    try:
        kind = KINDS.get(array.said.get("type", ""))
        if kind is None:
            known = ", ".join(KINDS)
            got = short(repr(array.said.get("type")))
            raise SceneError(f"type: expected one of {known}, got {got}")
        width = _whole(array.said, "NumberOfComponents", "1")
        found = _values_of(array, coding, appended, kind, rows * width)
    except SceneError as error:
        raise SceneError(f"array {short(name)!r}: {error}") from None
    return found if width == 1 else found.reshape(rows, width)


def _values_of(
    array: _Array, coding: Coding, appended: Written | None, kind: str, count: int
) -> "Array":
    """Return the numbers of an array, one after the other."""
    text = "".join(array.texts)
    way = array.said.get("format", "ascii")
    if way == "ascii":
        return numbers_of_text(text, kind, count)
    if way == "binary":
        inner = memoryview("".join(text.split()).encode())
        return numbers_of_bytes(Written(inner, 0, True), coding, kind, count)
    if way != "appended" or appended is None:
        got = "no AppendedData" if way == "appended" else short(repr(way))
        raise SceneError(f"format: expected ascii, binary, or appended with its data, got {got}")
    start = appended.start + _whole(array.said, "offset", "0")
    return numbers_of_bytes(appended._replace(start=start), coding, kind, count)


def _whole(said: dict[str, str], name: str, default: str) -> int:
    """Return a number that an element tells, from 0 on."""
    text = said.get(name, default).strip()
    if not (text.isascii() and text.isdigit() and len(text) < 19):
        raise SceneError(f"{name}: expected a whole number, got {short(text)!r}")
    return int(text)
