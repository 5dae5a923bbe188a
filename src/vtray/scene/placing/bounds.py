"""The spheres of a scene as two arrays, and a sphere around them all."""

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.scene.objects import Object, Plane, Sphere
from vtray.scene.placing.directions import Vec, dot, unit
from vtray.scene.placing.pieces import by_pieces
from vtray.scene.spheres import Spheres

Floats = NDArray[np.float64]


class HasObjects(Protocol):
    """A scene, as far as its objects go."""

    @property
    def objects(self) -> list[Object]: ...  # noqa: D102


class Balls(NamedTuple):
    """Spheres as arrays.

    Attributes
    ----------
    center
        Centres in world space, (n, 3), of float64 or float32.
    radius
        Radii, (n,), or one for all.
    """

    center: NDArray[Any]
    radius: NDArray[Any] | float


def balls_of(subject: object, place: str) -> Balls:
    """Return the spheres of a scene, of `Spheres`, or of points, which have radius 0.

    Raises
    ------
    SceneError
        If there is none, or `subject` is nothing of all this. Messages begin with `place`.
    """
    if isinstance(subject, Spheres):
        found = [Balls(subject.center, subject.radius)]
    elif hasattr(subject, "objects"):
        found = _balls_in(subject.objects)
    else:
        zeros = {"radius": 0, "color": (0, 0, 0), "lambert": 0}
        called = {"center": "positions"}
        points = Spheres.from_arrays({"center": subject, **zeros}, f"{place}: ", called)
        found = [Balls(points.center, 0.0)]
    found = [balls for balls in found if len(balls.center)]
    if not found:
        words = "there are no spheres; expected at least one, as planes have no edge"
        raise SceneError(f"{place}: {words} (Camera.look_at needs none)")
    if len(found) == 1:
        return found[0]
    radii = [np.broadcast_to(balls.radius, len(balls.center)) for balls in found]
    return Balls(np.concatenate([balls.center for balls in found]), np.concatenate(radii))


def _balls_in(objects: list[Object]) -> list[Balls]:
    """Return the spheres among objects: those of each array, and all single ones together."""
    found = [Balls(item.center, item.radius) for item in objects if isinstance(item, Spheres)]
    single = [item for item in objects if isinstance(item, Sphere)]
    if single:
        center = np.array([(s.center.x, s.center.y, s.center.z) for s in single], np.float64)
        found.append(Balls(center, np.array([s.radius for s in single], np.float64)))
    return found


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
    """Return those of the spheres that an index chooses."""
    radius = balls.radius
    return Balls(balls.center[rows], radius if isinstance(radius, float) else radius[rows])


def box_of(center: NDArray[Any]) -> tuple[Floats, Floats]:
    """Return the least and the greatest coordinates of points, each (3,)."""

    def ends(rows: slice) -> tuple[list[float], list[float]]:
        # Column by column, which NumPy does forty times as fast as along an axis.
        columns = center[rows].T
        return [float(c.min()) for c in columns], [float(c.max()) for c in columns]

    low, high = zip(*by_pieces(len(center), ends), strict=True)
    return np.min(low, axis=0), np.max(high, axis=0)


def middle_of(center: NDArray[Any]) -> Floats:
    """Return the middle of the box around points, (3,)."""
    low, high = box_of(center)
    # Halves, as the sum may be more than a double can be.
    middle: Floats = low / 2 + high / 2
    return middle


def from_middle(center: NDArray[Any], middle: Floats) -> list[Floats]:
    """Return the coordinates of points relative to the middle, each (n,)."""
    return [column - offset for column, offset in zip(center.T, middle, strict=True)]


def bounding_sphere(balls: Balls) -> tuple[Floats, float]:
    """Return centre and radius of a sphere around all spheres.

    Its centre is that of the box around their centres, so it may be larger than need be: its radius
    is at most the square root of 3 times that of the smallest.
    """
    low, high = box_of(balls.center)
    middle = low / 2 + high / 2
    # In a unit in which no square overflows.
    unit = float(max((high - middle).max(), (middle - low).max())) or 1.0

    def reach(rows: slice) -> float:
        part = some(balls, rows)
        squares = sum(np.square(column / unit) for column in from_middle(part.center, middle))
        return float((np.sqrt(squares) * unit + part.radius).max())

    return middle, max(by_pieces(len(balls.center), reach))
