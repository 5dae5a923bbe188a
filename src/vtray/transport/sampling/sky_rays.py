"""The rays of a fan to a sky whose colour changes with the direction."""

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.fan import BLOCKED, FAN, WEIGHT, Fan, direction_of, set_direction
from vtray.geometry.vector import Vec
from vtray.transport.lights.sky import Skies
from vtray.transport.sampling.sky_map import light_towards
from vtray.transport.sampling.warps import cosine_direction


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
        u, v, _ = direction_of(fan, ray)
        set_direction(fan, ray, cosine_direction(u, v, normal))
    for ray in range(rays):
        _set_weights(fan, ray, light_towards(skies, sky, direction_of(fan, ray)))
    return True


@device
def _set_weights(fan: Fan, ray: int, light: Vec) -> None:
    """Set what a ray counts; one that counts nothing is not cast."""
    red, green, blue = light
    fan[WEIGHT + ray] = red
    fan[WEIGHT + FAN + ray] = green
    fan[WEIGHT + 2 * FAN + ray] = blue
    fan[BLOCKED + ray] = 0.0 if max(red, green, blue) > 0.0 else 1.0
