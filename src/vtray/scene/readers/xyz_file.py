"""XYZ files, plain and extended, with NumPy alone.

References
----------
https://github.com/libAtoms/extxyz
"""

import re
from typing import TYPE_CHECKING, Any, NamedTuple

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.column_names import canonical, name_columns, name_twice
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.plain_numbers import parsed, parsed_all
from vtray.scene.readers import table_file
from vtray.scene.readers.by_content import beginning_of, is_table
from vtray.scene.readers.frames import Steps, find_frame, steps_of
from vtray.scene.readers.lines import Lines
from vtray.scene.readers.reader_table import Given
from vtray.scene.readers.rows import check_places, kind_of, read_rows

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Cell = NDArray[np.float64]

_LIST = r"\[(?:[^\[\]]|\[[^\[\]]*\])*\]"
_PAIR = re.compile(rf"""([\w.-]+)\s*=\s*("[^"]*"|'[^']*'|\{{[^}}]*\}}|{_LIST}|[^\s,;]+)""")
"""A key of a comment, and its value."""

_POS = "pos"
"""The column of the places, where several may be meant."""

_PLAIN = "species:S:1:pos:R:3"
"""The first columns, where nothing else is said."""


class _Head(NamedTuple):
    """What stands before the rows of a frame.

    Attributes
    ----------
    size
        How many particles there are.
    comment
        The second line.
    line
        The number of the first line.
    """

    size: int
    comment: str
    line: int


def read(given: Given) -> Particles:
    """Read a frame of an XYZ file.

    A plain file has a symbol and a place in each row, and further columns become ``column5`` and so
    on. An extended one says in its comment what the columns are (``Properties=``), and may name a
    cell (``Lattice=``, ``pbc=``, ``Origin=``). Where no number of particles comes first, but rows
    of a table, as in scans, it is one.

    Raises
    ------
    SceneError
        The file has no such frame, or it is not right. The message names the line.
    """
    if _is_table(given):
        return table_file.read(given._replace(format="csv"))
    lines = Lines(given.file)
    return _read_frame(lines, *find_frame(lines, given.frame, _read_head, "the number of atoms"))


def steps(given: Given) -> Steps:
    """Give what reads each frame, one after the other."""
    if _is_table(given):
        return iter([lambda: table_file.read(given._replace(format="csv"))])
    return steps_of(Lines(given.file), _read_head, _read_frame)


def _is_table(given: Given) -> bool:
    """Tell whether there are rows of a table from the first line on."""
    begin = beginning_of(given.file)
    given.file.seek(0)
    return begin is not None and is_table(begin)


def _read_frame(lines: Lines, number: int, head: _Head) -> Particles:
    """Read the rows of a frame, which come next."""
    said = {key.lower(): value.strip("\"'{}[]") for key, value in _PAIR.findall(head.comment)}
    properties = said.get("properties", "")
    if properties:
        names = _columns_of(properties, head.line + 1)
        kinds = "".join(kind * width for _, kind, width in names)
        found = read_rows(lines, head.size, kinds)
    else:
        names, found = _read_plain(lines, head)
    columns = _gather(names, found)
    positions = columns.pop(_POS, None)
    if positions is None or positions.shape != (head.size, 3):
        raise SceneError(f"line {head.line + 1}: Properties: expected pos:R:3 among the columns")
    check_places(positions, range(head.line + 2, head.line + 2 + head.size))
    cell, origin = _cell_of(said, head.line + 1)
    return Particles(
        positions,
        name_columns(columns),
        cell=cell,
        origin=origin,
        periodic=_periodic_of(said, head.line + 1) if cell is not None else None,
        frame=number,
        time=_number(said.get("time")),
    )


def _read_head(lines: Lines) -> _Head | None:
    """Read what stands before the rows of a frame; None at the end of the file."""
    text = lines.next()
    while text is not None and not text.strip():
        text = lines.next()
    if text is None:
        return None
    number = lines.number
    if not re.fullmatch(r"\s*\+?[0-9]{1,18}\s*", text):
        problem = f"expected the number of atoms, got {short(text.strip())!r}"
        raise SceneError(f"line {number}: {problem}")
    return _Head(int(text), lines.next() or "", number)


