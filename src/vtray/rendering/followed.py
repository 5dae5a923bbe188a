"""Light over many surfaces: who shows it, and what does not go with it."""

from collections.abc import Iterator, Sequence

from vtray.base.errors import RenderError
from vtray.rendering.acceleration import Acceleration
from vtray.scene.copies import Copies
from vtray.scene.materials import is_matt, materials_of
from vtray.scene.objects import Object
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings


def matt_instead(objects: Sequence[Object], settings: RenderSettings) -> str:
    """Say which materials the integrator cannot show; "" if it shows all."""
    found = [*dict.fromkeys(_names(objects))] if settings.integrator == "direct" else []
    if not found:
        return ""
    words = 'shown as matt by the integrator direct; give integrator="whitted" or "path"'
    return f"material: {' and '.join(found)} {'are' if len(found) > 1 else 'is'} {words}"


def check_followed(kept: Acceleration, settings: RenderSettings, *, keep_lights: bool) -> None:
    """Raise RenderError if something is asked for that does not go with following mirrors."""
    if settings.integrator == "direct":
        return
    if keep_lights:
        message = (
            "keep_lights: light over many surfaces is not kept for each light; leave it out, or "
            'give integrator="direct"'
        )
        raise RenderError(message)
    if kept.bodies is not None:
        message = (
            f'opacity: not between 0 and 1 with integrator="{settings.integrator}", which does not '
            'show what fades; give material="glass" instead, or integrator="direct"'
        )
        raise RenderError(message)


def shines(scene: Scene) -> bool:
    """Tell whether any object of a scene shines, and is shown so."""
    return scene.render.integrator != "direct" and "emissive" in _names(scene.objects)


def check_told(objects: Sequence[Object], settings: RenderSettings, caller: str) -> None:
    """Raise RenderError if the rays of a pixel cannot be told, as they go on from surfaces."""
    is_matt = next(_names(objects), None) is None
    if settings.integrator == "path" or (settings.integrator == "whitted" and not is_matt):
        message = (
            f'{caller}: rays that go on from surfaces are not told; give integrator="direct", got '
            f'"{settings.integrator}"'
        )
        raise RenderError(message)


def _names(objects: Sequence[Object]) -> Iterator[str]:
    """Give the materials of objects, and of what is copied, that are not matt."""
    for item in objects:
        if isinstance(item, Copies):
            yield from _names(item.objects)
        for material in materials_of(getattr(item, "material", "lambert")):
            if not is_matt(material):
                yield type(material).__name__.lower()
