"""Turns what a scene file says of many objects into `Arrays`, with the arrays it names."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from msgspec import UNSET

from vtray.base.capacity import MAX_SPHERES
from vtray.base.errors import SceneError
from vtray.scene.array_file import ArrayFileError, read_arrays
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.checks.columns import array_words, check_shapes
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.scene_check import hints_of
from vtray.scene.checks.scene_words import Unknown, expected, nearest, tags
from vtray.scene.files.in_file import ArraysInFile, CopiesInFile, ObjectInFile
from vtray.scene.objects import Object

if TYPE_CHECKING:
    from vtray.scene.arrays import Arrays
    from vtray.scene.copies import Copies


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
        The same, with `Arrays` and `Copies` instead of what names their files.
    unknown : list of str
        Lines about the arrays that are not known.

    Raises
    ------
    SceneError
        If a file cannot be read, or an array is missing, not right, or given twice.
    """
    within = [part for item in objects if isinstance(item, CopiesInFile) for part in item.objects]
    counts = Counter[type](map(type, [*objects, *within]))
    reader = _Reader(Path(folder), counts, Unknown("array"))
    return reader.complete(objects, "objects"), reader.unknown.lines()


class _Reader(NamedTuple):
    """Reads the arrays of a scene.

    Attributes
    ----------
    folder
        What paths are relative to.
    counts
        How many objects of each type there are so far, those of copies once.
    unknown
        The arrays that are not known.
    """

    folder: Path
    counts: Counter[type]
    unknown: Unknown

    def complete(self, objects: Sequence[Any], place: str) -> list[Any]:
        """Return objects with all arrays that they name."""
        return [
            self._complete(item, f"{place}[{index}]")
            if isinstance(item, (ArraysInFile, CopiesInFile))
            else item
            for index, item in enumerate(objects)
        ]

    def _complete(self, item: ArraysInFile | CopiesInFile, place: str) -> ArrayHolder:
        """Return what a file says of many objects, or of copies, with its arrays."""
        if isinstance(item, ArraysInFile):
            names = [*item.MADE.COLUMNS, "material"]
            given = {name: getattr(item, name, UNSET) for name in names}
            given = {name: value for name, value in given.items() if value is not UNSET}
            made = self._read(item, given, place, MAX_SPHERES - self.counts[item.ONE])
            self.counts[item.ONE] += len(made)
            return made
        given = {"objects": self.complete(item.objects, f"{place}.objects")}
        if item.at is UNSET:
            return self._read(item, given, place, MAX_SPHERES)
        given["at"] = [(v.x, v.y, v.z) for v in item.at]
        return item.MADE.from_arrays(given, f"{place}.")

    def _read(
        self,
        item: ArraysInFile | CopiesInFile,
        given: dict[str, Any],
        place: str,
        most: int,
    ) -> "Arrays | Copies":
        """Read one file of arrays of at most so many rows; note those that are not known."""
        assert item.data is not UNSET  # noqa: S101
        data: str = item.data
        file = short(data, 100)
        where = f"{place}.data: {file}"
        columns = item.MADE.COLUMNS
        first = next(iter(columns))

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

        try:
            arrays, others = read_arrays(self.folder / data, columns, alone=item.ALONE, check=check)
        except ArrayFileError as problem:
            raise SceneError(f"{where}: {problem}") from None
        for other in others:
            self.unknown.add(f"{where}: {short(other)}", other, list(columns))
        made = item.MADE.from_arrays({**arrays, **given}, f"{where}: ")
        return made.read_from(self.folder / data)


def _missing(
    name: str, item: ArraysInFile | CopiesInFile, place: str, file: str, others: list[str]
) -> SceneError:
    """Give the error for an array that is not there, with the one that may be meant for it."""
    close = nearest(name, others, cutoff=0.6)
    hint = f" (is {close} meant for it?)" if close else ""
    if isinstance(item, CopiesInFile) or name not in item.__struct_fields__:
        problem = f"missing; expected {array_words(item.MADE.COLUMNS[name])}{hint}"
        return SceneError(f"{place}.data: {file}: {name}: {problem}")
    words = expected(hints_of(type(item))[name])
    array = f", or an array {name} in {file}{hint}" if file.endswith(".npz") else ""
    return SceneError(f"{place}.{name}: missing; expected {words}{array}")
