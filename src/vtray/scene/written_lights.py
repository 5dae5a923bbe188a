"""What a scene file, a dictionary and the hash of a scene say of lights: no more than is needed."""

from collections.abc import Callable
from functools import cache
from typing import Any

import msgspec

from vtray.scene.light_types import WHITE, AnyLight, Light
from vtray.scene.pictures.sky_image import SkyImage


def as_written(light: AnyLight, write_image: Callable[[SkyImage], object]) -> dict[str, Any]:
    """Return the keys of a light: neither those with their default, nor the type of a point.

    So the files and the hashes of scenes with nothing but white points are those of the versions
    that knew no other lights.

    Parameters
    ----------
    light
        The light.
    write_image
        Gives what stands for the picture of a sky.
    """
    kind = type(light)
    if (
        isinstance(light, Light) and light.color == WHITE
    ):  # in a third of the time, as there may be many
        return {"location": light.location, "intensity": light.intensity}
    tag = {} if kind is Light else {"type": kind.__struct_config__.tag}
    values = ((name, getattr(light, name), default) for name, default in _defaults(kind))
    written = {
        **tag,
        **{name: value for name, value, default in values if value not in (default, None)},
    }
    if isinstance(written.get("image"), SkyImage):
        written["image"] = write_image(written["image"])
    return written


@cache
def _defaults(kind: type[AnyLight]) -> tuple[tuple[str, object], ...]:
    """Return the keys of a kind of lights with their defaults, which required ones do not have."""
    fields = msgspec.structs.fields(kind)
    # An intensity that is neither given nor replaced by a radiance is 1.
    own = {"intensity": 1.0} if "radiance" in kind.__struct_fields__ else {}
    return tuple((field.name, own.get(field.name, field.default)) for field in fields)
