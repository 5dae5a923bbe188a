"""Files and folders that belong to this user alone, so that what is in them may be run.

What was opened is looked at, not its name: by the time of opening, a name may stand for another
thing. Folders further up do not matter: who can write to one may put something else in the place of
what is in it, but cannot make that belong to this user, nor lead elsewhere by a link, as none is
followed from the folder on that is asked for. Windows has no such owners; there, all is taken.
"""

import contextlib
import errno
import os
import stat
from functools import reduce
from operator import or_
from pathlib import Path

from vtray.base.signals import LastStep, blocked

HAS_OWNERS = hasattr(os, "geteuid")

_FLAGS = ("O_NOFOLLOW", "O_NONBLOCK", "O_BINARY")  # not all systems have all; no pipe is waited for
_READ = reduce(or_, (getattr(os, name, 0) for name in _FLAGS), os.O_RDONLY)

_KINDS = {stat.S_IFDIR: "folder", stat.S_IFREG: "file"}
_OTHERS = stat.S_IWGRP | stat.S_IWOTH


class NotOwnError(OSError):
    """A file or folder is somebody else's, or might be."""


def check_own(folder: Path, *names: str) -> None:
    """Raise NotOwnError if a folder, or one of those in it by their names, is not this user's."""
    if HAS_OWNERS:
        os.close(_open(folder, names, stat.S_IFDIR))


def read_own(folder: Path, *names: str) -> bytes:
    """Return what a file holds.

    Parameters
    ----------
    folder, names
        A folder, then the names of folders and of the file, each in the one before it.

    Raises
    ------
    NotOwnError
        One of them is not this user's own, or is not what it should be.
    OSError
        The file cannot be read.
    """
    path = folder.joinpath(*names)
    opened = _open(folder, names, stat.S_IFREG) if HAS_OWNERS else os.open(path, _READ)
    with os.fdopen(opened, "rb") as file:
        return file.read()


def write_own(file: Path, content: bytes) -> None:
    """Write a file as a whole: a new one of this user's own, whatever had its name before.

    Raises
    ------
    OSError
        It cannot be written.
    """
    import tempfile

    opened, name = -1, ""

    def remove() -> None:
        with contextlib.suppress(OSError):
            os.unlink(name)

    with LastStep(remove):
        with blocked():  # where there is a file, its name is known
            # A file made so can be read and written by its owner alone.
            opened, name = tempfile.mkstemp(prefix=f"{file.name}.", dir=file.parent)
        try:
            with os.fdopen(opened, "wb") as stream:
                stream.write(content)
            os.replace(name, file)
        except BaseException:
            remove()
            raise


def _open(path: Path, names: tuple[str, ...], kind: int) -> int:
    """Open a folder, and what is in it by its names, step by step; return the last's descriptor."""
    opened = _open_one(path, None, stat.S_IFDIR if names else kind)
    for left, name in zip(range(len(names) - 1, -1, -1), names, strict=True):
        path, outer = path / name, opened
        try:
            opened = _open_one(path, outer, stat.S_IFDIR if left else kind)
        finally:
            os.close(outer)
    return opened


def _open_one(path: Path, inside: int | None, kind: int) -> int:
    """Open a file or folder of this user's own, in a folder that is open or by its whole path."""
    try:
        opened = os.open(path if inside is None else path.name, _READ, dir_fd=inside)
    except OSError as error:
        if error.errno != errno.ELOOP:
            raise
        message = f"{path} is a link"
        raise NotOwnError(message) from error
    doubt = _doubt(os.fstat(opened), kind)
    if doubt:
        os.close(opened)
        message = f"{path} {doubt}"
        raise NotOwnError(message)
    return opened


def _doubt(found: os.stat_result, kind: int) -> str:
    """Say why what was opened may not be this user's own, as the end of a sentence."""
    if stat.S_IFMT(found.st_mode) != kind:
        return f"is no {_KINDS[kind]}"
    if found.st_uid != os.geteuid():
        return "belongs to another user"
    return "may be written to by others" if found.st_mode & _OTHERS else ""
