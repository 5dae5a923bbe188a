"""The lights of a scene, and where light comes from."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.vector import pick

Floats = NDArray[np.float64]


class Lights(NamedTuple):
    """Point lights, all (n,).

    Attributes
    ----------
    x, y, z
        Their places.
    plane_depth
        Their distances in front of the image plane.
    intensity
        Their intensities.
    error_scale
        What the rounding of a light's place is relative to: its coordinates in world space, where
        it was worked out, by hand or by a program.
    """

    x: Floats
    y: Floats
    z: Floats
    plane_depth: Floats
    intensity: Floats
    error_scale: Floats


@device
def light_count(lights: Lights) -> int:
    """Return how many lights there are."""
    count: int = lights.x.shape[0]
    return count


@device
def light_target(lights: Lights, light: int) -> Target:
    """Return where the shadow rays to a light end."""
    return Target(pick(lights, light), lights.plane_depth[light], lights.error_scale[light])
