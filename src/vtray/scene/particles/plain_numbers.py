"""Numbers of texts, as files of data have them: labels such as 1_2 are none."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray


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


def whole_or_texts(texts: "NDArray[Any]") -> "NDArray[Any]":
    """Return texts as integers, or as they are if one is none."""
    try:
        return parsed_all(texts.tolist(), int)
    except (ValueError, OverflowError):
        return texts
