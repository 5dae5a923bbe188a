"""Lambert's cosine law: a surface that scatters light evenly, without fall-off."""

import math

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, dot, scale


@device
def is_above(normal: Vec, to_light: Vec, error_bound: float) -> bool:
    """Tell whether a light is above the horizon of a surface.

    Parameters
    ----------
    normal
        The surface's unit normal.
    to_light
        The light's place minus the point.
    error_bound
        How far rounding may have moved the point or the light: one no higher than that is on the
        horizon.
    """
    # The square is 0 for a light that is nearer than 1e-300 of the scene's size.
    return (dot(normal, to_light) > error_bound) & (dot(to_light, to_light) > 0.0)


@device
def lambert_cosine(normal: Vec, to_light: Vec, error_bound: float) -> float:
    """Return the cosine of the angle between normal and light, 0 for a light below the horizon.

    The parameters are those of `is_above`.
    """
    return cosine_of(normal, to_light) if is_above(normal, to_light, error_bound) else 0.0


@device
def cosine_of(normal: Vec, way: Vec) -> float:
    """Return the cosine of the angle between a unit normal and a way of any length, not 0."""
    return dot(normal, way) / math.sqrt(dot(way, way))


@device
def lambert_light(color: Vec, lambert: float, cosine: float, intensity: float) -> Vec:
    """Return the light that a surface scatters, in parts of its colour from 0 to 255."""
    return scale(cosine * lambert * intensity, color)
