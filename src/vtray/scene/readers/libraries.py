"""What the libraries that read files say, in one line each."""

import contextlib
import os
import warnings
from collections.abc import Iterator

from vtray.base.errors import SceneError, VtrayError
from vtray.base.memory import lack_of_memory
from vtray.scene.checks.json_tree import short


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
    except Exception as error:  # noqa: BLE001  libraries raise whatever broken files lead to
        words = short(" ".join(str(error).split()), 120)
        said = f"{type(error).__name__}: {words}" if words else type(error).__name__
        raise SceneError(f"expected {expected}, which {library} cannot read ({said})") from None


def check_room(path: str, times: int) -> None:
    """Raise SceneError if there is not so many times the memory that a file has bytes."""
    lack = lack_of_memory(times * os.stat(path).st_size)
    if lack:
        raise SceneError(f"reading it needs about {lack}")
