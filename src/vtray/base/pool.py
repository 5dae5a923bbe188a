"""A pool of threads that takes tasks from a queue."""

import os
import threading
from collections.abc import Callable, Iterable
from queue import Empty, SimpleQueue
from typing import Generic, TypeVar

Task = TypeVar("Task")
Progress = Callable[[int, int], None]

POLL_SECONDS = 0.05
"""How often the waiting thread looks at the progress and at Ctrl-C."""


LEAST_ALLOWED = 64
"""So many threads may be asked for on any machine; more only where there are more cores."""


def available_cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def useful_threads(threads: int, work: int) -> int:
    """Return how many threads are of use, at least 1, however many are asked for.

    Parameters
    ----------
    threads
        How many may be used.
    work
        How many of them would have something to do.
    """
    return max(min(threads, work, max(available_cores(), LEAST_ALLOWED)), 1)


def run_tasks(
    tasks: Iterable[Task],
    new_worker: Callable[[], Callable[[Task], object]],
    threads: int,
    *,
    stop: Callable[[], None] = lambda: None,
    progress: Progress | None = None,
) -> None:
    """Run all tasks; the calling thread waits, so that Ctrl-C works.

    There are no more threads than are of use, and fewer where the system allows no more or memory
    is short; if it allows none, the calling thread does the work.

    Parameters
    ----------
    tasks
        What is to be done, in the order in which it is begun.
    new_worker
        Called once in each thread; what it returns is called with one task after the other.
    threads
        How many threads to use at the most.
    stop
        Called when the rest is given up, to hurry the tasks that run; from any thread.
    progress
        Called from time to time, in the calling thread, with the tasks done and their number.

    Raises
    ------
    BaseException
        The first exception of a task, of `progress`, or KeyboardInterrupt; the other tasks are
        given up and the threads have ended by then.
    """
    pool = _Pool(tasks, new_worker, stop)
    try:
        pool.start(threads)
        pool.wait(progress)
        pool.finish(progress)
    except BaseException:
        pool.give_up()
        pool.wait(None)
        raise
    if pool.failures:
        raise pool.failures[0]


class _Pool(Generic[Task]):
    """The threads, the tasks that wait for them, and what became of the others."""

    def __init__(
        self,
        tasks: Iterable[Task],
        new_worker: Callable[[], Callable[[Task], object]],
        stop: Callable[[], None],
    ) -> None:
        self.failures: list[BaseException] = []
        self._new_worker = new_worker
        self._stop = stop
        self._waiting: SimpleQueue[Task] = SimpleQueue()
        for task in tasks:
            self._waiting.put(task)
        self._total = self._waiting.qsize()
        self._done: SimpleQueue[None] = SimpleQueue()
        self._started = 0
        self._begun: list[bool] = []
        self._ended: list[bool] = []
        self._wake = threading.Event()

    def start(self, threads: int) -> None:
        """Start the threads, or as many as the system allows."""
        if self._total == 0:
            return
        for _ in range(useful_threads(threads, self._total)):
            try:
                threading.Thread(target=self._work, daemon=True).start()
            except (RuntimeError, MemoryError):
                break
            self._started += 1

    def wait(self, progress: Progress | None) -> None:
        """Wait until all threads have ended."""
        # Not by Thread.join: interrupted by Ctrl-C, it takes a thread that runs for ended (3.11).
        while True:
            # Ctrl-C may come when a thread has begun and is not yet counted as started.
            ended = len(self._ended) >= max(self._started, len(self._begun))
            if progress is not None:
                progress(self._done.qsize(), self._total)
            if ended:
                return
            self._wake.wait(POLL_SECONDS)
            self._wake.clear()

    def finish(self, progress: Progress | None) -> None:
        """Do in the calling thread what is left because no other thread could."""
        if not self._waiting.empty():
            worker = self._new_worker()
            while (task := self._next()) is not None:
                worker(task)
                self._done.put(None)
                if progress is not None:
                    progress(self._done.qsize(), self._total)

    def give_up(self) -> None:
        """Drop the tasks that wait, and hurry those that run."""
        while self._next() is not None:
            pass
        self._stop()

    def _next(self) -> Task | None:
        """Return the next task, None if there is none left."""
        try:
            return self._waiting.get_nowait()
        except Empty:
            return None

    def _work(self) -> None:
        """Take tasks until there are none."""
        self._begun.append(True)
        try:
            try:
                worker = self._new_worker()
            except MemoryError:
                return  # the others have the tasks, or else the calling thread
            while (task := self._next()) is not None:
                worker(task)
                self._done.put(None)
        except BaseException as failure:  # noqa: BLE001 - handed to the calling thread
            self.failures.append(failure)
            self.give_up()
        finally:
            self._ended.append(True)
            self._wake.set()
