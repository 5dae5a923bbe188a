"""HDF5 files, by h5py: tables, snapshots of Gadget and its kin, H5MD and openPMD.

References
----------
https://docs.h5py.org, https://wwwmpa.mpa-garching.mpg.de/gadget4/gadget4_manual.pdf (section 8)
"""

import contextlib
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from vtray.base.caller_warning import warn_caller
from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.object_column import without_objects
from vtray.scene.particles.column_names import canonical
from vtray.scene.particles.from_columns import from_columns, places_among
from vtray.scene.particles.joined_groups import joined_groups
from vtray.scene.particles.particles import POSITION, Particles
from vtray.scene.readers import h5md_file, openpmd_file
from vtray.scene.readers.frames import Steps, frame_number
from vtray.scene.readers.libraries import check_bytes, told
from vtray.scene.readers.reader_table import Given
from vtray.scene.readers.snapshot_files import files_of_snapshot

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vtray.scene.particles.joined_groups import Group

    Array = NDArray[Any]

_WHAT = "an HDF5 file"

_HEADS = ("Header", "/")
"""The groups whose attributes may tell the size of the box, and the time."""

_PLACES = {*POSITION, "position"}
"""What the places are called here."""

_KIND, _MASSES = "PartType", "Masses"
"""What snapshots call a group, before its number, and the masses in it."""

_COPIES = 2
"""How many copies of an array are in memory at once."""


def read(given: Given) -> Particles:
    """Read a frame of an HDF5 file.

    H5MD and openPMD have frames. In all others, the places are arrays of the file or of a group in
    it: ``x``, ``y`` and ``z``, or ``position`` and what else that may be called. Where several
    groups have some, as ``PartType0`` and ``PartType4``, all are read: ``type`` is the name of the
    group, and what is not known in one is NaN there. The attributes ``BoxSize`` and ``Time`` of
    ``Header`` are the cell, with its corner at the origin, and the time; ``MassTable`` has the
    masses of groups whose particles all have one. With one of several files of a snapshot, those
    beside it are read.

    Raises
    ------
    SceneError
        The file is not right, or has no such frame; or one of its snapshot is missing.
    ExtraError
        h5py is not installed.
    """
    with _opened(given.path) as file:
        files, said = _files_of(file, given.path), _count_of_files(file)
        frames = _frames_of(file, files, given.columns)
        found = frames[frame_number(given.frame, len(frames))]()
    _warn_of_others(files, said)
    return found


def steps(given: Given) -> Steps:
    """Give what reads each frame, one after the other."""
    h5py: Any = need("h5py", "tables", "reading HDF5 files")
    with told("h5py", _WHAT):
        file = h5py.File(given.path, "r")
    with file:
        with told("h5py", _WHAT):
            files, said = _files_of(file, given.path), _count_of_files(file)
            frames = _frames_of(file, files, given.columns)
        _warn_of_others(files, said)
        for number, read_frame in enumerate(frames):
            yield partial(_told_frame, read_frame, number)


def read_as_one(given: Given) -> list[str]:
    """Return the files that are read as one with another, itself among them."""
    with _opened(given.path) as file:
        return _files_of(file, given.path)


@contextlib.contextmanager
def _opened(path: str, what: str = _WHAT) -> Iterator[Any]:
    """Open a file; what h5py raises of it becomes a SceneError."""
    h5py: Any = need("h5py", "tables", "reading HDF5 files")
    with told("h5py", what), h5py.File(path, "r") as file:
        yield file


def _told_frame(read_frame: Callable[[], Particles], number: int) -> Particles:
    """Read a frame; what h5py raises becomes a SceneError."""
    with told("h5py", f"frame {number} of {_WHAT}"):
        return read_frame()


def _frames_of(
    file: Any,  # noqa: ANN401
    files: Sequence[str],
    called: Mapping[str, str],
) -> list[Callable[[], Particles]]:
    """Return what reads each frame of an open file, of whose snapshot `files` are all files."""
    if h5md_file.is_h5md(file):
        return [partial(h5md_file.read_frame, file, k) for k in range(h5md_file.count(file))]
    iterations = openpmd_file.iterations_of(file)
    if iterations:
        return [partial(openpmd_file.read_iteration, of, k) for k, of in enumerate(iterations)]
    return [partial(_read_snapshot, file, files, called)]


