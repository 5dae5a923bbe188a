"""Scenes with other colours of an object, and with other intensities of the lights."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import msgspec

from vtray.base.errors import SceneError
from vtray.scene.arrays import Arrays
from vtray.scene.checks.scene_words import show
from vtray.scene.colors.color_arrays import color_arrays
from vtray.scene.objects import Light
from vtray.scene.scene import Scene
from vtray.scene.vectors import Color

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vtray.scene.colors.color_scale import ColorMap
    from vtray.scene.colors.names import AnyColor


def recolored(
    scene: Scene,
    index: int,
    color: "AnyColor | ArrayLike | Sequence[AnyColor]",
    *,
    color_end: "AnyColor | ArrayLike | Sequence[AnyColor] | None" = None,
    cmap: "ColorMap | None" = None,
    clim: tuple[float, float] | None = None,
    nan_color: "AnyColor" = "gray",
) -> Scene:
    """Return a scene in which one object has another colour, or those in its arrays have.

    Parameters
    ----------
    scene
        The scene.
    index
        The place of the one that changes; a negative one counts from the end.
    color, color_end, cmap, clim, nan_color
        The colours, as for `Scene.add_cylinders`; without `color_end`, objects have one each.

    Raises
    ------
    SceneError
        If there is no such object, or a colour is not right.
    """
    changed = list(scene.objects)
    _check_index(index, len(changed))
    item = changed[index]
    if color_end is not None and "color_end" not in item.__struct_fields__:
        words = f"expected None, as only Cylinders have two colours, got {show(color_end)}"
        message = f"recolor: color_end: {words}"
        raise SceneError(message)
    scale: dict[str, Any] = {"cmap": cmap, "clim": clim, "nan_color": nan_color}
    if isinstance(item, Arrays):
        colors = {"color": color, "color_end": color_end}
        changed[index] = item.colored(msgspec.structs.asdict(item), colors, "recolor: ", **scale)
    else:
        found, _ = color_arrays({"color": color}, 1, "recolor: ", **scale)
        changed[index] = item.replace(color=Color(*found["color"].reshape(3).tolist()))
    return Scene(scene.camera, scene.lights, changed, scene.render)


def relit(scene: Scene, intensities: Sequence[float]) -> Scene:
    """Return a scene whose lights have other intensities.

    Raises
    ------
    SceneError
        If an intensity is not right, or there are too many or too few.
    """
    lights = scene.lights
    count = len(intensities) if hasattr(intensities, "__len__") else repr(intensities)
    if count != len(lights):
        words = f"{len(lights)} numbers, one for each light"
        message = f"relight: intensities: expected {words}, got {count}"
        raise SceneError(message)
    changed = []
    for k, (light, intensity) in enumerate(zip(lights, intensities, strict=True)):
        try:
            changed.append(Light(light.location, intensity))
        except SceneError as problem:
            words = str(problem).partition(": ")[2]
            message = f"relight: intensities[{k}]: {words}"
            raise SceneError(message) from None
    return Scene(scene.camera, changed, scene.objects, scene.render)


def _check_index(index: int, count: int) -> None:
    """Raise SceneError if there is no object at an index."""
    is_integer = hasattr(index, "__index__") and not isinstance(index, bool)
    if is_integer and -count <= index < count:
        return
    expected = f"a place from 0 to {count - 1}" if count else "nothing, as there are no objects"
    message = f"recolor: index: expected {expected}, got {index!r}"
    raise SceneError(message)
