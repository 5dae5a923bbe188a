"""The lights of a scene, and where light comes from."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.packets.packet import NO_PRIMITIVE
from vtray.geometry.vector import Vec, pick
from vtray.transport.lights.soft_light import SoftLights
from vtray.transport.lights.visible import VisibleLamps
from vtray.transport.materials.material import Power

Floats = NDArray[np.float64]


class Lights(NamedTuple):
    """Lights: the points first, and then the soft ones.

    Attributes
    ----------
    x, y, z
        The places of the points, (n,).
    plane_depth
        Their distances in front of the image plane, (n,).
    error_scale
        What the rounding of a light's place is relative to: its coordinates in world space, where
        it was worked out, by hand or by a program, (n,).
    points
        How many points there are; None where there are none, but other lights, so that no code is
        compiled for them.
    soft
        The lights that are no points; None where there are none, so that no code is compiled for
        them.
    visible
        Those that the camera sees; None where there are none, so that no code is compiled for them.
    intensity
        The intensities of all, (all,).
    color
        Their colours, 1 for white, (all, 3).
    """

    x: Floats
    y: Floats
    z: Floats
    plane_depth: Floats
    error_scale: Floats
    points: int | None
    soft: SoftLights | None
    visible: VisibleLamps | None
    intensity: Floats
    color: Floats


@device
def light_count(lights: Lights) -> int:
    """Return how many points there are."""
    count: int = lights.x.shape[0]
    return count


@device
def load_power(lights: Lights, light: int) -> Power:
    """Return how strong one of all lights is."""
    color = lights.color
    red, green, blue = color[light, 0], color[light, 1], color[light, 2]
    return Power(lights.intensity[light], (red, green, blue))


@device
def light_target(lights: Lights, light: int, is_wide: bool | None = None) -> Target:
    """Return where the shadow rays to a light end; `is_wide` is that of `Target`."""
    plane_depth, error_scale = lights.plane_depth[light], lights.error_scale[light]
    return Target(pick(lights, light), plane_depth, error_scale, is_wide)


@device
def lamp_light(lights: Lights, light: int) -> Vec:
    """Return what is seen of a lamp: white where its strength and its colour are 1."""
    power = load_power(lights, light)
    shown = 255.0 * power.intensity
    return shown * power.color[0], shown * power.color[1], shown * power.color[2]


@device
def lamp_number(light: int) -> int:
    """Return the number of a lamp among what rays meet: below that of nothing.

    The same leads back from there to the number of the light.
    """
    return NO_PRIMITIVE - 1 - light
