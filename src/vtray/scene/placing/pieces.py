"""Long arrays piece by piece, on all cores.

What is worked out of a piece stays in the cache of a core, and NumPy lets other threads run while
it works on one.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from vtray.base.pool import available_cores, run_tasks

Result = TypeVar("Result")

PIECE = 2**16
"""Rows of a piece: with fewer, threads spend their time on waiting for the interpreter."""


def by_pieces(count: int, work: Callable[[slice], Result]) -> list[Result]:
    """Return the results of a function for the pieces of `count` rows, in their order.

    Parameters
    ----------
    count
        How many rows there are, at least 1.
    work
        Called with the rows of each piece, in any thread; overflows are no concern.
    """
    return by_workers(count, lambda: work)


def by_workers(count: int, new_worker: Callable[[], Callable[[slice], Result]]) -> list[Result]:
    """Return the same for a function that each thread makes for itself, with memory of its own."""
    results: dict[int, Result] = {}

    def new_runner() -> Callable[[int], None]:
        work = new_worker()

        def run(begin: int) -> None:
            with np.errstate(over="ignore", invalid="ignore"):
                results[begin] = work(slice(begin, min(begin + PIECE, count)))

        return run

    begins = range(0, count, PIECE)
    if len(begins) == 1:
        new_runner()(0)  # sooner than a thread is started
    else:
        run_tasks(begins, new_runner, available_cores())
    return [results[begin] for begin in begins]
