"""The spheres of a scene as two arrays, and a sphere around them all."""

from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from vtray.errors import SceneError
from vtray.objects import Object, Plane, Sphere
from vtray.spheres import Spheres, from_arrays

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
        points = from_arrays({"center": subject, **zeros}, f"{place}: ", called)
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


def first_plane(subject: object) -> Plane | None:
    """Return the first plane of a scene, None if there is none."""
    objects = getattr(subject, "objects", ())
    return next((item for item in objects if isinstance(item, Plane)), None)


def middle_of(center: NDArray[Any]) -> Floats:
    """Return the middle of the box around points, (3,)."""
    # Halves, as the sum may be more than a double can be.
    middle: Floats = center.min(axis=0) * np.float64(0.5) + center.max(axis=0) * np.float64(0.5)
    return middle


def bounding_sphere(balls: Balls) -> tuple[Floats, float]:
    """Return centre and radius of a sphere around all spheres.

    Its centre is that of the box around their centres, so it may be larger than need be: its radius
    is at most the square root of 3 times that of the smallest.
    """
    middle = middle_of(balls.center)
    offset = balls.center - middle
    reach = np.sqrt(np.einsum("ij,ij->i", offset, offset)) + balls.radius
    return middle, float(reach.max())
