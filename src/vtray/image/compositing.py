"""Light with what is drawn onto it, and with what is behind it, as 8 bits for each channel.

It is made of each pixel in turn, where `vtray.image.exposure` makes a picture of each step.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.base.pool import run_tasks
from vtray.base.tiles import TILE
from vtray.image.exposure import warm_up as warm_up_exposure
from vtray.scene.colors.tone_map_names import is_encoded
from vtray.scene.settings import Background, RenderSettings
from vtray.scene.vectors import Color


class Drawn(NamedTuple):
    """What a style draws onto light: (0, 0) arrays for what there is not.

    Attributes
    ----------
    shade
        How much of its light each pixel keeps, (height, width).
    lines
        How much of each pixel lines hide, (height, width).
    fog
        How much of it, beside lines, fog of its own colour is, (height, width).
    line_color, fog_color
        Red, green and blue, from 0 to 255.
    """

    shade: NDArray[np.float32]
    lines: NDArray[np.float32]
    fog: NDArray[np.float64]
    line_color: tuple[float, float, float]
    fog_color: tuple[float, float, float]


class Behind(NamedTuple):
    """What is seen where nothing is: red, green and blue, from 0 to 255, unless that is nothing."""

    red: float
    green: float
    blue: float
    is_transparent: bool


class Part(NamedTuple):
    """Shares of a pixel, from 0 to 1: of light that is left, line, fog, and what is covered."""

    shade: float
    line: float
    fog: float
    covered: float


class Exposure(NamedTuple):
    """The light that becomes the maximum.

    Attributes
    ----------
    white
        That light, and 0 if all is black.
    unit, again
        Two powers of two: with their product, white is about 1, so that what overflows is white.
    """

    white: float
    unit: float
    again: float


def has_background(settings: RenderSettings) -> bool:
    """Tell whether pictures with such settings show what is behind things, and are made here."""
    return settings.background not in ("black", "sky") and not is_encoded(settings.tonemap)


def composite(
    linear: NDArray[np.float64],
    white: float,
    background: Background,
    alpha: Callable[[], NDArray[np.float64]],
    drawn: Drawn,
    threads: int = 1,
) -> NDArray[np.uint8]:
    """Return the pixels of light, of what is drawn onto it, and of what is behind it.

    They are those that `vtray.image.exposure.develop` makes of the same, one after the other.

    Parameters
    ----------
    linear, white, threads
        As for `develop`, light without what is drawn.
    alpha
        Likewise, without lines: these cover what they are drawn on.
    background
        What is seen where nothing is, any but a sky.
    drawn
        What is drawn.
    """
    is_transparent = background == "transparent"
    cover = np.zeros((0, 0)) if background == "black" else alpha()
    color = Color(0, 0, 0) if isinstance(background, str) else background
    exposure = _exposure_of(white)
    behind = Behind(float(color.r), float(color.g), float(color.b), is_transparent)
    height, width = linear.shape[:2]
    light, pixels = linear.reshape(height, 3 * width), np.empty(linear.shape, np.uint8)
    bytes_ = pixels.reshape(light.shape)
    with_alpha = np.empty((height if is_transparent else 0, width, 4), np.uint8)

    def develop_rows(top: int) -> None:
        bottom = min(top + TILE, height)
        _composite(light, exposure, drawn, cover, behind, top, bottom, bytes_)
        if is_transparent:
            with_alpha[top:bottom, :, :3] = pixels[top:bottom]
            share = with_lines(cover[top:bottom], drawn.lines[top:bottom])
            with_alpha[top:bottom, :, 3] = np.rint(255.0 * share.clip(0.0, 1.0))

    run_tasks(range(0, height, TILE), lambda: develop_rows, threads)
    return with_alpha if is_transparent else pixels


def warm_up(settings: RenderSettings) -> None:
    """Load the kernel that makes pixels of pictures with such settings, or compile it."""
    if not has_background(settings):
        warm_up_exposure()
        return
    none, color = np.zeros((0, 0)), (0.0, 0.0, 0.0)
    shares = none.astype(np.float32)
    drawn = Drawn(shares, shares, none, color, color)
    composite(np.zeros((1, 0, 3)), 0.0, "transparent", lambda: np.zeros((1, 0)), drawn)


def with_lines(cover: NDArray[np.float64], lines: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return how much of each pixel is covered, by lines too, if there are any."""
    return 1.0 - (1.0 - cover) * (1.0 - lines.astype(np.float64)) if lines.size > 0 else cover


