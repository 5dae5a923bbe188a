"""Copies written out: each copy of each object as an object of its own, where it stands."""

from typing import Any, NamedTuple

import numpy as np

import vtray


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
    for name in {"center", "start", "end"} & set(columns):
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
