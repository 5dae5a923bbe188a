"""What the commands have in common: arguments, errors and exit status."""

import argparse
import contextlib
import os
import sys
from collections.abc import Callable
from functools import partial
from typing import NoReturn

from vtray.base.errors import OutputError, UsageError, VtrayError, printable
from vtray.base.memory import why_out_of_memory
from vtray.base.signals import INTERRUPTED

SUCCESS = 0
FAILURE = 1


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are like all others.

    Parameters
    ----------
    hint
        A line on how to call the command, for its error messages.
    formatter
        How the help is laid out.
    """

    def __init__(
        self,
        *,
        hint: str,
        formatter: type[argparse.HelpFormatter] = argparse.HelpFormatter,
        **options: object,
    ) -> None:
        # Each option asks for one, which would load a lot to look how wide the terminal is.
        narrow = partial(formatter, width=80)
        super().__init__(allow_abbrev=False, formatter_class=narrow, **options)  # type: ignore[arg-type]
        self._hint = hint
        self._formatter = formatter

    def format_help(self) -> str:
        """Return the help, as wide as the terminal."""
        self.formatter_class = self._formatter
        return super().format_help()

    def error(self, message: str) -> NoReturn:
        """Raise UsageError instead of printing and exiting with status 2."""
        full = f"{message}; {self._hint}"
        raise UsageError(full)


def run_command(action: Callable[[], int]) -> int:
    """Run a command and return its exit status; every failure is one line on stderr.

    Parameters
    ----------
    action
        What the command does; it returns the exit status.
    """
    _open_closed_streams()
    # NumPy's linear algebra, unused here, starts a thread for each core that spins for 40 ms, and
    # ends the process where no more threads are allowed.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        status = _until_printed(action)
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:  # the reader of the output has had enough
        return FAILURE
    except VtrayError as error:
        return _fail(str(error))
    except Exception as error:  # noqa: BLE001 - a user never sees a traceback
        return _fail(why_out_of_memory(error) or _explain(error))
    return status


def print_result(text: str) -> None:
    """Print on standard output, at once; raise OutputError where that fails."""
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        message = f"standard output cannot be written: {error.strerror or error}"
        raise OutputError(message) from error


def print_note(text: str) -> None:
    """Print on standard error what is no result; where that fails, nothing is lost but the note."""
    with contextlib.suppress(OSError):
        print(text, file=sys.stderr, flush=True)


def leave(status: int) -> NoReturn:
    """End the process.

    At once: taking everything down takes time, and Python would complain about a pipe whose reader
    has gone.
    """
    with contextlib.suppress(OSError):
        sys.stderr.flush()
    os._exit(status)


def _open_closed_streams() -> None:
    """Let what is printed vanish where the caller has closed standard output or error."""
    for number, name in ((1, "stdout"), (2, "stderr")):
        if getattr(sys, name) is None:
            # No other file gets its number, and a picture that is to go there finds it closed.
            while os.open(os.devnull, os.O_RDONLY) < number:
                pass
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115 - until the process ends


def _until_printed(action: Callable[[], int]) -> int:
    """Run a command until all that it prints is written."""
    try:
        status = action()
    except SystemExit:  # --help and --version have printed what they had to
        status = SUCCESS
    print_result("")
    return status


def _explain(error: Exception) -> str:
    """Say what an error is that is not meant for the user."""
    # No bug of vtray's: something is missing, has no place, or cannot be loaded.
    if isinstance(error, (OSError, ImportError)):
        return str(error)
    return f"this is a bug in vtray, please report it: {error!r}"


def _fail(message: str) -> int:
    """Print an error on stderr; return the exit status."""
    print_note(f"Error: {printable(message)}")
    return FAILURE
