"""VTK's older files, of lines that say what follows: as text, or as bytes.

References
----------
https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.readers.vtk_array import TIMES, Part
from vtray.scene.readers.vtk_cursor import Cursor

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_DATASETS = ("POLYDATA", "UNSTRUCTURED_GRID", "STRUCTURED_GRID")
"""What has points."""

_WIDTHS = {
    "VECTORS": 3,
    "NORMALS": 3,
    "TENSORS": 9,
    "TENSORS6": 6,
    "GLOBAL_IDS": 1,
    "PEDIGREE_IDS": 1,
    "EDGE_FLAGS": 1,
}
"""How many numbers a row of an attribute has."""


def read_legacy(content: bytes) -> Part:
    """Read a file of VTK that is no XML.

    Cells, and what is known of these, are passed over.

    Raises
    ------
    SceneError
        It is not right, or has no points. The message names the line, or the byte where it begins.
    """
    cursor = Cursor(content)
    _read_head(cursor)
    sections = _Sections(cursor)
    while entries := cursor.line():
        sections.read(entries)
    return sections.part()


class _Sections:
    """What the sections of a file say, as they are met."""

    def __init__(self, cursor: Cursor) -> None:
        self._cursor = cursor
        self._positions: Array | None = None
        self._columns: dict[str, Array] = {}
        self._time: float | None = None
        self._within = ""  # what the arrays are of: points, cells, or neither
        self._count = 0  # of these

    def part(self) -> Part:
        """Return the points; raise SceneError if there are none, or an array is not as long."""
        if self._positions is None:
            raise SceneError("expected the line POINTS; there is none")
        count = len(self._positions)
        for name, values in self._columns.items():
            if len(values) != count:
                words = f"expected {count} rows, got {len(values)}"
                raise SceneError(f"array {short(name)!r}: {words}")
        return Part(self._positions, self._columns, self._time)

    def read(self, entries: list[str]) -> None:
        """Read a section, of which the first line has these entries."""
        word, cursor = entries[0].upper(), self._cursor
        if word == "POINTS":
            count = cursor.whole(entries, 1)
            numbers = cursor.numbers(cursor.entry(entries, 2), 3 * count)
            self._positions = numbers.reshape(count, 3)
        elif word in ("POINT_DATA", "CELL_DATA"):
            self._within, self._count = word, cursor.whole(entries, 1)
        elif word == "FIELD":
            self._take(_field(cursor, cursor.whole(entries, 2)))
        elif word in _PASSED_OVER:
            _PASSED_OVER[word](cursor, entries)
        else:
            self._take(dict([_attribute(cursor, entries, self._count)]))

    def _take(self, arrays: "dict[str, Array]") -> None:
        """Keep arrays of the points, or the time."""
        if self._within == "POINT_DATA":
            self._columns |= arrays
        elif not self._within:
            for name in TIMES:
                if name in arrays and arrays[name].size:
                    self._time = float(arrays[name].ravel()[0])


def _read_head(cursor: Cursor) -> None:
    """Read the first lines."""
    if not cursor.raw_line().lower().startswith("# vtk datafile"):
        raise cursor.wrong("expected # vtk DataFile Version and a number")
    cursor.raw_line()  # the title
    way = cursor.raw_line().upper()
    if way not in ("ASCII", "BINARY"):
        raise cursor.wrong(f"expected ASCII or BINARY, got {short(way)!r}")
    entries = cursor.line()
    kind = entries[1].upper() if len(entries) == 2 else ""
    if not entries or entries[0].upper() != "DATASET" or kind not in _DATASETS:
        known = ", ".join(_DATASETS)
        raise cursor.wrong(
            f"expected DATASET with one of {known}, got {short(' '.join(entries))!r}"
        )
    cursor.is_text = way == "ASCII"


def _skip_cells(cursor: Cursor, entries: list[str]) -> None:
    """Pass over cells, as numbers of points, or with the places where each cell begins."""
    count, size = cursor.whole(entries, 1), cursor.whole(entries, 2)
    if not cursor.follows("OFFSETS"):
        cursor.numbers("int", size)
        return
    for needed in (count, size):
        cursor.numbers(cursor.entry(cursor.line(), 1), needed)


def _field(cursor: Cursor, count: int) -> "dict[str, Array]":
    """Read the arrays of a field, without those of texts."""
    found = {}
    while count:
        entries = cursor.line()
        if entries and entries[0] == "METADATA":
            cursor.skip_to_empty_line()
            continue
        count -= 1
        kind = cursor.entry(entries, 3)
        width, rows = cursor.whole(entries, 1), cursor.whole(entries, 2)
        if kind == "string" and cursor.is_text:
            cursor.skip_lines(rows * width)
            continue
        values = cursor.numbers(kind, rows * width)
        found[unquote(entries[0])] = values if width == 1 else values.reshape(rows, width)
    return found


def _attribute(cursor: Cursor, entries: list[str], count: int) -> "tuple[str, Array]":
    """Read an attribute of points or cells."""
    word, name = entries[0].upper(), unquote(cursor.entry(entries, 1))
    if word == "COLOR_SCALARS":
        width = cursor.whole(entries, 2)
        values = _colors(cursor, count * width)
        return name, values if width == 1 else values.reshape(count, width)
    if word == "SCALARS":
        kind = cursor.entry(entries, 2)
        width = cursor.whole(entries, 3) if len(entries) > 3 else 1
        if cursor.follows("LOOKUP_TABLE"):
            cursor.line()
    elif word == "TEXTURE_COORDINATES":
        width, kind = cursor.whole(entries, 2), cursor.entry(entries, 3)
    elif word in _WIDTHS:
        width, kind = _WIDTHS[word], cursor.entry(entries, 2)
    else:
        expected = "a word of VTK, such as POINTS, SCALARS or FIELD"
        raise cursor.wrong(f"expected {expected}, got {short(entries[0])!r}")
    values = cursor.numbers(kind, count * width)
    return name, values if width == 1 else values.reshape(count, width)


def _colors(cursor: Cursor, count: int) -> "Array":
    """Read colours: bytes, or in text numbers from 0 to 1."""
    import numpy as np

    if not cursor.is_text:
        return cursor.numbers("unsigned_char", count)
    shares = cursor.numbers("float", count)
    if not ((shares >= 0) & (shares <= 1)).all():
        raise cursor.wrong("expected colours from 0 to 1")
    return np.round(255 * shares).astype(np.uint8)


_PASSED_OVER: dict[str, Callable[[Cursor, list[str]], object]] = {
    **dict.fromkeys(("VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS", "CELLS"), _skip_cells),
    "CELL_TYPES": lambda cursor, entries: cursor.numbers("int", cursor.whole(entries, 1)),
    "LOOKUP_TABLE": lambda cursor, entries: _colors(cursor, 4 * cursor.whole(entries, 2)),
    "METADATA": lambda cursor, _: cursor.skip_to_empty_line(),
    "DIMENSIONS": lambda *_: None,
}
"""What passes over sections that say nothing of points."""
