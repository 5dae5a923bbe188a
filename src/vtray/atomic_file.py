"""Files that are written whole or not at all."""

import contextlib
import os
import stat
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO

from vtray.errors import OutputError


def check_writable(path: Path) -> None:
    """Raise OutputError if it is plain before any work that `path` cannot be written."""
    with _explained(path):
        target = path.resolve()
        if target.is_dir():
            message = f"{path}: is a folder; give the name of a file"
            raise OutputError(message)
        if not target.parent.is_dir():
            message = f"{path}: there is no folder {target.parent}"
            raise OutputError(message)
        if _is_special(target):
            return
        handle, name = _new_beside(target)
        os.close(handle)
        os.unlink(name)


def write_whole(path: Path, write: Callable[[BinaryIO], None]) -> None:
    """Write a file through a temporary one in the same folder, which then takes its name.

    Parameters
    ----------
    path
        The file. A link is followed; a device or a pipe is written to directly.
    write
        Called with the open temporary file.

    Raises
    ------
    OutputError
        The file cannot be written. What was there before is unchanged.
    """
    with _explained(path):
        target = path.resolve()
        if _is_special(target):
            with target.open("wb") as file:
                write(file)
            return
        handle, name = _new_beside(target)
        try:
            with os.fdopen(handle, "wb") as file:
                write(file)
            os.chmod(name, _mode(target))
            os.replace(name, target)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(name)
            raise


def _new_beside(target: Path) -> tuple[int, str]:
    """Make an empty file in the folder of another; return its descriptor and its name."""
    return tempfile.mkstemp(prefix=f".{target.name[:100]}.", dir=target.parent)


def _is_special(target: Path) -> bool:
    """Tell whether a file is a device or a pipe, which cannot be replaced."""
    return target.exists() and not target.is_file()


def _mode(target: Path) -> int:
    """Return the permissions of a file: those it has, or those that a new one gets."""
    with contextlib.suppress(FileNotFoundError):
        return stat.S_IMODE(target.stat().st_mode)
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


@contextlib.contextmanager
def _explained(path: Path) -> Iterator[None]:
    """Turn an OSError into an OutputError that names the file."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        message = f"{path}: cannot be written: {reason[:1].lower()}{reason[1:]}"
        raise OutputError(message) from error
