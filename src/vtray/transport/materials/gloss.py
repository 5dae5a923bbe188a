"""Glossy surfaces: a coat of facets over a base, which gets what the coat leaves.

Of the light that comes at an angle, the coat mirrors a share, its albedo E. The base scatters light
evenly, but for what the coat keeps from it on both ways: it counts (1 - E(in)) (1 - E(out)) / (1 -
the mean of E) times. So a white base makes the surface white as a whole, and light goes the same
way forth and back. Under the coat of plastic the base is its colour; a rough metal has one for the
light that goes over several of its facets.

References
----------
Kelemen, Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance
Sampling", Eurographics 2001; Kulla, Conty, "Revisiting Physically Based Shading at Imageworks",
SIGGRAPH 2017 courses.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, add, dot, scale
from vtray.geometry.warps import cosine_direction
from vtray.transport.materials.albedo import NODES, albedo_at
from vtray.transport.materials.facets import PI, facet_density, masking, seen_facet
from vtray.transport.materials.look import METAL, Albedos, Look, Looks, first_number, spread_of
from vtray.transport.materials.metal import metal_base, metal_shares
from vtray.transport.materials.optics import mirrored, mirrored_part

WHITE = (1.0, 1.0, 1.0)


class Gloss(NamedTuple):
    """A glossy surface as it is seen from somewhere.

    Attributes
    ----------
    look
        What it is made of.
    spread
        How far the facets of its coat turn away; 0 for a smooth one.
    color
        The colour of the object, 1 for white.
    towards, normal
        The unit direction to the viewer, and the unit normal on that side.
    base
        What the base scatters, with what the coat leaves on the way to the viewer.
    chance
        With which chance the coat is chosen, and not the base.
    """

    look: Look
    spread: float
    color: Vec
    towards: Vec
    normal: Vec
    base: Vec
    chance: float


class Scattered(NamedTuple):
    """Where light goes on, or comes from.

    Attributes
    ----------
    way
        The unit direction.
    share
        How much of the light from there is seen, divided by the density.
    density
        That of the direction, per solid angle; 0 if it is the only one.
    """

    way: Vec
    share: Vec
    density: float


@device
def gloss_of(
    looks: Looks,
    albedos: Albedos,
    look: Look,
    color: Vec,
    lambert: float,
    direction: Vec,
    normal: Vec,
) -> Gloss:
    """Return a surface of plastic or metal as it is seen along a ray.

    Parameters
    ----------
    looks, albedos, look
        What it is made of.
    color, lambert
        The colour of the object, 1 for white, and what share its base scatters, if it is no metal.
    direction, normal
        The unit direction of the ray, and the unit normal on the side that it comes from.
    """
    table, cosine = 2 * look.row, min(max(-dot(direction, normal), 0.0), 1.0)
    mean, albedo = albedos[table, NODES + 1], albedo_at(albedos, table, cosine)
    shares = coat_shares(looks, look, cosine, color)
    coat = albedo
    if look.kind == METAL:
        coat *= max(shares[0], shares[1], shares[2])
        base = metal_base(looks, look.row, color, mean)
    else:
        base = scale(lambert, color)
    left = 1.0 - albedo
    below = left * max(base[0], base[1], base[2])
    chance = coat / (coat + below) if coat + below > 0.0 else 1.0
    base = scale(left / (1.0 - mean) if mean < 1.0 else 0.0, base)
    towards = scale(-1.0, direction)
    return Gloss(look, spread_of(looks, look), color, towards, normal, base, chance)


@device
def coat_shares(looks: Looks, look: Look, cosine: float, color: Vec) -> Vec:
    """Return the shares of light that a facet of the coat mirrors, given the cosine to it."""
    if look.kind == METAL:
        return metal_shares(looks, look.row, cosine, color, WHITE)
    share = mirrored_part(cosine, first_number(looks, look))
    return share, share, share


@device
def seen_light(looks: Looks, albedos: Albedos, gloss: Gloss, way: Vec) -> Scattered:
    """Return how much of the light from a direction is seen, times its cosine, and the density.

    The density is that with which `scatter_gloss` takes the direction; the share is not divided by
    it. What a smooth coat mirrors is not counted: it comes from one direction alone.
    """
    cosine, out = dot(gloss.normal, way), dot(gloss.normal, gloss.towards)
    if cosine <= 0.0 or out <= 0.0:
        return Scattered(way, (0.0, 0.0, 0.0), 0.0)
    left = (1.0 - albedo_at(albedos, 2 * gloss.look.row, cosine)) * cosine / PI
    share, density = scale(left, gloss.base), (1.0 - gloss.chance) * cosine / PI
    if gloss.spread > 0.0:
        middle = add(gloss.towards, way)
        facet = scale(1.0 / math.sqrt(dot(middle, middle)), middle)
        facets = facet_density(gloss.spread, dot(facet, gloss.normal)) / (4.0 * out)
        seen = 1.0 + masking(gloss.spread, out)
        shares = coat_shares(looks, gloss.look, dot(facet, way), gloss.color)
        both = seen + masking(gloss.spread, cosine)
        share = add(share, scale(facets / both, shares))
        density += gloss.chance * facets / seen
    return Scattered(way, share, density)


@device
def scatter_gloss(
    looks: Looks, albedos: Albedos, gloss: Gloss, u: float, v: float, choice: float
) -> Scattered:
    """Return a direction from which light may come, for three numbers from 0 to 1.

    Two of them are a point for the direction; the third chooses between coat and base.
    """
    is_coat, direction = choice < gloss.chance, scale(-1.0, gloss.towards)
    if is_coat and gloss.spread == 0.0:
        shares = coat_shares(looks, gloss.look, dot(gloss.normal, gloss.towards), gloss.color)
        way = mirrored(direction, gloss.normal)
        return Scattered(way, scale(1.0 / gloss.chance, shares), 0.0)
    if is_coat:
        way = mirrored(direction, seen_facet(gloss.spread, gloss.towards, gloss.normal, u, v))
    else:
        way = cosine_direction(u, v, gloss.normal)
    seen = seen_light(looks, albedos, gloss, way)
    if not seen.density > 0.0:
        return Scattered(way, (0.0, 0.0, 0.0), 0.0)
    return Scattered(way, scale(1.0 / seen.density, seen.share), seen.density)
