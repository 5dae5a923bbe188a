"""Exposure: from linear light to the numbers of the image file."""

import math
import sys
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from vtray.compiled import kernel
from vtray.errors import RenderError
from vtray.scene import Light

BRIGHTEST = sys.float_info.max / 2.0**17
"""The largest sum of intensities: times a colour of 255 and the 255 of exposure it is a double."""


def check_brightness(lights: Sequence[Light]) -> None:
    """Raise RenderError if the lights are so bright that a pixel could overflow."""
    total = sum(light.intensity for light in lights)
    if total > BRIGHTEST:
        message = f"lights: the intensities add up to {total:g}, expected at most {BRIGHTEST:g}"
        raise RenderError(message)


def develop(film: NDArray[np.float64], peak: float, pixels: NDArray[np.uint8]) -> None:
    """Expose rows of a film so that the brightest channel of the image becomes 255.

    Parameters
    ----------
    film
        Linear light, (height, width, 3).
    peak
        The largest channel of the whole image; if it is 0, the pixels become black.
    pixels
        Where the result is written, (height, width, 3).
    """
    # Not in the kernel: there it would call a library of Numba's, which takes 3 ms to load.
    _expose(film.reshape(film.size), float(peak), pixels.reshape(pixels.size))


@kernel
def _expose(linear: NDArray[np.float64], peak: float, bytes_: NDArray[np.uint8]) -> None:
    """Expose the channels of any number of pixels, all (n,)."""
    for k in range(linear.size):
        exposed = math.floor((255.0 * linear[k]) / peak) if peak > 0.0 else 0.0
        # For one peak in seven, 255 * peak / peak rounds to just below 255.
        exposed = 255.0 if linear[k] == peak > 0.0 else exposed
        bytes_[k] = np.uint8(exposed)
