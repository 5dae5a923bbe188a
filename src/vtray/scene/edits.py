"""Objects with other colours, and lights with other intensities."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import msgspec

from vtray.base.errors import SceneError
from vtray.scene.arrays import Arrays
from vtray.scene.colors.color_arrays import color_array
from vtray.scene.objects import Light, Object
from vtray.scene.vectors import Color

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vtray.scene.colors.color_scale import ColorMap
    from vtray.scene.colors.names import AnyColor


def recolored(
    objects: Sequence[Object],
    index: int,
    color: "AnyColor | ArrayLike | Sequence[AnyColor]",
    *,
    cmap: "ColorMap | None" = None,
    clim: tuple[float, float] | None = None,
    nan_color: "AnyColor" = "gray",
) -> list[Object]:
    """Return objects of which one has another colour, or its spheres have.

    Parameters
    ----------
    objects
        The objects.
    index
        The place of the one that changes; a negative one counts from the end.
    color, cmap, clim, nan_color
        The colours, as for `Scene.add_spheres`.

    Raises
    ------
    SceneError
        If there is no such object, or a colour is not right.
    """
    _check_index(index, len(objects))
    changed = list(objects)
    item = changed[index]
    count = len(item) if isinstance(item, Arrays) else 1
    colors, scale = color_array(
        color, count, "recolor: ", cmap=cmap, clim=clim, nan_color=nan_color
    )
    if isinstance(item, Arrays):
        arrays = {**msgspec.structs.asdict(item), "color": colors}
        changed[index] = type(item).from_arrays(arrays, "recolor: ").with_scale(scale)
    else:
        one = Color(*colors.reshape(3).tolist())
        changed[index] = item.replace(color=one)
    return changed


def relit(lights: Sequence[Light], intensities: Sequence[float]) -> list[Light]:
    """Return lights with other intensities.

    Raises
    ------
    SceneError
        If an intensity is not right, or there are too many or too few.
    """
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
    return changed


def _check_index(index: int, count: int) -> None:
    """Raise SceneError if there is no object at an index."""
    is_integer = hasattr(index, "__index__") and not isinstance(index, bool)
    if is_integer and -count <= index < count:
        return
    expected = f"a place from 0 to {count - 1}" if count else "nothing, as there are no objects"
    message = f"recolor: index: expected {expected}, got {index!r}"
    raise SceneError(message)
