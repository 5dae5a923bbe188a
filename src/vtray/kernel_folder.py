"""The folder in which compiled kernels are kept.

Its name is a hash of all sources of the package, so that a change in any function that a kernel
calls is noticed. What is in it is machine code, so nobody else may write to it.
"""

import contextlib
import hashlib
import os
import shutil
import stat
import tempfile
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path

CACHE_VARIABLE = "VTRAY_CACHE_DIR"
"""Environment variable that names another folder for compiled kernels."""

SUFFIX = ".kernel"
"""The ending of all files in the folder."""

KEPT_SECONDS = 30 * 24 * 3600
"""How long the kernels of other versions of vtray are kept."""


@cache
def cache_folder() -> Path | None:
    """Return the folder of this version's compiled kernels, None if nothing can be written."""
    chosen = os.environ.get(CACHE_VARIABLE)
    if chosen:
        return _kernels_in(lambda: Path(chosen))
    return _kernels_in(_user_home) or _kernels_in(_temporary_home)


def is_compiled() -> bool:
    """Tell whether an earlier process has left compiled kernels (perhaps not all of them)."""
    folder = cache_folder()
    return folder is not None and any(folder.glob(f"*{SUFFIX}"))


def _kernels_in(home: Callable[[], Path]) -> Path | None:
    """Return the folder of this version's kernels in a home, None if it cannot be written to."""
    with contextlib.suppress(OSError):
        folder = home() / f"kernels-{_source_hash()}"
        if not folder.is_dir():
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            _prune(folder)
        if os.access(folder, os.W_OK | os.X_OK):
            return folder
    return None


def _user_home() -> Path:
    """Return the user's folder for caches."""
    from platformdirs import user_cache_path

    return user_cache_path("vtray")


def _temporary_home() -> Path:
    """Return a folder of this user's own, for machines without a writable home.

    Raises
    ------
    PermissionError
        Somebody else could write to it, and so let this process run what he likes.
    """
    user = os.getuid() if hasattr(os, "getuid") else None
    home = Path(tempfile.gettempdir()) / f"vtray-cache-{'user' if user is None else user}"
    home.mkdir(mode=0o700, parents=True, exist_ok=True)
    found = home.lstat()
    if user is not None and not (
        stat.S_ISDIR(found.st_mode) and found.st_uid == user and not found.st_mode & 0o022
    ):
        message = f"{home}: is not this user's own"
        raise PermissionError(message)
    return home


def _prune(folder: Path) -> None:
    """Delete the kernels of other versions, beside a new folder, that were made long ago."""
    oldest = time.time() - KEPT_SECONDS
    for other in folder.parent.glob("kernels-*"):
        with contextlib.suppress(OSError):
            if other != folder and other.stat().st_mtime < oldest:
                shutil.rmtree(other, ignore_errors=True)


def _source_hash() -> str:
    """Return a short hash of all sources of the package."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.name.encode() + b"\0" + source.read_bytes() + b"\0")
    return digest.hexdigest()[:16]
