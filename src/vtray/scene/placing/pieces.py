"""Long arrays piece by piece, on all cores.

What is worked out of a piece stays in the cache of a core, and NumPy lets other threads run while
it works on one.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from vtray.base.pool import available_cores, run_tasks

Result = TypeVar("Result")

PIECE = 2**13
"""Rows of a piece: memory for so many doubles is reused, where more is mapped anew each time."""


def by_pieces(count: int, work: Callable[[slice], Result]) -> list[Result]:
    """Return the results of a function for the pieces of `count` rows, in their order.

    Parameters
    ----------
    count
        How many rows there are, at least 1.
    work
        Called with the rows of each piece, in any thread; overflows are no concern.
    """
    results: dict[int, Result] = {}

    def run(begin: int) -> None:
        with np.errstate(over="ignore", invalid="ignore"):
            results[begin] = work(slice(begin, begin + PIECE))

    begins = range(0, count, PIECE)
    run_tasks(begins, lambda: run, available_cores())
    return [results[begin] for begin in begins]
