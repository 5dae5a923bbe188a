"""Turns what a scene file says of many spheres into `Spheres`, with the arrays it names."""

from collections.abc import Sequence
from pathlib import Path

from msgspec import UNSET

from vtray.array_file import read_arrays
from vtray.errors import SceneError
from vtray.json_tree import short
from vtray.scene import Object, Plane, Sphere, SpheresInFile
from vtray.scene_check import hints_of
from vtray.scene_words import expected, nearest
from vtray.spheres import COLUMNS, Spheres, array_words, from_arrays


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
        One line for each array that is not known.

    Raises
    ------
    SceneError
        If a file cannot be read, or an array is missing, not right, or given twice.
    """
    complete: list[Object] = []
    unknown: list[str] = []
    for index, item in enumerate(objects):
        if isinstance(item, SpheresInFile):
            complete.append(_read_spheres(item, Path(folder), f"objects[{index}]", unknown))
        else:
            complete.append(item)
    return complete, unknown


def _read_spheres(item: SpheresInFile, folder: Path, place: str, unknown: list[str]) -> Spheres:
    """Read one file of arrays; append a line to `unknown` for each that is not known."""
    file = short(item.data, 100)
    where = f"{place}.data: {file}"
    try:
        arrays, others = read_arrays(folder / item.data, COLUMNS, alone="center")
    except SceneError as problem:
        raise SceneError(f"{where}: {problem}") from None
    given = {name: getattr(item, name, UNSET) for name in COLUMNS}
    given = {name: value for name, value in given.items() if value is not UNSET}
    for name in COLUMNS:
        if name in given and name in arrays:
            twice = f"given here and in {file}; expected it in one of them"
            raise SceneError(f"{place}.{name}: {twice}")
        if name not in given and name not in arrays:
            raise _missing(name, place, file, others)
    spheres = from_arrays({**arrays, **given}, f"{where}: ").read_from(folder / item.data)
    for other in others:
        text = f"unknown array, ignored; the nearest known array is {nearest(other, list(COLUMNS))}"
        unknown.append(f"{where}: {short(other)}: {text}")
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
