"""The pixels that annotations are painted onto."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from vtray.figures.ink import HALO, Ink, ink_on
from vtray.figures.painted.cover import Cover
from vtray.figures.painted.letters import Letters

Pixels = NDArray[np.uint8]
Rgb = tuple[int, int, int]


class Canvas:
    """A copy of a picture that marks are painted onto; what they do not cover stays as it is.

    Parameters
    ----------
    pixels
        The picture, uint8, (height, width, 3 or 4).
    em
        The size of its letters in pixels.
    """

    def __init__(self, pixels: Pixels, em: int) -> None:
        self._under = pixels
        self.pixels = pixels.copy()
        self.height, self.width = pixels.shape[:2]
        self.halo = max(1, round(0.09 * em))

    def ink(self, left: int, top: int, width: int, height: int) -> Ink:
        """Return what to write with in a rectangle that lies in the picture."""
        return ink_on(self._under[top : top + height, left : left + width])

    def blend(self, cover: Cover, color: Rgb | Pixels, share: float = 1.0) -> None:
        """Paint what is covered.

        Parameters
        ----------
        cover
            Which pixels, and how much of each.
        color
            One colour, or those of its pixels, (height, width, 3).
        share
            How opaque the paint is, from 0 to 1.
        """
        height, width = cover.parts.shape
        top, left = max(cover.top, 0), max(cover.left, 0)
        bottom, right = min(cover.top + height, self.height), min(cover.left + width, self.width)
        if top >= bottom or left >= right:
            return
        cut = np.s_[top - cover.top : bottom - cover.top, left - cover.left : right - cover.left]
        opaque = np.floor(share * cover.parts[cut] + 0.5).astype(np.int64)[..., None]
        paint = np.asarray(color, np.int64)
        if paint.ndim == 3:
            paint = paint[cut]
        spot = self.pixels[top:bottom, left:right]
        under = spot.astype(np.int64)
        # As a sheet that covers a part of another; in whole numbers, rounded once.
        new, old = 255 * opaque, (under[..., 3:] if spot.shape[-1] == 4 else 255) * (255 - opaque)
        total = new + old
        mixed = (paint * new + under[..., :3] * old + total // 2) // np.maximum(total, 1)
        spot[..., :3] = np.where(opaque > 0, mixed, under[..., :3])
        if spot.shape[-1] == 4:
            spot[..., 3:] = (total + 127) // 255

    def shapes(self, covers: Iterable[Cover], wider: Iterable[Cover], color: Rgb, ink: Ink) -> None:
        """Paint shapes of one colour, all of their halos, which are wider, first."""
        for cover in wider:
            self.blend(cover, ink.halo, HALO)
        for cover in covers:
            self.blend(cover, color)

    def write(self, letters: Letters, text: str, left: int, baseline: int, ink: Ink) -> None:
        """Write a line of text."""
        wider = letters.cover(text, left, baseline, self.halo)
        self.shapes([letters.cover(text, left, baseline)], [wider], ink.color, ink)

    def paper(self, left: int, top: int, width: int, height: int) -> None:
        """Paint what sets a rectangle off from the picture, a little larger than it, as a halo."""
        ink, around = self.ink(left, top, width, height), 3 * self.halo
        sides = (height + 2 * around, width + 2 * around)
        cover = Cover(left - around, top - around, np.full(sides, 255, np.uint8))
        self.blend(cover, ink.halo, HALO)

    def rectangle(self, left: int, top: int, width: int, height: int, color: Rgb | Pixels) -> None:
        """Paint a rectangle of whole pixels; one colour, or those of its pixels."""
        if width > 0 and height > 0:
            self.blend(Cover(left, top, np.full((height, width), 255, np.uint8)), color)
