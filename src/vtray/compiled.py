"""How kernels are compiled, and where the machine code is kept.

Every compile-time decision is made here:

- ``error_model="numpy"``: a division by zero gives infinity or NaN, as in C, and loops vectorise.
- ``nogil=True``: kernels of several threads run side by side.
- No ``fastmath``, no fused multiply-add: pictures are equal to the last bit on every processor.
- ``_nrt=False``: no reference counts on arrays. Kernels allocate nothing, and the counting in inner
  loops kept them from being vectorised (a room with 64 lights: 0.55 s with it, 0.09 s without).
- ``cache=True`` for kernels (not for the device functions inside them): compiled once per machine.

Numba's own cache does not notice a change in a function that a kernel calls from another module,
so the cache folder is named after a hash of all sources of the package. Within it, Numba keys the
code on its own version and on the processor, and writes by renaming, so that two processes may
start at once.
"""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba

Function = TypeVar("Function", bound=Callable[..., Any])

CACHE_VARIABLE = "VTRAY_CACHE_DIR"
"""Environment variable that names another folder for compiled kernels."""

_OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "_nrt": False}


def device(function: Function) -> Function:
    """Compile a small scalar function that kernels call."""
    compiled: Function = numba.njit(function, **_OPTIONS)
    return compiled


def kernel(function: Function) -> Function:
    """Compile a loop over arrays, and keep the machine code on disk."""
    folder = cache_folder()
    if folder is None:
        return device(function)
    # Numba reads this setting when the decorator runs; other users of Numba keep theirs.
    settings: Any = numba.config
    theirs = settings.CACHE_DIR
    settings.CACHE_DIR = str(folder)
    try:
        compiled: Function = numba.njit(function, cache=True, **_OPTIONS)
    finally:
        settings.CACHE_DIR = theirs
    return compiled


@cache
def cache_folder() -> Path | None:
    """Return the folder of this version's compiled kernels, None if nothing can be written."""
    from platformdirs import user_cache_path

    chosen = os.environ.get(CACHE_VARIABLE)
    homes = [Path(chosen)] if chosen else [user_cache_path("vtray"), _temporary_home()]
    for home in homes:
        folder = home / f"kernels-{_source_hash()}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                return folder
        except OSError:
            continue
    return None


def is_compiled() -> bool:
    """Tell whether an earlier process has left compiled kernels (perhaps not all of them)."""
    folder = cache_folder()
    return folder is not None and any(folder.rglob("*.nbc"))


def forget() -> None:
    """Throw the compiled kernels on disk away, for instance because they cannot be read."""
    folder = cache_folder()
    if folder is not None:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True, exist_ok=True)


def _temporary_home() -> Path:
    """Return a folder of this user's own, for machines without a writable home."""
    user = os.getuid() if hasattr(os, "getuid") else "user"
    return Path(tempfile.gettempdir()) / f"vtray-cache-{user}"


def _source_hash() -> str:
    """Return a short hash of all sources of the package."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.name.encode() + b"\0" + source.read_bytes() + b"\0")
    return digest.hexdigest()[:16]
