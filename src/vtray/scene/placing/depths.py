"""How far from a camera the bounded shapes of a scene reach."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from vtray.scene.placing.bounding_sphere import bounding_sphere
from vtray.scene.placing.bounds import Balls, from_middle, normals_of, some
from vtray.scene.placing.directions import unit
from vtray.scene.placing.moved import HasView
from vtray.scene.placing.pieces import by_pieces

Floats = NDArray[np.float64]

SLACK = 1e-9
"""By how much rounding may change a distance, in parts of the largest length."""


def depths_of(camera: HasView, parts: Sequence[Balls]) -> tuple[float, float]:
    """Return the distances of the nearest and of the farthest point of balls and discs.

    They are those along the rays to these points, in scene units, from where such rays start; where
    rays are parallel, what is behind that has distances below 0.
    """
    forward = np.array(unit(camera.normal))
    focus = 0.0 if camera.projection == "panorama" else camera.focus
    eye = np.array([camera.center.x, camera.center.y, camera.center.z]) - focus * forward
    axis = forward if camera.projection == "orthographic" else None
    largest = max(map(_largest, (*parts, Balls(eye[None], focus))))
    scale = math.ldexp(1.0, min(math.frexp(largest)[1], 1023))  # which changes no bits
    found = [
        _ends(part, eye, axis, scale)
        if part.at is None
        else _ends_of_copies(part, eye, axis, scale)
        for part in parts
    ]
    nearest, farthest = zip(*found, strict=True)
    return min(nearest), max(farthest)


def _largest(balls: Balls) -> float:
    """Return a length near the largest coordinate or radius; twice that is no less than any."""
    given = [balls.radius, abs(balls.center), *([] if balls.at is None else [abs(balls.at)])]
    return max(float(np.max(values)) for values in given)


def _ends_of_copies(
    copies: Balls, eye: Floats, axis: Floats | None, scale: float
) -> tuple[float, float]:
    """Return what `_ends` does of copies written out.

    Only those are asked whose balls around them may reach as near, or as far.
    """
    assert copies.at is not None  # noqa: S101
    middle, radius = bounding_sphere(copies._replace(at=None))
    way = [column / scale for column in from_middle(copies.at + middle, eye)]
    near, far = (found * scale for found in _of_balls(way, radius / scale, axis))
    slack = SLACK * scale
    nearest, farthest = math.inf, -math.inf
    for k in np.argsort(near).tolist():
        if near[k] - slack > nearest:
            break
        nearest = min(nearest, _ends(_written_out(copies, k), eye, axis, scale)[0])
    for k in np.argsort(-far).tolist():
        if far[k] + slack < farthest:
            break
        farthest = max(farthest, _ends(_written_out(copies, k), eye, axis, scale)[1])
    return nearest, farthest


def _written_out(copies: Balls, k: int) -> Balls:
    """Return a copy where it stands."""
    assert copies.at is not None  # noqa: S101
    center, toward = (
        None if points is None else points.astype(np.float64) + copies.at[k]
        for points in (copies.center, copies.toward)
    )
    assert center is not None  # noqa: S101
    return Balls(center, copies.radius, toward)


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
            near, far = _of_balls(way, radius, axis)
        return float(near.min()) * scale, float(far.max()) * scale

    nearest, farthest = zip(*by_pieces(len(balls.center), ends), strict=True)
    return min(nearest), max(farthest)


def _of_balls(
    way: list[Floats], radius: Floats | float, axis: Floats | None
) -> tuple[Floats, Floats]:
    """Return the distances of the nearest and of the farthest points of balls, each (n,)."""
    middle = _lengths(way) if axis is None else _along(way, axis)
    return middle - radius, middle + radius


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
