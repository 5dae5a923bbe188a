"""From linear light to the numbers of the image file by a tone map that encodes sRGB.

What has colours of its own, fog, lines and the background, is mixed with the light that a monitor
shows of the scene, between the tone map and the encoding: so these colours are exactly what was
given, and edges are neither too light nor too dark.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.pool import run_tasks
from vtray.image.exposure import Overlay
from vtray.image.tone_maps.table import TONE_MAPS
from vtray.scene.colors.color_light import light_of
from vtray.scene.colors.srgb import encode_srgb
from vtray.scene.colors.tone_map_names import ToneMapName
from vtray.scene.settings import Background
from vtray.scene.vectors import Color

Floats = NDArray[np.float64]

ROWS = 32
"""Rows that are made together: arrays of more leave the caches, and take twice as long."""

MOST = 2.0**40
"""More light than this counts as this: all tone maps show it as white."""


class Toning(NamedTuple):
    """How light becomes numbers.

    Attributes
    ----------
    tonemap
        The tone map, any but "linear".
    white
        The light that is 1 for it; if it is 0, there is no light.
    background
        What is seen where nothing is; a sky belongs to the light.
    maximum
        The largest number, 255 or 65535.
    """

    tonemap: ToneMapName
    white: float
    background: Background
    maximum: int


def develop_toned(
    linear: Floats,
    toning: Toning,
    alpha: Callable[[], Floats],
    threads: int = 1,
    overlays: Sequence[Overlay] = (),
) -> NDArray[Any]:
    """Return the pixels of light: for a share v of what a monitor can show, round(maximum * v).

    Parameters
    ----------
    linear
        Linear light, (height, width, 3).
    toning
        How it becomes numbers.
    alpha, threads, overlays
        As for `vtray.image.exposure.develop`, and so is what is returned.
    """
    background = toning.background
    cover = None if background in ("black", "sky") else alpha().clip(0.0, 1.0)
    channels = 4 if background == "transparent" else 3
    kind = np.uint8 if toning.maximum == 255 else np.uint16
    pixels = np.empty((*linear.shape[:2], channels), kind)

    def develop_rows(top: int) -> None:
        rows = slice(top, top + ROWS)
        some = [Overlay(share[rows], color) for share, color in overlays]
        pixels[rows] = _developed(
            linear[rows], toning, None if cover is None else cover[rows], some
        )

    run_tasks(range(0, len(linear), ROWS), lambda: develop_rows, threads)
    return pixels


def _developed(
    linear: Floats, toning: Toning, cover: Floats | None, overlays: Sequence[Overlay]
) -> Floats:
    """Return the numbers of some rows; `cover` is None where light covers all."""
    light = _exposed(linear, toning.white)
    show = TONE_MAPS[toning.tonemap]
    if cover is None and not overlays:
        return _numbers(show(light), toning.maximum)
    whole = np.ones(linear.shape[:2]) if cover is None else cover
    # The share of a pixel that shows the scene itself, and the light of that alone.
    own = np.maximum(whole - sum(overlay.share for overlay in overlays), 0.0)[..., None]
    shown = own * show(
        np.divide(light, own, out=np.zeros_like(light), where=own > 0.0).clip(0.0, MOST)
    )
    # Light of what covers nothing, such as stars, is added to what is behind it.
    alone = (own[..., 0] == 0.0) & (light > 0.0).any(axis=2)
    if alone.any():
        shown[alone] = show(light[alone][:, None])[:, 0]
    for overlay in overlays:
        shown = shown + overlay.share[..., None] * _shown(overlay.color, toning.tonemap)
    if isinstance(toning.background, Color):
        shown = shown + (1.0 - whole[..., None]) * _shown(toning.background, toning.tonemap)
    if toning.background != "transparent":
        return _numbers(shown, toning.maximum)
    share = whole[..., None]
    shown = np.divide(shown, share, out=np.zeros_like(shown), where=share > 0.0)
    alpha = np.rint(toning.maximum * share)
    return np.concatenate([_numbers(shown, toning.maximum), alpha], axis=2)


def _exposed(linear: Floats, white: float) -> Floats:
    """Return light in parts of white, from 0 to MOST."""
    if white == 0.0:
        return np.zeros_like(linear)
    with np.errstate(over="ignore"):
        return (linear / white).clip(0.0, MOST)


def _shown(color: Color, tonemap: ToneMapName) -> Floats:
    """Return the light by which a monitor shows a colour, 1 for white, (3,)."""
    return np.array(light_of(color, tonemap)) / 255.0


def _numbers(shown: Floats, maximum: int) -> Floats:
    """Return the light of a monitor as numbers of sRGB."""
    return np.floor(maximum * encode_srgb(shown.clip(0.0, 1.0)) + 0.5)
