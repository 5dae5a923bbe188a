"""What rays from surfaces see that meet nothing: the light of all skies and wide suns."""

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, add
from vtray.transport.lights.sky import Skies
from vtray.transport.lights.surroundings import (
    Discs,
    Surroundings,
    disc_count,
    is_towards,
    light_of_disc,
)
from vtray.transport.sampling.sky_map import light_towards


@device
def far_light(surroundings: Surroundings | None, direction: Vec, sees_lights: bool) -> Vec:
    """Return the light that comes against a unit direction from far away.

    That of one colour is seen by all rays, all other only by those that see lights.
    """
    if surroundings is None:
        return 0.0, 0.0, 0.0
    light = _with_maps(surroundings, surroundings.skies, direction, sees_lights)
    return _with_discs(light, surroundings.discs, direction) if sees_lights else light


@device
def _with_maps(
    surroundings: Surroundings, skies: Skies | None, direction: Vec, sees_lights: bool
) -> Vec:
    """Return the light of all skies; see `far_light`."""
    red, green, blue = surroundings.even
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if skies is not None:  # noqa: SIM102
        if sees_lights:
            color = surroundings.color
            for sky in range(color.shape[0]):
                light = light_towards(skies, sky, direction)
                red += color[sky, 0] * light[0]
                green += color[sky, 1] * light[1]
                blue += color[sky, 2] * light[2]
    return red, green, blue


@device
def _with_discs(light: Vec, discs: Discs, direction: Vec) -> Vec:
    """Return light, and that of the suns towards which a direction leads."""
    for sun in range(disc_count(discs)):
        if is_towards(discs, sun, direction):
            light = add(light, light_of_disc(discs, sun))
    return light
