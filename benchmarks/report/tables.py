"""Tables of Markdown, and how numbers are written in them."""

import math
from collections.abc import Iterable, Sequence


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Write a table."""
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def ratio(theirs: float, ours: float) -> str:
    """Write how many times as much the first is as the second."""
    if math.isnan(theirs) or math.isnan(ours):
        return "-"
    found = theirs / ours
    return f"{found:.0f}" if found >= 10 else f"{found:.2f}"


def megabytes(size: float) -> str:
    """Write a number of bytes in MB."""
    return "-" if math.isnan(size) else f"{size / 1e6:,.0f}"
