"""A file that one process holds, so that another one leaves alone what belongs to it.

The system forgets that a file is held when the process ends, however that is. Where it knows no
such locks, as Windows, and file systems of some clusters, nothing is held.
"""

import contextlib
import os
from pathlib import Path

from vtray.base.errors import OutputError


class HeldError(Exception):
    """A file is held by somebody else."""


class FileLock:
    """An empty file that is held from here on, until it is released, which removes it.

    Parameters
    ----------
    path
        The file, which need not exist.

    Raises
    ------
    HeldError
        Somebody else holds it.
    OutputError
        It cannot be made.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._handle: int | None = None
        if hasattr(os, "O_NOFOLLOW"):  # not in Windows
            self._handle = _held(path)

    def release(self) -> None:
        """Let others hold it."""
        if self._handle is not None:
            with contextlib.suppress(OSError):
                self._path.unlink()  # before it is free, or it could be another's
            os.close(self._handle)
            self._handle = None


def _held(path: Path) -> int | None:
    """Return the descriptor that holds a file; None where the system has no locks."""
    import fcntl  # not in Windows

    flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC
    while True:
        try:
            handle = os.open(path, flags, 0o600)
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise OutputError(f"{path}: cannot be made: {reason}") from None
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # Who had it may have removed it in between.
            with contextlib.suppress(FileNotFoundError):
                if os.path.samestat(os.fstat(handle), os.lstat(path)):
                    return handle
        except BlockingIOError:
            os.close(handle)
            raise HeldError from None
        except OSError:  # there are no locks here
            path.unlink(missing_ok=True)
            os.close(handle)
            return None
        os.close(handle)