def _read_plain(lines: Lines, head: _Head) -> "tuple[list[tuple[str, str, int]], list[Array]]":
    """Read rows whose columns are not named."""
    place = lines.place()
    first = (lines.next() or "").split() if head.size else []
    lines.go(place)
    names = _columns_of(_PLAIN, 0)
    names += [(f"column{number}", kind_of(entry), 1) for number, entry in enumerate(first[4:], 5)]
    kinds = "".join(kind * width for _, kind, width in names)
    try:
        return names, read_rows(lines, head.size, kinds)
    except SceneError:
        # Notes at the end of rows are no columns.
        if len(names) == 2:
            raise
    lines.go(place)
    return names[:2], read_rows(lines, head.size, kinds[:4], more=True)


def _columns_of(properties: str, line: int) -> list[tuple[str, str, int]]:
    """Return the name, the kind and the width of each column of `Properties`."""
    parts = properties.split(":")
    triples = list(zip(parts[::3], parts[1::3], parts[2::3], strict=False))
    for name, kind, width in triples:
        if not name or kind not in set("RISL") or not re.fullmatch("[1-9][0-9]{0,2}", width):
            problem = f"expected name:R, I, S or L:width, got {short(f'{name}:{kind}:{width}')!r}"
            raise SceneError(f"line {line}: Properties: {problem}")
    if len(parts) % 3:
        problem = f"expected three parts for each column, got {short(properties)!r}"
        raise SceneError(f"line {line}: Properties: {problem}")
    names = [name for name, _, _ in triples]
    twice = name_twice(names)
    if twice is not None:
        problem = f"expected each column once, got {short(twice)!r} twice"
        raise SceneError(f"line {line}: Properties: {problem}")
    places = [name for name in sorted(names, key=_POS.__ne__) if canonical(name) == "position"]
    return [
        (_POS if name in places[:1] else name, kind, int(width)) for name, kind, width in triples
    ]


def _gather(names: list[tuple[str, str, int]], found: "list[Array]") -> "dict[str, Array]":
    """Join the columns that belong together."""
    import numpy as np

    left = iter(found)
    joined = {}
    for name, _, width in names:
        parts = [next(left) for _ in range(width)]
        joined[name] = parts[0] if width == 1 else np.stack(parts, axis=1)
    return joined


def _cell_of(said: dict[str, str], line: int) -> "tuple[Cell | None, Cell | tuple[float, ...]]":
    """Return the cell and its corner, if there is one."""
    import numpy as np

    origin = _numbers(said.get("origin", "0 0 0"), (3,), "Origin", line)
    if "lattice" not in said:
        return None, origin
    edges = _numbers(said["lattice"], (3, 9), "Lattice", line)
    return (np.diag(edges) if len(edges) == 3 else edges.reshape(3, 3)), origin


def _numbers(text: str, counts: tuple[int, ...], key: str, line: int) -> "Cell":
    """Return the numbers of a value of the comment."""
    import numpy as np

    try:
        entries = re.split(r"[\s,\[\]]+", text.strip(" ,[]"))
        found = parsed_all(entries)
    except ValueError:
        found = np.empty(0)
    if len(found) not in counts:
        words = " or ".join(map(str, counts))
        raise SceneError(f"line {line}: {key}: expected {words} numbers, got {short(text)!r}")
    return found


def _periodic_of(said: dict[str, str], line: int) -> tuple[bool, bool, bool]:
    """Return along which edges the cell repeats."""
    words = re.split(r"[\s,]+", said.get("pbc", "T T T").strip(" ,"))
    truth = {"t": True, "true": True, "1": True, "f": False, "false": False, "0": False}
    found = [truth.get(word.lower()) for word in words]
    if len(found) != 3 or None in found:
        shown = short(said["pbc"])
        raise SceneError(f"line {line}: pbc: expected T or F three times, got {shown!r}")
    one, two, three = map(bool, found)
    return one, two, three


def _number(text: str | None) -> float | None:
    """Return a number of the comment; None if it is none, as comments may say anything."""
    try:
        return parsed(text) if text is not None else None
    except ValueError:
        return None
