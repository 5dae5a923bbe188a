"""Frames of a file that others read themselves, where they see the same file."""

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from threading import Lock
from typing import Any

from vtray.base.errors import VtrayError
from vtray.base.file_series import files_of
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.read import read_numbers


class Stored:
    """A file with frames; what travels to others is where it is, and how it is told from others.

    Parameters
    ----------
    path
        The file, or a pattern for several.
    reading
        What `vtray.read` is told of it.
    """

    def __init__(self, path: str, reading: Mapping[str, Any]) -> None:
        second = reading.get("trajectory")
        self._path = Path(path).absolute()
        self._reading = dict(reading)
        if second is not None:
            self._reading["trajectory"] = Path(os.fsdecode(second)).absolute()
        self._lock = Lock()
        self._marks = self._marks_here()
        self._begin()

    def __getstate__(self) -> tuple[Any, ...]:
        return self._path, self._reading, self._marks

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        self._path, self._reading, self._marks = state
        self._lock = Lock()
        self._begin()

    def read(self, number: int) -> Particles | None:
        """Return a frame by its number from 0; None if it cannot be read from here.

        Frames that are asked for in their order are read in one go through the file.
        """
        with self._lock:
            if not self._marks or self._marks != self._marks_here():
                return None
            self._number = number
            try:
                return next(self._frames)
            except VtrayError:  # who has given the file says what is wrong with it
                self._begin()
                return None

    def _begin(self) -> None:
        """Let the file be opened when the next frame is asked for."""
        self._number = 0
        asked = iter(lambda: self._number, None)
        self._frames: Iterator[Particles] = read_numbers(self._path, asked, **self._reading)

    def _marks_here(self) -> list[tuple[int, int]]:
        """Return the sizes of the files and when they were written; none if they are not seen."""
        second = self._reading.get("trajectory")
        try:
            files = map(Path, files_of(str(self._path)))
            found = [path.stat() for path in (*files, second) if path is not None]
        except OSError:
            return []
        return [(status.st_size, status.st_mtime_ns) for status in found]
