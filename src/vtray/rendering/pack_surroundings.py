"""From the skies and suns of a scene to what mirrors show of them."""

import math
from collections.abc import Sequence
from typing import TypeGuard

import numpy as np

from vtray.base.compiler.compiled import input_array
from vtray.geometry.vector import Vec
from vtray.rendering.pack_skies import changes_color, pack_skies, up_of
from vtray.scene.colors.color_light import light_of
from vtray.scene.colors.tone_map_names import ToneMapName
from vtray.scene.light_types import Ambient, AnyLight, Sky, Sun, strength_of
from vtray.scene.placing.directions import unit as unit_vector
from vtray.scene.scene import Scene
from vtray.transport.lights.surroundings import LEAST_SPREAD, Discs, Surroundings, spread_of


def pack_surroundings(scene: Scene) -> Surroundings:
    """Return the light that comes from far away: that of skies, ambient light, and wide suns."""
    tonemap = scene.render.tonemap
    skies = [light for light in scene.lights if isinstance(light, Sky) or is_even(light)]
    maps = [sky for sky in skies if isinstance(sky, Sky) and not is_even(sky)]

    def color_of(sky: AnyLight) -> list[float]:
        return [strength_of(sky) * channel for channel in light_of(sky.color, tonemap)]

    even = [color_of(sky) for sky in skies if is_even(sky)]
    red, green, blue = (math.fsum(color[k] for color in even) for k in range(3))
    return Surroundings(
        (red, green, blue),
        pack_skies(maps, up_of(scene.camera), tonemap) if maps else None,
        input_array(np.array([color_of(sky) for sky in maps]).reshape(-1, 3), np.float64),
        _pack_discs(scene.lights, tonemap),
    )


def _pack_discs(lights: Sequence[AnyLight], tonemap: ToneMapName) -> Discs:
    """Return the suns that rays from surfaces see."""
    middle, spread, color = [], [], []
    for sun in lights:
        if is_disc(sun):
            middle.append(towards_sun(sun))
            spread.append(spread_of(sun.angle))
            color.append([disc_radiance(sun) * part for part in light_of(sun.color, tonemap)])
    return Discs(
        input_array(np.array(middle).reshape(-1, 3), np.float64),
        input_array(np.array(spread), np.float64),
        input_array(np.array(color).reshape(-1, 3), np.float64),
    )


def is_disc(light: AnyLight) -> TypeGuard[Sun]:
    """Tell whether a light is a sun that rays from surfaces see: it is wide enough."""
    return isinstance(light, Sun) and spread_of(light.angle) >= LEAST_SPREAD


def disc_radiance(sun: Sun) -> float:
    """Return how bright the disc of a sun is, 1 for white, to light what is square to it so."""
    spread = spread_of(sun.angle)
    # The cosines of a cone around the normal add up to so much, relative to those all around.
    return sun.intensity / (spread * (2.0 - spread))


def towards_sun(sun: Sun) -> Vec:
    """Return the unit direction to the middle of a sun."""
    x, y, z = unit_vector(sun.direction)
    return -x, -y, -z


def is_even(light: AnyLight) -> bool:
    """Tell whether a light comes from everywhere in one colour, however far away that is."""
    if isinstance(light, Ambient):
        return math.isinf(light.distance) or is_everywhere(light)
    return isinstance(light, Sky) and not changes_color(light)


def is_everywhere(light: AnyLight) -> bool:
    """Tell whether nothing keeps off a light, which takes no rays."""
    return isinstance(light, Ambient) and light.distance == 0
