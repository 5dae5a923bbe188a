"""Spheres as a camera sees them: how far they reach, and which can touch an edge of its picture.

Of many, only few can be the first to touch a plane through the eye, whatever the field of view up
to the camera's. One look at each finds them, and the way to the answer leads past few.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.exact_math import hypotenuse
from vtray.scene.placing.bounds import Balls, from_middle, some
from vtray.scene.placing.directions import Vec
from vtray.scene.placing.pieces import by_pieces

Floats = NDArray[np.float64]

Axes = tuple[Vec, Vec, Vec]
"""Of a camera: to the right, downwards and forward, unit vectors in world space."""

Slopes = tuple[float, float]
"""Of two edges of a picture, left and right or upper and lower: how far aside they go ahead."""

MANY = 2**17
"""So many spheres are worth a choice."""

SAMPLE = 2**14
"""Spheres among which those are looked for that reach farthest."""

BEYOND = 2.0**-10
"""How far beyond the slopes asked for spheres are kept, relative to the picture: for rounding."""

ROUNDING = 2.0**-46
"""More than rounding changes lengths, relative to the extent of the spheres: 64 roundings."""

SMALLEST = 2.0**-1000
"""Lengths below have products that lose digits."""


class Seen(NamedTuple):
    """Spheres in the space of a camera that is in the middle of them.

    Attributes
    ----------
    x, y, z
        Centres to the right, downwards and forward, of all spheres that may be the first to touch
        an edge, in their order, (m,).
    radius
        Their radii, (m,), or one for all.
    centers, surfaces
        The least and the greatest coordinates of all centres, and of all surfaces, (2, 3).
    """

    x: Floats
    y: Floats
    z: Floats
    radius: Floats | float
    centers: Floats
    surfaces: Floats


class Bound(NamedTuple):
    """A bound on the room that spheres leave at a slope on one side of the picture.

    Attributes
    ----------
    aside
        Which sides: 0 for left and right, 1 for up and down.
    side
        -1 for left or up, 1 for right or down.
    slope
        How far aside the slope goes ahead.
    room
        The bound.
    """

    aside: int
    side: int
    slope: float
    room: float


UNBOUNDED = Bound(0, 1, 0.0, math.inf)
"""What no sphere leaves more room than."""


def look(balls: Balls, middle: Floats, axes: Axes, edges: Sequence[Slopes] = ()) -> Seen:
    """Bring spheres into the space of a camera.

    Parameters
    ----------
    balls
        The spheres.
    middle
        The middle of the box around their centres, (3,).
    axes
        Those of the camera.
    edges
        The slopes of the picture's edges, across and down: all from the middle of a pair to its
        ends count. By default none does.
    """
    bounds = _find_bounds(balls, middle, axes, edges)
    parts = by_pieces(
        len(balls.center), lambda rows: _look_at(some(balls, rows), middle, axes, bounds)
    )
    x, y, z = (np.concatenate([part[k] for part in parts]) for k in range(3))
    radius = balls.radius
    if not isinstance(radius, float):
        radius = np.concatenate([part.radius for part in parts])
    centers, surfaces = (
        np.array([np.min(ends[:, 0], axis=0), np.max(ends[:, 1], axis=0)])
        for ends in (np.array([p.centers for p in parts]), np.array([p.surfaces for p in parts]))
    )
    return Seen(x, y, z, radius, centers, surfaces)


def _turn(balls: Balls, middle: Floats, axes: Axes) -> list[Floats]:
    """Return the coordinates of centres along the axes, each (n,)."""
    columns = from_middle(balls.center, middle)
    # Not by a product of matrices: for three rows, BLAS is slower.
    return [columns[0] * a + columns[1] * b + columns[2] * c for a, b, c in axes]


def _look_at(balls: Balls, middle: Floats, axes: Axes, bounds: list[Bound]) -> Seen:
    """Bring a piece into the space of a camera, without spheres that leave more than all bounds."""
    columns = _turn(balls, middle, axes)
    radius = balls.radius
    centers = surfaces = np.array([[c.min() for c in columns], [c.max() for c in columns]])
    if isinstance(radius, float):
        surfaces = centers + np.array([[-radius], [radius]])
    else:
        radius = radius.astype(float, copy=False)
        ends = [((c - radius).min(), (c + radius).max()) for c in columns]
        surfaces = np.array(ends).T
    inside = np.ones(len(balls.center), np.bool_)
    for aside, side, slope, room in bounds:
        left = rooms(columns[aside], columns[2], slope, side)
        length = math.sqrt(1.0 + slope * slope)
        if isinstance(radius, float):
            inside &= left > room + radius * length
        else:
            left -= radius * length
            inside &= left > room
    kept = np.flatnonzero(~inside)
    x, y, z = (column[kept] for column in columns)
    return Seen(x, y, z, radius if isinstance(radius, float) else radius[kept], centers, surfaces)


def rooms(place: Floats, ahead: Floats, slope: float, side: int) -> Floats:
    """Return the bounds that points set to an eye, (n,).

    An eye at depth d and place p sees a point on the inner side of the plane of this slope if
    ``side * (slope * d - p)`` is at most this bound. Spheres take off their radius, for a plane of
    this slope ``sqrt(1 + slope**2)`` times.

    Parameters
    ----------
    place, ahead
        Where the points are across or down, and forward, (n,).
    slope
        How far aside the plane goes ahead.
    side
        -1 for a plane on the left or above, 1 for one on the right or below.
    """
    bounds = ahead * (side * slope)
    if side > 0:
        bounds -= place
    else:
        bounds += place
    return bounds


def _find_bounds(balls: Balls, middle: Floats, axes: Axes, edges: Sequence[Slopes]) -> list[Bound]:
    """Return bounds: a sphere that leaves more room than all is not the first to touch an edge."""
    count = len(balls.center)
    if not edges:
        return []
    if count < MANY or not all(map(_is_usual, edges)):
        return [UNBOUNDED]
    # Numbers spread as the golden ratio does, in step with no order of the spheres.
    chosen = np.arange(SAMPLE) * (int(count * 0.6180339887) | 1) % count
    x, y, z = _turn(some(balls, chosen), middle, axes)
    extent = float(balls.center.max()) - float(balls.center.min()) + float(np.max(balls.radius))
    # What is the same of all radii makes no difference between spheres.
    less = float(np.min(balls.radius)) - ROUNDING * extent - SMALLEST
    return [
        Bound(aside, side, slope, room - less * math.sqrt(1.0 + slope * slope))
        for aside, (place, (low, high)) in enumerate(zip((x, y), edges, strict=True))
        for side, end in ((-1, low), (1, high))
        for slope, room in _least_rooms(place, z, side, (low + high) / 2, end)
    ]


def _is_usual(slopes: Slopes) -> bool:
    """Tell whether no slopes but those that count are sure to be asked for.

    Others might be where the middle of a picture is far from the axis, as in one of few pixels.
    """
    low, high = slopes
    return abs(low + high) * hypotenuse(1.0, low, high) <= 1


def _least_rooms(
    place: Floats, ahead: Floats, side: int, middle: float, end: float
) -> list[tuple[float, float]]:
    """Return slopes and, for each, the room that one of the points leaves.

    Room is linear in the slope, so a point that leaves more of it than another at two slopes does
    so at all between. One point leaves least at the first slope, and one at the last, which takes
    over where both leave the same.
    """
    more = BEYOND * (end - middle)
    ends = middle - more, end + more
    found = [int(rooms(place, ahead, slope, side).argmin()) for slope in ends]
    (a, b), (c, d) = points = [(float(place[k]), float(ahead[k])) for k in found]
    turn = float(np.clip((a - c) / (b - d), min(ends), max(ends))) if b != d else ends[0]
    least = [side * (z * slope - x) for (x, z), slope in zip(points, ends, strict=True)]
    both = max(side * (z * turn - x) for x, z in points)
    return [(ends[0], least[0]), (turn, both), (ends[1], least[1])]
