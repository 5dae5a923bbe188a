"""What the libraries that read files say, in one line each."""

import contextlib
import io
import warnings
from collections.abc import Iterator
from typing import BinaryIO

from vtray.base.errors import SceneError, VtrayError
from vtray.base.memory import lack_of_memory
from vtray.scene.checks.json_tree import short

RUST = "PanicException"
"""What libraries in Rust raise where they give up, which is no Exception."""


@contextlib.contextmanager
def told(library: str, expected: str) -> Iterator[None]:
    """Turn what a library raises into a SceneError, and keep its warnings to itself.

    Parameters
    ----------
    library
        Its name.
    expected
        What it was to read, such as "a CIF file".
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (VtrayError, MemoryError):
        raise
    except BaseException as error:  # libraries raise whatever broken files lead to
        if not isinstance(error, Exception) and type(error).__name__ != RUST:
            raise
        words = short(" ".join(str(error).split()), 120)
        said = f"{type(error).__name__}: {words}" if words else type(error).__name__
        raise SceneError(f"expected {expected}, which {library} cannot read ({said})") from None


def check_room(file: BinaryIO, times: int) -> None:
    """Raise SceneError if there is not so many times the memory that a file has bytes."""
    size = file.seek(0, io.SEEK_END)
    file.seek(0)
    check_bytes(times * size)


def check_bytes(count: int) -> None:
    """Raise SceneError if there are not so many bytes of memory."""
    lack = lack_of_memory(count)
    if lack:
        raise SceneError(f"reading it needs about {lack}")
