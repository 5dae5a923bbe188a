"""OKLab: colours by lightness L, and by a (green to red) and b (blue to yellow).

References
----------
Björn Ottosson, "A perceptual color space for image processing", 2020,
https://bottosson.github.io/posts/oklab/ (the matrices, as amended on 2021-01-25).
IEC 61966-2-1:1999 (the curve of sRGB).
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_CONES = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
_LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
# Inverted here, as those that are published have ten digits, so that a way there and back would
# move colours of the gamut's edge out of it.
_FROM_CONES = np.linalg.inv(_CONES)
_FROM_LAB = np.linalg.inv(_LAB)


def srgb_to_oklab(pixels: NDArray[np.number]) -> Floats:
    """Return sRGB colours, (..., 3) from 0 to 255, as L, a and b; L is from 0 to 1."""
    share = np.asarray(pixels, np.float64) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    lab: Floats = np.cbrt(linear @ _CONES.T) @ _LAB.T
    return lab


def oklab_to_linear(lab: Floats) -> Floats:
    """Return colours as linear sRGB: from 0 to 1 if a monitor can show them."""
    linear: Floats = (lab @ _FROM_LAB.T) ** 3 @ _FROM_CONES.T
    return linear


def oklab_to_srgb(lab: Floats) -> NDArray[np.uint8]:
    """Return colours as the nearest 8-bit sRGB; channels out of its gamut are clipped."""
    linear = np.clip(oklab_to_linear(lab), 0.0, 1.0)
    share = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.floor(share * 255.0 + 0.5).astype(np.uint8)
