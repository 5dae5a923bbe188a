"""Exposure: from linear light to the numbers of the image file."""

import math
import reprlib
import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import kernel
from vtray.base.errors import RenderError
from vtray.base.pool import run_tasks
from vtray.base.tiles import TILE
from vtray.scene.light_types import AnyLight, brightest
from vtray.scene.settings import Background, Exposure
from vtray.scene.vectors import Color

BRIGHTEST = sys.float_info.max / 2.0**17
"""The largest sum of intensities: times a colour of 255 and the 255 of exposure it is a double."""


def check_brightness(lights: Sequence[AnyLight]) -> None:
    """Raise RenderError if the lights are so bright that a pixel could overflow."""
    total = sum(map(brightest, lights))
    if total > BRIGHTEST:
        message = f"lights: the intensities add up to {total:g}, expected at most {BRIGHTEST:g}"
        raise RenderError(message)


def develop(
    linear: NDArray[np.float64],
    white: float,
    background: Background,
    alpha: Callable[[], NDArray[np.float64]],
    threads: int = 1,
    bits: int = 8,
) -> NDArray[Any]:
    """Expose the light of an image: a channel v becomes ``floor(maximum * v / white)``.

    Parameters
    ----------
    linear
        Linear light, (height, width, 3).
    white
        What becomes the maximum, as does what is more; if it is 0, the picture is black.
    background
        What is seen where nothing is; a sky belongs to the light.
    alpha
        Gives how much of each pixel is covered, (height, width); called only where it matters.
    threads
        How many threads to use at the most.
    bits
        8 or 16, of each channel; the maximum is 255 or 65535.

    Returns
    -------
    array
        The pixels, uint8 or uint16, (height, width, 3), or with alpha, not premultiplied,
        (height, width, 4).
    """
    is_light = background in ("black", "sky")
    if bits != 8:
        cover = np.ones(linear.shape[:2]) if is_light else alpha()
        exposed = put_on_background(linear, white, background, cover, 2**bits - 1)
        return exposed.astype(np.uint16)
    pixels = np.empty(linear.shape, np.uint8)

    def develop_rows(top: int) -> None:
        # Not in the kernel: there it would call a library of Numba's, which takes 3 ms to load.
        light, bytes_ = linear[top : top + TILE], pixels[top : top + TILE]
        _expose(light.reshape(light.size), float(white), bytes_.reshape(bytes_.size))

    run_tasks(range(0, len(linear), TILE), lambda: develop_rows, threads)
    if is_light:
        return pixels
    return put_on_background(linear, white, background, alpha(), 255).astype(np.uint8)


def put_on_background(
    linear: NDArray[np.float64],
    white: float,
    background: Background,
    alpha: NDArray[np.float64],
    maximum: int,
) -> NDArray[np.float64]:
    """Expose the light of an image, up to a maximum, over or without a background.

    What is covered in part is blended with the background after exposure, so that the background
    has exactly its colour. For a transparent one, colours are those of what covers the pixel, and
    its share is the fourth channel.
    """
    cover = alpha.clip(0.0, 1.0)[..., None]
    light = np.zeros_like(linear)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        if white > 0.0:
            # In units of a power of two, so that what overflows is white.
            unit = -math.frexp(white)[1]
            light = maximum * np.ldexp(linear, unit) / math.ldexp(white, unit)
        if background == "transparent":
            light = np.where(cover > 0.0, light / cover, 0.0)
    light[linear == white] = maximum if white > 0.0 else 0.0
    if background == "transparent":
        return np.concatenate([np.floor(light).clip(0, maximum), np.rint(maximum * cover)], axis=2)
    if isinstance(background, Color):
        behind = np.array([background.r, background.g, background.b]) * (maximum / 255)
        light = light + (1.0 - cover) * behind
    return np.floor(light).clip(0, maximum)


def warm_up() -> None:
    """Load the kernel of this module, or compile it."""
    _expose(np.zeros(0), 0.0, np.zeros(0, np.uint8))


@kernel
def _expose(linear: NDArray[np.float64], white: float, bytes_: NDArray[np.uint8]) -> None:
    """Expose the channels of any number of pixels, all (n,)."""
    for k in range(linear.size):
        share = (255.0 * linear[k]) / white if white > 0.0 else 0.0
        exposed = math.floor(min(max(share, 0.0), 255.0))
        # For one peak in seven, 255 * peak / peak rounds to just below 255.
        exposed = 255.0 if linear[k] == white > 0.0 else exposed
        bytes_[k] = np.uint8(exposed)


def locked_white(lock: object, exposure: object = None) -> float:
    """Return the white of the picture whose exposure another one shall have.

    Raises
    ------
    RenderError
        It is no picture, or an exposure was asked for too.
    """
    if exposure is not None:
        shown = reprlib.repr(exposure)
        message = f"lock and exposure {shown}: expected one of them; leave out the other"
        raise RenderError(message)
    white = getattr(lock, "white", None)
    if isinstance(white, (int, float)):
        return float(white)
    message = f"lock: expected a picture that was rendered, or None, got {reprlib.repr(lock)}"
    raise RenderError(message)


def known_white(exposure: Exposure, lock: object = None) -> float | None:
    """Return the light that becomes 255, if that is known before the light of the picture is."""
    if lock is not None:
        return locked_white(lock)
    return None if exposure == "max" else white_of(exposure, 0.0)


def white_of(exposure: Exposure, peak: float, lock: object = None) -> float:
    """Return the light that becomes 255 in an image whose largest channel is `peak`.

    Parameters
    ----------
    exposure
        What the settings say.
    peak
        The largest channel, ≥ 0.
    lock
        A picture whose exposure is taken instead, or None.
    """
    if lock is not None:
        return locked_white(lock)
    return peak if exposure == "max" else 255.0 / exposure
