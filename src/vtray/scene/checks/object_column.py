"""Arrays of bytes and of Python's objects, such as tables have, as numbers or names."""

from decimal import Decimal
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

MISSING_NAME = ""
"""The name of what has none."""


def without_objects(column: "Array") -> "Array":
    """Return a column of numbers or names for one of bytes or objects; others as they are.

    Bytes are names in UTF-8; what is none of it becomes a question mark.
    What is missing, ``None`` or not a number, is NaN among numbers, and a name without letters
    among names. What is true or false counts as 1 or 0 where some of it is missing. Entries that
    are arrays of one length, such as Arrow's lists of three numbers, become rows; those of
    several lengths become texts, as of lists.

    Parameters
    ----------
    column
        Of any dtype, (n,) or (n, k).
    """
    import numpy as np

    if column.dtype.kind == "S":
        return np.char.decode(column, "utf-8", "replace")
    if column.dtype != object:
        return column
    entries = column.ravel().tolist()
    if set(map(type, entries)) == {str}:  # most often, and told fast
        return np.array(entries, np.str_).reshape(column.shape)
    shapes = {entry.shape if isinstance(entry, np.ndarray) else () for entry in entries}
    if column.ndim == 1 and len(shapes) == 1 and len(next(iter(shapes))) == 1:
        return np.stack(entries)
    if shapes != {()}:
        entries = [entry.tolist() if isinstance(entry, np.ndarray) else entry for entry in entries]
    missing = [_is_missing(entry) for entry in entries]
    there = [entry for entry, gone in zip(entries, missing, strict=True) if not gone]
    if there and all(isinstance(entry, (Real, Decimal, np.bool_)) for entry in there):
        # Integers and truths stay what they are where none is missing.
        are_exact = not any(missing) and all(isinstance(e, (Integral, np.bool_)) for e in there)
        numbers = [np.nan if gone else entry for entry, gone in zip(entries, missing, strict=True)]
        return np.array(numbers, None if are_exact else np.float64).reshape(column.shape)
    names = [
        MISSING_NAME if gone else _text_of(entry)
        for entry, gone in zip(entries, missing, strict=True)
    ]
    return np.array(names, np.str_).reshape(column.shape)


def _text_of(entry: object) -> str:
    """Return the text of an entry."""
    return entry.decode("utf-8", "replace") if isinstance(entry, bytes) else str(entry)


def _is_missing(entry: object) -> bool:
    """Tell whether an entry is missing: None, or what is not equal to itself, such as NaN."""
    if entry is None:
        return True
    try:
        return not bool(entry == entry)  # noqa: PLR0124
    except (TypeError, ValueError):  # what pandas has for what is missing is neither
        return True
