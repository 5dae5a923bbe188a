"""Copies written out: what they stand for, object by object and place by place."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from vtray.scene.copies import Copies, Part

POINTS = ("center", "start", "end")


def written_out(objects: Iterable[Any]) -> list[Any]:
    """Return objects with those of copies in their place, copy by copy."""
    found: list[Any] = []
    for item in objects:
        if isinstance(item, Copies):
            places = item.at.astype(np.float64)
            found += [moved(part, place) for place in places for part in item.objects]
        else:
            found.append(item)
    return found


def moved(part: Part, place: np.ndarray) -> Part:
    """Return an object moved by three doubles: each sum is rounded to a double."""
    points: dict[str, Any] = {}
    for name in POINTS:
        given = getattr(part, name, None)
        if hasattr(given, "x"):
            given = np.array([given.x, given.y, given.z])
        if given is not None:
            points[name] = given.astype(np.float64) + place
    return part.replace(**points)


def written_out_file(scene: dict[str, Any]) -> dict[str, Any]:
    """Return a scene, as a file says it, with copies written out."""
    objects = []
    for item in scene["objects"]:
        if item["type"] == "copies":
            objects += [_moved(part, place) for place in item["at"] for part in item["objects"]]
        else:
            objects.append(item)
    return {**scene, "objects": objects}


def _moved(part: dict[str, Any], place: dict[str, float]) -> dict[str, Any]:
    """Return an object, as a file says it, that is moved."""
    names = [name for name in POINTS if name in part]
    return part | {name: {a: part[name][a] + place[a] for a in "xyz"} for name in names}
