"""Reads scene files.

The good path is one msgspec decode and a count of the colons. Everything that explains a
problem is slow, lives in `vtray.scene.checks`, and is imported only then.
"""

import os
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import cache, partial
from typing import Any

import msgspec
from msgspec import UNSET, UnsetType

from vtray.base.caller_warning import warn_caller
from vtray.base.errors import SceneError, why_unreadable
from vtray.base.file_name import file_name
from vtray.base.input_file import is_given, read_input
from vtray.scene.camera import Camera
from vtray.scene.checks.checked import make_unchecked
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.files.in_file import (
    KINDS,
    AnyIntegrator,
    HolderInFile,
    LightInFile,
    ObjectInFile,
    SceneInFile,
    with_integrator,
)
from vtray.scene.files.light_reader import count_known, count_least, read_light, read_lights
from vtray.scene.files.named_materials import KEY as NAMES_MATERIALS
from vtray.scene.files.named_materials import in_their_places, names_in
from vtray.scene.files.pattern_images import PatternImages, without_image
from vtray.scene.files.skies import names_images, with_skies
from vtray.scene.light_types import AnyLight
from vtray.scene.objects import Object
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.scene.style import Style
from vtray.scene.vectors import Direction, Vector

Warn = Callable[[str], None]


class _Found(msgspec.Struct):
    """What a scene file holds, its lights as they stand there."""

    camera: Camera
    lights: msgspec.Raw
    objects: list[ObjectInFile]
    render: RenderSettings | UnsetType = UNSET
    style: Style | UnsetType = UNSET
    integrator: AnyIntegrator | UnsetType = UNSET


_BYTE_ORDER_MARK = b"\xef\xbb\xbf"


@explain_unknown
def load(path: str | os.PathLike[str], *, warn: Warn | None = None) -> Scene:
    """Read a scene file, and the files of arrays that it names.

    Parameters
    ----------
    path : str or path
        The file, JSON in UTF-8. Paths in it are relative to its folder, or, if it is a pipe such as
        ``/dev/stdin``, to the current one.
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
        If the file cannot be read or is not a valid scene. The message names the file, the
        place, what is wrong and what would be right.
    """
    name = file_name(path, SceneError)
    try:
        raw = read_input(path)
    except (OSError, ValueError, MemoryError) as error:
        raise SceneError(f"{name}: {why_unreadable(error, 'scene file')}") from None
    folder = "" if is_given(path) else os.path.dirname(name)
    try:
        return loads_bytes(raw, name, PatternImages(folder), folder, warn or warn_caller)
    except SceneError:
        if not begins_as_scene(raw) and _is_data(name):
            problem = "is data, which vtray.read reads; expected a scene file"
            raise SceneError(f"{name}: {problem}") from None
        raise


def begins_as_scene(raw: bytes) -> bool:
    """Tell whether a file begins as those of scenes do."""
    return raw.lstrip().startswith((b"{", _BYTE_ORDER_MARK))


def _is_data(name: str) -> bool:
    """Tell whether a file is one of particles."""
    from vtray.scene.readers.reader_table import is_data

    return is_data(name)


