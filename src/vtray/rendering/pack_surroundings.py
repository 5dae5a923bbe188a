"""From the skies of a scene to what mirrors show of them."""

import math

import numpy as np

from vtray.base.compiler.compiled import input_array
from vtray.rendering.pack_skies import changes_color, pack_skies, up_of
from vtray.scene.colors.color_light import light_of
from vtray.scene.colors.tone_map_names import ToneMapName
from vtray.scene.light_types import Ambient, AnyLight, Sky, Sun, strength_of
from vtray.scene.placing.directions import unit as unit_vector
from vtray.scene.scene import Scene
from vtray.transport.lights.surroundings import LEAST_SPREAD, Discs, Surroundings, spread_of


def pack_surroundings(scene: Scene) -> Surroundings:
    """Return the light that comes from far away: that of skies, and ambient light."""
    tonemap = scene.render.tonemap
    skies = [light for light in scene.lights if isinstance(light, Sky) or is_even(light)]

    def color_of(sky: AnyLight) -> list[float]:
        return [strength_of(sky) * channel for channel in light_of(sky.color, tonemap)]

    maps = [sky for sky in skies if isinstance(sky, Sky) and not is_even(sky)]
    even = [color_of(sky) for sky in skies if is_even(sky)]
    red, green, blue = (math.fsum(color[k] for color in even) for k in range(3))
    return Surroundings(
        (red, green, blue),
        pack_skies(maps, up_of(scene.camera), tonemap) if maps else None,
        input_array(np.array([color_of(sky) for sky in maps]).reshape(-1, 3), np.float64),
        _pack_discs([light for light in scene.lights if isinstance(light, Sun)], tonemap),
    )


def _pack_discs(suns: list[Sun], tonemap: ToneMapName) -> Discs:
    """Return the suns that rays from surfaces see."""
    middle, spread, color = [], [], []
    for sun in suns:
        towards, share = unit_vector(sun.direction), spread_of(sun.angle)
        if share < LEAST_SPREAD:
            continue
        middle.append((-towards[0], -towards[1], -towards[2]))
        spread.append(share)
        # As bright as it must be: the cosines of a cone around the normal add up to so much.
        brightness = sun.intensity / (share * (2.0 - share))
        color.append([brightness * channel for channel in light_of(sun.color, tonemap)])
    return Discs(
        input_array(np.array(middle).reshape(-1, 3), np.float64),
        input_array(np.array(spread), np.float64),
        input_array(np.array(color).reshape(-1, 3), np.float64),
    )


def is_even(light: AnyLight) -> bool:
    """Tell whether a light comes from everywhere in one colour, however far away that is."""
    if isinstance(light, Ambient):
        return math.isinf(light.distance)
    return isinstance(light, Sky) and not changes_color(light)
