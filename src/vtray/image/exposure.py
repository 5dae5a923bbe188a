"""Exposure: from linear light to the numbers of the image file."""

import math
import sys
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import kernel
from vtray.base.errors import RenderError
from vtray.base.pool import run_tasks
from vtray.base.tiles import TILE
from vtray.scene.light_types import AnyLight, brightest
from vtray.scene.settings import Background
from vtray.scene.vectors import Color

BRIGHTEST = sys.float_info.max / 2.0**17
"""The largest sum of intensities: times a colour of 255 and the 255 of exposure it is a double."""


class Overlay(NamedTuple):
    """A colour of its own that is a part of pixels: that of fog, or of lines.

    Attributes
    ----------
    share
        How much of each pixel it is, from 0 to 1, (height, width).
    color
        The colour, which exposure does not change.
    """

    share: NDArray[np.float64]
    color: Color


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
    overlays: Sequence[Overlay] = (),
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
    overlays
        What has colours of its own.

    Returns
    -------
    array
        The pixels, uint8 or uint16, (height, width, 3), or with alpha, not premultiplied,
        (height, width, 4).
    """
    is_light = background in ("black", "sky")
    if bits != 8 or not is_light:
        cover = np.ones(linear.shape[:2]) if is_light else alpha()
        exposed = put_on_background(linear, white, background, cover, 2**bits - 1, overlays)
        return exposed.astype(np.uint8 if bits == 8 else np.uint16)
    pixels = np.empty(linear.shape, np.uint8)

    def develop_rows(top: int) -> None:
        # Not in the kernel: there it would call a library of Numba's, which takes 3 ms to load.
        light, bytes_ = linear[top : top + TILE], pixels[top : top + TILE]
        _expose(light.reshape(light.size), float(white), bytes_.reshape(bytes_.size))

    run_tasks(range(0, len(linear), TILE), lambda: develop_rows, threads)
    if overlays:
        covered = np.any([overlay.share > 0.0 for overlay in overlays], axis=0)
        # One column of pixels, as any picture.
        some = [Overlay(share[covered][:, None], color) for share, color in overlays]
        light, cover = linear[covered][:, None], np.ones((np.count_nonzero(covered), 1))
        pixels[covered] = put_on_background(light, white, background, cover, 255, some)[:, 0]
    return pixels


def put_on_background(
    linear: NDArray[np.float64],
    white: float,
    background: Background,
    alpha: NDArray[np.float64],
    maximum: int,
    overlays: Sequence[Overlay] = (),
) -> NDArray[np.float64]:
    """Expose the light of an image, up to a maximum, over or without a background.

    What is covered in part is blended with the background after exposure, so that the background
    has exactly its colour; so are overlays. For a transparent one, colours are those of what
    covers the pixel, and its share is the fourth channel.
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
    for overlay in overlays:
        own = np.array([overlay.color.r, overlay.color.g, overlay.color.b]) * (maximum / 255)
        share = overlay.share[..., None]
        if background == "transparent":
            share = np.divide(share, cover, out=np.zeros_like(share), where=cover > 0.0)
        light = light + share * own
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
