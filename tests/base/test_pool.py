"""The pool of threads."""

import os
import signal
import threading
import time
from collections.abc import Callable

import pytest

from vtray.base.pool import available_cores, run_tasks, useful_threads


def assert_threads(count: int) -> None:
    """Check that no thread is left but one that has just done its last task."""
    time.sleep(0.05)
    assert threading.active_count() == count


@pytest.mark.parametrize("threads", [1, 2, 9])
def test_every_task_is_done_once(threads: int) -> None:
    done: list[int] = []
    workers: list[int] = []

    def new_worker() -> Callable[[int], None]:
        workers.append(1)
        return done.append

    run_tasks(range(100), new_worker, threads)
    assert sorted(done) == list(range(100))
    assert len(workers) == threads


def test_no_tasks() -> None:
    run_tasks([], lambda: pytest.fail("no worker is needed"), 3)


def test_progress_counts_up_to_all_tasks() -> None:
    seen: list[tuple[int, int]] = []
    run_tasks(
        range(5),
        lambda: lambda _: time.sleep(0.03),
        1,
        progress=lambda *counts: seen.append(counts),
    )
    assert seen[-1] == (5, 5)
    assert seen == sorted(seen)


def test_failure_of_a_task_ends_the_others_and_is_raised() -> None:
    done: list[int] = []
    stopped: list[bool] = []

    def work(task: int) -> None:
        if task == 3:
            raise LookupError("task 3")
        done.append(task)

    with pytest.raises(LookupError, match="task 3"):
        run_tasks(range(1000), lambda: work, 1, stop=lambda: stopped.append(True))
    assert done == [0, 1, 2]
    assert stopped == [True]


def test_failure_of_progress_ends_the_tasks() -> None:
    stop = threading.Event()
    before = threading.active_count()

    def progress(done: int, total: int) -> None:
        raise LookupError

    with pytest.raises(LookupError):
        run_tasks(range(9), lambda: lambda _: stop.wait(20), 2, stop=stop.set, progress=progress)
    assert_threads(before)


def test_interrupt_ends_the_tasks_at_once() -> None:
    stop = threading.Event()
    before = threading.active_count()
    timer = threading.Timer(0.2, os.kill, [os.getpid(), signal.SIGINT])
    timer.start()
    start = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        run_tasks(range(9), lambda: lambda _: stop.wait(20), 2, stop=stop.set)
    assert time.perf_counter() - start < 2
    timer.join()
    assert_threads(before)


def test_fewer_threads_than_asked_for_do_the_work_too(monkeypatch: pytest.MonkeyPatch) -> None:
    start, started = threading.Thread.start, []

    def start_two(thread: threading.Thread) -> None:
        if len(started) == 2:
            raise RuntimeError("can't start new thread")
        started.append(thread)
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", start_two)
    done: list[int] = []
    run_tasks(range(50), lambda: done.append, 10)
    assert sorted(done) == list(range(50))

    # None at all: the calling thread does the work, and shows its progress.
    callers: list[threading.Thread] = []
    seen: list[tuple[int, int]] = []
    run_tasks(
        range(3),
        lambda: lambda _: callers.append(threading.current_thread()),
        10,
        progress=lambda *counts: seen.append(counts),
    )
    assert callers == [threading.current_thread()] * 3
    assert seen == [(0, 3), (1, 3), (2, 3), (3, 3)]
    with pytest.raises(ZeroDivisionError):
        run_tasks([1, 0, 1], lambda: lambda task: 1 // task, 10)


def test_a_thread_without_memory_leaves_its_tasks_to_others() -> None:
    done: list[int] = []
    tries: list[int] = []

    def new_worker() -> Callable[[int], None]:
        tries.append(1)
        if len(tries) < 5:
            raise MemoryError
        return done.append

    run_tasks(range(50), new_worker, 4)  # the fifth is the calling thread
    assert sorted(done) == list(range(50))
    tries.clear()
    with pytest.raises(MemoryError):
        run_tasks(range(50), new_worker, 1)


def test_threads_are_those_of_use() -> None:
    most = max(64, available_cores())
    cases = {(3, 9): 3, (9, 3): 3, (1, 0): 1, (9, 0): 1, (10**18, 10**6): most}
    assert {case: useful_threads(*case) for case in cases} == cases


def test_interrupt_while_threads_are_started(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = threading.Thread.start
    before = threading.active_count()

    def interrupted(thread: threading.Thread) -> None:
        whole(thread)
        raise KeyboardInterrupt

    monkeypatch.setattr(threading.Thread, "start", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_tasks(range(100), lambda: lambda task: time.sleep(0.001), 2)
    assert_threads(before)
