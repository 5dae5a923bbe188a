"""Flat pictures: light changes lightness only, so that colours can be read back.

A colour is taken to OKLab, where a and b say which colour it is and L how light it is. Light moves
L alone, within what a monitor can show: full light gives the colour itself, shadow one that is
darker by `CONTRAST`. Colours that have no room below, such as the dark end of viridis, use what is
above them.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from vtray.figures.oklab import oklab_to_linear, oklab_to_srgb, srgb_to_oklab
from vtray.figures.seen_objects import objects_seen
from vtray.figures.subject import Floats, Pixels, Subject
from vtray.scene.arrays import Arrays
from vtray.scene.colors.color_light import light_of_numbers
from vtray.scene.objects import Object
from vtray.scene.vectors import Color

CONTRAST = 0.3
"""By how much L changes from shadow to full light, where there is room for it."""

DARKEST = 0.2
"""The least L: below it, steps of 8 bits are too coarse to tell a and b apart."""

_STEPS = 40
"""How often an interval of L is halved to find the edge of the gamut: to far below 8 bits."""


def flat_pixels(image: Subject) -> Pixels:
    """Return the flat picture of an image; see `vtray.Image.flat`."""
    shown = image.shown
    places = shown.ids[..., 0]
    picture = np.zeros((*places.shape, 3), np.uint8)
    background = image.settings.background
    if isinstance(background, Color):
        picture[:] = (background.r, background.g, background.b)
    seen = places >= 0
    if seen.any():
        colors = _own_colors(image.scene.objects, shown.ids[seen], shown.halves[seen])
        picture[seen] = lit_colors(colors, _lightness(image, seen, colors))
    return picture


def lit_colors(colors: Pixels, light: Floats) -> Pixels:
    """Return colours in some light: the same in a and b of OKLab, as nearly as 8 bits allow.

    Parameters
    ----------
    colors
        8-bit sRGB, (n, 3).
    light
        From 0, which is shadow, to 1, which is full light, (n,).
    """
    packed = colors.astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], np.uint32)
    _, first, which = np.unique(packed, return_index=True, return_inverse=True)
    lab = srgb_to_oklab(colors[first])
    shadow, full = lightness_range(lab)
    lit = lab[which]
    lit[:, 0] = shadow[which] + (full - shadow)[which] * light
    return oklab_to_srgb(lit)


def lightness_range(lab: Floats) -> tuple[Floats, Floats]:
    """Return L in shadow and in full light for colours in OKLab, (n, 3)."""
    least = np.maximum(_edge(lab, 0.0), DARKEST)
    most = np.maximum(_edge(lab, 1.0), least)
    shadow = np.clip(lab[:, 0] - CONTRAST, least, most)
    return shadow, np.minimum(shadow + CONTRAST, most)


def _edge(lab: Floats, goal: float) -> Floats:
    """Return the L nearest to `goal` that a monitor can show with the same a and b."""
    inside, outside = lab[:, 0].copy(), np.full(len(lab), goal)
    for _ in range(_STEPS):
        middle = (inside + outside) / 2
        linear = oklab_to_linear(np.column_stack([middle, lab[:, 1:]]))
        shown = ((linear >= 0.0) & (linear <= 1.0)).all(axis=1)
        inside, outside = np.where(shown, middle, inside), np.where(shown, outside, middle)
    return inside


def _own_colors(
    objects: Sequence[Object], ids: NDArray[np.int32], halves: NDArray[np.int8]
) -> Pixels:
    """Return the colours of the surfaces with these ids, (n, 2), and halves, (n,), as (n, 3)."""
    colors = np.zeros((len(ids), 3), np.uint8)
    for item, mine, index, _ in objects_seen(objects, ids):
        if isinstance(item, Arrays):
            colors[mine] = _rows(item.given_for("color"), index)
            if "color_end" in item.COLUMNS:
                at_end = halves[mine] == 1
                colors[mine[at_end]] = _rows(item.given_for("color_end"), index[at_end])
        else:
            colors[mine] = (item.color.r, item.color.g, item.color.b)
    return colors


def _rows(colors: Pixels, index: NDArray[np.int32]) -> Pixels:
    """Return the colours of rows, of which one may stand for all."""
    return colors if colors.ndim == 1 else colors[index]


def _lightness(image: Subject, seen: NDArray[np.bool_], colors: Pixels) -> Floats:
    """Return how much light there is on what is seen, from 0 to 1, (n,).

    That is how often the light of a pixel contains the colour of its surface, in parts of what
    becomes white or, if that is only the brightest channel, in parts of the most there is.
    """
    own = light_of_numbers(image.settings.tonemap)[colors]
    squares = (own * own).sum(axis=1)
    times = (image.linear[seen] * own).sum(axis=1) / np.maximum(squares, 1.0)
    # A black surface scatters nothing; its light is not known.
    times[squares == 0] = 0.0
    # Antialiased edges are dim as they are partly empty, not as there is less light.
    times /= np.maximum(image.alpha[seen], 1e-3)
    brightest = image.white == image.linear.max()
    most = float(times.max()) if brightest else image.white / 255.0
    return np.clip(times / most, 0.0, 1.0) if most > 0.0 else np.zeros(len(times))
