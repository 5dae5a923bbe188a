"""A stopwatch with laps."""

import time


class Stopwatch:
    """Takes the seconds of one step after the other.

    Attributes
    ----------
    seconds
        The time of each step so far, by its name.
    """

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, step: str) -> None:
        """Note the time since the last lap as that of `step`."""
        now = time.perf_counter()
        self.seconds[step] = now - self._last
        self._last = now
