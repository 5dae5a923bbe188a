"""Mirrored and refracted rays, and how much light each takes: in nothing but + - * / and roots."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, add, dot, scale


class Split(NamedTuple):
    """How light divides at a smooth boundary between two transparent materials.

    Attributes
    ----------
    reflected
        The share that is mirrored, from 0 to 1; 1 where all is.
    refracted
        The unit direction of the rest; without meaning where there is none.
    """

    reflected: float
    refracted: Vec


@device
def mirrored(direction: Vec, normal: Vec) -> Vec:
    """Return the unit direction in which a ray is mirrored.

    Parameters
    ----------
    direction
        The unit direction of the ray.
    normal
        The surface's unit normal, on the side that the ray comes from.
    """
    way = add(direction, scale(-2.0 * dot(direction, normal), normal))
    return scale(1.0 / math.sqrt(dot(way, way)), way)


@device
def split_at(direction: Vec, normal: Vec, ratio: float) -> Split:
    """Return how unpolarised light divides at a smooth boundary.

    Parameters
    ----------
    direction
        The unit direction of the ray.
    normal
        The boundary's unit normal, on the side that the ray comes from.
    ratio
        The index of refraction on the other side, divided by that on this one.

    References
    ----------
    Snell's law and Fresnel's equations, as in Born and Wolf, "Principles of Optics", 1.5.
    """
    cosine = min(max(-dot(direction, normal), 0.0), 1.0)
    # The sine's square on the other side.
    beyond = (1.0 - cosine * cosine) / (ratio * ratio)
    if beyond >= 1.0:
        return Split(1.0, direction)
    other = math.sqrt(1.0 - beyond)
    across = (cosine - ratio * other) / (cosine + ratio * other)
    along = (ratio * cosine - other) / (ratio * cosine + other)
    way = add(scale(1.0 / ratio, direction), scale(cosine / ratio - other, normal))
    unit = scale(1.0 / math.sqrt(dot(way, way)), way)
    return Split(0.5 * (across * across + along * along), unit)
