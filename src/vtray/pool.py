"""A pool of threads that takes tasks from a queue."""

import threading
from collections.abc import Callable, Iterable
from queue import Empty, SimpleQueue
from typing import TypeVar

Task = TypeVar("Task")

POLL_SECONDS = 0.05
"""How often the waiting thread looks at the progress and at Ctrl-C."""


def run_tasks(
    tasks: Iterable[Task],
    new_worker: Callable[[], Callable[[Task], None]],
    threads: int,
    *,
    stop: Callable[[], None] = lambda: None,
    progress: Callable[[int, int], None] | None = None,
) -> None:
    """Run all tasks; the calling thread waits, so that Ctrl-C works.

    Parameters
    ----------
    tasks
        What is to be done, in the order in which it is begun.
    new_worker
        Called once in each thread; what it returns is called with one task after the other.
    threads
        How many threads to use at the most.
    stop
        Called once when the rest is given up, to hurry the tasks that run; from any thread.
    progress
        Called from time to time, in the calling thread, with the tasks done and their number.

    Raises
    ------
    BaseException
        The first exception of a task, of `progress`, or KeyboardInterrupt; the other tasks are
        given up and the threads have ended by then.
    """
    queue: SimpleQueue[Task] = SimpleQueue()
    for task in tasks:
        queue.put(task)
    total = queue.qsize()
    failures: list[BaseException] = []

    def give_up() -> None:
        while _take(queue) is not None:
            pass
        stop()

    finished: SimpleQueue[None] = SimpleQueue()

    def work() -> None:
        try:
            worker = new_worker()
            while (task := _take(queue)) is not None:
                worker(task)
                finished.put(None)
        except BaseException as failure:  # noqa: BLE001 - handed to the calling thread
            failures.append(failure)
            give_up()

    pool = [threading.Thread(target=work, daemon=True) for _ in range(min(threads, total))]
    try:
        for thread in pool:
            thread.start()
        for thread in pool:
            while thread.is_alive():
                thread.join(POLL_SECONDS)
                if progress is not None:
                    progress(finished.qsize(), total)
    except BaseException:
        give_up()
        for thread in pool:
            if thread.ident is not None:
                thread.join()
        raise
    if failures:
        raise failures[0]


def _take(queue: SimpleQueue[Task]) -> Task | None:
    """Return the next task, None if there is none left."""
    try:
        return queue.get_nowait()
    except Empty:
        return None
