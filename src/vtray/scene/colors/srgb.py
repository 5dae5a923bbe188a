"""The transfer function of sRGB: from light to the numbers that monitors expect, and back.

References
----------
IEC 61966-2-1:1999, "Colour measurement and management - Default RGB colour space - sRGB".
"""

import numpy as np
from numpy.typing import NDArray

from vtray.base.exact_math import power

Floats = NDArray[np.float64]

_LINEAR_UP_TO = 0.0031308
_ENCODED_UP_TO = 0.04045


def encode_srgb(light: Floats) -> Floats:
    """Return light from 0 to 1, of any shape, as sRGB from 0 to 1; within 2**-42 of the standard.

    The same to the last bit on every machine.
    """
    curve = 1.055 * power(light, 1.0 / 2.4) - 0.055
    return np.where(light <= _LINEAR_UP_TO, 12.92 * light, curve)


def decode_srgb(encoded: Floats) -> Floats:
    """Return sRGB from 0 to 1, of any shape, as light from 0 to 1: `encode_srgb` turned round."""
    curve = power((encoded + 0.055) / 1.055, 2.4)
    return np.where(encoded <= _ENCODED_UP_TO, encoded / 12.92, curve)
