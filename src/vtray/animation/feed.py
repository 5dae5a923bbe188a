"""Pictures that are done, on their way into a movie while others are still traced."""

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Pixels = NDArray[np.uint8]


class GivenUpError(Exception):
    """There will be no more pictures, and no movie."""


class Feed:
    """The pictures of a movie in their order, from files; who takes them waits for those to come.

    In memory there is but the one that is taken.
    """

    def __init__(self) -> None:
        self._paths: list[Path] = []
        self._is_whole = False
        self._is_given_up = False
        self._changed = threading.Condition()

    @property
    def count(self) -> int:
        """How many pictures there are so far."""
        return len(self._paths)

    def add(self, path: Path) -> None:
        """Let the next picture be that of a file."""
        with self._changed:
            self._paths.append(path)
            self._changed.notify_all()

    def end(self) -> None:
        """Say that all pictures are there."""
        with self._changed:
            self._is_whole = True
            self._changed.notify_all()

    def give_up(self) -> None:
        """Let who waits for pictures end with GivenUpError."""
        with self._changed:
            self._is_given_up = True
            self._changed.notify_all()

    def __iter__(self) -> "Iterator[Pixels]":
        k = 0
        while (path := self._wait_for(k)) is not None:
            yield _pixels_of(path)
            k += 1

    def some(self, count: int) -> "Iterator[Pixels]":
        """Wait for the whole movie, and give some pictures that are spread over it."""
        with self._changed:
            self._changed.wait_for(lambda: self._is_whole or self._is_given_up)
            self._check()
        for k in spread(len(self._paths), count):
            yield _pixels_of(self._paths[k])

    def _wait_for(self, k: int) -> Path | None:
        """Return the file of a picture; None behind the last."""
        with self._changed:
            self._changed.wait_for(
                lambda: k < len(self._paths) or self._is_whole or self._is_given_up
            )
            self._check()
            return self._paths[k] if k < len(self._paths) else None

    def _check(self) -> None:
        if self._is_given_up:
            raise GivenUpError


def spread(total: int, count: int) -> list[int]:
    """Return numbers from 0 to less than `total`, the first and the last among them.

    Parameters
    ----------
    total
        How many there are.
    count
        How many to choose at the most, > 1.
    """
    if total <= count:
        return [*range(total)]
    return [(k * (total - 1)) // (count - 1) for k in range(count)]


def _pixels_of(path: Path) -> "Pixels":
    """Return what a picture shows, (height, width, 3 or 4)."""
    import numpy as np
    from PIL import Image

    with Image.open(path) as picture:
        return np.asarray(picture)
