"""The colours of many objects: one, one for each, or values that a colour map turns into them."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.scene.checks.given_array import (
    RED_GREEN_BLUE,
    UNCONVERTED,
    converted,
    is_masked,
    remedy_for,
    show_array,
    show_shape,
)
from vtray.scene.checks.object_column import without_objects
from vtray.scene.checks.scene_words import show
from vtray.scene.colors.color_scale import ColorScale, scale_of
from vtray.scene.colors.names import ALPHA, WORDS, Rgb, ambiguous, to_rgb
from vtray.scene.vectors import Color

if TYPE_CHECKING:
    from vtray.scene.colors.color_scale import ColorMap, Norm
    from vtray.scene.colors.names import AnyColor

Bytes = NDArray[np.uint8]

_VALUE = ("value",)

ONE_COLOR = ((3,), (4,))
"""Shapes of numbers that are one colour, the second with the alpha that none has."""


def color_arrays(
    given: Mapping[str, Any],
    count: int,
    place: str,
    *,
    each: str = "position",
    cmap: "ColorMap | None",
    clim: object,
    nan_color: "AnyColor",
    norm: "Norm | None" = None,
) -> tuple[dict[str, Bytes], ColorScale | None]:
    """Return the colours of `count` objects.

    Parameters
    ----------
    given
        By the name of an argument, without `cmap`: a colour as `vtray.colors.to_rgb` takes it, a
        list of such, or numbers of shape (count, 3). With `cmap`: numbers of shape (count,).
    count
        How many objects there are.
    place
        What messages begin with, right before the name of an argument.
    each
        What one object is called in messages.
    cmap, clim, nan_color
        As for `Scene.add_spheres`; all arguments share the limits of the map.
    norm
        "linear", "log" or "centered", as for `scale_of`.

    Returns
    -------
    colors : dict of array
        By the same names: uint8, (count, 3), or (3,) for one colour.
    scale : ColorScale or None
        How values became colours, if they did.

    Raises
    ------
    SceneError
        If an argument is not right.
    """
    if cmap is not None:
        values = {
            name: _values(item, count, f"{place}{name}", each) for name, item in given.items()
        }
        together = np.concatenate(list(values.values()))
        scale = scale_of(together, cmap, clim, nan_color, place, norm)
        return {name: scale.colors(numbers) for name, numbers in values.items()}, scale
    if clim is not None:
        hint = 'give a colour map too, for instance cmap="viridis"'
        raise SceneError(f"{place}clim: expected None without cmap, got {show(clim)}; {hint}")
    return {
        name: _colors(item, count, f"{place}{name}", each) for name, item in given.items()
    }, None


def _values(given: Any, count: int, place: str, each: str) -> NDArray[np.float64]:  # noqa: ANN401
    """Return the numbers that a colour map is for, as doubles; what is masked is NaN."""
    words = f"with cmap: expected numbers of shape ({count},), one for each {each}"
    masked = isinstance(given, np.ma.MaskedArray)
    try:
        array = without_objects(converted(given.data if masked else given))
        values = np.array(array, np.float64) if array.dtype.kind in "biuf" else None
    except UNCONVERTED:
        values = None
    if values is None:
        got = show_array(given)
        raise SceneError(f"{place}: {words}, got {got}{remedy_for(given, _VALUE)}")
    if values.shape != (count,):
        got = show_shape(given, values.shape)
        raise SceneError(f"{place}: {words}, got {got}{remedy_for(given, _VALUE)}")
    if masked:
        values[np.ma.getmaskarray(given)] = np.nan
    return values


def _colors(given: Any, count: int, place: str, each: str) -> Bytes:  # noqa: ANN401
    """Return one colour or one for each object."""
    if isinstance(given, (str, Color)):
        return np.array(to_rgb(given, place), np.uint8)
    if isinstance(given, (list, tuple)) and any(isinstance(item, (str, Color)) for item in given):
        return _listed(given, count, place, each)
    try:
        array = converted(given, RED_GREEN_BLUE)
    except UNCONVERTED:
        # Rows of different length, or of integers too large.
        if isinstance(given, (list, tuple)):
            return _listed(given, count, place, each)
        raise _no_colors(given, place) from None
    if array.dtype.kind in "OUT" and array.ndim == 1 and not is_masked(given):
        return _listed(array.tolist(), count, place, each)
    return _numbers(given, array, count, place)


def _numbers(given: Any, array: NDArray[Any], count: int, place: str) -> Bytes:  # noqa: ANN401
    """Return colours that are an array of numbers."""
    if array.dtype.kind not in "iuf" or is_masked(given):
        raise _no_colors(given, place)
    if array.shape in ONE_COLOR:
        return np.array(to_rgb(given if isinstance(given, (list, tuple)) else array, place), "u1")
    if array.shape == (0,) and count == 0:
        return np.zeros((0, 3), np.uint8)
    if array.shape != (count, 3):
        raise SceneError(f"{place}: {_wrong_shape(given, array.shape, count)}")
    return _rows(array, place)


def _no_colors(given: object, place: str) -> SceneError:
    """Give the error for what is neither a colour nor colours."""
    got = show_array(given)
    return SceneError(f"{place}: expected {WORDS}, got {got}{remedy_for(given, RED_GREEN_BLUE)}")


def _wrong_shape(given: object, shape: tuple[int, ...], count: int) -> str:
    """Say what is wrong with the shape of colours."""
    if shape == (count, 4):
        remedy = remedy_for(given, RED_GREEN_BLUE) or "; give color[:, :3]"
        return f"{ALPHA}, got {show_shape(given, shape)}{remedy}"
    words = f"expected one colour, or numbers of shape ({count}, 3)"
    words = f"{words}, got {show_shape(given, shape)}{remedy_for(given, RED_GREEN_BLUE)}"
    if shape == (count,):
        return f'{words}; to colour by values, give a colour map too, for instance cmap="viridis"'
    return words


def _listed(items: Any, count: int, place: str, each: str) -> Bytes:  # noqa: ANN401
    """Return colours of which each may be written in another way."""
    if len(items) != count:
        words = f"one colour, or {count}, one for each {each}"
        raise SceneError(f"{place}: expected {words}, got {len(items)}")
    # The same name often stands for many.
    numbers: dict[str, int] = {}
    palette: list[Rgb] = []
    picked = np.empty(count, np.intp)
    for index, item in enumerate(items):
        number = numbers.get(item) if isinstance(item, str) else None
        if number is None:
            number = len(palette)
            palette.append(to_rgb(item, f"{place}[{index}]"))
            if isinstance(item, str):
                numbers[item] = number
        picked[index] = number
    return np.array(palette, np.uint8).reshape(-1, 3)[picked]


def _rows(array: NDArray[Any], place: str) -> Bytes:
    """Return numbers of shape (n, 3) as bytes: integers as they are, floats times 255."""
    if array.dtype == np.uint8 or array.size == 0:
        return array.astype(np.uint8, copy=False)
    is_float = array.dtype.kind == "f"
    low, high = array.min(), array.max()
    # Not the other way round, so that NaN is wrong.
    if not (low >= 0 and high <= (1 if is_float else 255)):
        wrong = ~((array >= 0) & (array <= (1 if is_float else 255)))
        row = int(np.flatnonzero(wrong.any(axis=1))[0])
        to_rgb(array[row], f"{place}[{row}]")  # which raises
    if is_float:
        return np.floor(array * 255.0 + 0.5).astype(np.uint8)
    if high == 1:
        row = int(np.flatnonzero((array == 1).any(axis=1))[0])
        raise SceneError(f"{place}[{row}]: {ambiguous(array[row].tolist())}")
    return array.astype(np.uint8)
