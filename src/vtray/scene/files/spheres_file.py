"""Turns what a scene file says of many spheres into `Spheres`, with the arrays it names."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from msgspec import UNSET

from vtray.base.capacity import MAX_SPHERES
from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.scene_check import hints_of
from vtray.scene.checks.scene_words import Unknown, expected, nearest
from vtray.scene.files.array_file import ArrayFileError, read_arrays
from vtray.scene.scene import Object, Plane, Sphere, SpheresInFile
from vtray.scene.spheres import COLUMNS, Spheres, array_words, check_shapes, from_arrays


def with_arrays(
    objects: Sequence[Sphere | Plane | SpheresInFile], folder: str
) -> tuple[list[Object], list[str]]:
    """Read the arrays of all spheres.

    Parameters
    ----------
    objects
        The objects of a scene as they stand in a file.
    folder
        What paths are relative to.

    Returns
    -------
    objects : list
        The same, with `Spheres` instead of what names their files.
    unknown : list of str
        Lines about the arrays that are not known.

    Raises
    ------
    SceneError
        If a file cannot be read, or an array is missing, not right, or given twice.
    """
    complete: list[Object] = []
    unknown = Unknown("array")
    count = len(objects)
    for index, item in enumerate(objects):
        if isinstance(item, SpheresInFile):
            place = f"objects[{index}]"
            count -= 1
            spheres = _read_spheres(item, Path(folder), place, MAX_SPHERES - count, unknown)
            count += len(spheres)
            complete.append(spheres)
        else:
            complete.append(item)
    return complete, unknown.lines()


def _read_spheres(
    item: SpheresInFile, folder: Path, place: str, most: int, unknown: Unknown
) -> Spheres:
    """Read one file of arrays of at most so many spheres; note those that are not known."""
    file = short(item.data, 100)
    where = f"{place}.data: {file}"
    given = {name: getattr(item, name, UNSET) for name in COLUMNS}
    given = {name: value for name, value in given.items() if value is not UNSET}

    def check(arrays: dict[str, Any], others: list[str]) -> None:
        for name in COLUMNS:
            if name in given and name in arrays:
                twice = f"given here and in {file}; expected it in one of them"
                raise SceneError(f"{place}.{name}: {twice}")
            if name not in given and name not in arrays:
                raise _missing(name, place, file, others)
        shaped = check_shapes({**arrays, **given}, f"{where}: ")
        if len(shaped["center"]) > most:
            count = f"{len(shaped['center'])}, {most} of {MAX_SPHERES} are left"
            raise SceneError(f"{where}: center: expected fewer spheres, got {count}")

    try:
        arrays, others = read_arrays(folder / item.data, COLUMNS, alone="center", check=check)
    except ArrayFileError as problem:
        raise SceneError(f"{where}: {problem}") from None
    spheres = from_arrays({**arrays, **given}, f"{where}: ").read_from(folder / item.data)
    for other in others:
        unknown.add(f"{where}: {short(other)}", other, list(COLUMNS))
    return spheres


def _missing(name: str, place: str, file: str, others: list[str]) -> SceneError:
    """Give the error for an array that is not there, with the one that may be meant for it."""
    close = nearest(name, others, cutoff=0.6)
    hint = f" (is {close} meant for it?)" if close else ""
    if name == "center":
        problem = f"missing; expected {array_words(name)}{hint}"
        return SceneError(f"{place}.data: {file}: {name}: {problem}")
    words = expected(hints_of(SpheresInFile)[name])
    array = f", or an array {name} in {file}{hint}" if file.endswith(".npz") else ""
    return SceneError(f"{place}.{name}: missing; expected {words}{array}")
