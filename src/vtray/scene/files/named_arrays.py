"""Turns what a scene file says of many objects into `Arrays`, with the arrays it names."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from msgspec import UNSET

from vtray.base.capacity import MAX_SPHERES
from vtray.base.errors import SceneError
from vtray.scene.arrays import Arrays
from vtray.scene.checks.columns import array_words, check_shapes
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.scene_check import hints_of
from vtray.scene.checks.scene_words import Unknown, expected, nearest, tags
from vtray.scene.files.array_file import ArrayFileError, read_arrays
from vtray.scene.files.in_file import ArraysInFile, ObjectInFile
from vtray.scene.objects import Object


def with_arrays(objects: Sequence[ObjectInFile], folder: str) -> tuple[list[Object], list[str]]:
    """Read the arrays of all objects that name a file of them.

    Parameters
    ----------
    objects
        The objects of a scene as they stand in a file.
    folder
        What paths are relative to.

    Returns
    -------
    objects : list
        The same, with `Arrays` instead of what names their files.
    unknown : list of str
        Lines about the arrays that are not known.

    Raises
    ------
    SceneError
        If a file cannot be read, or an array is missing, not right, or given twice.
    """
    complete: list[Any] = []
    unknown = Unknown("array")
    counts = Counter[type](map(type, objects))
    for index, item in enumerate(objects):
        if isinstance(item, ArraysInFile):
            most = MAX_SPHERES - counts[item.ONE]
            arrays = _read(item, Path(folder), f"objects[{index}]", most, unknown)
            counts[item.ONE] += len(arrays)
            complete.append(arrays)
        else:
            complete.append(item)
    return complete, unknown.lines()


def _read(item: ArraysInFile, folder: Path, place: str, most: int, unknown: Unknown) -> Arrays:
    """Read one file of arrays of at most so many objects; note those that are not known."""
    file = short(item.data, 100)
    where = f"{place}.data: {file}"
    columns = item.MADE.COLUMNS
    first = next(iter(columns))
    given = {name: getattr(item, name, UNSET) for name in columns}
    given = {name: value for name, value in given.items() if value is not UNSET}

    def check(arrays: dict[str, Any], others: list[str]) -> None:
        for name, column in columns.items():
            if name in given and name in arrays:
                twice = f"given here and in {file}; expected it in one of them"
                raise SceneError(f"{place}.{name}: {twice}")
            if name not in given and name not in arrays and not column.stand_in:
                raise _missing(name, item, place, file, others)
        shaped = check_shapes(columns, {**arrays, **given}, f"{where}: ")
        if len(shaped[first]) > most:
            (kind,) = tags([type(item)])
            count = f"{len(shaped[first])}, {most} of {MAX_SPHERES} are left"
            raise SceneError(f"{where}: {first}: expected fewer {kind}, got {count}")

    path = folder / item.data
    try:
        arrays, others = read_arrays(path, columns, alone=item.ALONE, check=check)
    except ArrayFileError as problem:
        raise SceneError(f"{where}: {problem}") from None
    for other in others:
        unknown.add(f"{where}: {short(other)}", other, list(columns))
    return item.MADE.from_arrays({**arrays, **given}, f"{where}: ").read_from(path)


def _missing(name: str, item: ArraysInFile, place: str, file: str, others: list[str]) -> SceneError:
    """Give the error for an array that is not there, with the one that may be meant for it."""
    close = nearest(name, others, cutoff=0.6)
    hint = f" (is {close} meant for it?)" if close else ""
    if name not in item.__struct_fields__:
        problem = f"missing; expected {array_words(item.MADE.COLUMNS[name])}{hint}"
        return SceneError(f"{place}.data: {file}: {name}: {problem}")
    words = expected(hints_of(type(item))[name])
    array = f", or an array {name} in {file}{hint}" if file.endswith(".npz") else ""
    return SceneError(f"{place}.{name}: missing; expected {words}{array}")
