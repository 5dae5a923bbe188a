"""Processes that compile parts of kernels while this one compiles what calls them.

Numba compiles one function at a time in a process. So each core but one gets a process of its own,
from when the first kernel is compiled until there is nothing to do for a while. It is told on its
standard input what to compile, keeps it on disk, and tells on its standard output of parts that it
meets on the way. Whatever goes wrong with it, this process compiles the part itself.
"""

import atexit
import contextlib
import os
import queue
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future

from vtray.base.memory import COMPILER, lack_of_memory
from vtray.base.pool import available_cores
from vtray.base.signals import LastStep

MOST = 3
"""So many at the most: there are no more parts that take long."""

IDLE_SECONDS = 10.0
"""They end when nothing has been asked of them for so long."""

DONE = b"done\n"
"""What they say after each part."""

_PROGRAM = "import sys; sys.path[:] = {path!r}; from {module} import work; work()"

_MODULE = "vtray.base.compiler.helper"

_POLL_SECONDS = 0.02

_Order = tuple[tuple[bool, int], str, "Future[None]", bytes, Callable[[bytes], object]]

_orders: queue.PriorityQueue[_Order] = queue.PriorityQueue()
"""Orders in their places, which are all different."""

_asked: dict[str, "Future[None]"] = {}
_lock = threading.Lock()
_at_work: list[threading.Thread] = []
_processes: dict["subprocess.Popen[bytes]", LastStep] = {}
"""Each with what ends it should a signal end this process."""

_of_others: list["subprocess.Popen[bytes]"] = []
"""Those of the process of which this one is a fork."""


def get_ready() -> None:
    """Start as many as are of use, if they are not at work yet; they take a second for it."""
    with _lock:
        while len(_at_work) < min(available_cores() - 1, MOST):
            thread = threading.Thread(target=_serve, daemon=True)
            try:
                thread.start()
            except RuntimeError:  # no more threads are allowed
                return
            _at_work.append(thread)


def ask(name: str, order: bytes, tell: Callable[[bytes], object], *, is_long: bool = False) -> None:
    """Let the next that is free compile a part.

    Parameters
    ----------
    name, order
        The part, and a line that says how to compile it.
    tell
        Called from another thread with such a line for each part that this one calls.
    is_long
        Whether it takes longer than others, and so comes before them.
    """
    get_ready()
    with _lock:
        if _at_work and name not in _asked:
            place = not is_long, len(_asked)
            _asked[name] = Future()
            _orders.put((place, name, _asked[name], order, tell))


def is_at_work_on(name: str) -> bool:
    """Tell whether one of them compiles a part now."""
    return name in _asked and _asked[name].running()


def wait_for(name: str) -> str | None:
    """Wait until a part is done, or another waits to be begun.

    Returns
    -------
    str or None
        The name of that other one, whose order is taken back; None if the part is done.
    """
    while is_at_work_on(name):
        with contextlib.suppress(queue.Empty):
            _, other, future, _, _ = _orders.get(timeout=_POLL_SECONDS)
            if not future.cancelled() and future.cancel():
                return other
    return None


def leave_to_caller(name: str) -> None:
    """Take an order back; if it has begun, wait for its end."""
    if name in _asked and not _asked[name].cancel():
        _asked[name].result()


def _serve() -> None:
    """Hand orders to a process, one after the other."""
    process = _started()
    while True:
        try:
            _, _, future, order, tell = _orders.get(timeout=IDLE_SECONDS)
        except queue.Empty:
            with _lock:
                if not _orders.empty():
                    continue
                _at_work.remove(threading.current_thread())
            _end(process)
            return
        if future.set_running_or_notify_cancel():
            # Whatever goes wrong, the part is left to who asked.
            with contextlib.suppress(Exception):
                _hand_over(process, order, tell)
            future.set_result(None)


def _started() -> "subprocess.Popen[bytes] | None":
    """Start a process, if there is memory for it."""
    if lack_of_memory(COMPILER):
        return None
    program = _PROGRAM.format(path=sys.path, module=_MODULE)
    pipe, nothing = subprocess.PIPE, subprocess.DEVNULL
    try:
        process = subprocess.Popen(
            [sys.executable, "-c", program],
            stdin=pipe,
            stdout=pipe,
            stderr=nothing,
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
    except (OSError, ValueError):
        return None
    if not _processes:
        atexit.register(_end_all)
    _processes[process] = last = LastStep(process.kill)
    last.__enter__()
    return process


def _hand_over(
    process: "subprocess.Popen[bytes] | None", order: bytes, tell: Callable[[bytes], object]
) -> None:
    """Let a process compile a part, and wait until it is done."""
    if process and process.stdin and process.stdout:
        process.stdin.write(order)
        process.stdin.flush()
        for line in process.stdout:
            if line == DONE:
                break
            tell(line)


def _end(process: "subprocess.Popen[bytes] | None") -> None:
    """End a process."""
    if process:
        process.kill()
        with contextlib.suppress(OSError):
            process.communicate()
        last = _processes.pop(process, None)
        if last:
            last.__exit__()


def _end_all() -> None:
    """End what is still at work when this process ends."""
    for process in list(_processes):
        _end(process)


def _forget() -> None:
    """Begin anew after a fork: the threads and the processes are those of the other process."""
    global _lock, _orders
    _lock, _orders = threading.Lock(), queue.PriorityQueue()
    _of_others.extend(_processes)
    for state in (_processes, _at_work, _asked):
        state.clear()


if hasattr(os, "register_at_fork"):  # not in Windows
    os.register_at_fork(after_in_child=_forget)
