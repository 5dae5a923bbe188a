"""What a thread compiles now, which Numba does not tell the functions that kernels call."""

import contextlib
import threading
from collections.abc import Iterator

_mode = threading.local()


@contextlib.contextmanager
def compiling(is_kept: bool) -> Iterator[None]:
    """Compile machine code without Numba; tell whether it is kept on disk."""
    before = is_for_kernels(), getattr(_mode, "is_kept", False)
    _mode.is_for_kernels, _mode.is_kept = True, is_kept
    try:
        yield
    finally:
        _mode.is_for_kernels, _mode.is_kept = before


def is_for_kernels() -> bool:
    """Tell whether what this thread compiles now is machine code without Numba."""
    return getattr(_mode, "is_for_kernels", False)


def is_kept() -> bool:
    """Tell whether that is kept on disk, and what it calls may be, too."""
    return getattr(_mode, "is_kept", False)
