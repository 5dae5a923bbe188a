"""The progress bar of the command line."""

import sys
import time
from typing import Any

DELAY_SECONDS = 1.0
"""No bar is shown for a render that is done before."""


class ProgressBar:
    """Shows tiles done on stderr; call it with the tiles done and the number of all."""

    def __init__(self) -> None:
        self._start = time.perf_counter()
        self._bar: Any = None

    def __call__(self, done: int, total: int) -> None:
        """Show the progress, once the render has taken long enough."""
        if self._bar is None and time.perf_counter() - self._start > DELAY_SECONDS:
            from tqdm import tqdm

            self._bar = tqdm(total=total, initial=done, unit="tile", file=sys.stderr, leave=False)
        if self._bar is not None:
            self._bar.update(done - self._bar.n)

    def close(self) -> None:
        """Take the bar away."""
        if self._bar is not None:
            self._bar.close()
