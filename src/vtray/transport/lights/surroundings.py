"""What shines from far away: skies, and light from everywhere."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.base.compiler.unseen import apart
from vtray.base.exact_math import sine
from vtray.geometry.vector import Vec, dot
from vtray.transport.lights.sky import Skies


def spread_of(degrees: float) -> float:
    """Return 1 minus the cosine of half an angle."""
    return 2.0 * sine(degrees / 4.0) * sine(degrees / 4.0)


LEAST_SPREAD = spread_of(5.0)
"""That of the narrowest suns that rays from surfaces see. What mirrors and glass throw onto other
surfaces of the light of narrower ones would be found by one path in 100,000, as specks."""


class Discs(NamedTuple):
    """Suns that rays from surfaces see, as discs in the sky: all that are wide enough.

    Attributes
    ----------
    middle
        The unit directions towards their middles, (suns, 3).
    spread
        1 minus the cosine of half the angle under which they are seen, (suns,).
    color
        Their light, white being 255, (suns, 3).
    """

    middle: NDArray[np.float64]
    spread: NDArray[np.float64]
    color: NDArray[np.float64]


@apart
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
    discs
        Suns.
    """

    even: Vec
    skies: Skies | None
    color: NDArray[np.float64]
    discs: Discs


@device
def has_even_light(surroundings: Surroundings | None) -> bool:
    """Tell whether there is light of one colour from everywhere."""
    if surroundings is None:
        return False
    return max(surroundings.even[0], surroundings.even[1], surroundings.even[2]) > 0.0


@device
def disc_count(discs: Discs) -> int:
    """Return how many suns there are."""
    count: int = discs.spread.shape[0]
    return count


@device
def light_of_disc(discs: Discs, sun: int) -> Vec:
    """Return the light of a sun."""
    return discs.color[sun, 0], discs.color[sun, 1], discs.color[sun, 2]


@device
def is_towards(discs: Discs, sun: int, direction: Vec) -> bool:
    """Tell whether a unit direction leads to a sun."""
    middle = discs.middle
    towards = middle[sun, 0], middle[sun, 1], middle[sun, 2]
    is_within: bool = 1.0 - dot(direction, towards) < discs.spread[sun]
    return is_within
