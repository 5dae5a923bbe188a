"""Texts of rows between commas, semicolons, tabs or blanks, as columns.

They hold numbers, truths or texts. Rows without names above them have numbers for names, from 1.
"""

import csv
import io
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import chain, islice
from typing import TYPE_CHECKING, Any, TypeAlias

from vtray.base.errors import SceneError
from vtray.base.memory import lack_of_memory
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.column_names import UNIT, name_twice
from vtray.scene.particles.plain_numbers import doubles, is_overflow, of_fortran, parsed_all

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Blocks: TypeAlias = Iterator[Sequence[Array | Sequence[str]]]

_SEPARATORS = ",;\t"

_BLANK = " "
"""What is between entries where none of these is: any number of blanks."""

_COMMENTS = "#", "%"
"""What comments begin with: those of NumPy and gnuplot, and those of MATLAB and COMSOL."""

_MISSING = {"", "na", "n/a", "nan", "null", "none", "<na>", "-nan"}
"""What such texts have in the place of a number that is missing, in any case."""

_TRUTHS = {"true": True, "false": False}
"""What they have for what is true or not, in any case."""

_ROWS = 2**14
"""Rows that are taken apart at once: the texts of their entries take 5 MB, those of all far more
than the columns."""

_LETTERS = 2**20
"""Letters that are cut into lines at once: a file of a text takes four bytes for each."""

_BYTES = 64
"""Of memory for an entry while it is read."""


def without_comments(text: str) -> str:
    """Return a text whose comments before all else are empty lines.

    The last of them stays if it names the columns, as those of NumPy do: where numbers follow.
    """
    count, last, begin = 0, "", 0
    while text.startswith(_COMMENTS, begin):
        end = text.find("\n", begin)
        end = len(text) if end < 0 else end
        last, begin = text[begin:end], end + 1
        count += 1
    if count == 0:
        return text
    rest = text[begin:]
    separator = _separator(rest)
    names, first = last.lstrip("".join(_COMMENTS)), _split(_first_line(rest), separator)
    ways = names, re.sub(UNIT, "", names)  # before which blanks are that divide no names
    fitting = (way for way in ways if len(_split(way, separator)) == len(first))
    names = next(fitting, "") if any(map(_is_number, first)) else ""
    return "\n" * (count - 1) + names + "\n" + rest


def csv_columns(text: str) -> "dict[str, Array]":
    """Return columns by the names in the first line, or by their numbers where these are missing.

    Raises
    ------
    SceneError
        A row does not have an entry for each name, a name is there twice, a quote has no end, or
        numbers are stars; or memory is short. The message names the line.
    """
    lack = lack_of_memory(_BYTES * len(first_entries(text)) * text.count("\n"))
    if lack:
        raise SceneError(f"reading it needs about {lack}")
    names = next(_rows(text))
    kinds = [0] * len(names)
    parts, are_alike = _parts(text, kinds)
    while not are_alike:
        # What came first were integers, for instance, and what came later other numbers.
        parts, are_alike = _parts(text, kinds)
    columns = {name: _joined(part) for name, part in zip(names, parts, strict=True)}
    for name, column in columns.items():
        _check_overflow(text, name, column)
    return columns


def first_entries(text: str) -> list[str]:
    """Return the entries of the first line of a text, as far as they are not between quotes."""
    return _split(_first_line(text), _separator(text))


def are_numbered(names: Iterable[str]) -> bool:
    """Tell whether columns have the names of those that a file does not name."""
    return all(name == str(k) for k, name in enumerate(names, 1))


def _parts(text: str, kinds: list[int]) -> "tuple[list[list[Array]], bool]":
    """Return the columns, each in parts of some rows, and whether these are of one kind.

    Parameters
    ----------
    text
        The whole text.
    kinds
        For each column, which of `_KINDS` it is at least; then, which it is.
    """
    before = [*kinds]
    if _is_plain(text):
        try:
            return _of_kinds(_plain_blocks(text, kinds), kinds)
        except ValueError:  # a row has too few entries, or too many, which is told below
            kinds[:] = before
    return _of_kinds(_blocks(text), kinds)


