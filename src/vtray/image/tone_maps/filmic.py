"""A filmic curve: the fit to that of ACES, the Academy Color Encoding System.

Shadows get deeper, and highlights roll off to white, which light of 7.24 reaches.

References
----------
Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2016,
https://knarkowicz.wordpress.com/2016/01/06/aces-filmic-tone-mapping-curve/
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def filmic(light: Floats) -> Floats:
    """Return light of a scene, ≥ 0, as that of a monitor, from 0 to 1, channel by channel."""
    above = light * (2.51 * light + 0.03)
    below = light * (2.43 * light + 0.59) + 0.14
    return np.minimum(above / below, 1.0)
