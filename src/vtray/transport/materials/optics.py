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
    way = add(scale(1.0 / ratio, direction), scale(cosine / ratio - other, normal))
    unit = scale(1.0 / math.sqrt(dot(way, way)), way)
    return Split(_share(cosine, other, ratio), unit)


@device
def mirrored_part(cosine: float, ratio: float) -> float:
    """Return the share of unpolarised light that a smooth boundary mirrors, as `split_at` does.

    Parameters
    ----------
    cosine
        That of the angle between the light and the normal, from 0 to 1; rounding may take it
        beyond.
    ratio
        As for `split_at`.
    """
    cosine = min(max(cosine, 0.0), 1.0)
    beyond = (1.0 - cosine * cosine) / (ratio * ratio)
    return 1.0 if beyond >= 1.0 else _share(cosine, math.sqrt(1.0 - beyond), ratio)


@device
def _share(cosine: float, other: float, ratio: float) -> float:
    """Return the share that is mirrored, given the cosines on both sides."""
    across = (cosine - ratio * other) / (cosine + ratio * other)
    along = (ratio * cosine - other) / (ratio * cosine + other)
    return 0.5 * (across * across + along * along)


@device
def through_both(split: Split, direction: Vec) -> Split:
    """Return how light divides at a thin sheet, given how it does at the first of its two sides.

    What is not mirrored goes straight on.
    """
    return Split(mirrored_by_both(split.reflected), direction)


@device
def mirrored_by_both(share: float) -> float:
    """Return the share that a thin sheet mirrors, given that of one of its sides.

    Of what is mirrored to and fro within, all comes out on either side: 2 R / (1 + R) is mirrored
    in the end where a side mirrors R.
    """
    return 2.0 * share / (1.0 + share)
