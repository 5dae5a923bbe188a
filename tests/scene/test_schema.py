"""The published JSON Schema."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from vtray.scene.files.schema import scene_schema

ROOT = Path(__file__).parents[2]
CONFORMANCE = ROOT.parent / "shared" / "conformance"
VALIDATOR = jsonschema.Draft202012Validator(scene_schema())
SCENE = """{
  "camera": {"center": {"x": 0, "y": 0, "z": 0}, "normal": {"x": 0, "y": 0, "z": 1},
             "focus": 10, "size": [256, 256.0], "resolution": [0.01, 0.01]},
  "lights": [{"location": {"x": 5, "y": -5, "z": 0}, "intensity": 0}],
  "objects": [
    {"type": "sphere", "center": {"x": 0, "y": 0, "z": 5}, "radius": 0,
     "color": {"r": 255, "g": 255.0, "b": 0}, "lambert": 1},
    {"type": "plane", "center": {"x": 0, "y": 0, "z": 5}, "normal": {"x": 0, "y": 1, "z": 0},
     "color": {"r": 255, "g": 255.0, "b": 0}, "lambert": 1}
  ],
  "note": "unknown keys are allowed"
}"""


def test_file_is_current() -> None:
    printed = subprocess.run(
        [sys.executable, "-m", "vtray.scene.files.schema"], capture_output=True, check=True
    ).stdout
    assert (ROOT / "docs" / "scene.schema.json").read_bytes() == printed
    assert json.loads(printed) == scene_schema()


def test_schema_is_a_schema() -> None:
    VALIDATOR.check_schema(scene_schema())


def test_every_key_is_described() -> None:
    schema = scene_schema()
    for part in [schema, *schema["$defs"].values()]:
        assert part["description"]
        for name, key in part["properties"].items():
            assert name == "type" or key["description"]


@pytest.mark.parametrize("name", ["scene0.json", "scene1.json"])
def test_conformance_scenes_are_valid(name: str) -> None:
    if not CONFORMANCE.is_dir():
        pytest.skip("the conformance scenes are not here")
    VALIDATOR.validate(json.loads((CONFORMANCE / name).read_bytes()))


def test_scene_is_valid() -> None:
    VALIDATOR.validate(json.loads(SCENE))


CHECKER = {"type": "checker"}


def blend_with(pattern: Any) -> dict[str, Any]:
    """Return a blend whose first material has a pattern."""
    return {"type": "blend", "first": {"type": "metal", "pattern": pattern}, "second": "mirror"}


def test_blend_is_valid() -> None:
    scene = json.loads(SCENE)
    scene["objects"][0].update(material={**blend_with(None), "pattern": CHECKER})
    VALIDATOR.validate(scene)


BAD: dict[str, Callable[[Any], Any]] = {
    "no camera": lambda scene: scene.pop("camera"),
    "no type": lambda scene: scene["objects"][0].pop("type"),
    "unknown type": lambda scene: scene["objects"][0].update(type="cube"),
    "sphere as plane": lambda scene: scene["objects"][0].update(type="plane"),
    "color too large": lambda scene: scene["objects"][0]["color"].update(r=256),
    "color not an integer": lambda scene: scene["objects"][0]["color"].update(r=254.5),
    "color a boolean": lambda scene: scene["objects"][0]["color"].update(r=True),
    "color a string": lambda scene: scene["objects"][0]["color"].update(r="255"),
    "negative radius": lambda scene: scene["objects"][0].update(radius=-1),
    "lambert above 1": lambda scene: scene["objects"][0].update(lambert=1.1),
    "negative intensity": lambda scene: scene["lights"][0].update(intensity=-1),
    "no focus": lambda scene: scene["camera"].update(focus=0),
    "no pixels": lambda scene: scene["camera"].update(size=[0, 1]),
    "three sizes": lambda scene: scene["camera"].update(size=[1, 1, 1]),
    "one size": lambda scene: scene["camera"].update(size=[1]),
    "no direction": lambda scene: scene["camera"].update(normal={"x": 0, "y": 0.0, "z": 0}),
    "pattern in a blend": lambda scene: scene["objects"][0].update(material=blend_with(CHECKER)),
    "array of objects": lambda scene: scene.update(objects={}),
}


@pytest.mark.parametrize("spoil", BAD.values(), ids=BAD.keys())
def test_bad_scenes_are_not_valid(spoil: Callable[[Any], Any]) -> None:
    scene = json.loads(SCENE)
    spoil(scene)
    assert not VALIDATOR.is_valid(scene)
