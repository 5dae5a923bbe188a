"""The bounded shapes of a scene as balls and discs, and the box around their centres.

A sphere is a ball, and a cylinder or a cone the convex hull of two discs, its caps: what holds
these holds it, and what touches it from outside touches one of them.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.scene.arrays import Arrays
from vtray.scene.checks.given_array import positions_in
from vtray.scene.copies import Copies
from vtray.scene.objects import Object, Plane
from vtray.scene.placing.directions import Vec, dot, unit
from vtray.scene.placing.pieces import by_pieces
from vtray.scene.spheres import Spheres
from vtray.scene.vectors import Vector

Floats = NDArray[np.float64]


class HasObjects(Protocol):
    """A scene, as far as its objects go."""

    @property
    def objects(self) -> list[Object]: ...  # noqa: D102


class Balls(NamedTuple):
    """Balls as arrays, or the discs that planes through their centres cut out of them.

    Attributes
    ----------
    center
        Centres in world space, (n, 3), of float64 or float32.
    radius
        Radii, (n,), or one for all.
    toward
        For discs, other points of the lines that they are square to, (n, 3); a disc is a point if
        that is its centre. None for balls.
    at
        Translations, (m, 3), if all of these stand at m places, each with sums rounded to doubles.
        None if they stand where they are.
    """

    center: NDArray[Any]
    radius: NDArray[Any] | float
    toward: NDArray[Any] | None = None
    at: NDArray[Any] | None = None


def balls_of(subject: object, place: str) -> list[Balls]:
    """Return what a scene, arrays of objects, or points, which have radius 0, are the hulls of.

    Particles, and atoms of ASE and MDAnalysis, are points.

    Raises
    ------
    SceneError
        If there is none, or `subject` is nothing of all this. Messages begin with `place`.
    """
    if isinstance(subject, (Arrays, Copies)):
        found = _balls_in([subject])  # type: ignore[list-item]  # arrays are of one of the kinds
    elif hasattr(subject, "objects"):
        found = _balls_in(subject.objects)
    else:
        zeros = {"radius": 0, "color": (0, 0, 0), "lambert": 0}
        called = {"center": "positions"}
        given = {"center": positions_in(subject), **zeros}
        points = Spheres.from_arrays(given, f"{place}: ", called)
        found = [Balls(points.center, 0.0)]
    found = [balls for balls in found if len(balls.center) and (balls.at is None or len(balls.at))]
    if not found:
        words = "expected at least one sphere, cylinder, cone or point, as planes have no edge"
        raise SceneError(f"{place}: nothing has an end; {words} (Camera.look_at needs none)")
    return found


def _balls_in(objects: Sequence[Object]) -> list[Balls]:
    """Return what objects are the hulls of: balls, discs at starts, discs at ends, and copies."""
    single: dict[tuple[int, bool], list[tuple[Vector, float, Vector | None]]] = {}
    parts: dict[tuple[int, bool], list[Balls]] = {}
    placed: list[Balls] = []
    for item in objects:
        if isinstance(item, Arrays):
            for k, arrays in enumerate(item.hull()):
                parts.setdefault((k, arrays[2] is None), []).append(Balls(*arrays))
        elif isinstance(item, Copies):
            placed += [balls._replace(at=item.at) for balls in _balls_in(item.objects)]
        elif not isinstance(item, Plane):
            for k, row in enumerate(item.hull()):
                single.setdefault((k, row[2] is None), []).append(row)
    for kind, rows in single.items():
        parts.setdefault(kind, []).append(_as_arrays(rows))
    own = [_joined([part for part in found if len(part.center)]) for found in parts.values()]
    return own + placed


def _as_arrays(rows: list[tuple[Vector, float, Vector | None]]) -> Balls:
    """Return single balls, or single discs, as arrays."""
    centers, radii, towards = zip(*rows, strict=True)
    toward = None if towards[0] is None else _points(towards)
    return Balls(_points(centers), np.array(radii, np.float64), toward)


def _points(vectors: Sequence[Vector]) -> Floats:
    """Return vectors as rows."""
    return np.array([(v.x, v.y, v.z) for v in vectors], np.float64)


def _joined(parts: list[Balls]) -> Balls:
    """Return balls, or discs, as one."""
    if len(parts) == 1:
        return parts[0]
    if not parts:
        return Balls(np.zeros((0, 3)), 0.0)
    radii = [np.broadcast_to(part.radius, len(part.center)) for part in parts]
    towards = [part.toward for part in parts if part.toward is not None]
    return Balls(
        np.concatenate([part.center for part in parts]),
        np.concatenate(radii),
        np.concatenate(towards) if towards else None,
    )


def ups_of_planes(subject: object, middle: Sequence[float] | Floats) -> list[Vec]:
    """Return what is up on each plane of a scene: its unit normal on the side of the spheres.

    Parameters
    ----------
    subject
        A scene, or what has no planes.
    middle
        The middle of the spheres, three numbers.
    """
    ups = []
    for plane in getattr(subject, "objects", ()):
        if isinstance(plane, Plane):
            x, y, z = unit(plane.normal)
            c = plane.center
            from_plane = (middle[0] - c.x, middle[1] - c.y, middle[2] - c.z)
            side = -1.0 if dot((x, y, z), from_plane) < 0 else 1.0
            ups.append((side * x, side * y, side * z))
    return ups


def some(balls: Balls, rows: Any) -> Balls:  # noqa: ANN401 - whatever NumPy takes
    """Return those of the balls or discs that an index chooses."""
    radius, toward = balls.radius, balls.toward
    return Balls(
        balls.center[rows],
        radius if isinstance(radius, float) else radius[rows],
        None if toward is None else toward[rows],
    )


def normals_of(discs: Balls) -> list[Floats]:
    """Return the coordinates of unit vectors square to discs, each (n,); 0 where there is none."""
    assert discs.toward is not None  # noqa: S101
    columns = [
        np.subtract(a, b, dtype=float) for a, b in zip(discs.toward.T, discs.center.T, strict=True)
    ]
    # In parts of the largest, so that no square overflows.
    largest = np.maximum(np.maximum(abs(columns[0]), abs(columns[1])), abs(columns[2]))
    x, y, z = (column / np.where(largest > 0, largest, 1.0) for column in columns)
    length = np.sqrt(x * x + y * y + z * z)
    length[length == 0] = 1.0
    return [x / length, y / length, z / length]


def box_of(parts: Sequence[Balls]) -> tuple[Floats, Floats]:
    """Return the least and the greatest coordinates of all centres, each (3,)."""
    low, high = zip(*map(_box_of_part, parts), strict=True)
    return np.min(low, axis=0), np.max(high, axis=0)


def _box_of_part(balls: Balls) -> tuple[Floats, Floats]:
    """Return the least and the greatest coordinates of the centres of some balls or discs."""
    low, high = box_of_points(balls.center)
    if balls.at is None:
        return low, high
    least, greatest = box_of_points(balls.at)
    # As rounding keeps order, those of the sums.
    return low + least, high + greatest


def box_of_points(points: NDArray[Any]) -> tuple[Floats, Floats]:
    """Return the least and the greatest coordinates of points, each (3,)."""

    def ends(rows: slice) -> tuple[list[float], list[float]]:
        # Column by column, which NumPy does forty times as fast as along an axis.
        columns = points[rows].T
        return [float(c.min()) for c in columns], [float(c.max()) for c in columns]

    low, high = zip(*by_pieces(len(points), ends), strict=True)
    return np.min(low, axis=0), np.max(high, axis=0)


def middle_of(parts: Sequence[Balls]) -> Floats:
    """Return the middle of the box around all centres, (3,)."""
    low, high = box_of(parts)
    # Halves, as the sum may be more than a double can be.
    middle: Floats = low / 2 + high / 2
    return middle


def middle_in(subject: object, place: str) -> Vec:
    """Return the middle of what has one; see `balls_of`."""
    x, y, z = map(float, middle_of(balls_of(subject, place)))
    return x, y, z


def from_middle(center: NDArray[Any], middle: Floats) -> list[Floats]:
    """Return the coordinates of points relative to the middle, each (n,)."""
    return [column - offset for column, offset in zip(center.T, middle, strict=True)]
