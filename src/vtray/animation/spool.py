"""Frames that are slow to read, kept on disk once they have been read."""

import pickle
import tempfile
import weakref
from collections.abc import Iterator
from threading import Lock

from vtray.base.errors import SceneError
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import no_such_frame


class Spool:
    """Frames that come one by one, and can be had again; one of them is in memory.

    Parameters
    ----------
    path
        The name of their file, for messages.
    frames
        Gives them.
    """

    def __init__(self, path: str, frames: Iterator[Particles]) -> None:
        self._path = path
        self._frames = frames
        self._file = tempfile.TemporaryFile()  # noqa: SIM115 - closed, and so gone, with this
        weakref.finalize(self, self._file.close)
        self._places = [0]
        self._lock = Lock()

    def count(self) -> int:
        """Return how many there are: all are read."""
        with self._lock:
            while self._read_on():
                pass
            return len(self._places) - 1

    def read(self, number: int) -> Particles:
        """Return a frame by its number from 0."""
        with self._lock:
            while len(self._places) <= number + 1:
                if not self._read_on():
                    problem = no_such_frame(number, len(self._places) - 1)
                    raise SceneError(f"{self._path}: {problem}")
            self._file.seek(self._places[number])
            found: Particles = pickle.load(self._file)
            return found

    def _read_on(self) -> bool:
        """Keep one more; tell whether there was one."""
        found = next(self._frames, None)
        if found is None:
            return False
        self._file.seek(self._places[-1])
        pickle.dump(found, self._file, protocol=5)
        self._places.append(self._file.tell())
        return True
