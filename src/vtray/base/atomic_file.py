"""Files that are written whole or not at all.

What is written goes to a temporary file in the same folder, which then takes the file's name. These
rules hold for what was there before:

- A link is followed, and stays a link.
- Owner, group and permissions stay. Where the system does not let this user keep them, and where a
  file has several names (hard links), its content is replaced instead of the file, once the new
  content is complete and there is space for it.
- What may not be written to is not replaced, not even by root: a read-only file stays.
- Devices, pipes, and what this process has open (``/dev/stdout``) are written to directly.

A process that is killed leaves its temporary file behind; the next one that writes to the same file
takes it over.
"""

import contextlib
import os
import re
import stat
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import BinaryIO

from blake3 import blake3

from vtray.base.errors import OutputError
from vtray.base.signals import LastStep, blocked

TEMPORARY_NAMES = 16
"""How many processes may write to a file at once before their names are chosen at random."""

_STEP = 1 << 20
"""Bytes that are copied at a time."""

_OPEN = re.compile(r"/dev/std(?:out|err)|/(?:dev|proc/self)/fd/([0-9]{1,6})")


def check_writable(path: Path) -> None:
    """Raise OutputError if it is plain before any work that `path` cannot be written."""
    with explained(path):
        if _is_special(path):
            return
        target = Path(os.path.realpath(path))
        _check_target(path)
        if not target.parent.is_dir():
            message = f"{path}: there is no folder {target.parent}"
            raise OutputError(message)
        with _temporary(target):
            pass


def check_replaceable(path: Path, remedy: str) -> None:
    """Raise OutputError if what is written to `path` would follow what was written before.

    Parameters
    ----------
    path
        A file that will be written again and again.
    remedy
        What to do instead.
    """
    with explained(path):
        if _is_special(path):
            message = f"{path}: is no file whose content can be replaced; {remedy}"
            raise OutputError(message)


def check_spares(path: Path, inputs: Iterable[Path], what: str, remedy: str) -> None:
    """Raise OutputError if writing a file would destroy another that is read.

    Parameters
    ----------
    path
        The file to write, which need not exist.
    inputs
        The files that are read.
    what
        What they are, to follow the name of `path`.
    remedy
        What to do instead.
    """
    for source in inputs:
        with contextlib.suppress(OSError, ValueError):  # what is not there cannot be destroyed
            if os.path.samefile(path, source) and path.is_file():
                message = f"{path}: {what}; {remedy}"
                raise OutputError(message)


