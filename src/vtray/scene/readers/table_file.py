"""Tables: .csv by Python alone, .npz by NumPy, .parquet by pyarrow."""

import csv
import io
from dataclasses import replace
from functools import partial
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.base.input_file import read_stream
from vtray.base.memory import lack_of_memory
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.object_column import without_objects
from vtray.scene.particles.column_names import name_twice
from vtray.scene.particles.from_columns import from_columns
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.plain_numbers import parsed_all
from vtray.scene.readers.frames import frame_number
from vtray.scene.readers.libraries import check_room, told
from vtray.scene.readers.reader_table import Given

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_SEPARATORS = ",;\t"

_COMMENT = "#"

CELLS = {"cell", "box", "lattice"}
"""What the three vectors of a cell, or its three lengths, are called in .npz files."""

PERIODIC = {"periodic", "pbc"}
"""What three truths are called that say along which edges of the cell all repeats, likewise."""

_MISSING = {"", "na", "n/a", "nan", "null", "none", "<na>", "-nan"}
"""What .csv files have in the place of a number that is missing, in any case."""

_TRUTHS = {"true": True, "false": False}
"""What they have for what is true or not, in any case."""

_BYTES = 160
"""Of memory for an entry of a .csv file while it is read."""


def read(given: Given) -> Particles:
    """Read a table with the columns x, y and z, or an array `position` of shape (n, 3).

    Raises
    ------
    SceneError
        The file is not right, or does not have these columns. The message names the line.
    ExtraError
        pyarrow, for .parquet, is not installed.
    """
    frame_number(given.frame, 1)
    if given.format == "csv":
        text = _without_comments(_read_text(given))
        return from_columns(_csv_columns(text), given.columns, partial(_in_line, text))
    columns = {"npz": _read_npz, "parquet": _read_parquet}[given.format](given)
    of_frame = _taken_out(columns) if given.format == "npz" else {}
    return replace(from_columns(columns, given.columns), **of_frame)


def _read_text(given: Given) -> str:
    """Read the text of a .csv file."""
    try:
        return read_stream(given.file).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError(f"byte {error.start}: not UTF-8; expected text") from None


def _without_comments(text: str) -> str:
    """Return a text whose comments before all else are empty lines.

    The last of them stays if it names the columns, as those of NumPy do: where numbers follow.
    """
    count, last, rest = 0, "", text
    while rest.startswith(_COMMENT):
        last, _, rest = rest.partition("\n")
        count += 1
    if count == 0:
        return text
    separator = _separator(rest)
    first = _first_line(rest).split(separator)
    has_numbers = any(_column([entry]).dtype.kind in "if" for entry in first)
    is_named = has_numbers and last.count(separator) == len(first) - 1
    names = last.lstrip(_COMMENT) if is_named else ""
    return "\n" * (count - 1) + names + "\n" + rest


def _csv_columns(text: str) -> "dict[str, Array]":
    """Return columns between commas, semicolons or tabs, named in the first line."""
    entries = _first_line(text).count(_separator(text)) + 1
    lack = lack_of_memory(_BYTES * entries * text.count("\n"))
    if lack:
        raise SceneError(f"reading it needs about {lack}")
    lines, begin = _csv_lines(text), 1
    try:
        names = [name.strip() for name in next(filter(None, lines), [])]
        _check_names(names, lines.line_num or 1)
        rows, begin = [], lines.line_num + 1
        for row in lines:
            if len(row) != len(names) and row:
                words = f"expected {len(names)} entries, got {len(row)}"
                raise SceneError(f"line {begin}: {words}")
            if row:
                rows.append(row)
            begin = lines.line_num + 1
    except csv.Error as error:
        words = "a quote has no end" if lines.line_num > begin else str(error)
        raise SceneError(f"line {begin}: {words}") from None
    parts = zip(*rows, strict=True) if rows else ([] for _ in names)
    return {name: _column(list(part)) for name, part in zip(names, parts, strict=True)}


def _separator(text: str) -> str:
    """Return what is between the entries of a text."""
    return max(_SEPARATORS, key=_first_line(text).count)


def _first_line(text: str) -> str:
    """Return the first line of a text that is not empty."""
    begun = text.lstrip("\r\n")
    end = begun.find("\n")
    return begun if end < 0 else begun[:end]  # what follows may be long, and is not copied


def _csv_lines(text: str) -> Any:  # noqa: ANN401
    """Return a reader of the lines of a text, entry by entry."""
    file = io.StringIO(text, newline="")
    return csv.reader(file, delimiter=_separator(text), skipinitialspace=True, strict=True)


