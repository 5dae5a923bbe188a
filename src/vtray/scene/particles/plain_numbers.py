"""Numbers of texts, as files of data have them: labels such as 1_2 are none."""

import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray


_DOUBLE = re.compile(r"[-+]?(?:[0-9]+\.[0-9]*|\.[0-9]+)[dD][-+]?[0-9]{1,3}")
"""Numbers that Fortran alone writes; without a point, they may be labels."""

_SHORT = re.compile(r"([-+]?[0-9]?\.[0-9]{3,})([-+][0-9]{3})")
"""Others: an exponent of three digits leaves no room for its letter."""


def parsed(text: str) -> float:
    """Return the number that a text is.

    Raises
    ------
    ValueError
        It is none.
    """
    found: float = parsed_all([text]).item()
    return found


def parsed_all(
    entries: Sequence[str] | Sequence[bytes], parse: Callable[[Any], float] = float
) -> "NDArray[Any]":
    """Return the numbers that entries are, (n,): int64 where they are parsed by `int`, or float64.

    Raises
    ------
    ValueError, OverflowError
        One is none, or too large.
    """
    import numpy as np

    kind = np.int64 if parse is int else np.float64
    found = np.fromiter(map(parse, entries), kind, len(entries))
    # Python, not files of data, groups digits by underscores. All at once, as that is faster.
    joined: Any = entries[0][:0].join(entries) if len(entries) else ""  # type: ignore[arg-type]
    if ("_" if isinstance(joined, str) else b"_") in joined:
        message = "numbers have no underscores"
        raise ValueError(message)
    return found


def of_fortran(text: str) -> float:
    """Return the number that a text is, also as Fortran writes it: 1.0D-03, or 0.123-100.

    Raises
    ------
    ValueError
        It is none.
    """
    if _DOUBLE.fullmatch(text):
        return float(_with_e(text))
    match = _SHORT.fullmatch(text)
    return parsed(text) if match is None else float(f"{match[1]}e{match[2]}")


def doubles(entries: Sequence[str]) -> "NDArray[Any] | None":
    """Return the numbers that entries are, (n,), if all are as 1.0D-03; None otherwise.

    That is three times as fast as one by one.
    """
    if not all(map(_DOUBLE.fullmatch, entries)):
        return None
    return parsed_all([*map(_with_e, entries)])


def _with_e(text: str) -> str:
    """Return a number of Fortran with the letter that others have before the exponent."""
    return text.replace("D", "E").replace("d", "e")


def is_overflow(text: str) -> bool:
    """Tell whether a text is the stars that Fortran writes where a number has no room."""
    return len(text) > 1 and not text.strip("*")


def whole_or_texts(texts: "NDArray[Any]") -> "NDArray[Any]":
    """Return texts as integers, or as they are if one is none."""
    try:
        return parsed_all(texts.tolist(), int)
    except (ValueError, OverflowError):
        return texts
