"""The tone maps by their names: a further one is a file with its curve, a row here, and a name.

Each takes light of a scene, (..., 3), of which 1 is what exposure makes white, ≥ 0, and gives light
of a monitor, from 0 to 1, likewise. What a monitor shows is then encoded as sRGB. "linear" has no
row: it shows light as it is, and encodes nothing.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from vtray.image.tone_maps.agx import agx
from vtray.image.tone_maps.filmic import filmic
from vtray.scene.colors.tone_map_names import ToneMapName

Floats = NDArray[np.float64]
ToneMap = Callable[[Floats], Floats]


def cut_off(light: Floats) -> Floats:
    """Return light as it is, up to white."""
    return np.minimum(light, 1.0)


TONE_MAPS: Mapping[ToneMapName, ToneMap] = MappingProxyType(
    {"srgb": cut_off, "filmic": filmic, "agx": agx}
)