def _count_of_files(file: Any) -> int:  # noqa: ANN401
    """Return over how many files a snapshot is spread."""
    import numpy as np

    attributes = file["Header"].attrs if "Header" in file else {}
    said = np.array(attributes.get("NumFilesPerSnapshot", 1)).ravel()
    return int(said[0]) if said.size == 1 and said.dtype.kind in "iu" else 1


def _files_of(file: Any, path: str) -> list[str]:  # noqa: ANN401
    """Return the names of the files of a snapshot, by an open one and its name."""
    return files_of_snapshot(path, _count_of_files(file))


def _warn_of_others(files: Sequence[str], said: int) -> None:
    """Warn that a file has but a part of a snapshot, which `said` files have as a whole."""
    if len(files) < said:
        warn_caller(f"the file is one of {said} of its snapshot, and the others are not read")


def _read_snapshot(
    file: Any,  # noqa: ANN401
    files: Sequence[str],
    called: Mapping[str, str],
) -> Particles:
    """Read what a file without frames has, and what others have of its snapshot, by their names."""
    names, parts = _read_groups(file, called) if len(files) == 1 else _read_files(files, called)
    return replace(from_columns(joined_groups(parts), names), **_of_frame(file))


def _read_files(
    files: Sequence[str], called: Mapping[str, str]
) -> "tuple[Mapping[str, str], list[Group]]":
    """Read the groups of several files, as `_read_groups` does: group by group.

    Raises
    ------
    SceneError
        One is no such file; or none has what was asked for.
    """
    wanted, needed = [], 0
    for path in files:
        with _opened_part(path, len(files)) as file:
            tables = _tables_of(file)
            if _has_some(tables, called):
                _, groups = _chosen(tables, called)
                needed += sum(map(_bytes_of, groups.values()))
                wanted.append(path)
    check_bytes(needed)
    names, parts = called, []
    for path in wanted or files[:1]:  # which says what is not there
        with _opened_part(path, len(files)) as file:
            names, found = _read_groups(file, called)
            parts += found
    return names, sorted(parts, key=lambda part: part[0])


@contextlib.contextmanager
def _opened_part(path: str, count: int) -> Iterator[Any]:
    """Open one of the files of a snapshot; what is wrong with it names it."""
    name = os.path.basename(path)
    with _opened(path, f"an HDF5 file in {name}") as file:
        said = _count_of_files(file)
        if said != count:
            raise SceneError(f"{name} beside it is one of {said} files; expected one of {count}")
        yield file


def _read_groups(
    file: Any,  # noqa: ANN401
    called: Mapping[str, str],
) -> "tuple[Mapping[str, str], list[Group]]":
    """Read the groups of a file that have places.

    Returns
    -------
    names : mapping of str to str
        What columns are called, without the names of groups.
    parts : list of Group
        The groups.
    """
    import numpy as np

    names, groups = _chosen(_tables_of(file), called)
    check_bytes(sum(map(_bytes_of, groups.values())))
    read = {path: {k: _values_of(of) for k, of in group.items()} for path, group in groups.items()}
    for path, columns in read.items():
        mass = _mass_of(file, path)
        if mass > 0 and "mass" not in map(canonical, columns):
            columns[_MASSES] = np.full(len(next(iter(columns.values()))), mass)
    return names, [*read.items()]


def _mass_of(file: Any, path: str) -> float:  # noqa: ANN401
    """Return the mass of all particles of a group, which a snapshot may have in its head; else 0.

    As it has there, by the number of the group: 2 for PartType2.
    """
    import numpy as np

    number = path.removeprefix(_KIND)
    known = np.array(file["Header"].attrs.get("MassTable", ()) if "Header" in file else ())
    if not path.startswith(_KIND) or not number.isdecimal() or known.dtype.kind not in "iuf":
        return 0.0
    return float(known[int(number)]) if known.ndim == 1 and int(number) < len(known) else 0.0


