"""What a thread compiles now, which Numba does not tell the functions that kernels call."""

import contextlib
import threading
from collections.abc import Iterator

from vtray.base.compiler.unseen import Unsaid, unsaid_of

_mode = threading.local()


@contextlib.contextmanager
def compiling(is_kept: bool, unsaid: Unsaid | None = None) -> Iterator[None]:
    """Compile machine code without Numba; tell whether it is kept on disk, and what it is for."""
    before = is_for_kernels(), getattr(_mode, "is_kept", False), unsaid_now()
    _mode.is_for_kernels, _mode.is_kept, _mode.unsaid = True, is_kept, unsaid or before[2]
    try:
        yield
    finally:
        _mode.is_for_kernels, _mode.is_kept, _mode.unsaid = before


def is_for_kernels() -> bool:
    """Tell whether what this thread compiles now is machine code without Numba."""
    return getattr(_mode, "is_for_kernels", False)


def is_kept() -> bool:
    """Tell whether that is kept on disk, and what it calls may be, too."""
    return getattr(_mode, "is_kept", False)


def unsaid_now() -> Unsaid:
    """Return what the tuples are that it passes on, where that is known."""
    found: Unsaid | None = getattr(_mode, "unsaid", None)
    return found or unsaid_of("")