def write_whole(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Write a file, whole or not at all.

    Parameters
    ----------
    path
        The file.
    write
        Called with an open file.

    Raises
    ------
    OutputError
        The file cannot be written. What was there before is unchanged.
    """
    with explained(path):
        if _is_special(path):
            with _open_special(path) as file:
                write(file)
            return
        target = Path(os.path.realpath(path))
        old = _check_target(path)
        with _temporary(target) as (file, name):
            write(file)
            file.close()
            if old is None:
                os.chmod(name, _usual_mode())
            elif old.st_nlink > 1 or not _take_over(name, old):
                _overwrite(target, name)
                return
            os.replace(name, target)


def _is_special(path: Path) -> bool:
    """Tell whether a file is a device, a pipe, or open already, so that it cannot be replaced."""
    if _OPEN.fullmatch(os.fspath(path)):
        return True
    old = _status(path)
    return old is not None and not stat.S_ISREG(old.st_mode) and not stat.S_ISDIR(old.st_mode)


def _open_special(path: Path) -> BinaryIO:
    """Open a device or a pipe, or use what is open already."""
    match = _OPEN.fullmatch(os.fspath(path))
    if match is None:
        return path.open("wb")
    # Opened by its name, a file would be cut short, and a socket could not be opened.
    number = int(match[1] or (1 if "out" in match[0] else 2))
    if os.isatty(number):
        message = f"{path}: is a terminal; send it to a file or a pipe"
        raise OutputError(message)
    return os.fdopen(os.dup(number), "wb")


def _status(path: Path) -> os.stat_result | None:
    """Return what is known of a file, links followed, None if it is not there."""
    try:
        return path.stat()
    except FileNotFoundError:
        return None


def _check_target(path: Path) -> os.stat_result | None:
    """Return what is known of the file to replace; raise OutputError if it may not be replaced."""
    old = _status(path)
    if old is not None and stat.S_ISDIR(old.st_mode):
        message = f"{path}: is a folder; give the name of a file"
        raise OutputError(message)
    # Root may write to anything, but who has made a file read-only wants it to stay.
    if old is not None and not (old.st_mode & 0o222 and os.access(path, os.W_OK)):
        message = f"{path}: is read-only; make it writable, or choose another name"
        raise OutputError(message)
    return old


@contextlib.contextmanager
def _temporary(target: Path) -> Iterator[tuple[BinaryIO, str]]:
    """Give an empty file beside another, open and by its name; in the end it is gone."""
    lock: int | None = None
    handle, name = -1, ""

    def remove() -> None:
        # Where it has taken the name of the target, the old name may be that of another process.
        with contextlib.suppress(OSError):
            if lock is None or os.path.samestat(os.fstat(lock), os.lstat(name)):
                os.unlink(name)

    with LastStep(remove):
        with blocked():  # where there is a file, its name is known
            handle, name, lock = _open_temporary(target)
        try:
            with os.fdopen(handle, "wb") as file:
                yield file, name
        finally:
            remove()
            if lock is not None:  # from here on, another process could take it over
                os.close(lock)


def _open_temporary(target: Path) -> tuple[int, str, int | None]:
    """Make an empty file beside another, or take over one that a dead process has left.

    Returns
    -------
    handle
        Its descriptor.
    name
        Its path.
    lock
        A second descriptor, if it is locked for as long as this is open.
    """
    mark = blake3(os.fsencode(target.name)).hexdigest(6)
    # Where there are no locks, as in Windows, nothing can be taken over.
    for k in range(TEMPORARY_NAMES if hasattr(os, "O_NOFOLLOW") else 0):
        name = str(target.with_name(f".vtray-{mark}-{k}.part"))
        with contextlib.suppress(OSError):
            handle = os.open(name, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
            if _is_ours(handle, name):
                os.ftruncate(handle, 0)
                return handle, name, os.dup(handle)
            os.close(handle)
    import tempfile

    # If the folder cannot be written to, this says why.
    handle, name = tempfile.mkstemp(prefix=".vtray-", suffix=".part", dir=target.parent)
    return handle, name, None


def _is_ours(handle: int, name: str) -> bool:
    """Lock an open file; tell whether that worked, and it is no file of somebody else's."""
    import fcntl  # not in Windows

    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        opened, named = os.fstat(handle), os.lstat(name)
    except OSError:  # another process is about to write, or there are no locks here
        return False
    return (
        stat.S_ISREG(opened.st_mode)
        and opened.st_uid == os.geteuid()
        and opened.st_nlink == 1
        # The process that had it may have given it its name, or removed it, in between.
        and os.path.samestat(opened, named)
    )


def _take_over(name: str, old: os.stat_result) -> bool:
    """Give a file the owner and the permissions of another; tell whether that is allowed."""
    found = os.stat(name)
    try:
        if (found.st_uid, found.st_gid) != (old.st_uid, old.st_gid):
            os.chown(name, old.st_uid, old.st_gid)
    except PermissionError:
        return False
    os.chmod(name, stat.S_IMODE(old.st_mode))
    return True


def _overwrite(target: Path, name: str) -> None:
    """Replace the content of a file by that of another, once there is space for it."""
    with open(name, "rb") as new, open(target, "r+b") as file:
        before, size = os.fstat(file.fileno()).st_size, os.fstat(new.fileno()).st_size
        try:
            if size > before and hasattr(os, "posix_fallocate"):  # not in macOS
                os.posix_fallocate(file.fileno(), before, size - before)
        except OSError:
            file.truncate(before)
            raise
        with blocked():
            while part := new.read(_STEP):
                file.write(part)
            file.truncate()


def _usual_mode() -> int:
    """Return the permissions that a new file gets."""
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


@contextlib.contextmanager
def explained(path: Path) -> Iterator[None]:
    """Turn an OSError into an OutputError that names the file."""
    if "\0" in os.fspath(path):
        message = f"{path}: cannot be written: no file name may hold a null character"
        raise OutputError(message)
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        message = f"{path}: cannot be written: {reason[:1].lower()}{reason[1:]}"
        raise OutputError(message) from error
