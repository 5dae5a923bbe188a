"""Which colour to write with on a picture."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]
Rgb = tuple[int, int, int]

DARK: Rgb = (20, 22, 26)
LIGHT: Rgb = (255, 255, 255)

MIDDLE = 118
"""The brightness on which dark and light letters are as easy to read: 18 % of the light of white.

References
----------
Web Content Accessibility Guidelines 2.2, W3C, "contrast ratio": equal to black and to white there.
"""

WEIGHTS = (2126, 7152, 722)
"""How bright red, green and blue are, in parts of 10,000, as for HDTV (ITU-R BT.709)."""

HALO = 0.85
"""How much a halo covers what lies behind it, from 0 to 1."""


class Ink(NamedTuple):
    """What to write with: the colour of letters, and of the halo that sets them off."""

    color: Rgb
    halo: Rgb


def ink_on(behind: Pixels) -> Ink:
    """Return what to write with on pixels, (height, width, 3 or 4): dark where they are light.

    What is transparent counts as white paper.
    """
    # In whole numbers, so that the choice is the same on every machine.
    parts = behind.reshape(-1, behind.shape[-1]).astype(np.int64)
    red, green, blue = WEIGHTS
    bright = parts[:, 0] * red + parts[:, 1] * green + parts[:, 2] * blue
    if parts.shape[1] == 4:
        bright = (bright * parts[:, 3] + 255 * sum(WEIGHTS) * (255 - parts[:, 3])) // 255
    is_light = int(bright.sum()) > MIDDLE * sum(WEIGHTS) * len(parts)
    return Ink(DARK, LIGHT) if is_light else Ink(LIGHT, DARK)
