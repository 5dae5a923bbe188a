"""Rough glass: each facet mirrors a part of the light and refracts the rest.

What is lost where facets stand in the way of each other is given back, so that clear glass takes
nothing away from light that is the same from everywhere.

References
----------
Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction through Rough Surfaces", EGSR
2007; Turquin, "Practical multiple scattering compensation for microfacet models", 2019 (what is
lost divides what is seen).
"""

from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, dot, scale
from vtray.transport.materials.albedo import albedo_at
from vtray.transport.materials.facets import both_seen, seen_facet
from vtray.transport.materials.look import Albedos
from vtray.transport.materials.optics import Split, mirrored, split_at


class Passed(NamedTuple):
    """Where light goes on at a boundary.

    Attributes
    ----------
    way
        The unit direction.
    share
        How much of the light from there is seen, divided by the density.
    is_mirrored
        Whether it stays on the side where it was.
    chance
        With which chance it is mirrored, or not.
    """

    way: Vec
    share: float
    is_mirrored: bool
    chance: float


@device
def chance_of(split: Split, is_mirrored: bool) -> float:
    """Return with which chance light is mirrored that is split so, or not."""
    return split.reflected if is_mirrored else 1.0 - split.reflected


@device
def pass_facet(
    albedos: Albedos,
    table: int,
    spread: float,
    ratio: float,
    direction: Vec,
    normal: Vec,
    u: float,
    v: float,
    choice: float,
) -> Passed:
    """Return where a ray goes on at rough glass, for three numbers from 0 to 1.

    Parameters
    ----------
    albedos, table
        What is not lost.
    spread
        How far facets turn away, > 0.
    ratio
        The index of refraction on the other side, divided by that on this one.
    direction, normal
        The unit direction of the ray, and the unit normal on the side that it comes from.
    u, v, choice
        A point for the facet, and a number that chooses between mirroring and refraction.
    """
    towards = scale(-1.0, direction)
    out = max(dot(towards, normal), 1e-9)
    facet = seen_facet(spread, towards, normal, u, v)
    split = split_at(direction, facet, ratio)
    is_mirrored = choice < split.reflected
    way = mirrored(direction, facet) if is_mirrored else split.refracted
    cosine = dot(way, normal) if is_mirrored else -dot(way, normal)
    chosen = chance_of(split, is_mirrored)
    if cosine <= 0.0:
        return Passed(way, 0.0, is_mirrored, chosen)
    share = both_seen(spread, out, cosine) / albedo_at(albedos, table, out)
    return Passed(way, share, is_mirrored, chosen)
