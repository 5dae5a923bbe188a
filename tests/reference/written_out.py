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
