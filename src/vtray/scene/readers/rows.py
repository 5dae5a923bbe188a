"""Rows of a text: numbers and names between blanks, as columns.

A block of lines is split at once, with a mark between the lines, which tells whether each has as
many entries as there are columns. Only where that or a number is wrong, lines are looked at one by
one.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.base.memory import lack_of_memory
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.few_names import texts_of
from vtray.scene.particles.plain_numbers import parsed, parsed_all
from vtray.scene.readers.lines import Lines, text_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_MARK = b"\0"
"""What stands for an end of line among the entries; no text holds it."""

_BYTES = {"R": 8, "I": 8, "L": 1, "S": 40}
"""Of memory, for an entry of a column."""

_WORDS = {"R": "a number", "I": "an integer", "L": "T or F", "S": "a name"}

_TRUTH = {b"T": True, b"F": False, b"TRUE": True, b"FALSE": False, b"1": True, b"0": False}


def kind_of(entry: str) -> str:
    """Tell what an entry is: "R", a number, or "S", a name."""
    try:
        parsed(entry)
    except ValueError:
        return "S"
    return "R"


def read_rows(lines: Lines, count: int, kinds: str, more: bool = False) -> "list[Array]":
    """Read the next lines as rows of a table.

    Parameters
    ----------
    lines
        The file, before the first row.
    count
        How many rows there are.
    kinds
        For each column "R" (a number), "I" (an integer), "L" (true or false) or "S" (a name).
    more
        Whether lines may have more entries, which are then left out.

    Returns
    -------
    list of array (n,)
        The columns: float64, int64, bool, or text.

    Raises
    ------
    SceneError
        A row is not as expected, the file ends too early, or there is no memory for so many rows.
        The message names the line.
    """
    import numpy as np

    parts: list[list[Array]] = []
    read = 0
    room = sum(_BYTES[kind] for kind in kinds)
    for block, size in lines.blocks(count):
        lack = lack_of_memory(count * room) if parts else None
        if lack:
            raise SceneError(f"line {lines.number}: {count} rows need {lack}")
        parts.append(_columns(block, size, kinds, more, lines.number - size + 1))
        read += size
    if read < count:
        raise SceneError(f"line {lines.number}: the file ends after {read} of {count} rows")
    if not parts:
        parts = [_columns(b"", 0, kinds, more, 0)]
    return [np.concatenate(column) for column in zip(*parts, strict=True)]


def check_places(positions: "Array", lines: Sequence[int]) -> None:
    """Raise SceneError if a coordinate is not finite.

    Parameters
    ----------
    positions
        The places, (n, 3).
    lines
        The number of the line where each stands.
    """
    import numpy as np

    if np.isfinite(positions).all():
        return
    row, axis = (int(place) for place in np.argwhere(~np.isfinite(positions))[0])
    words = f"{'xyz'[axis]} must be finite, got {positions[row, axis]}"
    raise SceneError(f"line {lines[row]}: {words}")


def _columns(block: bytes, count: int, kinds: str, more: bool, first: int) -> "list[Array]":
    """Return the columns of a block of lines, of which `first` is the number of the first."""
    width = len(kinds)
    text = block + b"\n" if count else b""  # the last may be empty
    entries = text.replace(b"\n", b" \0 ").split()
    marks = entries[width :: width + 1]
    if len(entries) != count * (width + 1) or marks != [_MARK] * count:
        entries = _checked_entries(block, kinds, more, first)
    found = [entries[i :: width + 1] for i in range(width)]
    try:
        return [_convert(column, kind) for column, kind in zip(found, kinds, strict=True)]
    except (ValueError, KeyError, OverflowError):
        raise _wrong_entry(found, kinds, first) from None


def _checked_entries(block: bytes, kinds: str, more: bool, first: int) -> list[bytes]:
    """Return the entries line by line, each with a mark at its end; raise if there are too few."""
    entries: list[bytes] = []
    width = len(kinds)
    for number, line in enumerate(block.split(b"\n"), first):
        found = line.split()
        if len(found) < width or (len(found) > width and not more):
            shown = short(text_of(line, number).strip())
            problem = f"expected {width} entries, got {len(found)}"
            raise SceneError(f"line {number}: {problem}: {shown!r}")
        entries += [*found[:width], _MARK]
    return entries


def _convert(entries: list[bytes], kind: str) -> "Array":
    """Return a column of a kind; raise ValueError, KeyError or OverflowError if it is not."""
    import numpy as np

    if kind == "R":
        try:
            return parsed_all(entries)
        except ValueError:  # Fortran writes 1.0D-3
            return parsed_all([e.replace(b"D", b"E").replace(b"d", b"e") for e in entries])
    if kind == "I":
        return parsed_all(entries, int)
    if kind == "L":
        return np.fromiter((_TRUTH[entry.upper()] for entry in entries), np.bool_, len(entries))
    return texts_of(entries, bytes.decode)


def _wrong_entry(found: list[list[bytes]], kinds: str, first: int) -> SceneError:
    """Give the error for the first line with an entry that is not of its column's kind."""
    for number, row in enumerate(zip(*found, strict=True), first):
        for place, (entry, kind) in enumerate(zip(row, kinds, strict=True), 1):
            try:
                _convert([entry], kind)
            except (ValueError, KeyError, OverflowError):
                shown = short(entry.decode(errors="replace"))
                words = f"entry {place} must be {_WORDS[kind]}, got {shown!r}"
                return SceneError(f"line {number}: {words}")
    return SceneError(f"line {first}: not understood")
