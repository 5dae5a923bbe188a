"""Puts the materials that a scene file names at its top in their places."""

from collections.abc import Mapping
from typing import Any

import msgspec

KEY = b'"materials"'
"""What stands in a file that names materials, and seldom in any other."""


class _Named(msgspec.Struct):
    """A scene file, as far as it names materials."""

    materials: dict[str, msgspec.Raw] = {}


def names_in(raw: bytes) -> frozenset[str]:
    """Return the names of the materials at the top of a file; none if it is not right."""
    try:
        return frozenset(msgspec.json.decode(raw, type=_Named).materials)
    except (msgspec.MsgspecError, RecursionError):
        return frozenset()


def in_their_places(raw: bytes) -> bytes:
    """Return a file that is right with each material where it is named."""
    scene = msgspec.json.decode(raw)
    named = scene.pop("materials")
    scene["objects"] = [with_named(item, named) for item in scene["objects"]]
    return msgspec.json.encode(scene)


def with_named(item: Any, named: Mapping[str, Any]) -> Any:  # noqa: ANN401
    """Return an object as a file says it, and what it holds, with what the names stand for."""
    if not isinstance(item, Mapping):
        return item
    changed = dict(item)
    if "material" in item:
        changed["material"] = _named_by(item["material"], named)
    if isinstance(item.get("objects"), (list, tuple)):
        changed["objects"] = [with_named(part, named) for part in item["objects"]]
    return changed


def _named_by(given: Any, named: Mapping[str, Any]) -> Any:  # noqa: ANN401
    """Return the material of a name, or those of several; anything else as it is."""
    if isinstance(given, (list, tuple)):
        return [_named_by(one, named) for one in given]
    return named.get(given, given) if isinstance(given, str) else given
