"""Copies written out: each copy of each object as an object of its own, where it stands."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

import vtray

POINTS = ("center", "start", "end")
"""What is moved of an object."""


class Origin(NamedTuple):
    """Where an object that is written out comes from.

    Attributes
    ----------
    place
        The place in the objects of the scene.
    copy, part
        Which copy, and the place among the objects that are copied; None for what is not copied.
    """

    place: int
    copy: int | None = None
    part: int | None = None


def write_out(scene: vtray.Scene) -> tuple[vtray.Scene, list[Origin]]:
    """Return a scene without copies, and where each of its objects comes from."""
    objects: list[Any] = []
    origins: list[Origin] = []
    for place, item in enumerate(scene.objects):
        if not isinstance(item, vtray.Copies):
            objects.append(item)
            origins.append(Origin(place))
            continue
        for copy, way in enumerate(item.at):
            for part, one in enumerate(item.objects):
                objects.append(moved(one, way))
                origins.append(Origin(place, copy, part))
    return vtray.Scene(scene.camera, list(scene.lights), objects, scene.render), origins


def moved(item: Any, way: Any) -> Any:
    """Return an object moved by a translation, (3,): each coordinate is a sum of two doubles."""
    columns = {name: getattr(item, name) for name in item.__struct_fields__}
    for name in set(POINTS) & set(columns):
        columns[name] = moved_points(columns[name], way)
    made = type(item)(**columns)
    # Its colours stand for the same values, in a colour bar.
    return made.with_scale(item.color_scale) if hasattr(item, "color_scale") else made


def moved_points(points: Any, way: Any) -> Any:
    """Return a point, or points, (n, 3), moved by a translation."""
    x, y, z = map(float, way)
    if isinstance(points, vtray.Vector):
        return points.x + x, points.y + y, points.z + z
    return np.asarray(points, np.float64) + np.array([x, y, z])


def written_out(objects: Iterable[Any]) -> list[Any]:
    """Return objects with those of copies in their place, copy by copy."""
    return write_out(vtray.Scene(None, [], list(objects)))[0].objects


def written_out_file(scene: dict[str, Any]) -> dict[str, Any]:
    """Return a scene, as a file says it, with copies written out."""
    objects: list[dict[str, Any]] = []
    places: list[list[int]] = []
    for item in scene["objects"]:
        made = [item]
        if item["type"] == "copies":
            made = [_moved(part, place) for place in item["at"] for part in item["objects"]]
        places.append(list(range(len(objects), len(objects) + len(made))))
        objects += made
    written = {**scene, "objects": objects}
    if "style" in scene:
        cuts = {name: scene["style"][name] for name in ("clip", "slice") if name in scene["style"]}
        written["style"] = scene["style"] | {name: _cut(cut, places) for name, cut in cuts.items()}
    return written


def _cut(cut: Any, places: list[list[int]]) -> Any:
    """Return what cuts objects, as a file says it, that stand at new places."""
    if isinstance(cut, list):
        return [_cut(one, places) for one in cut]
    if "objects" not in cut:
        return cut
    return cut | {"objects": [place for old in cut["objects"] for place in places[old]]}


def _moved(part: dict[str, Any], place: dict[str, float]) -> dict[str, Any]:
    """Return an object, as a file says it, that is moved."""
    names = [name for name in POINTS if name in part]
    return part | {name: {a: part[name][a] + place[a] for a in "xyz"} for name in names}