def _exposure_of(white: float) -> Exposure:
    """Return how light is exposed of which this becomes the maximum."""
    power = -math.frexp(white)[1]
    first = max(power, 0) // 2
    return Exposure(float(white), math.ldexp(1.0, power - first), math.ldexp(1.0, first))


@kernel
def _composite(
    linear: NDArray[np.float64],
    exposure: Exposure,
    drawn: Drawn,
    cover: NDArray[np.float64],
    behind: Behind,
    top: int,
    bottom: int,
    bytes_: NDArray[np.uint8],
) -> None:
    """Expose some rows of a picture with what is drawn onto it, (height, 3 * width).

    `cover` is how much of each pixel is covered without lines, (height, width), or (0, 0) for all.
    """
    for row in range(top, bottom):
        _expose_alone(linear[row], exposure, bytes_[row])
        for column in range(linear.shape[1] // 3):
            shade = float(drawn.shade[row, column]) if drawn.shade.size > 0 else 1.0
            line = float(drawn.lines[row, column]) if drawn.lines.size > 0 else 0.0
            fog = drawn.fog[row, column] * (1.0 - line) if drawn.fog.size > 0 else 0.0
            covered = cover[row, column] if cover.size > 0 else 1.0
            if drawn.lines.size > 0:
                covered = 1.0 - (1.0 - covered) * (1.0 - line)
            covered = min(max(covered, 0.0), 1.0)
            if not (shade == 1.0 and line == 0.0 and fog == 0.0 and covered == 1.0):
                part = Part(shade, line, fog, covered)
                _expose_with(linear[row], column, exposure, drawn, part, behind, bytes_[row])


@device
def _share_of(light: float, exposure: Exposure) -> float:
    """Return light as a number of which white is 255, but for rounding."""
    unit, again = exposure.unit, exposure.again
    most = exposure.white * unit * again if exposure.white > 0.0 else math.inf
    return (255.0 * (light * unit * again)) / most


@device
def _is_white(light: float, exposure: Exposure) -> bool:
    """Tell whether light is white: for one in seven, 255 * white / white is just below 255."""
    return light == exposure.white > 0.0


@device
def _expose_alone(
    linear: NDArray[np.float64], exposure: Exposure, bytes_: NDArray[np.uint8]
) -> None:
    """Expose the channels of a row as if nothing were drawn on them, and all were covered, (n,)."""
    for k in range(linear.size):
        share = 255.0 if _is_white(linear[k], exposure) else _share_of(linear[k], exposure)
        bytes_[k] = np.uint8(math.floor(min(max(share, 0.0), 255.0)))


@device
def _expose_with(
    linear: NDArray[np.float64],
    column: int,
    exposure: Exposure,
    drawn: Drawn,
    part: Part,
    behind: Behind,
    bytes_: NDArray[np.uint8],
) -> None:
    """Expose a pixel of a row with what is drawn onto it, and what is behind it."""
    whole = part.covered if behind.is_transparent else 1.0
    color = behind.red, behind.green, behind.blue
    first, second, third = linear[3 * column], linear[3 * column + 1], linear[3 * column + 2]
    is_empty = part.covered == 0.0 and part.line == 0.0 and part.fog == 0.0
    if is_empty and first == 0.0 and second == 0.0 and third == 0.0:
        for k in range(3):
            bytes_[3 * column + k] = np.uint8(color[k])
        return
    for k in range(3):
        light = linear[3 * column + k] * part.shade * (1.0 - part.line)
        share = _share_of(light, exposure) / whole if whole > 0.0 else 0.0
        share = 255.0 if _is_white(light, exposure) else share
        if whole > 0.0:
            share += (part.fog / whole) * drawn.fog_color[k]
            share += (part.line / whole) * drawn.line_color[k]
        share += (1.0 - part.covered) * color[k]
        bytes_[3 * column + k] = np.uint8(math.floor(min(max(share, 0.0), 255.0)))
