"""The rays of a fan to a sky whose colour changes with the direction.

Where a sky is far brighter in places than on average, half of the unit square gives rays to these
places, and the other half rays around the normal, by the cosine, as to other skies. Each counts by
the density of both together, so that neither leaves noise where the other is good.

References
----------
Veach, Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995
(the balance heuristic).
"""

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.fan import BLOCKED, FAN, WEIGHT, Fan, load_direction, set_direction
from vtray.geometry.vector import Vec, dot, scale
from vtray.geometry.warps import cosine_direction
from vtray.transport.lights.sky import Brightness, Skies, light_at
from vtray.transport.sampling.sky_brightness import bright_density, bright_direction
from vtray.transport.sampling.sky_map import map_place


@device
def spread_to_sky(fan: Fan, rays: int, skies: Skies | None, sky: int, normal: Vec) -> bool:
    """Set directions and weights of the rays to a sky of many colours; tell whether it is one.

    Parameters
    ----------
    fan, rays
        The rays, so many; their directions hold points of the unit square so far.
    skies, sky
        The sky, -1 for other lights, of which nothing is set.
    normal
        The unit normal of the surface.
    """
    if skies is None:
        return False
    if sky < 0:
        return False
    for ray in range(rays):
        u, v, _ = load_direction(fan, ray)
        set_direction(fan, ray, sky_direction(u, v, normal, skies, skies.bright, sky))
    for ray in range(rays):
        direction = load_direction(fan, ray)
        _set_weights(fan, ray, sky_weights(direction, normal, skies, skies.bright, sky))
    return True


@device
def _set_weights(fan: Fan, ray: int, light: Vec) -> None:
    """Set what a ray counts; one that counts nothing is not cast."""
    red, green, blue = light
    fan[WEIGHT + ray] = red
    fan[WEIGHT + FAN + ray] = green
    fan[WEIGHT + 2 * FAN + ray] = blue
    fan[BLOCKED + ray] = 0.0 if max(red, green, blue) > 0.0 else 1.0


@device
def sky_direction(
    u: float, v: float, normal: Vec, skies: Skies, bright: Brightness, sky: int
) -> Vec:
    """Return the direction of a ray for a point of the unit square."""
    share = bright.share[sky]
    if u < share:
        return bright_direction(u / share, v, skies, bright, sky)
    return cosine_direction((u - share) / (1.0 - share), v, normal)


@device
def sky_weights(direction: Vec, normal: Vec, skies: Skies, bright: Brightness, sky: int) -> Vec:
    """Return what a ray counts: the sky's light, times cosine over pi, over its density."""
    place = map_place(skies, sky, direction)
    light = light_at(skies, sky, place.across, place.down)
    share = bright.share[sky]
    if share == 0.0:
        return light
    cosine = max(dot(normal, direction), 0.0)
    density = share * bright_density(skies, bright, sky, place) + (1.0 - share) * cosine
    return scale(cosine / density if cosine > 0.0 else 0.0, light)
