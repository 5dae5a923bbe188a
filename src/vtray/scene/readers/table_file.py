"""Tables: .csv by Python and NumPy, .npz by NumPy, .parquet by pyarrow."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.base.input_file import read_stream
from vtray.base.memory import lack_of_memory
from vtray.scene.checks.given_array import without_categories
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.from_columns import from_columns
from vtray.scene.particles.particles import POSITION, Particles
from vtray.scene.readers.csv_columns import are_numbered, csv_columns, in_line, without_comments
from vtray.scene.readers.frames import frame_number
from vtray.scene.readers.libraries import check_room, told
from vtray.scene.readers.reader_table import Given

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

CELLS = {"cell", "box", "lattice"}
"""What the three vectors of a cell, or its three lengths, are called in .npz files."""

PERIODIC = {"periodic", "pbc"}
"""What three truths are called that say along which edges of the cell all repeats, likewise."""


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
        text = without_comments(_read_text(given))
        columns = _placed(csv_columns(text), given.columns)
        return from_columns(columns, given.columns, partial(in_line, text))
    columns = {"npz": _read_npz, "parquet": _read_parquet}[given.format](given)
    of_frame = _taken_out(columns) if given.format == "npz" else {}
    return replace(from_columns(columns, given.columns), **of_frame)


def _read_text(given: Given) -> str:
    """Read the text of a .csv file."""
    try:
        return read_stream(given.file).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError(f"byte {error.start}: not UTF-8; expected text") from None


def _placed(columns: "dict[str, Array]", called: Mapping[str, str]) -> "dict[str, Array]":
    """Call three columns without names x, y and z; raise SceneError if there are others."""
    if called or not columns or not are_numbered(columns):
        return columns
    if len(columns) != len(POSITION):
        problem = f"expected the names of the columns, or three numbers, got {len(columns)}"
        names = '{"x": "1", "y": "2", "z": "3"}'
        remedy = f"columns={names}, or --position 1,2,3, says which are the places"
        raise SceneError(f"{problem}; {remedy}")
    return dict(zip(POSITION, columns.values(), strict=True))


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
        # A thread that still holds the file when Python ends would end it by SIGABRT.
        table = parquet.ParquetFile(given.file, pre_buffer=False).read(use_threads=False)
        return {name: without_categories(table[name]).to_numpy() for name in table.column_names}
