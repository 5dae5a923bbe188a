"""Puts the materials that a scene file names at its top in their places."""

from collections.abc import Mapping
from typing import Any

import msgspec

from vtray.scene.files.in_file import NamedMaterials
from vtray.scene.files.pattern_images import PatternImages
from vtray.scene.materials import AnyMaterial

KEY = b'"materials"'
"""What stands in a file that names materials, and seldom in any other."""


class _Named(msgspec.Struct):
    """A scene file, as far as it names materials."""

    materials: NamedMaterials = {}


def names_in(raw: bytes) -> frozenset[str]:
    """Return the names of the materials at the top of a file; none if it is no scene."""
    try:
        found = msgspec.json.decode(raw, type=dict[str, msgspec.Raw]).get("materials", b"{}")
        return frozenset(msgspec.json.decode(found, type=dict[str, msgspec.Raw]))
    except (msgspec.MsgspecError, RecursionError):
        return frozenset()


def in_their_places(raw: bytes, images: PatternImages) -> tuple[bytes, bool]:
    """Put the materials of a file where they are named.

    Parameters
    ----------
    raw
        The file.
    images
        Reads the pictures of their patterns.

    Returns
    -------
    raw : bytes
        The file as it would be without names.
    is_plain : bool
        Whether it says nothing twice, and its materials nothing that the format does not know.

    Raises
    ------
    msgspec.MsgspecError
        If it cannot be done, as something is wrong.
    """
    import json

    scene = msgspec.json.decode(raw)
    is_plain = json.dumps(scene).count(":") == raw.count(b":")
    named = with_parts(scene.pop("materials", {}))
    text = json.dumps({"materials": named}).encode()
    materials = msgspec.json.decode(text, type=_Named, dec_hook=images).materials
    is_plain = is_plain and all(map(_is_known, named.values(), materials.values()))
    if isinstance(scene.get("objects"), list):
        scene["objects"] = [with_named(item, named) for item in scene["objects"]]
    return json.dumps(scene).encode(), is_plain  # which, unlike msgspec, writes all integers


def with_parts(materials: Any) -> Any:  # noqa: ANN401
    """Return the materials of a file with those that blends name in their places."""
    if not isinstance(materials, Mapping):
        return materials
    single = {name: one for name, one in materials.items() if not _is_blend(one)}
    return {
        name: _named_by(one, single) if _is_blend(one) else one for name, one in materials.items()
    }


def _is_blend(given: Any) -> bool:  # noqa: ANN401
    return isinstance(given, Mapping) and given.get("type") == "blend"


def _is_known(given: Any, made: AnyMaterial) -> bool:  # noqa: ANN401
    """Tell whether a material has no key that the format does not know."""
    return isinstance(made, str) or given.keys() <= {"type", *made.__struct_fields__}


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
    """Return the material of a name, or those of several, or of a blend; else what is given."""
    if isinstance(given, (list, tuple)):
        return [_named_by(one, named) for one in given]
    if isinstance(given, Mapping):
        return {
            key: _named_by(one, named) if key in ("first", "second") else one
            for key, one in given.items()
        }
    return named.get(given, given) if isinstance(given, str) else given
