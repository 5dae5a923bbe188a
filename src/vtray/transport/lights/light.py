"""The lights of a scene, and where light comes from."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.base.exact_math import hypotenuse
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.packets.packet import NO_PRIMITIVE
from vtray.geometry.vector import Vec, pick
from vtray.transport.lights.crowd import Crowd
from vtray.transport.lights.soft_light import AROUND, NO_SKY, SoftLights, component_count
from vtray.transport.lights.surroundings import Surroundings
from vtray.transport.lights.visible import VisibleLamps
from vtray.transport.materials.material import Material, Power, scattered

Floats = NDArray[np.float64]


class Lights(NamedTuple):
    """Lights: the points first, and then the soft ones, component by component.

    A light whose colour changes with the direction has three components, of red, of green and of
    blue light, each with a row of intensity and colour; all others have one.

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
    crowd
        The lights among which fans of rays are shared; None where each light has its own.
    visible
        Those that the camera sees; None where it sees none and no ray goes on from mirrors, so that
        no code is compiled for them.
    mirrored
        All lamps with a size, which rays from mirrors may meet; None where there are no such rays.
    surroundings
        What shines from far away, as rays from surfaces see it; None where there are no such rays.
    intensity
        The intensities of all components, (components,).
    color
        Their colours, 1 for white, (components, 3).
    """

    x: Floats
    y: Floats
    z: Floats
    plane_depth: Floats
    error_scale: Floats
    points: int | None
    soft: SoftLights | None
    crowd: Crowd | None
    visible: VisibleLamps | None
    mirrored: VisibleLamps | None
    surroundings: Surroundings | None
    intensity: Floats
    color: Floats


class Points(NamedTuple):
    """Where the points are; the columns are those of `Lights`."""

    x: Floats
    y: Floats
    z: Floats
    plane_depth: Floats
    error_scale: Floats


class Powers(NamedTuple):
    """How strong all components are; the columns are those of `Lights`."""

    intensity: Floats
    color: Floats


@device
def points_of(lights: Lights) -> Points:
    """Return where the points are."""
    return Points(lights.x, lights.y, lights.z, lights.plane_depth, lights.error_scale)


@device
def powers_of(lights: Lights) -> Powers:
    """Return how strong all components are."""
    return Powers(lights.intensity, lights.color)


def no_lights() -> Lights:
    """Return no lights at all."""
    none = np.zeros(0)
    return Lights(
        none, none, none, none, none, None, None, None, None, None, None, none, np.zeros((0, 3))
    )


@device
def light_count(lights: Lights | Points) -> int:
    """Return how many points there are."""
    count: int = lights.x.shape[0]
    return count


@device
def load_power(lights: Lights | Powers, row: int) -> Power:
    """Return how strong one of all components is."""
    color = lights.color
    red, green, blue = color[row, 0], color[row, 1], color[row, 2]
    return Power(lights.intensity[row], (red, green, blue))


@device
def soft_worth(lights: Lights | Powers, soft: SoftLights, light: int, material: Material) -> float:
    """Return the largest channel of what all of a soft light adds to a surface, squarely."""
    worth = 0.0
    for component in range(component_count(soft, light)):
        power = load_power(lights, soft.row[light] + component)
        red, green, blue = scattered(material, 1.0, power)
        worth = max(worth, red, green, blue)
    return worth


def noisy_light(lights: Lights) -> float:
    """Return the largest channels of what soft lights add by rays, together, at the most.

    As their errors are, they are added by their squares. What a sky adds whose colour changes is
    not known.
    """
    soft = lights.soft
    if soft is None:
        return 0.0
    if (soft.sky != NO_SKY).any():
        return math.inf
    needs_rays = (soft.kind != AROUND) | (soft.size > 0.0)
    rows = soft.row[needs_rays]
    brought = lights.intensity[rows] * lights.color[rows].max(axis=1, initial=0.0)
    return 255.0 * hypotenuse(0.0, *brought.tolist())


@device
def light_target(lights: Lights | Points, light: int, is_wide: bool | None = None) -> Target:
    """Return where the shadow rays to a light end; `is_wide` is that of `Target`."""
    plane_depth, error_scale = lights.plane_depth[light], lights.error_scale[light]
    return Target(pick(lights, light), plane_depth, error_scale, is_wide)


@device
def lamp_light(lights: Lights, row: int) -> Vec:
    """Return what is seen of a lamp: white where its strength and its colour are 1."""
    power = load_power(lights, row)
    shown = 255.0 * power.intensity
    return shown * power.color[0], shown * power.color[1], shown * power.color[2]


@device
def lamp_number(row: int) -> int:
    """Return the number of a lamp among what rays meet: below that of nothing.

    The same leads back from there to the row of the light.
    """
    return NO_PRIMITIVE - 1 - row