def _in_line(text: str, row: int, name: str) -> str:
    """Return where an entry stands, given its row below the names and the name of its column."""
    lines = _csv_lines(text)
    rows = (lines.line_num for entries in lines if entries)
    return f"line {next(islice(rows, row + 1, None))}: column {name!r}"


def _check_names(names: list[str], line: int) -> None:
    """Raise SceneError if a line does not name the columns."""
    are_numbers = bool(names) and all(_column([name]).dtype.kind in "if" for name in names)
    if not any(names) or are_numbers:
        shown = short(",".join(names)) or "nothing"
        raise SceneError(f"line {line}: expected the names of the columns, got {shown}")
    twice = name_twice(names)
    if twice is not None:
        raise SceneError(f"line {line}: expected each column once, got {short(twice)!r} twice")


def _column(entries: list[str]) -> "Array":
    """Return entries as integers, numbers (NaN where one is missing), truths, or text."""
    import numpy as np

    for parse in (int, float, _number_or_nan):
        try:
            return parsed_all(entries, parse)
        except (ValueError, OverflowError):
            continue
    words = [entry.strip() for entry in entries]
    if {word.lower() for word in words} - _MISSING <= _TRUTHS.keys():
        return without_objects(np.array([_TRUTHS.get(word.lower()) for word in words], object))
    return np.array(words, np.str_)


def _number_or_nan(entry: str) -> float:
    """Return an entry as a number, NaN where it says that there is none."""
    return float("nan") if entry.strip().lower() in _MISSING else float(entry)


def _read_npz(given: Given) -> "dict[str, Array]":
    """Read the arrays of a .npz file."""
    from vtray.scene.array_file import read_arrays

    def check(arrays: "dict[str, Array]", _: list[str]) -> None:
        needed = sum(array.size * array.dtype.itemsize for array in arrays.values())
        lack = lack_of_memory(needed)
        if lack:
            raise SceneError(f"its arrays need {lack}")

    names = ["position"] if given.path.lower().endswith(".npy") else _names_of(given)
    arrays, _ = read_arrays(Path(given.path), names, alone="position", check=check)
    records = arrays.get("position")
    if records is not None and records.dtype.names:
        return {name: records[name] for name in records.dtype.names}
    return arrays


def _taken_out(arrays: "dict[str, Array]") -> dict[str, Any]:
    """Take out of arrays what is known of the whole frame: its cell, what repeats, bonds, time.

    What else has such a name, as a second cell, stays, and is taken for a column.
    """
    import numpy as np

    found: dict[str, Any] = {}
    for name, array in [*arrays.items()]:
        is_cell = name.lower() in CELLS and array.shape in {(3,), (3, 3)}
        if is_cell and "cell" not in found:
            found["cell"] = np.diag(array) if array.ndim == 1 else array
            found.setdefault("periodic", None)  # along all its edges
            del arrays[name]
        elif name.lower() in PERIODIC and array.shape == (3,) and set(array.tolist()) <= {0, 1}:
            found["periodic"] = tuple(map(bool, array.tolist()))
            del arrays[name]
        elif name.lower() == "origin" and array.shape == (3,) and array.dtype.kind in "iuf":
            found["origin"] = arrays.pop(name)
        elif name.lower() == "bonds" and array.ndim == 2 and array.shape[1] == 2:
            found["bonds"] = arrays.pop(name)
        elif name.lower() == "time" and array.shape == () and array.dtype.kind in "biuf":
            found["time"] = float(arrays.pop(name))
    return found


def _names_of(given: Given) -> list[str]:
    """Return the names of the arrays of a .npz file."""
    import zipfile

    try:
        with zipfile.ZipFile(given.file) as whole:
            return [name.removesuffix(".npy") for name in whole.namelist()]
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError) as error:
        raise SceneError(f"expected a .npz file ({short(str(error), 100)})") from None


def _read_parquet(given: Given) -> "dict[str, Array]":
    """Read the columns of a Parquet file."""
    parquet: Any = need("pyarrow.parquet", "tables", "reading Parquet files")
    check_room(given.file, 3)
    with told("pyarrow", "a Parquet file"):
        table = parquet.read_table(given.file)
        columns = {}
        for name in table.column_names:
            column = table[name]
            if hasattr(column.type, "value_type") and hasattr(column.type, "index_type"):
                column = column.cast(column.type.value_type)  # categories as what they stand for
            columns[name] = column.to_numpy()
        return columns
