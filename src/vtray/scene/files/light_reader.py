"""Reads the lights of a scene file, of which points need not say their type.

A union of types needs the key that tells them apart, so lights are left as they stand while the
rest of the file is decoded, and then read: all at once where all are points or all have a type,
else one by one.
"""

import typing
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

import msgspec

from vtray.scene.files.in_file import LightInFile
from vtray.scene.light_types import Light

_POINTS = msgspec.json.Decoder(list[Light])
_TYPED = msgspec.json.Decoder(list[LightInFile])
_ITEMS = msgspec.json.Decoder(list[msgspec.Raw])
_POINT = msgspec.json.Decoder(Light)
_ANY = msgspec.json.Decoder(LightInFile)


def read_lights(written: msgspec.Raw) -> list[LightInFile]:
    """Read lights from the value of the key `lights`.

    Raises
    ------
    msgspec.MsgspecError
        If they are not right.
    """
    decoders: tuple[msgspec.json.Decoder[Any], ...] = (_POINTS, _TYPED)
    for decoder in decoders:
        try:
            lights: list[LightInFile] = decoder.decode(written)
        except msgspec.ValidationError:
            continue
        return lights
    return [_read_one(bytes(item)) for item in _ITEMS.decode(written)]


def read_light(written: bytes) -> tuple[LightInFile, int]:
    """Read one light, and count the colons of those of its keys that are known.

    Raises
    ------
    msgspec.MsgspecError
        If it is not right.
    """
    light = _read_one(written)
    return light, _count_known(light, msgspec.json.decode(written))


def count_least(lights: Iterable[LightInFile]) -> int:
    """Count the colons of lights of which all keys are left out that may be."""
    return sum(_LEAST[kind] * count for kind, count in Counter(map(type, lights)).items())


def count_known(written: msgspec.Raw, lights: Iterable[LightInFile]) -> int:
    """Count the colons of those keys of lights that are known.

    Where there are more in the file, there are unknown keys, or keys given twice. Gives 0 where
    only a closer look tells.
    """
    try:
        found = msgspec.json.decode(written)
    except msgspec.DecodeError:
        return 0
    return sum(_count_known(light, item) for light, item in zip(lights, found, strict=True))


def _read_one(written: bytes) -> LightInFile:
    """Read one light."""
    try:
        light: LightInFile = _ANY.decode(written)
    except msgspec.ValidationError:
        light = _POINT.decode(written)  # whose type is left out
    return light


def _count_known(light: LightInFile, found: Mapping[str, object]) -> int:
    """Count the colons of those keys of a light, given as it was read, that are known."""
    return ("type" in found) + _count_within(light, found)


def _count_within(value: object, found: object) -> int:
    """Count the colons within a value, given as it was read, but for those of unknown keys."""
    if isinstance(value, str):
        return value.count(":")
    if isinstance(value, tuple) and isinstance(found, list):
        return sum(map(_count_within, value, found))
    if not isinstance(value, msgspec.Struct) or not isinstance(found, Mapping):
        return 0
    known = (key for key in value.__struct_fields__ if key in found)
    return sum(1 + _count_within(getattr(value, key), found[key]) for key in known)


def _keys_of(kind: Any) -> int:  # noqa: ANN401
    """Count the keys of a value of a kind, all of them required."""
    if hasattr(kind, "__metadata__"):
        return _keys_of(kind.__origin__)
    if typing.get_origin(kind) is tuple:
        return sum(map(_keys_of, typing.get_args(kind)))
    return len(kind.__struct_fields__) if isinstance(kind, msgspec.StructMeta) else 0


def _least(kind: type[LightInFile]) -> int:
    """Count the colons of a light of a kind of which all keys are left out that may be."""
    required = [field.type for field in msgspec.structs.fields(kind) if field.required]
    return (kind is not Light) + sum(1 + _keys_of(value) for value in required)


_LEAST = {kind: _least(kind) for kind in typing.get_args(LightInFile)}
