"""What rays from surfaces see that meet nothing: the light of all skies."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec
from vtray.transport.lights.sky import Skies
from vtray.transport.sampling.sky_map import light_towards


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
def far_light(surroundings: Surroundings, direction: Vec, sees_lights: bool) -> Vec:
    """Return the light that comes against a unit direction from far away.

    That of one colour is seen by all rays, the other only by those that see lights.
    """
    return _with_maps(surroundings, surroundings.skies, direction, sees_lights)


@device
def _with_maps(
    surroundings: Surroundings, skies: Skies | None, direction: Vec, sees_lights: bool
) -> Vec:
    """Return the light of all skies; see `far_light`."""
    red, green, blue = surroundings.even
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if skies is not None:  # noqa: SIM102
        if sees_lights:
            color = surroundings.color
            for sky in range(color.shape[0]):
                light = light_towards(skies, sky, direction)
                red += color[sky, 0] * light[0]
                green += color[sky, 1] * light[1]
                blue += color[sky, 2] * light[2]
    return red, green, blue


@device
def has_even_light(surroundings: Surroundings) -> bool:
    """Tell whether there is light of one colour from everywhere."""
    return max(surroundings.even[0], surroundings.even[1], surroundings.even[2]) > 0.0
