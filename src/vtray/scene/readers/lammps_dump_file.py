"""Dumps of LAMMPS as text, with NumPy alone.

References
----------
https://docs.lammps.org/dump.html, https://docs.lammps.org/Howto_triclinic.html
"""

import re
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.column_names import IMAGES, name_columns
from vtray.scene.particles.masses import elements_of_masses
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.plain_numbers import parsed, parsed_all
from vtray.scene.readers.frames import Steps, find_frame, steps_of
from vtray.scene.readers.lines import Lines
from vtray.scene.readers.reader_table import Given
from vtray.scene.readers.rows import check_places, kind_of, read_rows

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Cell = NDArray[np.float64]

_INTEGERS = ("id", "type", "mol", "proc", *IMAGES)

_PLACES = (("x", "y", "z"), ("xu", "yu", "zu"), ("xs", "ys", "zs"), ("xsu", "ysu", "zsu"))
"""What columns of places are called: as they are or unwrapped, then both as shares of the box."""


class _Head(NamedTuple):
    """What stands before the rows of a frame.

    Attributes
    ----------
    size
        How many particles there are.
    names
        Their columns.
    time
        When it was; None if that is not said.
    box
        The lines of the box, its title first.
    line
        The number of the line that names the columns.
    """

    size: int
    names: list[str]
    time: float | None
    box: list[str]
    line: int


def read(given: Given) -> Particles:
    """Read a frame of a dump.

    The columns have the names of the dump; ``vx vy vz`` and ``fx fy fz`` become ``velocity`` and
    ``force``. Elements are those that the dump names, or else those of a column ``mass``. Where
    places are unwrapped (``xu``, ``xsu``), the columns ``ix iy iz`` are 0: nothing is left to
    unwrap.

    Raises
    ------
    SceneError
        The file has no such frame, or it is not right. The message names the line.
    """
    lines = Lines(given.file)
    return _read_frame(lines, *find_frame(lines, given.frame, _read_head, "ITEM: TIMESTEP"))


def steps(given: Given) -> Steps:
    """Give what reads each frame, one after the other."""
    return steps_of(Lines(given.file), _read_head, _read_frame)


def _read_frame(lines: Lines, number: int, head: _Head) -> Particles:
    """Read the rows of a frame, which come next."""
    place = lines.place()
    first = (lines.next() or "").split() if head.size else []
    lines.go(place)
    known = dict.fromkeys(_INTEGERS, "I") | dict.fromkeys(chain(*_PLACES), "R")
    kinds = "".join(
        known.get(name) or (kind_of(first[i]) if i < len(first) else "R")
        for i, name in enumerate(head.names)
    )
    columns = dict(zip(head.names, read_rows(lines, head.size, kinds), strict=True))
    cell, origin, periodic = _box_of(head)
    positions = _places_of(columns, cell, origin, head.line)
    check_places(positions, range(head.line + 1, head.line + 1 + head.size))
    if "mass" in columns and "element" not in columns:
        elements = elements_of_masses(columns["mass"])
        if elements is not None:
            columns = {"element": elements, **columns}
    return Particles(
        positions,
        name_columns(columns),
        cell=cell,
        origin=origin,
        periodic=periodic,
        frame=number,
        time=head.time,
    )


def _read_head(lines: Lines) -> _Head | None:
    """Read what stands before the rows of a frame; None at the end of the file."""
    found: dict[str, str] = {}
    box: list[str] = []
    while (text := lines.next()) is not None:
        item = re.fullmatch(r"ITEM:\s*(.*?)\s*", text)
        if item is None and not text.strip():
            continue
        if item is None:
            shown = short(text.strip())
            raise SceneError(f"line {lines.number}: expected ITEM: ..., got {shown!r}")
        title = item[1]
        if title.startswith("ATOMS"):
            return _head_of(found, box, title.split()[1:], lines.number)
        if title.startswith("BOX BOUNDS"):
            box = [title, *((lines.next() or "") for _ in range(3))]
        else:
            found[title] = (lines.next() or "").strip()
    if found or box:
        raise SceneError(f"line {lines.number}: the file ends; expected ITEM: ATOMS")
    return None