def _of_kinds(blocks: "Blocks", kinds: list[int]) -> "tuple[list[list[Array]], bool]":
    """Return what `_parts` does, given some rows at once: for each column, texts or numbers."""
    parts: list[list[Array]] = [[] for _ in kinds]
    are_alike = True
    for block in blocks:
        for k, entries in enumerate(block):
            kind, array = _parsed(entries, kinds[k])
            are_alike &= kind == kinds[k] or not parts[k]
            kinds[k] = kind
            parts[k].append(array)
    return parts, are_alike


def _joined(parts: "list[Array]") -> "Array":
    """Return the parts of a column as one; a column without rows is one of integers."""
    import numpy as np

    return np.concatenate(parts) if parts else np.zeros(0, np.int64)


def _is_plain(text: str) -> bool:
    """Tell whether lines end where rows do, and entries at the next separator."""
    return '"' not in text and text.count("\r") == text.count("\r\n")


def _plain_blocks(text: str, kinds: list[int]) -> "Blocks":
    """Yield the columns of pieces of a plain text, as numbers where they were such so far.

    NumPy takes them apart four times as fast as Python does.

    Raises
    ------
    ValueError
        A row does not have an entry for each column.
    """
    import numpy as np

    separator, first = _separator(text), _first_line(text)
    below = text.index(first) + (len(first) if _has_names(_split(first, separator)) else 0)
    names = [str(k) for k in range(len(kinds))]
    load: Callable[..., Array] = partial(
        np.loadtxt,
        delimiter=None if separator == _BLANK else separator,
        comments=None,
        quotechar=None,
        ndmin=1,
    )
    for piece in _pieces(text, below):
        if not piece.strip("\r\n" if separator != _BLANK else None):
            continue
        texts = [(name, "O") for name in names]
        mixed = [(name, "f8" if kinds[int(name)] == _FLOAT else "O") for name in names]
        try:
            found = load(io.StringIO(piece, newline=""), dtype=mixed)
        except ValueError:  # a number is missing, or is none
            found = load(io.StringIO(piece, newline=""), dtype=texts)
        columns = (found[name] for name in names)
        yield [of if of.dtype.kind == "f" else of.tolist() for of in columns]


def _blocks(text: str) -> "Blocks":
    """Yield the entries of each column, some rows at a time."""
    rows = islice(_rows(text), 1, None)
    while block := list(islice(rows, _ROWS)):
        yield list(zip(*block, strict=True))


def _rows(text: str) -> Iterator[list[str]]:
    """Yield the names of the columns, and then the entries of each row."""
    names: list[str] = []
    lines, begin = _lines(text), 1
    try:
        for row in lines:
            entries = row
            if row and not names:
                names = [name.strip() for name in row]
                if _has_names(names):
                    _check_names(names, lines.line_num)
                    entries = []
                else:
                    names = [str(k) for k in range(1, len(row) + 1)]
                yield names
            if entries:
                if len(entries) != len(names):
                    words = f"expected {len(names)} entries, got {len(entries)}"
                    raise SceneError(f"line {begin}: {words}")
                yield entries
            begin = lines.line_num + 1
    except csv.Error as error:
        words = "a quote has no end" if lines.line_num > begin else str(error)
        raise SceneError(f"line {begin}: {words}") from None
    if not names:
        _check_names(names, lines.line_num or 1)


def _separator(text: str) -> str:
    """Return what is between the entries of a text."""
    first = _first_line(text)
    found = max(_SEPARATORS, key=first.count)
    if found not in first:
        return _BLANK
    parts = [part.split() for part in first.split(found)]
    is_mixed = max(map(len, parts)) > 1 and all(map(_is_number, first.split()))
    return _BLANK if is_mixed else found  # tabs and blanks


def _split(line: str, separator: str) -> list[str]:
    """Return the entries of a line without quotes."""
    return line.split(None if separator == _BLANK else separator)


def _first_line(text: str) -> str:
    """Return the first line of a text that is not empty."""
    begun = text.lstrip("\r\n")
    end = begun.find("\n")
    return begun if end < 0 else begun[:end]  # what follows may be long, and is not copied


def _lines(text: str) -> Any:  # noqa: ANN401
    """Return a reader of the lines of a text, entry by entry."""
    files = (io.StringIO(piece, newline="") for piece in _pieces(text))
    lines: Iterator[str] = chain.from_iterable(files)
    separator = _separator(text)
    if separator == _BLANK:  # csv skips blanks before entries, and what is no blank is none
        lines = (line.replace("\t", _BLANK).rstrip() + "\n" for line in lines)
    return csv.reader(lines, delimiter=separator, skipinitialspace=True, strict=True)


