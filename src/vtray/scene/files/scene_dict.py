"""Scenes as Python's dictionaries: what a scene file says, with arrays in their places."""

import math
from collections.abc import Mapping
from typing import Any

import msgspec

from vtray.base.errors import SceneError
from vtray.scene.checks.scene_words import Unknown, join, nearest, show
from vtray.scene.files.scene_file import Warn, loads
from vtray.scene.scene import Scene
from vtray.scene.spheres import COLUMNS, Spheres, array_words, from_arrays

_KEYS = ["type", *COLUMNS]
# Stands in the text for spheres whose arrays stand in the dictionary.
_PLACEHOLDER = msgspec.Raw(
    b'{"type":"sphere","center":{"x":0,"y":0,"z":0},"radius":0,"color":{"r":0,"g":0,"b":0},"lambert":0}'
)


def load_dict(data: Mapping[str, Any], name: str = "<dict>", *, warn: Warn | None = None) -> Scene:
    """Make a scene of a dictionary, with the checks and the words of a scene file.

    Parameters
    ----------
    data : dict
        What a scene file says. Numbers may also be NumPy's; in place of an array of the file, there
        may be a tuple or an array of NumPy. Many spheres may hold their arrays themselves:
        ``{"type": "spheres", "center": array, "radius": 0.5, "color": array, "lambert": 1}``, which
        are not copied where `Spheres` does not. Paths are relative to the current folder.
    name : str
        What messages call the dictionary.
    warn : callable, optional
        Called with one line of text for each key or array that the format does not know;
        `warnings.warn` by default.

    Returns
    -------
    Scene
        The validated scene.

    Raises
    ------
    SceneError
        If it is not a valid scene. The message names the place, what is wrong and what would be
        right.
    """
    warnings: list[str] = []
    given = dict(data) if isinstance(data, Mapping) else data
    arrays: dict[int, Mapping[str, Any]] = {}
    if isinstance(given, dict) and isinstance(given.get("objects"), (list, tuple)):
        objects = given["objects"]
        arrays = {index: item for index, item in enumerate(objects) if _has_arrays(item)}
        if arrays:
            given["objects"] = [
                _PLACEHOLDER if index in arrays else item for index, item in enumerate(objects)
            ]
    try:
        text = msgspec.json.encode(given, enc_hook=_as_json)
    except (TypeError, ValueError, OverflowError, RecursionError, UnicodeEncodeError) as error:
        _check(given, "", name)
        raise SceneError(f"{name}: {error}") from None
    try:
        scene = loads(text, name, warn=warnings.append)
    except SceneError:
        # Not a number is null in JSON; say what it was.
        _check(given, "", name)
        raise
    unknown = Unknown("key")
    for index, item in arrays.items():
        scene.objects[index] = _spheres(item, f"objects[{index}]", name, unknown)
    for line in [*warnings, *(f"{name}: {line}" for line in unknown.lines())]:
        if warn is None:
            _warn(line)
        else:
            warn(line)
    return scene


def _has_arrays(item: object) -> bool:
    """Tell whether an object is spheres whose arrays stand in it, not in a file."""
    return isinstance(item, Mapping) and item.get("type") == "spheres" and "data" not in item


def _spheres(item: Mapping[str, Any], place: str, name: str, unknown: Unknown) -> Spheres:
    """Make spheres of the arrays in a dictionary; note the unknown keys."""
    strange = [key for key in item if key not in _KEYS]
    for key in COLUMNS:
        if key not in item:
            close = nearest(key, list(map(str, strange)), cutoff=0.6)
            hint = f" (is {close} meant for it?)" if close else ""
            words = f"missing; expected {array_words(key)}{hint}"
            raise SceneError(f"{name}: {place}.{key}: {words}")
    given = {key: item[key] for key in COLUMNS}
    color = given["color"]
    if isinstance(color, Mapping) and set(color) == {"r", "g", "b"}:
        given["color"] = [color[channel] for channel in "rgb"]
    try:
        spheres = from_arrays(given, f"{place}.")
    except SceneError as problem:
        raise SceneError(f"{name}: {problem}") from None
    for key in strange:
        unknown.add(join(place, str(key)), str(key), _KEYS)
    return spheres


def _warn(message: str) -> None:
    """Warn in the name of the code that called `load_dict`."""
    import warnings

    warnings.warn(message, stacklevel=3)


def _as_json(value: object) -> object:
    """Turn what NumPy makes, and any mapping, into what JSON knows."""
    if isinstance(value, Mapping):
        return dict(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(type(value).__name__)


def _check(value: Any, place: str, name: str) -> None:  # noqa: ANN401
    """Raise SceneError for the first value that JSON has no way to write."""
    found = value.tolist() if hasattr(value, "tolist") else value
    where = f"{name}: {place}" if place else name
    if isinstance(found, Mapping):
        for key, part in found.items():
            if not isinstance(key, str):
                raise SceneError(f"{where}: expected keys that are texts, got {show(key)}")
            _check(part, join(place, key), name)
    elif isinstance(found, (list, tuple)):
        for index, part in enumerate(found):
            _check(part, f"{place}[{index}]", name)
    elif isinstance(found, float) and not math.isfinite(found):
        raise SceneError(f"{where}: expected a finite number, got {found!r}")
    elif isinstance(found, int):
        try:
            float(found)
        except OverflowError:
            words = "a number within the range of a double, up to about 1.8e308"
            raise SceneError(f"{where}: expected {words}, got {show(found)}") from None
    elif not isinstance(found, (float, str, msgspec.Raw, type(None))):
        words = "a number, a text, a list or a dictionary"
        raise SceneError(f"{where}: expected {words}, got {show(found)}")
