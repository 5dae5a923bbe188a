"""Metals: what their facets mirror, and what light is left to go over several of them."""

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec
from vtray.transport.materials.conductor import conductor_shares, grazing_shares
from vtray.transport.materials.look import MEANS, Looks, three_numbers


@device
def metal_shares(looks: Looks, row: int, cosine: float, color: Vec, along: Vec) -> Vec:
    """Return the shares of light that metal mirrors, or a facet of it.

    Parameters
    ----------
    looks, row
        The metal.
    cosine
        That of the angle between the light and the normal.
    color, along
        The colour of the object and white, or both times how much is seen of the light.
    """
    n, k = three_numbers(looks, row, 0), three_numbers(looks, row, 3)
    if n[0] > 0.0:
        shares = conductor_shares(cosine, n, k)
        return color[0] * shares[0], color[1] * shares[1], color[2] * shares[2]
    return grazing_shares(cosine, color, along)


@device
def metal_base(looks: Looks, row: int, color: Vec, mean: float) -> Vec:
    """Return what becomes of light that a facet mirrors to another: what base there is.

    The parameters are those of `metal_shares`, with a `color` of 1 for white; `mean` is the mean
    albedo of facets that mirror all light.

    References
    ----------
    Kulla, Conty, 2017, for the Fresnel term of many bounces.
    """
    red, green, blue = color
    if looks.numbers[row, 0] > 0.0:
        means = three_numbers(looks, row, MEANS)
        red, green, blue = red * means[0], green * means[1], blue * means[2]
    else:
        # The mean of Schlick's formula.
        red, green, blue = _over_20(red), _over_20(green), _over_20(blue)
    return _often(red, mean), _often(green, mean), _often(blue, mean)


@device
def _over_20(squarely: float) -> float:
    """Return what Schlick's formula gives on average, for light that comes evenly."""
    return squarely + (1.0 - squarely) / 21.0


@device
def _often(share: float, mean: float) -> float:
    """Return the share of light that leaves after being mirrored twice or more."""
    return share * share * mean / (1.0 - share * (1.0 - mean))
