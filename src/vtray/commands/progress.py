"""The progress bar of the command line."""

import contextlib
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

DELAY_SECONDS = 1.0
"""No bar is shown for a render that is done before."""


class ProgressBar:
    """Shows on stderr what is being done; call it as `vtray.render` calls its `progress`.

    Parameters
    ----------
    unit
        What is counted.
    """

    def __init__(self, unit: str = "task") -> None:
        self._unit = unit
        self._start = time.perf_counter()
        self._step = ""
        self._bar: Any = None

    def __call__(self, step: str, done: int, total: int) -> None:
        """Show the progress, once the render has taken long enough."""
        if step != self._step:
            self.close()
            self._step = step
        if self._bar is None and time.perf_counter() - self._start > DELAY_SECONDS:
            from tqdm import tqdm

            self._bar = tqdm(
                desc=step, total=total, initial=done, unit=self._unit, file=sys.stderr, leave=False
            )
        if self._bar is not None:
            self._bar.update(done - self._bar.n)

    def close(self) -> None:
        """Take the bar away."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None


@contextmanager
def announced(text: str) -> Iterator[None]:
    """Print a line on stderr if what is done within takes long."""
    timer = threading.Timer(DELAY_SECONDS, print, (text,), {"file": sys.stderr})
    timer.daemon = True
    with contextlib.suppress(RuntimeError):  # no more threads are allowed
        timer.start()
    try:
        yield
    finally:
        timer.cancel()
