"""How glossy surfaces scatter light, in NumPy, with other means than the kernels' own.

All directions are rows of unit vectors in a space whose z is the normal.
"""

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

COSINES = np.linspace(0.0, 1.0, 201)[1:]


class Surface(NamedTuple):
    """A surface: what its facets mirror squarely, None for a dielectric coat, and its base."""

    roughness: float
    color: Any
    ior: float = 1.5
    is_metal: bool = True


def hidden(spread: float, cosine: Floats) -> Floats:
    """Return Smith's function for GGX."""
    tangent2 = 1 / cosine**2 - 1
    return (np.sqrt(1 + spread**2 * tangent2) - 1) / 2


def fresnel(ior: float, cosine: Floats) -> Floats:
    """Return the share that a dielectric mirrors, by the angles on both sides."""
    one = np.arccos(np.clip(cosine, 0, 1 - 1e-12))
    sine = np.sin(one) / ior
    other = np.arcsin(np.minimum(sine, 1))
    across = np.sin(one - other) / np.sin(one + other)
    along = np.tan(one - other) / np.tan(one + other)
    found: Floats = np.where(sine >= 1, 1.0, (across**2 + along**2) / 2)
    return found


def coat(surface: Surface, cosine: Floats) -> Floats:
    """Return what a facet mirrors of each channel, (n, 3)."""
    if surface.is_metal:
        squarely = np.asarray(surface.color, float)
        return squarely + (1 - squarely) * ((1 - np.clip(cosine, 0, 1)) ** 5)[:, None]
    return np.repeat(fresnel(surface.ior, cosine)[:, None], 3, axis=1)


@cache
def albedos(roughness: float, ior: float, is_metal: bool) -> tuple[Floats, float]:
    """Return what a coat mirrors from each of ``COSINES``, white for metal, and the mean.

    By facets as they stand, not as they are seen (Walter et al., 2007).
    """
    spread = roughness**2
    chance, around = np.meshgrid((np.arange(600) + 0.5) / 600, (np.arange(120) + 0.5) / 120)
    tangent = spread * np.sqrt(chance / (1 - chance))
    up = 1 / np.sqrt(1 + tangent**2)
    aside, angle = tangent * up, 2 * math.pi * around
    facet = np.stack([aside * np.cos(angle), aside * np.sin(angle), up], axis=-1).reshape(-1, 3)
    found = []
    for cosine in COSINES:
        out = np.array([math.sqrt(1 - cosine * cosine), 0, cosine])
        middle = facet @ out
        into = 2 * middle[:, None] * facet - out
        is_seen = (middle > 0) & (into[:, 2] > 0)
        both = 1 / (1 + hidden(spread, np.array(cosine)) + hidden(spread, np.abs(into[:, 2])))
        share = 1.0 if is_metal else fresnel(ior, middle)
        weight = share * np.abs(middle) * both / (cosine * facet[:, 2])
        found.append(float(np.mean(np.where(is_seen, weight, 0))))
    table = np.array(found)
    return table, float(np.mean(2 * COSINES * table))


def scattered(surface: Surface, into: Floats, out: Floats) -> Floats:
    """Return how much of the light from some directions goes into another, times the cosine.

    That is the reflectance distribution times the cosine of the light, (n, 3).
    """
    spread = surface.roughness**2
    out = np.broadcast_to(out, into.shape)
    cosine_in, cosine_out = into[:, 2], out[:, 2]
    facet = into + out
    facet /= np.linalg.norm(facet, axis=1)[:, None]
    slope2 = 1 / facet[:, 2] ** 2 - 1
    density = np.exp(-2 * np.log(spread * facet[:, 2] ** 2 * (1 + slope2 / spread**2))) / math.pi
    seen = 1 / (1 + hidden(spread, cosine_in) + hidden(spread, cosine_out))
    mirrored = coat(surface, np.sum(facet * out, axis=1))
    glossy = mirrored * (density * seen / (4 * cosine_in * cosine_out))[:, None]
    table, mean = albedos(surface.roughness, surface.ior, surface.is_metal)
    left = [1 - np.interp(cosine, COSINES, table) for cosine in (cosine_in, cosine_out)]
    base = np.asarray(surface.color, float)
    if surface.is_metal:
        average = base + (1 - base) / 21
        base = average**2 * mean / (1 - average * (1 - mean))
    matt = base * (left[0] * left[1] / (math.pi * (1 - mean)))[:, None]
    found: Floats = np.where((cosine_in > 0)[:, None], (glossy + matt) * cosine_in[:, None], 0.0)
    return found
