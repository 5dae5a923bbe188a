"""In which order many soft lights share fans: lights near each other near each other.

References
----------
Morton, "A Computer Oriented Geodetic Data Base and a New Technique in File Sequencing", 1966.
"""

import numpy as np
from numpy.typing import NDArray

from vtray.transport.lights.soft_light import AROUND, SUN, SoftLights

LEVELS = 16
"""How often the box around all lamps is halved along each axis."""


def order_by_place(soft: SoftLights) -> NDArray[np.int64]:
    """Return the numbers of soft lights: lamps along Morton's curve, then suns, then the others.

    Suns go along the same curve, by their directions.
    """
    codes = np.zeros(len(soft.kind), np.int64)
    is_sun, is_around = soft.kind == SUN, soft.kind == AROUND
    for which in (~is_sun & ~is_around, is_sun):
        codes[which] = _codes(np.stack([soft.x, soft.y, soft.z])[:, which])
    order: NDArray[np.int64] = np.lexsort((codes, is_sun, is_around))
    return order


def _codes(places: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the codes of places, (3, n), along Morton's curve, (n,)."""
    codes = np.zeros(places.shape[1], np.int64)
    if not codes.size:
        return codes
    low = places.min(axis=1, keepdims=True)
    extent = float((places - low).max())
    cells = (places - low) / (extent or 1.0) * ((1 << LEVELS) - 1)
    for level in range(LEVELS):
        for axis, row in enumerate(cells.astype(np.int64)):
            codes |= (row >> level & 1) << 3 * level + 2 - axis
    return codes
