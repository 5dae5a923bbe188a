"""The light of a picture in orders: how often surfaces have scattered it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Orders(NamedTuple):
    """Light in orders, each linear, (height, width, 3); together they are that of the picture.

    Attributes
    ----------
    emission
        What nothing has scattered.
    direct
        What one surface has scattered, the first that is seen.
    indirect
        The rest.
    """

    emission: Floats
    direct: Floats
    indirect: Floats


def unknown_orders(height: int, width: int) -> Orders:
    """Return NaN for each order of a picture of that size."""
    return Orders(*(np.full((height, width, 3), np.nan) for _ in Orders._fields))
