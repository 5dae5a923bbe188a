"""Rough surfaces as many small mirrors: how their facets stand, and which of them are seen.

All directions are unit vectors that leave the surface; the normal is on the side of the viewer.

References
----------
Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction through Rough Surfaces", EGSR
2007 (the distribution GGX, that of Trowbridge and Reitz, 1975); Heitz, "Understanding the
Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3 (2), 2014; Heitz, "Sampling the GGX
Distribution of Visible Normals", JCGT 7 (4), 2018.
"""

import math

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, add, dot, scale
from vtray.geometry.warps import disc_point, frame_around

PI = 3.141592653589793

SMOOTH = 1e-4
"""Facets of less spread than that are one mirror."""


@device
def facet_density(spread: float, cosine: float) -> float:
    """Return how many facets there are of a normal, per solid angle and projected area.

    Parameters
    ----------
    spread
        How far facets turn away from the surface, from ``SMOOTH`` to 1: the square of the
        roughness.
    cosine
        That of the angle between the facet's normal and the surface's.
    """
    cosine2 = min(cosine * cosine, 1.0)
    spread2 = spread * spread
    stretch = (1.0 - cosine2) + cosine2 * spread2
    return spread2 / (PI * stretch * stretch)


@device
def masking(spread: float, cosine: float) -> float:
    """Return how much of facets is hidden, relative to what is seen, from a direction.

    Parameters
    ----------
    spread
        As for `facet_density`.
    cosine
        That of the angle between the direction and the normal, > 0.
    """
    cosine2 = min(max(cosine * cosine, 1e-300), 1.0)
    return 0.5 * (math.sqrt(1.0 + spread * spread * (1.0 - cosine2) / cosine2) - 1.0)


@device
def both_seen(spread: float, one: float, other: float) -> float:
    """Return the share of what one direction sees of facets that the other sees, too.

    The cosines are those of `masking`; heights of facets count for both (Heitz 2014, 99).
    """
    hidden = masking(spread, one)
    return (1.0 + hidden) / (1.0 + hidden + masking(spread, other))


@device
def seen_facet(spread: float, towards: Vec, normal: Vec, u: float, v: float) -> Vec:
    """Return the normal of a facet, as likely as it is seen, for a point of the unit square.

    Parameters
    ----------
    spread
        As for `facet_density`.
    towards
        Where the viewer is, above the surface.
    normal
        The surface's normal.
    u, v
        The point, from 0 to 1.
    """
    across, up = frame_around(normal)
    # As seen by a viewer to whom the facets are those of a half-ball.
    x, y = spread * dot(towards, across), spread * dot(towards, up)
    z = dot(towards, normal)
    per_length = 1.0 / math.sqrt(x * x + y * y + z * z)
    x, y, z = per_length * x, per_length * y, per_length * z
    aside2 = x * x + y * y
    per_aside = 1.0 / math.sqrt(aside2) if aside2 > 0.0 else 0.0
    one = (-y * per_aside, x * per_aside, 0.0) if aside2 > 0.0 else (1.0, 0.0, 0.0)
    other = -z * one[1], z * one[0], x * one[1] - y * one[0]
    a, b = disc_point(u, v)
    half = 0.5 * (1.0 + z)
    b = (1.0 - half) * math.sqrt(max(1.0 - a * a, 0.0)) + half * b
    c = math.sqrt(max(1.0 - a * a - b * b, 0.0))
    facet = add(add(scale(a, one), scale(b, other)), scale(c, (x, y, z)))
    # Back among facets that turn away less.
    x, y, z = spread * facet[0], spread * facet[1], max(facet[2], 1e-12)
    per_length = 1.0 / math.sqrt(x * x + y * y + z * z)
    level = add(scale(per_length * x, across), scale(per_length * y, up))
    return add(level, scale(per_length * z, normal))
