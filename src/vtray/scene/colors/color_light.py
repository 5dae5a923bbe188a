"""What the numbers of a colour, 0 to 255, are as light.

A picture with the tone map "linear" shows light as it is, and its colours are light. All other tone
maps encode light as sRGB, and their colours are sRGB: they are decoded first, so that a surface in
white light gets its own colour back.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from vtray.scene.colors.srgb import decode_srgb
from vtray.scene.colors.tone_map_names import ToneMapName, is_encoded
from vtray.scene.vectors import Color

Floats = NDArray[np.float64]
Rgb = tuple[float, float, float]


@cache
def light_of_numbers(tonemap: ToneMapName) -> Floats:
    """Return what each number of a colour is as light, (256,), 255 for white; read-only."""
    numbers = np.arange(256.0)
    light = 255.0 * decode_srgb(numbers / 255.0) if is_encoded(tonemap) else numbers
    light.flags.writeable = False
    return light


def light_of(color: Color, tonemap: ToneMapName) -> Rgb:
    """Return a colour as light, 255 for white."""
    table = light_of_numbers(tonemap)
    return float(table[int(color.r)]), float(table[int(color.g)]), float(table[int(color.b)])
