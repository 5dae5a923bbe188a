"""What the numbers of a colour, 0 to 255, are as light.

A picture with the tone map "linear" shows light as it is, and its colours are light. All other tone
maps encode light as sRGB, and their colours are sRGB: they are decoded first, so that a surface in
white light gets its own colour back.
"""

from collections.abc import Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from vtray.scene.colors.srgb import decode_srgb
from vtray.scene.colors.tone_map_names import ToneMapName, is_encoded
from vtray.scene.vectors import Color

Floats = NDArray[np.float64]
Rgb = tuple[float, float, float]

_NUMBERS: Floats = np.arange(256.0)


@cache
def light_of_numbers(tonemap: ToneMapName) -> Floats:
    """Return what each number of a colour is as light, (256,), 255 for white; read-only."""
    light = 255.0 * decode_srgb(_NUMBERS / 255.0) if is_encoded(tonemap) else _NUMBERS.copy()
    light.flags.writeable = False
    return light


def as_light(color: Sequence[float], tonemap: ToneMapName) -> Rgb:
    """Return three numbers of a colour, which may lie between whole ones, as light."""
    red, green, blue = (_between(one, _NUMBERS, light_of_numbers(tonemap)) for one in color)
    return red, green, blue


def numbers_of_light(light: Sequence[float], tonemap: ToneMapName) -> Rgb:
    """Return the numbers of a colour that is given as light: `as_light` the other way."""
    red, green, blue = (_between(one, light_of_numbers(tonemap), _NUMBERS) for one in light)
    return red, green, blue


def _between(number: float, given: Floats, told: Floats) -> float:
    """Return what is told of a number, on the line between the two next that are given."""
    k = int(np.searchsorted(given[1:-1], number, side="right"))
    part = (number - given[k]) / (given[k + 1] - given[k])
    return float(told[k] + part * (told[k + 1] - told[k]))


def light_of(color: Color, tonemap: ToneMapName) -> Rgb:
    """Return a colour as light, 255 for white."""
    table = light_of_numbers(tonemap)
    return float(table[int(color.r)]), float(table[int(color.g)]), float(table[int(color.b)])
