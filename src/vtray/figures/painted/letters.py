"""Letters of a size, without Matplotlib: DejaVu Sans, which is Matplotlib's usual font too.

Pillow's own font has no more than ASCII: neither Å nor µ. So some 480 characters of DejaVu Sans
come with vtray, of Latin and Greek, with what stands in formulas and units (see `RANGES`).
"""

import functools
import math
import unicodedata
from pathlib import Path
from typing import Any

import numpy as np

from vtray.figures.painted.cover import Cover
from vtray.figures.sheet import FigureError

FONT = Path(__file__).with_name("letters.ttf")

RANGES = (
    (0x20, 0x7E),  # ASCII
    (0xA0, 0x17F),  # Latin of Europe, and signs such as ° ± ² µ Å
    (0x218, 0x21B),  # Romanian
    (0x386, 0x386),  # Greek, with accents
    (0x388, 0x38A),
    (0x38C, 0x38C),
    (0x38E, 0x3A1),
    (0x3A3, 0x3CE),
    (0x3D1, 0x3D1),
    (0x3D5, 0x3D5),
    (0x3F5, 0x3F5),
    (0x2010, 0x2015),  # dashes
    (0x2018, 0x201E),  # quotation marks
    (0x2020, 0x2022),
    (0x2026, 0x2026),
    (0x2030, 0x2030),
    (0x2032, 0x2033),
    (0x2070, 0x2071),  # digits above and below the line
    (0x2074, 0x208E),
    (0x20AC, 0x20AC),
    (0x210F, 0x210F),
    (0x2190, 0x2195),  # arrows
    (0x2202, 0x2202),  # signs of mathematics
    (0x2206, 0x2207),
    (0x2211, 0x2213),
    (0x221A, 0x221A),
    (0x221D, 0x221E),
    (0x2225, 0x2225),
    (0x222B, 0x222B),
    (0x2248, 0x2248),
    (0x2260, 0x2261),
    (0x2264, 0x2265),
    (0x226A, 0x226B),
    (0x22A5, 0x22A5),
    (0x22C5, 0x22C5),
    (0x27E8, 0x27E9),
)
"""The characters that there are: the first and the last of each range."""


def check_letters(text: str, place: str, *, lines: bool = False) -> str:
    """Return a text as it is written.

    Parameters
    ----------
    text, place
        The text, and what it is called in messages.
    lines
        Whether ends of lines are kept; they become spaces otherwise.

    Raises
    ------
    FigureError
        There is no letter for one of its characters.
    """
    text = unicodedata.normalize("NFC", text if lines else text.replace("\n", " "))
    for character in text.replace("\n", ""):
        if not any(first <= ord(character) <= last for first, last in RANGES):
            message = (
                f"{place}: expected letters of Latin and Greek, got {character!r} in {text!r}; "
                "Image.figure has all those of Matplotlib"
            )
            raise FigureError(message)
    return text


@functools.lru_cache(maxsize=32)
def letters(size: int) -> "Letters":
    """Return the letters of a size in pixels."""
    return Letters(size)


class Letters:
    """Letters of a size.

    Attributes
    ----------
    size
        Of the font in pixels.
    capital
        The height of a capital letter in pixels.
    line
        From one line to the next in pixels.
    """

    def __init__(self, size: int) -> None:
        from PIL import ImageFont

        # The layout that all builds of Pillow have, so that pictures are the same.
        basic = ImageFont.Layout.BASIC
        self._font: Any = ImageFont.truetype(str(FONT), size, layout_engine=basic)
        self.size = size
        self.capital = -int(self._font.getbbox("H", anchor="ls")[1])
        self.line = round(1.3 * size)

    def width(self, text: str) -> int:
        """Return how wide a line of text is, in pixels."""
        return math.ceil(float(self._font.getlength(text)))

    def drop(self, text: str) -> int:
        """Return how far its middle is above where a line of text stands, in pixels."""
        _, top, _, bottom = self._font.getbbox(text, anchor="ls")
        return -round(float(top + bottom) / 2)

    def cover(self, text: str, left: int, baseline: int, stroke: int = 0) -> Cover:
        """Return which pixels a line of text covers.

        Parameters
        ----------
        text
            One line.
        left, baseline
            Where it begins, and where its letters stand.
        stroke
            By how many pixels the letters are made larger on all sides.
        """
        from PIL import Image, ImageDraw

        x0, y0, x1, y1 = (
            int(v) for v in self._font.getbbox(text, anchor="ls", stroke_width=stroke)
        )
        picture = Image.new("L", (max(x1 - x0, 0) + 2, max(y1 - y0, 0) + 2))
        ImageDraw.Draw(picture).text(
            (1 - x0, 1 - y0), text, fill=255, font=self._font, anchor="ls", stroke_width=stroke
        )
        return Cover(left + x0 - 1, baseline + y0 - 1, np.asarray(picture))
