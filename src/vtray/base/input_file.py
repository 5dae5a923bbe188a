"""Files that are read: regular ones, and pipes that are given on purpose.

A name may lead to anything. A pipe whose writer never comes, or a device that never ends, is an
error at once; what is read from a pipe is bounded by memory.
"""

import contextlib
import errno
import io
import os
import re
import stat
from typing import BinaryIO

from vtray.base.errors import UnfitFileError
from vtray.base.memory import available_memory, readable

SHARE = 4
"""What is read as a whole may take this part of the memory that is available: a quarter."""

SMALL = 1 << 24
"""What has no more bytes is read without looking at the memory."""

STEP = 1 << 22
"""Bytes that are read from a pipe at a time."""

_GIVEN = re.compile(r"/dev/stdin|(?:/dev|/proc/self)/fd/([0-9]{1,9})")
"""The names of what is open already, given on purpose, as by ``<(command)``."""

_KINDS = {
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}


def open_input(path: str | os.PathLike[str]) -> BinaryIO:
    """Open a file for reading.

    Parameters
    ----------
    path
        A regular file; or a pipe by one of the names of what the process was given, ``/dev/stdin``,
        ``/dev/fd/N`` and ``/proc/self/fd/N``, which is read as a whole.

    Returns
    -------
    file
        In which any place can be sought.

    Raises
    ------
    OSError
        The file cannot be read, is none of these, or a pipe holds too much; `why_unreadable` in
        `vtray.base.errors` says it.
    """
    handle = _open_given(path) if is_given(path) else _open_named(path)
    try:
        found = os.fstat(handle)
        _check_kind(found, is_given(path))
        file = os.fdopen(handle, "rb")
    except BaseException:
        os.close(handle)
        raise
    if stat.S_ISREG(found.st_mode):
        return file
    with file:
        return io.BytesIO(read_stream(file))


def is_given(path: str | os.PathLike[str]) -> bool:
    """Tell whether a path is none of a folder, but a name of what the process was given."""
    return isinstance(path, (str, os.PathLike)) and bool(_GIVEN.fullmatch(os.fsdecode(path)))


def _open_given(path: str | os.PathLike[str]) -> int:
    """Return a descriptor of what is open already; by its name, a socket cannot be opened."""
    match = _GIVEN.fullmatch(os.fsdecode(path))
    return os.dup(int(match[1] or 0) if match else 0)


def _open_named(path: str | os.PathLike[str]) -> int:
    """Return a descriptor of a file; never wait for the writer of a pipe."""
    if "\0" in os.fsdecode(path):  # versions of Python say it in other words
        message = "embedded null byte"
        raise ValueError(message)
    _check_kind(os.stat(path), given=False)
    # The file may be replaced by a pipe meanwhile.
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0)
    return os.open(path, flags | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0))


def read_input(path: str | os.PathLike[str]) -> bytes:
    """Read a file as a whole; raise as `open_input` does, and if it is too large."""
    with open_input(path) as file:
        return read_stream(file)


def read_stream(file: BinaryIO) -> bytes:
    """Read what is left of a file or a pipe, such as standard input.

    Raises
    ------
    OSError
        It cannot be read, or is larger than the quarter of the memory that is available.
    """
    size = 0
    with contextlib.suppress(OSError):  # not every stream is a file
        size = os.fstat(file.fileno()).st_size
    _check_size(size)
    parts: list[bytes] = []
    read = 0
    while part := file.read(max(size - read, STEP)):
        parts.append(part)
        read += len(part)
        _check_size(read)
    return b"".join(parts)


def _check_size(size: int) -> None:
    """Raise OSError if something is too large to be read as a whole."""
    if size <= SMALL:
        return
    most = max(available_memory() // SHARE, SMALL)
    if size > most:
        problem = f"is larger than {readable(most)}, a quarter of the memory that is available"
        raise UnfitFileError(errno.EFBIG, problem)


def _check_kind(found: os.stat_result, given: bool) -> None:
    """Raise OSError if a file is not of a kind that can be read."""
    kind = stat.S_IFMT(found.st_mode)
    if kind == stat.S_IFDIR:
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if kind != stat.S_IFREG and not given:
        words = _KINDS.get(kind, "no file")
        hint = ", which is read only as /dev/stdin or <(command)" if kind == stat.S_IFIFO else ""
        raise UnfitFileError(errno.EINVAL, f"is {words}{hint}")