def _pieces(text: str, begin: int = 0) -> Iterator[str]:
    """Yield pieces of a text from a letter on, all of which end where lines do."""
    while begin < len(text):
        end = text.find("\n", begin + _LETTERS) + 1 or len(text)
        yield text[begin:end]
        begin = end


def in_line(text: str, row: int, name: str) -> str:
    """Return where an entry stands, given its row below the names and the name of its column."""
    lines = _lines(text)
    rows = (lines.line_num for entries in lines if entries)
    above = 0 if are_numbered(next(_rows(text))) else 1
    return f"line {next(islice(rows, row + above, None))}: column {name!r}"


def _check_overflow(text: str, name: str, column: "Array") -> None:
    """Raise SceneError if entries of a column are stars, and all others are numbers."""
    if "**" not in text or column.dtype.kind != "U":
        return
    entries = column.tolist()
    row = next((k for k, entry in enumerate(entries) if is_overflow(entry)), None)
    others = {entry for entry in entries if not is_overflow(entry)}
    # Stars beside nothing are marks.
    if row is not None and others - {""} and all(map(_is_number, others)):
        words = f"expected a number, got {short(repr(entries[row]))}"
        remedy = "Fortran writes stars where a number has no room"
        raise SceneError(f"{in_line(text, row, name)}: {words}; {remedy}")


def _check_names(names: list[str], line: int) -> None:
    """Raise SceneError if a line does not name the columns."""
    if not any(names):
        shown = short(",".join(names)) or "nothing"
        raise SceneError(f"line {line}: expected the names of the columns, got {shown}")
    twice = name_twice(names)
    if twice is not None:
        raise SceneError(f"line {line}: expected each column once, got {short(twice)!r} twice")


def _has_names(entries: Sequence[str]) -> bool:
    """Tell whether the first row of a text names its columns, or is to: if not all are numbers."""
    return not any(entries) or not all(_is_number(e) or is_overflow(e) for e in entries)


def _is_number(entry: str) -> bool:
    """Tell whether an entry is a number, or says that one is missing."""
    return _parsed([entry])[1].dtype.kind in "if"


def _parsed(entries: "Array | Sequence[str]", kind: int = 0) -> "tuple[int, Array]":
    """Return entries as the first of `_KINDS`, from one on, that they can be, and which that is."""
    if not isinstance(entries, Sequence):
        return kind, entries
    while True:
        try:
            return kind, _KINDS[kind](entries)
        except (ValueError, OverflowError):
            kind += 1


def _numbers_or_nan(entries: Sequence[str]) -> "Array":
    """Return entries as numbers, NaN where one says that there is none."""
    found = doubles(entries)
    return parsed_all(entries, _number_or_nan) if found is None else found


def _number_or_nan(entry: str) -> float:
    """Return an entry as a number, NaN where it says that there is none."""
    word = entry.strip()
    if word.lower() in _MISSING:
        return float("nan")
    try:
        return float(word)
    except ValueError:
        return of_fortran(word)


def _truths(entries: Sequence[str]) -> "Array":
    """Return entries as truths; as 1, 0 and NaN where one is missing.

    Raises
    ------
    ValueError
        One is none.
    """
    import numpy as np

    words = [entry.strip().lower() for entry in entries]
    different = set(words)
    if not different - _MISSING <= _TRUTHS.keys():
        message = "truths are true or false"
        raise ValueError(message)
    found = np.array([_TRUTHS.get(word, np.nan) for word in words])
    return found if different & _MISSING else found.astype(np.bool_)


def _texts(entries: Sequence[str]) -> "Array":
    """Return entries as texts."""
    import numpy as np

    return np.array([entry.strip() for entry in entries], np.str_)


_KINDS: "tuple[Callable[[Sequence[str]], Array], ...]" = (
    partial(parsed_all, parse=int),
    partial(parsed_all, parse=float),
    _numbers_or_nan,
    _truths,
    _texts,
)
"""What columns are made of: the first of these that all entries can be, as all can be the last."""

_FLOAT = 1
"""The one that NumPy finds as well."""
