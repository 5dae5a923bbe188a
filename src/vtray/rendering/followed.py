"""Light over many surfaces: who shows it, and what does not go with it."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import RenderError
from vtray.image.exposure import BRIGHTEST
from vtray.image.white import usual_brightness
from vtray.rendering.acceleration import Acceleration
from vtray.rendering.bodies import has_faded
from vtray.rendering.pack_surroundings import disc_radiance, is_disc
from vtray.scene.copies import Copies
from vtray.scene.materials import (
    Blend,
    Emissive,
    Lambert,
    Material,
    blended_in,
    can_vary,
    materials_of,
)
from vtray.scene.objects import Object
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings

FAR_BRIGHTER = 16.0
"""So many times as bright as nearly all pixels is what leaves these dark, an eye would say."""


def simpler_looks(objects: Sequence[Object], settings: RenderSettings) -> str:
    """Say which materials the integrator shows as simpler ones; "" if it shows all as they are."""
    simpler = {"direct": "matt", "whitted": "smooth", "path": ""}[settings.integrator]
    better = {"direct": '"whitted" or "path"', "whitted": '"path"', "path": ""}
    is_direct = settings.integrator == "direct"
    found = [*dict.fromkeys(name for name, rough in _kinds(objects) if is_direct or rough)]
    if not found or not simpler:
        return ""
    which = f"{' and '.join(found)} {'are' if len(found) > 1 else 'is'}"
    words = f"shown as {simpler} by the integrator {settings.integrator}"
    return f"material: {which} {words}; give integrator={better[settings.integrator]}"


def darkness(linear: NDArray[np.float64], peak: float, settings: RenderSettings) -> str:
    """Say that a picture is dark, as what it mirrors is far brighter than the rest; "" if not.

    Parameters
    ----------
    linear
        The light of the picture, (height, width, 3).
    peak
        Its largest channel.
    settings
        How it is taken.
    """
    if settings.integrator == "direct" or settings.exposure != "max":
        return ""
    usual = usual_brightness(linear)
    if usual == 0.0 or peak <= FAR_BRIGHTER * usual:
        return ""
    words = f"the brightest pixel is {peak / usual:.0f} times as bright as 99 of 100 are"
    return f'exposure: {words}, which leaves these dark; give exposure="auto"'


def check_followed(
    kept: Acceleration, objects: Sequence[Object], settings: RenderSettings, *, keep_lights: bool
) -> None:
    """Raise RenderError if something is asked for that does not go with following mirrors."""
    if settings.integrator == "direct":
        return
    if keep_lights:
        message = (
            "keep_lights: light over many surfaces is not kept for each light; leave it out, or "
            'give integrator="direct"'
        )
        raise RenderError(message)
    if has_faded(kept.bodies, objects):
        message = (
            f'opacity: not between 0 and 1 with integrator="{settings.integrator}", which does not '
            'show what fades; give material="glass" instead, or integrator="direct"'
        )
        raise RenderError(message)


def check_radiances(scene: Scene) -> None:
    """Raise RenderError if what shines is so bright that a pixel could overflow."""
    if scene.render.integrator == "direct":
        return
    for _, material in _singles(scene.objects):
        if isinstance(material, Emissive) and material.radiance > BRIGHTEST:
            words = f"expected at most {BRIGHTEST:g}, got {material.radiance:g}"
            message = f"material.radiance: {words}; give a lower one, and more exposure"
            raise RenderError(message)
    discs = sum(map(disc_radiance, filter(is_disc, scene.lights)))
    if discs > BRIGHTEST:
        words = f"in mirrors, suns are as bright as {discs:g}, expected at most {BRIGHTEST:g}"
        message = f"lights: {words}; give lower intensities, and more exposure"
        raise RenderError(message)


def shines(scene: Scene) -> bool:
    """Tell whether any object of a scene shines, and is shown so."""
    return scene.render.integrator != "direct" and "emissive" in dict(_kinds(scene.objects))


def followed(render: RenderSettings, settings: RenderSettings) -> RenderSettings:
    """Return the settings of a scene with those of others that say how its light is followed."""
    names = ("tonemap", "integrator", "depth", "firefly")
    return render.replace(**{name: getattr(settings, name) for name in names})


def _kinds(objects: Sequence[Object]) -> Iterator[tuple[str, bool]]:
    """Give the materials of objects, and of what is copied, that are not matt.

    Yields
    ------
    name, is_rough
        The name of each, and whether its surface is rough.
    """
    for item, one in _singles(objects):
        if not isinstance(one, Lambert):
            own = getattr(one, "roughness", 0.0)
            each = getattr(item, "roughness", None)
            rough = each if each is not None and can_vary(one, "roughness") else own
            yield type(one).__name__.lower(), bool(np.any(np.greater(rough, 0)))


def _singles(objects: Sequence[Object]) -> Iterator[tuple[Object, Material]]:
    """Give the materials of objects, and of what is copied, none of them a blend, with those."""
    for item in objects:
        if isinstance(item, Copies):
            yield from _singles(item.objects)
        for material in materials_of(getattr(item, "material", "lambert")):
            for one in blended_in(material):
                yield item, one
            if not isinstance(material, Blend):
                yield item, material
