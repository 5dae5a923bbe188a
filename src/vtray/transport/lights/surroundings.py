"""What shines from far away: skies, and light from everywhere."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec
from vtray.transport.lights.sky import Skies


class Surroundings(NamedTuple):
    """The light from far away.

    Attributes
    ----------
    even
        That of all skies of one colour, the same from everywhere, white being 255.
    skies
        Those whose colour changes with the direction, None if there are none.
    color
        What white in their maps stands for, (skies, 3).
    """

    even: Vec
    skies: Skies | None
    color: NDArray[np.float64]


@device
def has_even_light(surroundings: Surroundings | None) -> bool:
    """Tell whether there is light of one colour from everywhere."""
    if surroundings is None:
        return False
    return max(surroundings.even[0], surroundings.even[1], surroundings.even[2]) > 0.0
