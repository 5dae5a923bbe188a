"""The JSON Schema of the scene file, made from the types of `vtray.scene.files.in_file`.

``python -m vtray.scene.files.schema`` prints it; ``docs/scene.schema.json`` is that output.
"""

import inspect
import json
import re
import sys
import typing
from typing import Any

import msgspec

from vtray.scene.camera import Camera
from vtray.scene.clip import ClipPlane, Slice
from vtray.scene.files.in_file import (
    ARRAYS_IN_FILE,
    KINDS,
    CopiesInFile,
    IntegratorInFile,
    LightInFile,
    SceneInFile,
    SkyInFile,
)
from vtray.scene.lens import Lens
from vtray.scene.light_types import Ambient, Lamp, Light
from vtray.scene.materials import Blend, Material
from vtray.scene.patterns import Pattern
from vtray.scene.pictures.pattern_image import PatternImage
from vtray.scene.settings import RenderSettings
from vtray.scene.sky_types import Gradient
from vtray.scene.style import EyeDome, Fog, Outline, Style
from vtray.scene.vectors import Color, Direction, Vector

_FIELD = re.compile(r"^(\w+(?:, \w+)*) : .*\n((?:    .+\n?)+)", re.MULTILINE)


def scene_schema() -> dict[str, Any]:
    """Make the JSON Schema of the scene file.

    Returns
    -------
    dict
        A schema of draft 2020-12. It checks all that a schema can; that a key is given only
        once, for instance, it cannot.
    """
    style = (Style, Outline, Fog, EyeDome, ClipPlane, Slice)
    materials: tuple[type[msgspec.Struct], ...] = typing.get_args(Material)
    patterns: tuple[type[msgspec.Struct], ...] = typing.get_args(Pattern)
    values: tuple[type[msgspec.Struct], ...]
    values = (RenderSettings, *style, *materials, *patterns, Gradient, Vector, Direction, Color)
    lights: tuple[type[msgspec.Struct], ...] = typing.get_args(LightInFile)
    classes: list[type[msgspec.Struct]] = [
        SceneInFile,
        IntegratorInFile,
        Camera,
        Lens,
        *lights,
        *KINDS,
        *values,
    ]
    (_, parts) = msgspec.json.schema_components(
        classes, schema_hook=_path_schema, ref_template="#/$defs/{name}"
    )
    for cls in classes:
        _describe(parts[cls.__name__], inspect.getdoc(cls) or "")
    # What Direction.__post_init__ checks.
    parts["Direction"]["not"] = {
        "properties": {name: {"const": 0} for name in Direction.__struct_fields__}
    }
    for kind in ARRAYS_IN_FILE:
        if kind.ALONE:  # a file of one array has nothing else
            columns = kind.MADE.COLUMNS
            keys = [k for k in kind.__struct_fields__ if k in columns and not columns[k].stand_in]
            parts[kind.__name__] |= {
                "if": {"properties": {"data": {"pattern": r"\.npy$"}}},
                "then": {"required": keys},
            }
    # What SkyInFile.__post_init__ checks.
    colors = {"required": ["gradient", "image"]}
    either = {name: {"type": "null"} for name in colors["required"]}
    absent = [{"properties": {name: null}} for name, null in either.items()]
    parts[SkyInFile.__name__] |= {"if": colors, "then": {"anyOf": absent}}
    # What Lens.__post_init__ checks, but for the radius.
    focus = {key: {"not": {"type": "null"}} for key in ("focus_distance", "focus_on")}
    parts[Lens.__name__]["oneOf"] = [
        {"properties": {key: kind}, "required": [key]} for key, kind in focus.items()
    ]
    # What CopiesInFile.__post_init__ checks.
    places = [key for key in CopiesInFile.__struct_fields__ if key != "objects"]
    parts[CopiesInFile.__name__]["oneOf"] = [{"required": [key]} for key in places]
    # What lamps check in their __post_init__.
    for lamp in typing.get_args(Lamp):
        strengths = ("intensity", "radiance")
        number = {key: {"type": "number"} for key in strengths}
        parts[lamp.__name__]["not"] = {"properties": number, "required": [*strengths]}
    scene = parts.pop("SceneInFile")
    # A light need not say that it is a point, and so has nothing that always tells its type.
    parts[Light.__name__]["required"].remove("type")
    del scene["properties"]["lights"]["items"]["discriminator"]
    # What Blend.__post_init__ checks.
    patterned = {"pattern": {"not": {"type": "null"}}}
    for key in ("first", "second"):
        parts[Blend.__name__]["properties"][key]["not"] = {
            "type": "object",
            "properties": patterned,
            "required": ["pattern"],
        }
    for part in parts.values():
        # A file may name materials of its own.
        for key in ("material", "first", "second"):
            _allow_names(part["properties"].get(key, {}))
        for one in part["properties"].values():
            if isinstance(one.get("default"), tuple):  # JSON has none
                one["default"] = list(one["default"])
    # JSON has no infinity.
    del parts[Ambient.__name__]["properties"]["distance"]["default"]
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **scene,
        "title": "vtray scene",
        "$defs": parts,
    }


def _path_schema(kind: type) -> dict[str, Any]:
    """Give the schema of a picture of a pattern: that of its path."""
    if not issubclass(kind, PatternImage):
        raise NotImplementedError
    return {"type": "string"}


def _allow_names(kind: dict[str, Any]) -> None:
    """Allow any string where a name of those that are built in, or an array of them, may stand."""
    if kind.pop("enum", None):
        kind["type"] = "string"
    for one in kind.get("anyOf", []):
        _allow_names(one)
    if "items" in kind:
        _allow_names(kind["items"])


def _describe(part: dict[str, Any], doc: str) -> None:
    """Describe a type and its keys in the words of its docstring."""
    part["description"] = doc.partition("\n\n")[0].replace("\n", " ")
    for names, text in _FIELD.findall(doc):
        for name in names.split(", "):
            key = part["properties"][name]
            words = key.get("description")
            text_line = " ".join(text.split())
            key["description"] = f"{text_line} Expected: {words}." if words else text_line


if __name__ == "__main__":
    # Always UTF-8, whatever the terminal speaks.
    text = json.dumps(scene_schema(), indent=2, ensure_ascii=False) + "\n"
    sys.stdout.buffer.write(text.encode())
