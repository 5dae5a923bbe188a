"""HDF5 files, by h5py: tables, snapshots of Gadget and its kin, and H5MD.

References
----------
https://docs.h5py.org, https://wwwmpa.mpa-garching.mpg.de/gadget4/gadget4_manual.pdf (section 8)
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from vtray.base.caller_warning import warn_caller
from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.object_column import without_objects
from vtray.scene.particles.from_columns import from_columns, places_among
from vtray.scene.particles.particles import POSITION, Particles
from vtray.scene.readers import h5md_file
from vtray.scene.readers.frames import Steps, frame_number
from vtray.scene.readers.libraries import check_bytes, told
from vtray.scene.readers.reader_table import Given

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_WHAT = "an HDF5 file"

_HEADS = ("Header", "/")
"""The groups whose attributes may tell the size of the box, and the time."""

_PLACES = {*POSITION, "position"}
"""What the places are called here."""

_COPIES = 2
"""How many copies of an array are in memory at once."""


def read(given: Given) -> Particles:
    """Read a frame of an HDF5 file.

    H5MD has frames. In all others, the places are arrays of the file or of a group in it: ``x``,
    ``y`` and ``z``, or ``position`` and what else that may be called. Where several groups have
    some, as ``PartType0`` and ``PartType4``, all are read: ``type`` is the name of the group, and
    what is not known in one is NaN there. The attributes ``BoxSize`` and ``Time`` of ``Header`` are
    the cell, with its corner at the origin, and the time.

    Raises
    ------
    SceneError
        The file is not right, or has no such frame.
    ExtraError
        h5py is not installed.
    """
    h5py: Any = need("h5py", "tables", "reading HDF5 files")
    with told("h5py", _WHAT), h5py.File(given.path, "r") as file:
        number = frame_number(given.frame, _count(file))
        found, files = _read_frame(file, given.columns, number), _files_of(file)
    _warn_of_others(files)
    return found


def steps(given: Given) -> Steps:
    """Give what reads each frame, one after the other."""
    h5py: Any = need("h5py", "tables", "reading HDF5 files")
    with told("h5py", _WHAT):
        file = h5py.File(given.path, "r")
    with file:
        with told("h5py", _WHAT):
            count, files = _count(file), _files_of(file)
        _warn_of_others(files)
        for number in range(count):
            yield partial(_told_frame, file, given.columns, number)


def _told_frame(file: Any, called: Mapping[str, str], number: int) -> Particles:  # noqa: ANN401
    """Read a frame; what h5py raises becomes a SceneError."""
    with told("h5py", f"frame {number} of {_WHAT}"):
        return _read_frame(file, called, number)


def _count(file: Any) -> int:  # noqa: ANN401
    """Return how many frames there are."""
    return h5md_file.count(file) if h5md_file.is_h5md(file) else 1


def _files_of(file: Any) -> int:  # noqa: ANN401
    """Return over how many files a snapshot is spread."""
    import numpy as np

    attributes = file["Header"].attrs if "Header" in file else {}
    said = np.array(attributes.get("NumFilesPerSnapshot", 1)).ravel()
    return int(said[0]) if said.size == 1 and said.dtype.kind in "iu" else 1


def _warn_of_others(files: int) -> None:
    """Warn that a file has but a part of a snapshot."""
    if files > 1:
        warn_caller(f"the file is one of {files} of its snapshot, and the others are not read")


def _read_frame(file: Any, called: Mapping[str, str], number: int) -> Particles:  # noqa: ANN401
    """Read a frame of an open file."""
    if h5md_file.is_h5md(file):
        return h5md_file.read_frame(file, number)
    tables = _tables_of(file)
    if not _PLACES.isdisjoint(called) or any("/" in name for name in called.values()):
        names, path = _in_one_table(called, tables)
        found = from_columns(_columns_of(tables[path], names.values()), names)
    else:
        chosen = {path: table for path, table in tables.items() if places_among(table)}
        if not chosen:
            remedy = "columns={'position': 'stars/r'}, or --position stars/r, says which they are"
            words = "expected arrays x, y and z, or position, in the file or a group of it"
            raise SceneError(f"{words}, got {_known(tables)}; {remedy}")
        if "/" in chosen:
            chosen = {"/": chosen["/"]}
        columns = _joined({path: _columns_of(table) for path, table in chosen.items()})
        found = from_columns(columns, called)
    return replace(found, **_of_frame(file))


def _tables_of(file: Any) -> dict[str, dict[str, Any]]:  # noqa: ANN401
    """Return the arrays of a file by the names of their groups, and their own, the root first.

    The fields of an array of records are as the arrays of a group.
    """
    tables: dict[str, dict[str, Any]] = {"/": {}}

    def take(path: str, node: Any) -> None:  # noqa: ANN401
        group, _, name = path.rpartition("/")
        if getattr(node, "shape", None) is None:
            return
        if node.dtype.names and node.ndim == 1:
            tables[path] = {field: node.fields(field) for field in node.dtype.names}
        elif _is_column(node):
            tables.setdefault(group or "/", {})[name] = node

    file.visititems(take)
    return tables


def _is_column(array: Any) -> bool:  # noqa: ANN401
    """Tell whether an array may be a column: numbers, truths, or texts."""
    if array.dtype.kind in "biuf":
        return array.ndim in (1, 2)
    is_text = array.dtype.kind == "S" or (array.dtype.metadata or {}).get("vlen") in (str, bytes)
    return array.ndim == 1 and is_text


def _in_one_table(
    called: Mapping[str, str], tables: dict[str, dict[str, Any]]
) -> tuple[dict[str, str], str]:
    """Return the names of columns without that of their group, and this one's.

    Raises
    ------
    SceneError
        A column is not there, or they are in several groups.
    """
    found: dict[str, str] = {}
    paths: set[str] = set()
    for name, theirs in called.items():
        group, _, last = theirs.strip("/").rpartition("/")
        where = [path for path in tables if last in tables[path] and group in ("", path)]
        if not where:
            raise SceneError(f"columns[{name!r}]: no array {theirs!r}; there are {_known(tables)}")
        found[name] = last
        paths.add(where[0])
    if len(paths) > 1:
        listed = ", ".join(sorted(paths))
        raise SceneError(f"columns: expected arrays of one group, got some of {listed}")
    return found, paths.pop()


def _known(tables: dict[str, dict[str, Any]]) -> str:
    """Return the names of all arrays, with those of their groups, for messages."""
    names = [f"{path}/{name}".lstrip("/") for path, table in tables.items() for name in table]
    return short(", ".join(names), 100) or "none"


def _columns_of(table: dict[str, Any], wanted: Any = ()) -> "dict[str, Array]":  # noqa: ANN401
    """Read the arrays of a group that are as long as its places, or as what is wanted."""
    places = [*wanted] or places_among(table)
    count = len(table[places[0]])
    chosen = {name: of for name, of in table.items() if name in places or len(of) == count}
    row = sum((*of.shape, 1)[1] * of.dtype.itemsize for of in chosen.values())
    check_bytes(_COPIES * count * row)
    return {name: _values_of(of) for name, of in chosen.items()}


def _values_of(array: Any) -> "Array":  # noqa: ANN401
    """Read an array: texts as those of NumPy, numbers in the order of bytes of the machine."""
    import numpy as np

    if array.dtype.kind in "SO":
        return without_objects(np.asarray(array[...]))
    values = np.asarray(array[...])
    return values.astype(values.dtype.newbyteorder("="), copy=False)


def _joined(parts: "dict[str, dict[str, Array]]") -> "dict[str, Array]":
    """Return the columns of several groups as one, with the name of the group as their type."""
    import numpy as np

    if len(parts) == 1:
        return next(iter(parts.values()))
    counts = {path: len(next(iter(part.values()))) for path, part in parts.items()}
    found: dict[str, Array] = {"type": np.repeat([*counts], [*counts.values()]).astype(np.str_)}
    for name in dict.fromkeys(name for part in parts.values() for name in part):
        known = [part[name] for part in parts.values() if name in part]
        if len({(of.ndim, of.shape[1:], of.dtype.kind == "U") for of in known}) > 1:
            continue  # not the same thing
        lacking = np.str_("") if known[0].dtype.kind == "U" else np.nan
        columns = [
            part[name] if name in part else np.full((counts[path], *known[0].shape[1:]), lacking)
            for path, part in parts.items()
        ]
        found[name if name != "type" else "type2"] = np.concatenate(columns)
    return found


def _of_frame(file: Any) -> dict[str, Any]:  # noqa: ANN401
    """Return the cell and the time that a file tells, as far as it does."""
    import numpy as np

    found: dict[str, Any] = {}
    for name in _HEADS:
        attributes = file[name].attrs if name in file else {}
        sizes = np.array(attributes.get("BoxSize", 0.0))
        if "cell" not in found and sizes.dtype.kind in "iuf" and sizes.size in (1, 3):
            lengths = np.broadcast_to(sizes.ravel(), 3).astype(np.float64)
            if (lengths > 0).all():
                found |= {"cell": np.diag(lengths), "periodic": None}
        time = np.array(attributes.get("Time", ""))
        if "time" not in found and time.dtype.kind in "iuf" and time.size == 1:
            found["time"] = float(time.ravel()[0])
    return found
