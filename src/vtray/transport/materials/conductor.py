"""How much light a smooth metal mirrors, in nothing but + - * / and roots."""

import math

from vtray.base.compiler.compiled import device, uncompiled
from vtray.geometry.vector import Vec


@device
def conductor_shares(cosine: float, indices: Vec, extinctions: Vec) -> Vec:
    """Return the shares of unpolarised red, green and blue light that a metal mirrors, 0 to 1.

    Parameters
    ----------
    cosine
        That of the angle between the light and the normal, from 0 to 1; rounding may take it
        beyond.
    indices, extinctions
        The real and the imaginary parts of the metal's indices of refraction, relative to what is
        around it; the first > 0, the second ≥ 0.
    """
    inside = min(max(cosine, 0.0), 1.0)
    return (
        conductor_share(inside, indices[0], extinctions[0]),
        conductor_share(inside, indices[1], extinctions[1]),
        conductor_share(inside, indices[2], extinctions[2]),
    )


@device
def conductor_share(cosine: float, index: float, extinction: float) -> float:
    """Return the share of light that a metal mirrors; the parameters are those of one channel.

    References
    ----------
    Fresnel's equations for a complex index n + ik, as in Born and Wolf, "Principles of Optics",
    14.4, with a + ib for the root of (n + ik)**2 - sin(angle)**2.
    """
    cosine2 = cosine * cosine
    sine2 = 1.0 - cosine2
    real = index * index - extinction * extinction - sine2
    imaginary = 2.0 * index * extinction
    # The square of the length of a + ib.
    length2 = math.sqrt(real * real + imaginary * imaginary)
    a2 = max(0.5 * (length2 + real), 0.0)
    mixed = 2.0 * math.sqrt(a2) * cosine
    across = (length2 - mixed + cosine2) / (length2 + mixed + cosine2)
    flat = cosine2 * length2 + sine2 * sine2
    along = (flat - mixed * sine2) / (flat + mixed * sine2)
    return 0.5 * across * (1.0 + along)


def mean_shares(indices: Vec, extinctions: Vec) -> list[float]:
    """Return what a metal mirrors of light that comes evenly from all sides.

    The parameters are those of `conductor_shares`. The mean is that over the squares of 64 cosines
    of equal weight.
    """
    share = uncompiled(conductor_share)
    cosines = [math.sqrt((k + 0.5) / 64.0) for k in range(64)]
    return [
        math.fsum(share(cosine, n, k) for cosine in cosines) / 64.0
        for n, k in zip(indices, extinctions, strict=True)
    ]


@device
def grazing_shares(cosine: float, squarely: Vec, along: Vec) -> Vec:
    """Return the shares that a metal mirrors, between those of light that comes squarely and along.

    The parameters are that of the angle between the light and the normal, and both shares.

    References
    ----------
    Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Computer Graphics Forum 13
    (3), 1994.
    """
    rest = 1.0 - min(max(cosine, 0.0), 1.0)
    weight = (rest * rest) * (rest * rest) * rest
    return (
        squarely[0] + weight * (along[0] - squarely[0]),
        squarely[1] + weight * (along[1] - squarely[1]),
        squarely[2] + weight * (along[2] - squarely[2]),
    )
