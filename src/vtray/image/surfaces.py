"""What the middle rays of a picture meet, beside light."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Surfaces(NamedTuple):
    """What the ray through the middle of each pixel meets.

    Attributes
    ----------
    depth
        Distance along the ray in scene units, infinite where nothing is, (height, width).
    normals
        Unit normals in world space on the ray's side, 0 where nothing is, (height, width, 3).
    ids
        Place in ``scene.objects``, and place in the arrays of that object, 0 if it has none; both
        -1 where nothing is; int32, (height, width, 2).
    halves
        1 for the half at the end of a cylinder or a cone, else 0; int8, (height, width).
    copies
        Which copy of what `Copies` place, -1 where there is none; int32, (height, width).
    """

    depth: Floats
    normals: Floats
    ids: NDArray[np.int32]
    halves: NDArray[np.int8]
    copies: NDArray[np.int32]

    @property
    def any_seen(self) -> bool:
        """Whether any pixel has a surface."""
        return bool((self.ids[..., 0] >= 0).any())
