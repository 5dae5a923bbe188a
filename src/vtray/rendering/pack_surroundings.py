"""From the skies of a scene to what mirrors show of them."""

import numpy as np

from vtray.base.compiler.compiled import input_array
from vtray.rendering.pack_skies import changes_color, pack_skies, up_of
from vtray.scene.colors.color_light import light_of
from vtray.scene.light_types import Sky
from vtray.scene.scene import Scene
from vtray.transport.surroundings import Surroundings


def pack_surroundings(scene: Scene) -> Surroundings:
    """Return the light that comes from far away."""
    tonemap, skies = scene.render.tonemap, [one for one in scene.lights if isinstance(one, Sky)]

    def color_of(sky: Sky) -> list[float]:
        return [sky.radiance * channel for channel in light_of(sky.color, tonemap)]

    even = np.array([color_of(sky) for sky in skies if not changes_color(sky)]).reshape(-1, 3)
    maps = [sky for sky in skies if changes_color(sky)]
    red, green, blue = (float(part) for part in even.sum(axis=0))
    return Surroundings(
        (red, green, blue),
        pack_skies(maps, up_of(scene.camera), tonemap) if maps else None,
        input_array(np.array([color_of(sky) for sky in maps]).reshape(-1, 3), np.float64),
    )
