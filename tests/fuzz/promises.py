"""What vtray promises of every run of its command, whatever it is given."""

import contextlib
import io
import os
import tempfile
import warnings
from collections.abc import Sequence
from pathlib import Path

import numba

from vtray.commands import cli

STARTS = ("Error: ", "Warning: ")


def check_printed(status: int, err: str) -> None:
    """Check what a command has printed on standard error, and that it fits the status."""
    lines = err.splitlines()
    assert all(line.startswith(STARTS) for line in lines), err
    assert all(line.isprintable() for line in lines), err
    assert "bug in vtray" not in err, err
    assert sum(line.startswith("Error: ") for line in lines) == status, (status, err)


def run_quietly(arguments: Sequence[str]) -> None:
    """Run the command within this process, and check what it says; nothing reaches the terminal."""
    err = io.StringIO()
    with warnings.catch_warnings(), contextlib.redirect_stderr(err), _streams_apart():
        warnings.simplefilter("error")
        if numba.config.DISABLE_JIT:  # kernels that are not compiled warn of what they mean
            warnings.simplefilter("ignore", RuntimeWarning)
        status = cli.run(arguments)
    if "--stats" in arguments and status == 0:
        return
    check_printed(status, err.getvalue())


@contextlib.contextmanager
def _streams_apart():
    """Let standard output go to a file that vanishes, and standard input be empty."""
    with tempfile.TemporaryFile() as out, Path(os.devnull).open("rb") as empty:
        kept = os.dup(0), os.dup(1)
        os.dup2(empty.fileno(), 0)
        os.dup2(out.fileno(), 1)
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                yield
        finally:
            for number, handle in enumerate(kept):
                os.dup2(handle, number)
                os.close(handle)
