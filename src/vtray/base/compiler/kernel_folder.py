"""The folder in which compiled kernels are kept.

Its name is a hash of all sources of the package, so that a change in any function that a kernel
calls is noticed. What is in it is machine code, so folders and files must be this user's own.
"""

import contextlib
import errno
import os
import re
import stat
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from blake3 import blake3

from vtray.base.caller_warning import warn_caller
from vtray.base.own_files import NotOwnError, check_own, read_own, write_own

CACHE_VARIABLE = "VTRAY_CACHE_DIR"
"""Environment variable that names another folder for compiled kernels."""

SUFFIX = ".kernel"
"""The ending of all files in the folder."""

KEPT_SECONDS = 30 * 24 * 3600
"""How long the kernels of other versions of vtray are kept."""

MARK = "CACHEDIR.TAG"
"""The file by which a folder is known as one of vtray's, and passed over by many backups.

References
----------
https://bford.info/cachedir/
"""

_MARK = b"""Signature: 8a477f597d28d172789f06886806bc55
# Kernels compiled by vtray, which compiles them again where they are missing.
"""

_KERNEL = re.compile(rf"vtray\.[\w.]+-[0-9a-f]{{16}}{re.escape(SUFFIX)}(\.\w+)?")
"""The name of a kernel, and that of one which was never finished."""

_warned: list[str] = []


@cache
def cache_folder() -> Path | None:
    """Return the folder of this version's compiled kernels, None if nothing can be kept.

    That is one in the folder that the environment names; else in the user's own for caches, or
    where that is of no use, in the place for temporary files. There is a warning of one that is not
    this user's own, or was named and is of no use.
    """
    chosen = os.environ.get(CACHE_VARIABLE)
    homes = [_chosen_home] if chosen else [_user_home, _temporary_home]
    found, doubts = None, []
    for home in homes:
        try:
            found = _kernels_in(home())
            break
        except NotOwnError as error:
            doubts.append(str(error))
        except OSError as error:
            doubts += [f"{chosen} cannot be written to: {error.strerror}"] if chosen else []
    if doubts:
        instead = f"are kept in {found.parent}" if found else "are not kept"
        remedy = f"let {CACHE_VARIABLE} name a folder that only you may write to"
        _warn(f"{'; '.join(doubts)}, so compiled kernels {instead}; {remedy}")
    return found


def read_kept(file: Path) -> bytes | None:
    """Return what a file in the folder holds, None if that cannot be had, or not be trusted."""
    folder = file.parent
    try:
        return read_own(folder.parent, folder.name, file.name)
    except NotOwnError as error:
        _warn(f"{error}, so this kernel is compiled anew")
    except OSError:
        pass
    return None


def write_kept(file: Path, content: bytes) -> None:
    """Write a file in the folder, whole; raise OSError where that cannot be."""
    try:
        write_own(file, content)
    except FileNotFoundError:  # somebody has deleted the folder
        _kernels_in(file.parent.parent)
        write_own(file, content)


def _warn(message: str) -> None:
    """Warn of what is not trusted, once in each process."""
    if not _warned:
        _warned.append(message)
        warn_caller(message)


def _kernels_in(home: Path) -> Path:
    """Return the folder of this version's kernels in a home, made if need be.

    Raises
    ------
    NotOwnError
        One of the two is not this user's own.
    OSError
        It cannot be made, or not be written to.
    """
    folder = home / f"kernels-{_source_hash()}"
    _make(home)
    check_own(home)
    is_new = _make(folder)
    check_own(home, folder.name)
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    if not (folder / MARK).exists():
        write_own(folder / MARK, _MARK)
    if is_new:
        _prune(home, folder)
    return folder


def _make(folder: Path) -> bool:
    """Make a folder of this user's own; tell whether there was none."""
    try:
        folder.mkdir(mode=0o700, parents=True)
    except FileExistsError:
        return False
    return True


def _chosen_home() -> Path:
    """Return the folder that the environment names."""
    return Path(os.environ[CACHE_VARIABLE]).absolute()


def _user_home() -> Path:
    """Return the user's folder for caches; raise OSError if there is no home for it to be in."""
    from platformdirs import user_cache_path

    with contextlib.suppress(RuntimeError):
        home = user_cache_path("vtray")
        # Older versions of platformdirs would have it in a folder that is called ~.
        if home.is_absolute():
            return home
    raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))


def _temporary_home() -> Path:
    """Return a folder of this user's own, for machines without a writable home."""
    import tempfile

    user = os.geteuid() if hasattr(os, "geteuid") else "user"
    return Path(tempfile.gettempdir()) / f"vtray-cache-{user}"


def _prune(home: Path, folder: Path) -> None:
    """Delete what other versions made long ago in the home of a new folder."""
    oldest = time.time() - KEPT_SECONDS
    for other in home.glob("kernels-*"):
        with contextlib.suppress(OSError):
            if (
                other != folder
                and other.lstat().st_mtime < oldest
                and read_own(home, other.name, MARK) == _MARK
            ):
                _delete(other)


def _delete(folder: Path) -> None:
    """Delete what vtray has made in a folder, and the folder if nothing else is there."""
    names = {file.name for file in folder.iterdir() if stat.S_ISREG(file.lstat().st_mode)}
    for name in filter(_KERNEL.fullmatch, names):
        (folder / name).unlink()
    if [file.name for file in folder.iterdir()] == [MARK]:
        (folder / MARK).unlink()
        folder.rmdir()


def _source_hash(package: Path = Path(__file__).parents[2]) -> str:
    """Return a short hash of all sources of the package, also of those in folders of its own."""
    digest = blake3()
    for path in sorted(_sources(str(package))):
        with open(path, "rb", buffering=0) as source:
            content = source.read()
        name = os.fsencode(path[len(str(package)) :])
        digest.update(b"%d %b %d %b" % (len(name), name, len(content), content))
    return digest.hexdigest()[:16]


def _sources(folder: str) -> Iterator[str]:
    """Give the paths of all sources in a folder and in those in it."""
    # By pathlib, it takes three times as long, at each start.
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.is_dir(follow_symlinks=False):
                yield from _sources(entry.path)
            elif entry.name.endswith(".py"):
                yield entry.path
