"""Reads scene files.

The good path is one msgspec decode and a count of the colons. Everything that explains a
problem is slow, lives in `vtray.json_tree` and `vtray.scene_check`, and is imported only then.
"""

import os
import re
from collections import Counter
from collections.abc import Callable, Iterator

import msgspec

from vtray.errors import SceneError
from vtray.scene import Camera, Color, Direction, Light, Plane, Scene, Sphere, Vector

Warn = Callable[[str], None]

_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_MAX_WARNINGS = 20
_DECODER = msgspec.json.Decoder(Scene)
_ITEM = re.compile(r" - at `\$\.(lights|objects)\[(\d+)\][^`]*`$")


def load(path: str | os.PathLike[str], *, warn: Warn | None = None) -> Scene:
    """Read a scene file.

    Parameters
    ----------
    path : str or path
        The file, JSON in UTF-8.
    warn : callable, optional
        Called with one line of text for each key that the format does not know;
        `warnings.warn` by default.

    Returns
    -------
    Scene
        The validated scene.

    Raises
    ------
    SceneError
        If the file cannot be read or is not a valid scene. The message names the file, the
        place, what is wrong and what would be right.
    """
    name = os.fsdecode(path)
    try:
        with open(path, "rb") as file:
            raw = file.read()
    except IsADirectoryError:
        problem = "is a directory; expected a scene file"
    except FileNotFoundError:
        problem = "no such file; expected a scene file"
    except PermissionError:
        problem = "may not be read: permission denied; expected a readable scene file"
    except MemoryError:
        problem = "is too large to hold in memory"
    except (OSError, ValueError) as error:
        problem = f"cannot be read: {getattr(error, 'strerror', None) or error}"
    else:
        return _loads(raw, name, warn or _warn)
    raise SceneError(f"{name}: {problem}")


def loads(text: str | bytes, name: str = "<string>", *, warn: Warn | None = None) -> Scene:
    """Read a scene from JSON text.

    Parameters
    ----------
    text : str or bytes
        The JSON, in UTF-8 if bytes.
    name : str
        What messages call the text.
    warn : callable, optional
        As for `load`.

    Returns
    -------
    Scene
        The validated scene.

    Raises
    ------
    SceneError
        As for `load`.
    """
    if isinstance(text, bytes):
        return _loads(text, name, warn or _warn)
    try:
        raw = text.encode()
    except UnicodeEncodeError as error:
        line = text.count("\n", 0, error.start) + 1
        problem = f"half of a surrogate pair stands alone in line {line}; expected whole characters"
        raise SceneError(f"{name}: {problem}") from None
    return _loads(raw, name, warn or _warn)


def _loads(raw: bytes, name: str, warn: Warn) -> Scene:
    if not raw.isascii():
        _check_utf8(raw, name)
        raw = raw.removeprefix(_BYTE_ORDER_MARK)
    try:
        scene = _DECODER.decode(raw)
    except (msgspec.MsgspecError, RecursionError) as error:
        _explain(raw, name, str(error), warn)
        # The slow look should have raised; if it saw nothing, msgspec's own words have to do.
        raise SceneError(f"{name}: {error}") from None
    # Every key is required, so more colons than keys mean an unknown or a repeated one.
    # A colon inside a string is always such a case, as no key or value of a scene has one.
    if raw.count(b":") != _count_keys(scene):
        _explain(raw, name, "", warn)
    return scene


def _check_utf8(raw: bytes, name: str) -> None:
    try:
        raw.decode()
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        problem = f"line {line}, byte {error.start} of the file: not UTF-8; expected UTF-8 text"
        raise SceneError(f"{name}: {problem}") from None


def _keys(*classes: type[msgspec.Struct]) -> int:
    """Count the keys of objects of a file, their tags included."""
    fields = sum(len(cls.__struct_fields__) for cls in classes)
    return fields + sum(cls.__struct_config__.tag is not None for cls in classes)


_KEYS_ONCE = _keys(Scene, Camera, Vector, Direction)
_KEYS_OF: dict[type[msgspec.Struct], int] = {
    Light: _keys(Light, Vector),
    Sphere: _keys(Sphere, Vector, Color),
    Plane: _keys(Plane, Vector, Direction, Color),
}


def _count_keys(scene: Scene) -> int:
    """Count the keys that the file of a scene must have."""
    kinds = Counter(map(type, scene.lights)) + Counter(map(type, scene.objects))
    return _KEYS_ONCE + sum(_KEYS_OF[kind] * count for kind, count in kinds.items())


class _Split(msgspec.Struct):
    """A scene whose lists are left as they stand in the file."""

    lights: msgspec.Raw = msgspec.Raw(b"[]")
    objects: msgspec.Raw = msgspec.Raw(b"[]")


def _explain(raw: bytes, name: str, error: str, warn: Warn) -> None:
    """Look for what is wrong, slowly: raise SceneError, or warn about unknown keys."""
    from vtray.json_tree import JsonTree
    from vtray.scene_check import FileChecker

    if not raw.strip():
        problem = (
            "the file is empty; expected a JSON object with the keys camera, lights and objects"
        )
        raise SceneError(f"{name}: {problem}")
    try:
        tree = JsonTree(raw, _clean_parts(raw, error))
        checker = FileChecker(tree.line)
        checker.check(tree.read(), Scene)
    except SceneError as problem:
        raise SceneError(f"{name}: {problem}") from None
    except RecursionError:
        raise SceneError(f"{name}: nested too deeply; a scene needs 4 levels") from None
    for unknown in checker.unknown[:_MAX_WARNINGS]:
        warn(f"{name}: {unknown}")
    more = len(checker.unknown) - _MAX_WARNINGS
    if more > 0:
        warn(f"{name}: {more} more unknown keys, ignored")


def _warn(message: str) -> None:
    """Warn in the name of the code that called `load` or `loads`."""
    import warnings

    warnings.warn(message, stacklevel=5)


def _clean_parts(raw: bytes, error: str) -> dict[int, int] | None:
    """Find the lights and objects that are right, so that a million of them cost little.

    Gives their first and end offsets; None if the syntax is broken.
    """
    try:
        split = msgspec.json.decode(raw, type=_Split)
    except msgspec.ValidationError:
        return {}
    except (msgspec.DecodeError, RecursionError):
        return None
    # What stands after the first error was not looked at, nor will it be.
    item = _ITEM.search(error)
    wrong = (item[1], int(item[2])) if item else None
    clean: dict[int, int] = {}
    light_counts, object_counts = {_KEYS_OF[Light]}, {_KEYS_OF[Sphere], _KEYS_OF[Plane]}
    for key, counts in (("lights", light_counts), ("objects", object_counts)):
        end = 0
        for index, part in enumerate(_split_list(getattr(split, key))):
            start = raw.find(part, end)
            end = start + len(part)
            if part.count(b":") in counts and (key, index) != wrong:
                clean[start] = end
    return clean


def _split_list(raw: msgspec.Raw) -> Iterator[bytes]:
    """Give the items of an array as they stand in the file; none if it is not an array."""
    try:
        return map(bytes, msgspec.json.decode(raw, type=list[msgspec.Raw]))
    except msgspec.ValidationError:
        return iter(())
