"""Scenes with other colours of an object, and with other intensities of the lights."""

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from numbers import Real
from typing import TYPE_CHECKING, Any

import msgspec

from vtray.base.errors import SceneError
from vtray.base.number import count_of, integer_of
from vtray.scene.arrays import Arrays
from vtray.scene.checks.scene_words import show
from vtray.scene.colors.color_arrays import color_arrays
from vtray.scene.copies import Copies
from vtray.scene.light_types import with_strength
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
        The colours, as for `Scene.add_cylinders`; without `color_end`, objects have one each. Of
        `Copies`, one colour is that of all their objects, and a list has one entry for each object,
        of what would be given for it alone; what a single object has is given as if it stood alone.

    Raises
    ------
    SceneError
        If there is no such object, or a colour is not right.
    """
    changed = list(scene.objects)
    _check_index(index, len(changed))
    scale: dict[str, Any] = {"cmap": cmap, "clim": clim, "nan_color": nan_color}
    item = changed[index]
    colors = {"color": color, "color_end": color_end}
    if isinstance(item, Copies):
        changed[index] = _recolored_copies(item, colors, "recolor: ", scale)
    else:
        changed[index] = _recolored(item, colors, "recolor: ", scale)
    return Scene(scene.camera, scene.lights, changed, scene.render, scene.style)


def _recolored(item: Any, colors: dict[str, Any], place: str, scale: dict[str, Any]) -> Any:  # noqa: ANN401
    """Return one object, or arrays, with other colours."""
    _check_end(colors["color_end"], [item], place)
    if isinstance(item, Arrays):
        made = item.colored(msgspec.structs.asdict(item), colors, place, **scale)
        return made.remembering(item, colors)
    found, _ = color_arrays({"color": colors["color"]}, 1, place, **scale)
    return item.replace(color=Color(*found["color"].reshape(3).tolist()))


def _recolored_copies(
    item: Copies, colors: dict[str, Any], place: str, scale: dict[str, Any]
) -> Copies:
    """Return copies whose objects have other colours."""
    objects = item.objects
    if len(objects) == 1:
        return item.replace(objects=[_recolored(objects[0], colors, place, scale)])
    if scale["cmap"] is not None and scale["clim"] is None:
        words = "expected the limits (low, high) that all objects of the copies share, got None"
        raise SceneError(f"{place}clim: {words}")
    color, color_end = colors["color"], colors["color_end"]
    _check_end(color_end, objects, place)
    ends = _for_each(objects, color_end, f"{place}color_end")
    if _is_one_color(color_end):
        ends = [color_end if _has_two(part) else None for part in objects]
    each = zip(objects, _for_each(objects, color, f"{place}color"), ends, strict=True)
    changed = [
        _recolored(part, {"color": one, "color_end": end}, f"{place}objects[{k}]: ", scale)
        for k, (part, one, end) in enumerate(each)
    ]
    return item.replace(objects=changed)


def _for_each(objects: Sequence[Any], value: Any, place: str) -> list[Any]:  # noqa: ANN401
    """Return what is given for each object of copies."""
    if value is None or _is_one_color(value):
        return [value] * len(objects)
    count = count_of(value)
    if count != len(objects):
        words = f"one colour, or a list of {len(objects)}, one for each object of the copies"
        got = show(value) if count is None else count
        raise SceneError(f"{place}: expected {words}, got {got}")
    return list(value)


def _is_one_color(value: Any) -> bool:  # noqa: ANN401
    """Tell whether a value is one colour, not one for each of several objects."""
    if isinstance(value, (str, Color)):
        return True
    is_row = isinstance(value, (list, tuple)) or getattr(value, "ndim", 0) == 1
    return is_row and len(value) in (3, 4) and all(isinstance(part, Real) for part in value)


def _check_end(color_end: object, objects: Sequence[Any], place: str) -> None:
    """Raise SceneError if there are colours for second halves, and none to have them."""
    if color_end is not None and not any(map(_has_two, objects)):
        words = (
            f"expected None, as only Cylinders and Cones have two colours, got {show(color_end)}"
        )
        raise SceneError(f"{place}color_end: {words}")


def _has_two(item: object) -> bool:
    """Tell whether objects may have two colours each."""
    return isinstance(item, Arrays) and "color_end" in item.COLUMNS


def relit(scene: Scene, intensities: Sequence[float]) -> Scene:
    """Return a scene whose lights have other intensities.

    Raises
    ------
    SceneError
        If an intensity is not right, or there are too many or too few.
    """
    lights = scene.lights
    count = count_of(intensities)
    numbers = "a list of one number" if len(lights) == 1 else f"{len(lights)} numbers"
    expected = f"relight: intensities: expected {numbers}, one for each light"
    if isinstance(intensities, Mapping | AbstractSet):  # which say nothing of which is whose
        raise SceneError(f"{expected}, in their order, got a {type(intensities).__name__}")
    if count != len(lights):
        got = show(intensities) if count is None else count
        raise SceneError(f"{expected}, got {got}")
    changed = []
    for k, (light, intensity) in enumerate(zip(lights, intensities, strict=True)):
        try:
            changed.append(with_strength(light, intensity))
        except SceneError as problem:
            words = str(problem).partition(": ")[2]
            message = f"relight: intensities[{k}]: {words}"
            raise SceneError(message) from None
    return Scene(scene.camera, changed, scene.objects, scene.render, scene.style)


def _check_index(index: int, count: int) -> None:
    """Raise SceneError if there is no object at an index."""
    place = integer_of(index)
    if place is not None and -count <= place < count:
        return
    expected = f"a place from 0 to {count - 1}" if count else "nothing, as there are no objects"
    message = f"recolor: index: expected {expected}, got {index!r}"
    raise SceneError(message)
