"""How far from a camera the bounded shapes of a scene reach."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from vtray.scene.placing.bounding_sphere import bounding_sphere
from vtray.scene.placing.bounds import Balls, from_middle, normals_of, some
from vtray.scene.placing.directions import unit
from vtray.scene.placing.moved import HasView
from vtray.scene.placing.pieces import by_pieces

Floats = NDArray[np.float64]


def depths_of(camera: HasView, parts: Sequence[Balls]) -> tuple[float, float]:
    """Return the distances of the nearest and of the farthest point of balls and discs.

    They are those along the rays to these points, in scene units, from where such rays start; where
    rays are parallel, what is behind that has distances below 0. Of each copy, the ball around it
    counts.
    """
    forward = np.array(unit(camera.normal))
    focus = 0.0 if camera.projection == "panorama" else camera.focus
    eye = np.array([camera.center.x, camera.center.y, camera.center.z]) - focus * forward
    axis = forward if camera.projection == "orthographic" else None
    parts = [part if part.at is None else _around_each(part) for part in parts]
    scale = max(_largest(part) for part in (*parts, Balls(eye[None], focus))) or 1.0
    nearest, farthest = zip(*(_ends(part, eye, axis, scale) for part in parts), strict=True)
    return min(nearest), max(farthest)


def _around_each(copies: Balls) -> Balls:
    """Return the balls around copies."""
    middle, radius = bounding_sphere(copies._replace(at=None))
    assert copies.at is not None  # noqa: S101
    return Balls(copies.at + middle, radius)


def _largest(balls: Balls) -> float:
    """Return the largest of all coordinates and radii, a unit in which no square overflows."""
    return max(float(np.max(abs(balls.center))), float(np.max(balls.radius)))


def _ends(balls: Balls, eye: Floats, axis: Floats | None, scale: float) -> tuple[float, float]:
    """Return the distances of the nearest and of the farthest point of some balls, or discs.

    Parameters
    ----------
    balls
        The balls or discs.
    eye
        Where rays start, or a point of the plane that they do.
    axis
        The direction of parallel rays; None where all start at the eye.
    scale
        The unit to reckon in.
    """

    def ends(rows: slice) -> tuple[float, float]:
        part = some(balls, rows)
        way = [column / scale for column in from_middle(part.center, eye)]
        radius = part.radius / scale
        if part.toward is not None:
            near, far = _of_discs(way, radius, normals_of(part), axis)
        else:
            middle = _lengths(way) if axis is None else _along(way, axis)
            near, far = middle - radius, middle + radius
        return float(near.min()) * scale, float(far.max()) * scale

    nearest, farthest = zip(*by_pieces(len(balls.center), ends), strict=True)
    return min(nearest), max(farthest)


def _of_discs(
    way: list[Floats], radius: Floats | float, normals: list[Floats], axis: Floats | None
) -> tuple[Floats, Floats]:
    """Return the distances of the nearest and of the farthest points of discs, each (n,)."""
    if axis is not None:
        middle, cosine = _along(way, axis), _along(normals, axis)
        reach = radius * np.sqrt(np.maximum(1.0 - np.square(cosine), 0.0))
        return middle - reach, middle + reach
    # Of a disc, the nearest and the farthest point lie on the line through its middle and the foot
    # of the eye in its plane.
    height = _along(way, normals)
    aside = _lengths([w - height * n for w, n in zip(way, normals, strict=True)])
    near = _lengths([height, np.maximum(aside - radius, 0.0)])
    return near, _lengths([height, aside + radius])


def _along(way: Sequence[Floats], axis: Sequence[Floats] | Floats) -> Floats:
    """Return the scalar products of vectors and one or as many others, given by columns."""
    products: Floats = way[0] * axis[0] + way[1] * axis[1] + way[2] * axis[2]
    return products


def _lengths(columns: Sequence[Floats]) -> Floats:
    """Return the lengths of vectors, given by columns."""
    lengths: Floats = np.sqrt(sum(np.square(column) for column in columns))
    return lengths
