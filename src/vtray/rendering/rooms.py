"""What the clip planes of a style leave of a scene, in numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import RenderError, SceneError
from vtray.geometry.shapes.columns import Columns
from vtray.scene.clip import ClipPlane, Slice
from vtray.scene.objects import Plane
from vtray.scene.placing.bounds import balls_of, middle_of
from vtray.scene.placing.directions import Vec, along, camera_axes, dot, unit
from vtray.scene.scene import Scene
from vtray.scene.style import Style
from vtray.scene.vectors import Color

Floats = NDArray[np.float64]
Wall = tuple[float, float, float, float, float, float]
"""A plane around a room: a point of it, and the unit normal that points out of the room."""

TOUCHING = 1e-9
"""How far beyond a wall a point still counts as left, in parts of the largest coordinate."""


@dataclass(frozen=True)
class Rooms:
    """The rooms that clip planes leave to objects.

    Attributes
    ----------
    walls
        The planes of each room; none for one that is everything.
    of
        The room of each object of a scene; empty if all have the first.
    is_capped
        Whether what is cut is closed.
    color
        The colour of what closes it; None for that of what is cut.
    """

    walls: tuple[tuple[Wall, ...], ...]
    of: tuple[int, ...]
    is_capped: bool
    color: Color | None

    @property
    def planes(self) -> Columns:
        """The planes of all rooms, as columns of the kernels."""
        rows = np.array([wall for walls in self.walls for wall in walls], np.float64)
        return Columns(rows.reshape(-1), np.arange(len(rows), dtype=np.int32))

    @property
    def begin(self) -> NDArray[np.int64]:
        """The first plane of each room, and after all the end."""
        return np.cumsum([0, *map(len, self.walls)])

    @property
    def largest(self) -> float:
        """The largest coordinate of a point of a plane."""
        return max(abs(number) for walls in self.walls for wall in walls for number in wall[:3])

    def room_of(self, place: int) -> int:
        """Return the room of the object in a place."""
        return self.of[place] if self.of else 0

    def walls_of(self, place: int) -> tuple[Wall, ...]:
        """Return the planes around the room of the object in a place."""
        return self.walls[self.room_of(place)]


def rooms_of(style: Style, scene: Scene) -> Rooms | None:
    """Return the rooms of a style, None where it has no clip plane.

    Raises
    ------
    RenderError
        A plane cuts an object that is not there, or goes through the middle of nothing.
    """
    planes: list[tuple[Wall, tuple[int, ...] | None]] = []
    given: list[tuple[str, ClipPlane | Slice]] = [
        (f"style.clip[{k}]", plane) for k, plane in enumerate(style.clip)
    ]
    given += [("style.slice", style.slice)] if isinstance(style.slice, Slice) else []
    count = len(scene.objects)
    for name, plane in given:
        _check_objects(plane.objects, count, name)
        if plane.objects == ():
            continue  # it cuts nothing
        place = _place_of(plane, scene, name)
        if isinstance(plane, Slice):
            sides = (_wall(plane, place, 0.5 * plane.thickness, side) for side in (1.0, -1.0))
            planes += [(wall, plane.objects) for wall in sides]
        else:
            planes.append((_wall(plane, place, 0.0, 1.0), plane.objects))
    if not planes:
        return None
    color = style.cap if isinstance(style.cap, Color) else None
    walls: tuple[tuple[Wall, ...], ...] = (tuple(wall for wall, _ in planes),)
    of: tuple[int, ...] = ()
    if any(objects is not None for _, objects in planes):
        walls, of = _rooms_of_objects(planes, count)
    return Rooms(walls, of, style.cap is not False, color)


def is_plane_left(plane: Plane, walls: Sequence[Wall]) -> bool:
    """Tell whether any of an endless plane is within walls.

    If so, one of these points of it is: its own, the nearest to that on the line in which a wall
    meets it, or where two such lines meet.
    """
    center = plane.center.x, plane.center.y, plane.center.z
    longest = max(1.0, *map(abs, center), *(abs(number) for wall in walls for number in wall[:3]))
    right, up = camera_axes(unit(plane.normal))
    lines = []  # (a, b, c): points (u, v) of the plane with a u + b v <= c are within a wall
    for x, y, z, across, down, ahead in walls:
        normal = across, down, ahead
        way = along((x / longest, y / longest, z / longest), -1.0 / longest, center)
        lines.append((dot(normal, right), dot(normal, up), dot(normal, way)))
    points = [(0.0, 0.0)]
    for a, b, c in lines:
        length2 = a * a + b * b
        if length2 > TOUCHING * TOUCHING:
            points.append((a * c / length2, b * c / length2))
    for (a, b, c), (d, e, f) in combinations(lines, 2):
        area = a * e - b * d
        if abs(area) > TOUCHING:
            points.append(((c * e - b * f) / area, (a * f - c * d) / area))
    return any(all(a * u + b * v <= c + TOUCHING for a, b, c in lines) for u, v in points)


def _rooms_of_objects(
    planes: Sequence[tuple[Wall, tuple[int, ...] | None]], count: int
) -> tuple[tuple[tuple[Wall, ...], ...], tuple[int, ...]]:
    """Return the planes of each room, and the room of each object."""
    cuts = [range(count) if objects is None else set(objects) for _, objects in planes]
    found: dict[tuple[bool, ...], int] = {}
    keys = (tuple(k in places for places in cuts) for k in range(count))
    of = tuple(found.setdefault(key, len(found)) for key in keys)
    each = [wall for wall, _ in planes]
    walls = [tuple(wall for wall, cut in zip(each, key, strict=True) if cut) for key in found]
    return tuple(walls), of


def _check_objects(objects: tuple[int, ...] | None, count: int, place: str) -> None:
    """Raise RenderError if a plane cuts an object that is not there."""
    wrong = [k for k in objects or () if k >= count]
    if wrong:
        words = f"places in the scene's objects, of which there are {count}"
        message = f"{place}.objects: expected {words}, counted from 0, got {wrong[0]}"
        raise RenderError(message)


def _place_of(plane: ClipPlane | Slice, scene: Scene, name: str) -> Vec:
    """Return a point of a plane."""
    if plane.center is not None:
        return plane.center.x, plane.center.y, plane.center.z
    if plane.distance is not None:
        return along((0.0, 0.0, 0.0), plane.distance, unit(plane.normal))
    try:
        x, y, z = map(float, middle_of(balls_of(scene, name)))
    except SceneError:
        message = f"{name}: the scene has no middle; give a distance or a center"
        raise RenderError(message) from None
    return x, y, z


def _wall(plane: ClipPlane | Slice, place: Vec, half: float, side: float) -> Wall:
    """Return a wall so far before a plane through a point, or behind it."""
    normal = unit(plane.normal)
    x, y, z = along(place, side * half, normal)
    return x, y, z, side * normal[0], side * normal[1], side * normal[2]
