"""From the skies of a scene to what mirrors show of them."""

import math

import numpy as np

from vtray.base.compiler.compiled import input_array
from vtray.rendering.pack_skies import changes_color, pack_skies, up_of
from vtray.scene.colors.color_light import light_of
from vtray.scene.light_types import Ambient, AnyLight, Sky, strength_of
from vtray.scene.scene import Scene
from vtray.transport.lights.surroundings import Surroundings


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
    )


def is_even(light: AnyLight) -> bool:
    """Tell whether a light comes from everywhere in one colour, however far away that is."""
    if isinstance(light, Ambient):
        return math.isinf(light.distance)
    return isinstance(light, Sky) and not changes_color(light)
