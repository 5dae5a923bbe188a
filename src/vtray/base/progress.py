"""Progress that is shown on stderr."""

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
    stays
        Whether it is there at once, and stays when all is done.
    """

    def __init__(self, unit: str = "task", *, stays: bool = False) -> None:
        self._unit, self._stays = unit, stays
        self._start = time.perf_counter()
        self._step = ""
        self._bar: Any = None

    def __call__(self, step: str, done: int, total: int) -> None:
        """Show the progress, once the render has taken long enough; a total of 0 is not known."""
        if step != self._step:
            self.close()
            self._step = step
        if self._bar is None and (self._stays or self._took_long()):
            from tqdm import tqdm

            self._bar = tqdm(
                desc=step,
                total=total or None,
                initial=done,
                unit=self._unit,
                file=sys.stderr,
                leave=self._stays,
            )
        if self._bar is not None:
            self._bar.update(done - self._bar.n)

    def close(self) -> None:
        """Take the bar away, or leave it as it is if it stays."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None

    def _took_long(self) -> bool:
        return time.perf_counter() - self._start > DELAY_SECONDS


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
