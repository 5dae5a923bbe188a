"""AgX, by Troy Sobotka: strong light fades to white instead of to another colour.

It is his base look, in the small form by Benjamin Wrensch: channels are mixed a little, so that
each colour has some of all three; their logarithms from 2**-12.47393 to 2**4.026069 become 0 to 1;
a polynomial stands for the curve, of which its squared error is 3.7e-6 in the mean; and the mixing
is undone.

References
----------
Troy Sobotka, "AgX", https://github.com/sobotka/AgX
Benjamin Wrensch, "Minimal AgX Implementation", 2023,
https://iolite-engine.com/blog_posts/minimal_agx_implementation
"""

import math

import numpy as np
from numpy.typing import NDArray

from vtray.base.exact_math import logarithm, power

Floats = NDArray[np.float64]

# What red, green and blue become is a row each.
_INSET = (
    (0.842479062253094, 0.0784335999999992, 0.0792237451477643),
    (0.0423282422610123, 0.878468636469772, 0.0791661274605434),
    (0.0423756549057051, 0.0784336, 0.879142973793104),
)
_OUTSET = (
    (1.19687900512017, -0.0980208811401368, -0.0990297440797205),
    (-0.0528968517574562, 1.15190312990417, -0.0989611768448433),
    (-0.0529716355144438, -0.0980434501171241, 1.15107367264116),
)
_LEAST, _MOST = -12.47393, 4.026069
_CURVE = (15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232)

_LOGARITHM_OF_2 = 0.6931471805599453
_DARKEST = math.ldexp(1.0, -13)
"""Light below it, which is below the range, counts as this."""


def agx(light: Floats) -> Floats:
    """Return light of a scene, (..., 3), ≥ 0, as that of a monitor, from 0 to 1."""
    stops = logarithm(np.maximum(_mixed(light, _INSET), _DARKEST)) / _LOGARITHM_OF_2
    x = np.clip((stops - _LEAST) / (_MOST - _LEAST), 0.0, 1.0)
    curve = np.zeros_like(x)
    for coefficient in _CURVE:
        curve = curve * x + coefficient
    # The curve ends at the numbers of a monitor whose light is their power of 2.2.
    return power(np.clip(_mixed(curve, _OUTSET), 0.0, 1.0), 2.2)


def _mixed(channels: Floats, rows: tuple[tuple[float, float, float], ...]) -> Floats:
    """Return other channels, each a sum of those given, always in this order."""
    red, green, blue = channels[..., 0], channels[..., 1], channels[..., 2]
    return np.stack([a * red + b * green + c * blue for a, b, c in rows], axis=-1)
