"""A pool of threads that takes tasks from a queue."""

import threading
from collections.abc import Callable, Iterable
from queue import Empty, SimpleQueue
from typing import Generic, TypeVar

Task = TypeVar("Task")
Progress = Callable[[int, int], None]

POLL_SECONDS = 0.05
"""How often the waiting thread looks at the progress and at Ctrl-C."""


def run_tasks(
    tasks: Iterable[Task],
    new_worker: Callable[[], Callable[[Task], object]],
    threads: int,
    *,
    stop: Callable[[], None] = lambda: None,
    progress: Progress | None = None,
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
        for _ in range(min(threads, self._total)):
            try:
                threading.Thread(target=self._work, daemon=True).start()
            except RuntimeError:
                if self._started == 0:
                    raise
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
            worker = self._new_worker()
            while (task := self._next()) is not None:
                worker(task)
                self._done.put(None)
        except BaseException as failure:  # noqa: BLE001 - handed to the calling thread
            self.failures.append(failure)
            self.give_up()
        finally:
            self._ended.append(True)
            self._wake.set()
