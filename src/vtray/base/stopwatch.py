"""A stopwatch with laps."""

import time
from collections.abc import Callable


class Stopwatch:
    """Takes the seconds of one step after the other.

    Parameters
    ----------
    apart
        Returns how many seconds went into what belongs to no step; by default, none did.

    Attributes
    ----------
    seconds
        The time of each step so far, by its name.
    """

    def __init__(self, apart: Callable[[], float] = float) -> None:
        self.seconds: dict[str, float] = {}
        self._apart = apart
        self._last = time.perf_counter() - apart()

    def lap(self, step: str) -> None:
        """Note the time since the last lap as that of `step`."""
        now = time.perf_counter() - self._apart()
        # What is apart may be what another thread does at the same time, for a picture of its own.
        self.seconds[step] = max(now - self._last, 0.0)
        self._last = now
