"""Many soft lights: so many that the rays from a hit are shared among them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Crowd(NamedTuple):
    """The soft lights of a scene that has many.

    Attributes
    ----------
    order
        Their numbers, those of lights near each other near each other, (n,).
    """

    order: NDArray[np.int64]


def sharing_lights(crowd: Crowd | None) -> int:
    """Return how many lights share fans, 0 where each has its own."""
    return 0 if crowd is None else len(crowd.order)