@explain_unknown
def loads(text: str | bytes, name: str = "<string>", *, warn: Warn | None = None) -> Scene:
    """Read a scene from JSON text.

    Parameters
    ----------
    text : str or bytes
        The JSON, in UTF-8 if bytes. Paths in it are relative to the current folder.
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
    given: object = text
    if not isinstance(given, (str, bytes)):
        got = f"got {type(given).__name__} (vtray.load reads a file, vtray.load_dict a dictionary)"
        raise SceneError(f"{name}: expected the text of a scene, as str or bytes, {got}")
    if isinstance(text, bytes):
        return loads_bytes(text, name, PatternImages(""), "", warn or warn_caller)
    try:
        raw = text.encode()
    except UnicodeEncodeError as error:
        line = text.count("\n", 0, error.start) + 1
        problem = f"half of a surrogate pair stands alone in line {line}; expected whole characters"
        raise SceneError(f"{name}: {problem}") from None
    return loads_bytes(raw, name, PatternImages(""), "", warn or warn_caller)


def loads_bytes(raw: bytes, name: str, images: PatternImages, folder: str, warn: Warn) -> Scene:
    """Read a scene from JSON in UTF-8.

    Parameters
    ----------
    raw, name
        The JSON, and what messages call it.
    images
        Reads the pictures of patterns.
    folder
        What other paths are relative to.
    warn
        As for `load`.
    """
    if not raw.isascii():
        _check_utf8(raw, name)
        raw = raw.removeprefix(_BYTE_ORDER_MARK)
    text, is_plain = raw, True
    try:
        if NAMES_MATERIALS in raw:
            text, is_plain = in_their_places(raw, images)
        found = msgspec.json.Decoder(_Found, dec_hook=images).decode(text)
        lights = read_lights(found.lights)
    except (msgspec.MsgspecError, RecursionError) as error:
        _explain(raw, name, images, warn)
        # The slow look should have raised; if it saw nothing, msgspec's own words have to do.
        raise SceneError(f"{name}: {error}") from None
    keys, in_files = _count_keys(
        found.objects, has_more=b'"opacity"' in text or b'"material"' in text
    )
    others = text.count(b":") - _count_others(found) - keys
    # A colon of a path that is written as an escape is not in the file, and one inside any other
    # string is that of an unknown key or its value.
    are_known = others == count_least(lights) or others == count_known(found.lights, lights)
    has_paths = in_files or names_images(lights)
    if not is_plain or not are_known or (has_paths and b"\\u003" in raw):
        _explain(raw, name, images, warn)
    objects: list[Any] = found.objects
    if in_files:
        objects = _read_arrays(found, name, folder, warn)
    made = _read_skies(lights, name, folder)
    try:
        render = with_integrator(found.render, found.integrator)
    except SceneError as problem:
        raise SceneError(f"{name}: {problem}") from None
    parts = {"render": render, "style": found.style}
    parts = {key: value for key, value in parts.items() if value is not UNSET}
    scene: Scene = make_unchecked(Scene, camera=found.camera, lights=made, objects=objects, **parts)
    return scene


def _check_utf8(raw: bytes, name: str) -> None:
    try:
        raw.decode()
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        problem = f"line {line}, byte {error.start} of the file: not UTF-8; expected UTF-8 text"
        raise SceneError(f"{name}: {problem}") from None


@cache
def _keys(*classes: type[msgspec.Struct]) -> int:
    """Count the keys of objects of a file, their tags included."""
    fields = sum(len(cls.__struct_fields__) for cls in classes)
    return fields + sum(cls.__struct_config__.tag is not None for cls in classes)


# The required keys that a file has once.
_KEYS_ONCE = 3 + 5 + _keys(Vector, Direction)


def _keys_within(cls: type[msgspec.Struct]) -> int:
    """Count the keys that an object of a file must have, and of what it holds, its tag included."""
    parts = [kind for kind in cls.__annotations__.values() if isinstance(kind, msgspec.StructMeta)]
    return _keys(cls, *parts) - len(cls.__struct_defaults__)


# Those of other kinds are counted one by one, as most are optional.
_KEYS_OF = {kind: _keys_within(kind) for kind in KINDS if not issubclass(kind, HolderInFile)}


def _count_keys(objects: Sequence[Any], *, has_more: bool = True) -> tuple[int, bool]:
    """Count the colons of objects of a file, and tell whether any may name a file."""
    kinds = Counter(map(type, objects))
    keys = sum(_KEYS_OF.get(kind, 0) * count for kind, count in kinds.items())
    if has_more:
        keys += sum(_count_optional(item) for item in objects if type(item) in _KEYS_OF)
    in_files = any(issubclass(kind, HolderInFile) for kind in kinds)
    if in_files:
        keys += sum(_count_colons(item) for item in objects if isinstance(item, HolderInFile))
    return keys, in_files


def _count_optional(item: Any) -> int:  # noqa: ANN401
    """Count the optional keys of a single object; one that is given with its default is not."""
    keys = int(item.opacity != 1.0)
    if item.material != "lambert":
        keys += 1 + _colons_in(msgspec.to_builtins(item.material, enc_hook=without_image))
    return keys


def _count_others(found: _Found) -> int:
    """Count the colons of a file but for those of its lights and objects.

    Of the optional keys those that are given with their default are not counted. With such a key
    there are more colons, which costs a slow look, but misses nothing.
    """
    camera = found.camera
    keys = (camera.projection != "perspective") + (camera.up is not None) * (1 + _keys(Direction))
    if camera.lens is not None:
        keys += 1 + _colons_in(msgspec.to_builtins(camera.lens))
    for value in (found.render, found.style, found.integrator):
        if value is not UNSET:
            keys += 1 + _colons_in(msgspec.to_builtins(value))
    return _KEYS_ONCE + keys


def _count_colons(item: msgspec.Struct) -> int:
    """Count the colons of an object of a file: those of its keys, and of a path."""
    if type(item) in _KEYS_OF:
        return _KEYS_OF[type(item)] + _count_optional(item)
    values = [getattr(item, key) for key in item.__struct_fields__]
    tag = 1
    return tag + sum(1 + _count_within(value) for value in values if value is not UNSET)


def _count_within(value: object) -> int:
    """Count the colons of the value of a key of an object that may name a file."""
    if isinstance(value, list):
        is_place = bool(value) and isinstance(value[0], Vector)
        return len(value) * _keys(Vector) if is_place else _count_keys(value)[0]
    if isinstance(value, tuple):
        return sum(map(_count_within, value))
    if isinstance(value, msgspec.Struct):
        return _colons_in(msgspec.to_builtins(value, enc_hook=without_image))
    return value.count(":") if isinstance(value, str) else 0


class _Split(msgspec.Struct):
    """A scene whose lists are left as they stand in the file."""

    lights: msgspec.Raw = msgspec.Raw(b"[]")
    objects: msgspec.Raw = msgspec.Raw(b"[]")


def _explain(raw: bytes, name: str, images: PatternImages, warn: Warn) -> None:
    """Look for what is wrong, slowly: raise SceneError, or warn about unknown keys."""
    from vtray.scene.checks.json_tree import JsonTree
    from vtray.scene.checks.scene_check import FileChecker

    if not raw.strip():
        problem = (
            "the file is empty; expected a JSON object with the keys camera, lights and objects"
        )
        raise SceneError(f"{name}: {problem}")
    try:
        names = names_in(raw)
        # What names a material of the file looks wrong to who does not know the name.
        clean, ignored = ({}, 0) if names else _clean_parts(raw, images)
        tree = JsonTree(raw, clean, SceneInFile.__struct_fields__)
        checker = FileChecker(tree.line, ignored, names, images)
        checker.check(tree.read(), SceneInFile)
    except SceneError as problem:
        raise SceneError(f"{name}: {problem}") from None
    except RecursionError:
        raise SceneError(f"{name}: nested too deeply; a scene needs 4 levels") from None
    for line in checker.unknown.lines():
        warn(f"{name}: {line}")


def _read_arrays(found: _Found, name: str, folder: str, warn: Warn) -> list[Object]:
    """Return the objects of a file with the arrays it names; warn about unknown arrays."""
    from vtray.scene.files.named_arrays import with_arrays

    try:
        objects, unknown = with_arrays(found.objects, folder)
    except SceneError as problem:
        raise SceneError(f"{name}: {problem}") from None
    for line in unknown:
        warn(f"{name}: {line}")
    return objects


def _read_skies(lights: Sequence[LightInFile], name: str, folder: str) -> list[AnyLight]:
    """Return the lights of a file with the pictures of skies that it names."""
    try:
        return with_skies(lights, folder)
    except SceneError as problem:
        raise SceneError(f"{name}: {problem}") from None


def _clean_parts(raw: bytes, images: PatternImages) -> tuple[dict[int, int] | None, int]:
    """Find the lights and objects that need not be read, so that a million of them cost little.

    They are right; or so are they but for unknown keys, after enough others of which there will be
    warnings; or they come after one that is wrong, and so after the error.

    Returns
    -------
    clean : dict of int to int or None
        Their first and end offsets; None if the syntax is broken.
    ignored : int
        How many unknown keys are in them.
    """
    from vtray.scene.checks.scene_words import SHOWN_UNKNOWN

    try:
        split = msgspec.json.decode(raw, type=_Split)
    except msgspec.ValidationError:
        return {}, 0
    except (msgspec.DecodeError, RecursionError):
        return None, 0
    clean: dict[int, int] = {}
    ignored = 0
    readers: tuple[tuple[str, Callable[[bytes], tuple[msgspec.Struct, int]]], ...]
    decoder = msgspec.json.Decoder(ObjectInFile, dec_hook=images)
    readers = (("lights", read_light), ("objects", partial(_read_object, decoder)))
    for key, read in readers:
        whole = getattr(split, key)
        end = max(raw.find(whole), 0)
        is_wrong = False
        shown = 0
        for part in _split_list(whole):
            start = raw.find(part, end)
            end = start + len(part)
            if not is_wrong:
                try:
                    value, keys = read(part)
                except (msgspec.MsgspecError, RecursionError):
                    is_wrong = True
                    continue
                in_files = isinstance(value, HolderInFile)
                if part.count(b":") != keys or (in_files and b"\\u003" in part):
                    is_shown = in_files or shown < SHOWN_UNKNOWN
                    unknown = 0 if is_shown else _count_unknown(part, value)
                    if not unknown:
                        shown += 1
                        continue
                    ignored += unknown
            clean[start] = end
    return clean, ignored


def _read_object(
    decoder: msgspec.json.Decoder[ObjectInFile], part: bytes
) -> tuple[msgspec.Struct, int]:
    """Read an object, and count the colons that it has if all its keys are known."""
    value = decoder.decode(part)
    return value, _count_colons(value)


def _count_unknown(part: bytes, value: msgspec.Struct) -> int:
    """Count the unknown keys of a light or an object that is right but for them, as it was read.

    Gives 0 where a closer look is needed, as a key may be given twice.
    """
    try:
        found = msgspec.json.decode(part)
        colons = part.count(b":")
        # Most have no objects within objects, and no colon in a text.
        keys = len(found) + sum(len(value) for value in found.values() if type(value) is dict)
        # A colon that is written as an escape is not in the file.
        if keys != colons and (_colons_in(found) != colons or b"\\u003" in part):
            return 0
    except (msgspec.MsgspecError, RecursionError):
        return 0
    pairs: list[tuple[Any, Any]] = [(found, value)]
    for key in value.__struct_fields__:
        one, two = found.get(key), getattr(value, key)
        pairs += zip(one, two, strict=True) if isinstance(two, tuple) else [(one, two)]
    objects: list[tuple[dict[str, Any], type[msgspec.Struct]]]
    objects = [(one, type(two)) for one, two in pairs if isinstance(two, msgspec.Struct) and one]
    return sum(len(one.keys() - _known_keys(kind)) for one, kind in objects)


@cache
def _known_keys(cls: type[msgspec.Struct]) -> frozenset[str]:
    """Give the keys that an object of a file may have."""
    return frozenset([*cls.__struct_fields__, cls.__struct_config__.tag_field or ""])


def _colons_in(found: object) -> int:
    """Count the colons of a value of JSON: one for each key, and those in texts."""
    if isinstance(found, dict):
        return len(found) + sum(map(_colons_in, found)) + sum(map(_colons_in, found.values()))
    if isinstance(found, list):
        return sum(map(_colons_in, found))
    return found.count(":") if isinstance(found, str) else 0


def _split_list(raw: msgspec.Raw) -> Iterator[bytes]:
    """Give the items of an array as they stand in the file; none if it is not an array."""
    try:
        return map(bytes, msgspec.json.decode(raw, type=list[msgspec.Raw]))
    except msgspec.ValidationError:
        return iter(())
