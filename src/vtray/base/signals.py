"""How a command ends when it is told to: at once, and with nothing left behind.

Python's own answer to Ctrl-C is an exception, which may come out of any line: out of an import,
which then prints a traceback, or out of the middle of a decoder, which then may crash. To other
signals it has none. Here, a command ends from within the handler, and nothing goes on after it.
"""

import os
import signal

TYPE_CHECKING = False
if TYPE_CHECKING:  # not from typing: until the handlers stand, as little as possible is imported
    from collections.abc import Callable
    from types import FrameType
    from typing import Self

SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")
"""What asks a program to end, where the system has it."""

INTERRUPTED = 130
"""The exit status after Ctrl-C, as shells have it."""

_last_steps: "list[Callable[[], object]]" = []
_postponed: "list[Postponed]" = []
_blocked: "list[blocked]" = []


def leave_on_signals() -> None:
    """Let this process end at once when it is told to, unless its caller wants that ignored."""
    for name in SIGNALS:
        number = getattr(signal, name, None)
        usual = (signal.SIG_DFL, signal.default_int_handler)
        if number is not None and signal.getsignal(number) in usual:
            signal.signal(number, _leave)


class blocked:  # noqa: N801 - used like a function
    """A context in which a signal has to wait, where half of the work would be worse than none.

    Signals are kept from the thread, so that no call ends early; one that another thread gets is
    noted, and sent again.
    """

    number = 0

    def __enter__(self) -> None:
        numbers = [getattr(signal, name) for name in SIGNALS if hasattr(signal, name)]
        _blocked.append(self)
        if hasattr(signal, "pthread_sigmask"):  # not in Windows
            self._before = signal.pthread_sigmask(signal.SIG_BLOCK, numbers)

    def __exit__(self, *_: object) -> None:
        _blocked.remove(self)
        if hasattr(signal, "pthread_sigmask"):
            signal.pthread_sigmask(signal.SIG_SETMASK, self._before)
        if self.number:
            signal.raise_signal(self.number)


class LastStep:
    """Something to be done should the process end by a signal while this context lasts.

    Parameters
    ----------
    step
        Called in the main thread, between any two of its lines.
    """

    def __init__(self, step: "Callable[[], object]") -> None:
        self._step = step

    def __enter__(self) -> None:
        """Add the step."""
        _last_steps.append(self._step)

    def __exit__(self, *_: object) -> None:
        """Take it away: what was begun has been finished."""
        _last_steps.remove(self._step)


class Postponed:
    """A context in which the first signal is only noted, so that what there is can be saved.

    Who enters it looks often whether there was one. A second signal ends the process at once.

    Attributes
    ----------
    number
        The number of the signal that came; 0 if there was none.
    """

    number = 0

    def __enter__(self) -> "Self":
        """Note signals from here on."""
        _postponed.append(self)
        return self

    def __exit__(self, *_: object) -> None:
        """Let them end the process again."""
        _postponed.remove(self)


def end_by(number: int) -> None:
    """End the process as a signal does: with a status after Ctrl-C, else by the signal."""
    for step in reversed(_last_steps):
        # contextlib may be what is just being imported.
        try:  # noqa: SIM105
            step()
        except Exception:  # noqa: BLE001, S110 - the other steps come first
            pass
    if number != signal.SIGINT:
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)
    os._exit(INTERRUPTED)


def _leave(number: int, _frame: "FrameType | None") -> None:
    """End the process, unless that has to wait, or is postponed."""
    if _blocked:
        _blocked[-1].number = number
        return
    if _postponed and not _postponed[-1].number:
        _postponed[-1].number = number
        return
    end_by(number)