def _head_of(found: dict[str, str], box: list[str], names: list[str], line: int) -> _Head:
    """Return what was found before the rows of a frame."""
    count = found.get("NUMBER OF ATOMS", "")
    if not re.fullmatch("[0-9]{1,18}", count):
        problem = f"expected a number below ITEM: NUMBER OF ATOMS, got {short(count)!r}"
        raise SceneError(f"line {line}: {problem}")
    if not names:
        raise SceneError(f"line {line}: expected the names of the columns behind ITEM: ATOMS")
    if len(set(names)) < len(names):
        raise SceneError(f"line {line}: expected each column once, got {short(' '.join(names))!r}")
    try:
        time = parsed(found["TIME"]) if "TIME" in found else None
    except ValueError:
        time = None
    return _Head(int(count), names, time, box, line)


def _box_of(head: _Head) -> "tuple[Cell | None, Cell, tuple[bool, bool, bool] | None]":
    """Return the cell, its corner, and along which edges it repeats."""
    import numpy as np

    if not head.box:
        return None, np.zeros(3), None
    words = head.box[0].split()[2:]
    try:
        rows = np.array([parsed_all(row.split()) for row in head.box[1:]])
    except ValueError:
        rows = np.empty((0, 0))
    if words[:1] == ["abc"]:
        edges, corner, marks = rows[:, :3], rows[:, 3:].reshape(-1), words[2:]
    elif rows.shape in {(3, 2), (3, 3)}:
        edges, corner = _edges(rows)
        marks = words[3:] if words[:1] == ["xy"] else words
    else:
        edges, corner, marks = np.empty(0), np.empty(0), []
    if edges.shape != (3, 3) or corner.shape != (3,):
        problem = f"expected the bounds of the box, got {short(' / '.join(head.box[1:]), 60)!r}"
        raise SceneError(f"line {head.line}: {problem}")
    one, two, three = (mark == "pp" for mark in ([*marks, "pp", "pp", "pp"])[:3])
    return edges, corner, (one, two, three)


def _edges(rows: "Cell") -> "tuple[Cell, Cell]":
    """Return the edges and the corner of a box by its bounds, and its tilts where there are any."""
    import numpy as np

    low, high = rows[:, 0].copy(), rows[:, 1].copy()
    xy, xz, yz = rows[:, 2] if rows.shape[1] == 3 else (0.0, 0.0, 0.0)
    # The bounds are those of the box around a tilted cell.
    low[0] -= min(0.0, xy, xz, xy + xz)
    high[0] -= max(0.0, xy, xz, xy + xz)
    low[1] -= min(0.0, yz)
    high[1] -= max(0.0, yz)
    x, y, z = high - low
    return np.array([(x, 0, 0), (xy, y, 0), (xz, yz, z)]), low


def _places_of(
    columns: "dict[str, Array]", cell: "Cell | None", origin: "Cell", line: int
) -> "Array":
    """Take the places out of the columns."""
    import numpy as np

    for number, names in enumerate(_PLACES):
        if not all(name in columns for name in names):
            continue
        places: Array = np.stack([columns.pop(name) for name in names], axis=1)
        if names[0].endswith("u"):
            columns |= {name: np.zeros_like(columns[name]) for name in IMAGES if name in columns}
        if number < 2:
            break
        if cell is None:
            raise SceneError(f"line {line}: the columns {' '.join(names)} need a box")
        # One sum after the other: a matrix product adds in the order of the machine.
        scaled = places[:, :1] * cell[0] + places[:, 1:2] * cell[1] + places[:, 2:] * cell[2]
        places = scaled + origin
        break
    else:
        known = short(" ".join(columns), 80)
        remedy = "; places in a plane need a column z of zeros" if "x" in columns else ""
        raise SceneError(f"line {line}: expected the columns x y z, got {known!r}{remedy}")
    for name in ("x", "y", "z"):
        columns.pop(name, None)
    return places
