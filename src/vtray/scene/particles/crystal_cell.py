"""Cells by the lengths of their edges and the angles between these, as crystals have them."""

import math
from typing import TYPE_CHECKING

from vtray.base.errors import SceneError
from vtray.base.exact_math import cosine, sine

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Cell = NDArray[np.float64]


def edges_of(sizes: list[float], place: str) -> "Cell | None":
    """Return the edges of a cell, a along x and b in the plane x y.

    Parameters
    ----------
    sizes
        The lengths of a, b and c, and the angles between b and c, a and c, a and b in degrees.
    place
        What messages begin with.

    Returns
    -------
    array (3, 3) or None
        In the unit of the lengths. None where these are all 1 or 0, as in files without a crystal.

    Raises
    ------
    SceneError
        They are no six numbers, or no cell has them.
    """
    import numpy as np

    if len(sizes) == 6 and sizes[:3] in ([1.0, 1.0, 1.0], [0.0, 0.0, 0.0]):
        return None
    a, b, c, alpha, beta, gamma = sizes if len(sizes) == 6 else [-1.0] * 6
    # Along an edge of no length, nothing repeats.
    if not (min(a, b, c) >= 0 and all(0 < angle < 180 for angle in (alpha, beta, gamma))):
        raise SceneError(f"{place}: expected three lengths and three angles of a cell")
    x = cosine(beta)
    y = (cosine(alpha) - x * cosine(gamma)) / sine(gamma)
    z = 1 - x * x - y * y
    if z <= 0:
        raise SceneError(f"{place}: no cell has the angles {alpha}, {beta} and {gamma}")
    return np.array(
        [
            (a, 0.0, 0.0),
            (b * cosine(gamma), b * sine(gamma), 0.0),
            (c * x, c * y, c * math.sqrt(z)),
        ]
    )
