"""A valid scene as text, and ways to spoil it."""

import json
import re
from typing import Any

import pytest

from vtray.base.errors import SceneError
from vtray.scene.files.scene_file import loads
from vtray.scene.scene import Scene

TEXT = """{
  "camera": {
    "center": {"x": 0, "y": 0, "z": 0},
    "normal": {"x": 0, "y": 0, "z": 1},
    "focus": 10,
    "size": [256, 128],
    "resolution": [0.01, 0.02]
  },
  "lights": [{"location": {"x": 5, "y": -5, "z": 0}, "intensity": 1}],
  "objects": [
    {"type": "sphere", "center": {"x": 0, "y": 0, "z": 5}, "radius": 1,
     "color": {"r": 255, "g": 0, "b": 0}, "lambert": 1},
    {"type": "plane", "center": {"x": 0, "y": 5, "z": 0}, "normal": {"x": 0, "y": -1, "z": 0},
     "color": {"r": 1, "g": 2, "b": 3}, "lambert": 0.5}
  ]
}
"""
ABSENT = object()


def refuse(warning: str) -> None:
    """Turn a warning into a failure of the test."""
    raise AssertionError(warning)


def read(text: str | bytes) -> Scene:
    """Read a scene that must give no warning."""
    return loads(text, "room.json", warn=refuse)


def message_of(text: str | bytes) -> str:
    """Give the error for a text, without the file's name, which must lead it."""
    with pytest.raises(SceneError) as caught:
        read(text)
    name, message = str(caught.value).split(": ", 1)
    assert name == "room.json"
    return message


def replaced(old: str, new: str) -> str:
    """Give the valid text with the first occurrence of a part replaced."""
    assert old in TEXT
    return TEXT.replace(old, new, 1)


def changed(values: dict[str, object]) -> Any:
    """Give the valid scene as Python data, with values put at places such as objects[1].type."""
    data = json.loads(TEXT)
    for place, value in values.items():
        *steps, last = [
            int(number) if number else key
            for key, number in re.findall(r"([a-z]+)|\[(\d+)\]", place)
        ]
        inner = data
        for step in steps:
            inner = inner[step]
        if value is ABSENT:
            del inner[last]
        else:
            inner[last] = value
    return data