def _chosen(
    tables: dict[str, dict[str, Any]], called: Mapping[str, str]
) -> tuple[Mapping[str, str], dict[str, dict[str, Any]]]:
    """Return what columns are called, without the names of groups, and the arrays to read.

    Raises
    ------
    SceneError
        No group has places, or what was asked for.
    """
    if _names_places(called):
        names, path = _in_one_table(called, tables)
        return names, {path: _columns_of(tables[path], names.values())}
    chosen = {path: table for path, table in tables.items() if places_among(table)}
    # Where a group is called position, x, y and z of others are velocities, for instance.
    called_so = [path for path in chosen if canonical(path.rpartition("/")[2]) == "position"]
    chosen = {path: chosen[path] for path in called_so or chosen}
    if not chosen:
        remedy = "columns={'position': 'stars/r'}, or --position stars/r, says which they are"
        words = "expected arrays x, y and z, or position, in the file or a group of it"
        raise SceneError(f"{words}, got {_known(tables)}; {remedy}")
    if "/" in chosen:
        chosen = {"/": chosen["/"]}
    return called, {path: _columns_of(table) for path, table in chosen.items()}


def _names_places(called: Mapping[str, str]) -> bool:
    """Tell whether names of columns say which are the places, or in which group these are."""
    return not _PLACES.isdisjoint(called) or any("/" in name for name in called.values())


def _has_some(tables: dict[str, dict[str, Any]], called: Mapping[str, str]) -> bool:
    """Tell whether a file has something of what is asked for; one without stars has none."""
    if not _names_places(called):
        return any(map(places_among, tables.values()))
    names = [*called.values()]
    names = [name for name in names if "/" in name] or names
    return any(_paths_with(name, tables) for name in names)


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
    found = {name: theirs.strip("/").rpartition("/")[2] for name, theirs in called.items()}
    paths = {name: _paths_with(theirs, tables) for name, theirs in called.items()}
    lacking = next((name for name in called if not paths[name]), None)
    if lacking is not None:
        words = f"no array {called[lacking]!r}; there are {_known(tables)}"
        raise SceneError(f"columns[{lacking!r}]: {words}")
    first, *others = paths.values()
    common = [path for path in first if all(path in other for other in others)]
    if not common:
        listed = ", ".join(sorted({each[0] for each in paths.values()}))
        raise SceneError(f"columns: expected arrays of one group, got some of {listed}")
    return found, common[0]


def _paths_with(name: str, tables: dict[str, dict[str, Any]]) -> list[str]:
    """Return which groups have an array of a name, before which that of its group may stand."""
    group, _, last = name.strip("/").rpartition("/")
    return [path for path in tables if last in tables[path] and group in ("", path)]


def _known(tables: dict[str, dict[str, Any]]) -> str:
    """Return the names of all arrays, with those of their groups, for messages."""
    names = [f"{path}/{name}".lstrip("/") for path, table in tables.items() for name in table]
    return short(", ".join(names), 100) or "none"


def _columns_of(table: dict[str, Any], wanted: Any = ()) -> dict[str, Any]:  # noqa: ANN401
    """Return the arrays of a group that are as long as its places, or as what is wanted."""
    places = [*wanted] or places_among(table)
    count = len(table[places[0]])
    return {name: of for name, of in table.items() if name in places or len(of) == count}


def _bytes_of(arrays: dict[str, Any]) -> int:
    """Return how much memory it takes to read arrays."""
    sizes: list[int] = [math.prod(of.shape) * of.dtype.itemsize for of in arrays.values()]
    return _COPIES * sum(sizes)


def _values_of(array: Any) -> "Array":  # noqa: ANN401
    """Read an array: texts as those of NumPy, numbers in the order of bytes of the machine."""
    import numpy as np

    if array.dtype.kind in "SO":
        return without_objects(np.asarray(array[...]))
    values = np.asarray(array[...])
    return values.astype(values.dtype.newbyteorder("="), copy=False)


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
