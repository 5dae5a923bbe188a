"""What a camera sees: how far balls and discs reach, and which can touch an edge of its picture.

Of many, only few can be the first to touch a plane through the eye, whatever the field of view up
to the camera's. One look at each finds them, and the way to the answer leads past few.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.exact_math import hypotenuse
from vtray.scene.placing.bounds import Balls, from_middle, middle_of, normals_of, some
from vtray.scene.placing.directions import Vec
from vtray.scene.placing.pieces import PIECE, by_workers

Floats = NDArray[np.float64]

Axes = tuple[Vec, Vec, Vec]
"""Of a camera: to the right, downwards and forward, unit vectors in world space."""

Slopes = tuple[float, float]
"""Of two edges of a picture, left and right or upper and lower: how far aside they go ahead."""

MANY = 2**17
"""So many balls or discs are worth a choice."""

SAMPLE = 2**14
"""Among so many those are looked for that reach farthest."""

BEYOND = 2.0**-10
"""How far beyond the slopes asked for they are kept, relative to the picture: for rounding."""

ROUNDING = 2.0**-46
"""More than rounding changes lengths, relative to the extent of all: 64 roundings."""

SMALLEST = 2.0**-1000
"""Lengths below have products that lose digits."""


class Seen(NamedTuple):
    """Balls or discs in the space of a camera that is in the middle of all.

    Attributes
    ----------
    x, y, z
        Centres to the right, downwards and forward, of all that may be the first to touch an edge,
        in their order, (m,).
    radius
        Their radii, (m,), or one for all.
    normals
        The coordinates of unit normals of discs, each (m,); None for balls.
    centers, surfaces
        The least and the greatest coordinates of all centres, and of all surfaces, (2, 3).
    there
        Translations, as points, if all of these stand at several places; x, y and z are then
        relative to the middle of the translations. None if they stand where they are.
    """

    x: Floats
    y: Floats
    z: Floats
    radius: Floats | float
    normals: list[Floats] | None
    centers: Floats
    surfaces: Floats
    there: "Seen | None" = None


class Bound(NamedTuple):
    """A bound on the room that is left at a slope on one side of the picture.

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
"""What nothing leaves more room than."""


def look(balls: Balls, middle: Floats, axes: Axes, edges: Sequence[Slopes] = ()) -> Seen:
    """Bring balls or discs into the space of a camera.

    Parameters
    ----------
    balls
        What is seen, or a part of it.
    middle
        The middle of the box around the centres of all, (3,).
    axes
        Those of the camera.
    edges
        The slopes of the picture's edges, across and down: all from the middle of a pair to its
        ends count. By default none does.
    """
    if balls.at is not None:
        # What is first to touch a plane are those that are first at those places that are.
        places = Balls(balls.at, 0.0)
        away = middle_of([places])
        own = look(balls._replace(at=None), middle - away, axes, edges)
        there = look(places, away, axes, edges)
        ends = own.centers + there.centers, own.surfaces + there.centers
        return own._replace(centers=ends[0], surfaces=ends[1], there=there)
    bounds, core = _find_bounds(balls, middle, axes, edges)

    def new_worker() -> Callable[[slice], Seen]:
        outside = _Outside(middle, core) if core > 0.0 else None

        def look_at(rows: slice) -> Seen:
            piece = some(balls, rows)
            return _look_at(outside.of(piece) if outside else piece, middle, axes, bounds)

        return look_at

    parts = by_workers(len(balls.center), new_worker)
    x, y, z = (np.concatenate([part[k] for part in parts]) for k in range(3))
    radius = balls.radius
    if not isinstance(radius, float):
        radius = np.concatenate([part.radius for part in parts])
    normals = None
    if balls.toward is not None:
        normals = [
            np.concatenate(columns) for columns in zip(*(p.normals for p in parts), strict=True)
        ]
    centers, surfaces = (
        np.array([np.min(ends[:, 0], axis=0), np.max(ends[:, 1], axis=0)])
        for ends in (np.array([p.centers for p in parts]), np.array([p.surfaces for p in parts]))
    )
    return Seen(x, y, z, radius, normals, centers, surfaces)


def _turn(columns: list[Floats], axes: Axes) -> list[Floats]:
    """Return the coordinates of vectors along the axes, each (n,)."""
    # Not by a product of matrices: for three rows, BLAS is slower.
    return [columns[0] * a + columns[1] * b + columns[2] * c for a, b, c in axes]


class _Outside:
    """Chooses those of some balls that are not near the middle of all.

    Parameters
    ----------
    middle
        The middle, (3,).
    core
        How far their centres are from there at least.
    """

    def __init__(self, middle: Floats, core: float) -> None:
        self._middle = middle
        self._least = core * core
        # New memory for each piece would take as long as the work.
        self._memory = np.empty((3, PIECE))

    def of(self, balls: Balls) -> Balls:
        """Return those of a piece."""
        squares, square, place = self._memory[:, : len(balls.center)]
        squares[...] = 0.0
        for column, offset in zip(balls.center.T, self._middle, strict=True):
            np.subtract(column, offset, out=place)
            np.multiply(place, place, out=square)
            squares += square
        return some(balls, np.flatnonzero(squares >= self._least))


def _look_at(balls: Balls, middle: Floats, axes: Axes, bounds: list[Bound]) -> Seen:
    """Bring a piece into the space of a camera, without what leaves more than all bounds."""
    columns = _turn(from_middle(balls.center, middle), axes)
    radius = balls.radius
    normals = None if balls.toward is None else _turn(normals_of(balls), axes)
    ends = [(c.min(initial=math.inf), c.max(initial=-math.inf)) for c in columns]
    centers = surfaces = np.array(ends).T
    if normals is not None:
        x, y, z = normals
        around = [np.sqrt(a * a + b * b) * radius for a, b in ((y, z), (x, z), (x, y))]
        ends = [((c - r).min(), (c + r).max()) for c, r in zip(columns, around, strict=True)]
        surfaces = np.array(ends).T
    elif isinstance(radius, float):
        surfaces = centers + np.array([[-radius], [radius]])
    else:
        radius = radius.astype(float, copy=False)
        ends = [
            ((c - radius).min(initial=math.inf), (c + radius).max(initial=-math.inf))
            for c in columns
        ]
        surfaces = np.array(ends).T
    inside = np.ones(len(columns[0]), np.bool_)
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
    if normals is not None:
        normals = [column[kept] for column in normals]
    radius = radius if isinstance(radius, float) else radius[kept]
    return Seen(x, y, z, radius, normals, centers, surfaces)


def rooms(place: Floats, ahead: Floats, slope: float, side: int) -> Floats:
    """Return the bounds that points set to an eye, (n,).

    An eye at depth d and place p sees a point on the inner side of the plane of this slope if
    ``side * (slope * d - p)`` is at most this bound. Balls take off their radius, for a plane of
    this slope ``sqrt(1 + slope**2)`` times, and discs less: see `least_room`.

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


def least_room(seen: Seen, aside: int, slope: float, side: int) -> tuple[float, float]:
    """Return the least bound that balls or discs set to the eye on one side, as `rooms` does.

    That of copies is the sum of those of the objects and of the translations. A vector v is the
    normal of a plane that touches a ball ``radius * |v|`` from its centre, and a disc of normal n
    ``radius * |v x n|``.

    Returns
    -------
    bound, change
        The bound, and how it changes with the slope.
    """
    place = (seen.x, seen.y)[aside]
    length = math.sqrt(1.0 + slope * slope)
    bounds = rooms(place, seen.z, slope, side)
    if seen.normals is None:
        bounds -= seen.radius * length
        k = int(bounds.argmin())
        change, width = slope, length
    else:
        across, other, ahead = seen.normals[aside], seen.normals[1 - aside], seen.normals[2]
        lean = slope * across + ahead
        widths = np.sqrt(np.square(length * other) + np.square(lean))
        bounds -= seen.radius * widths
        k = int(bounds.argmin())
        change = float(slope * other[k] * other[k] + lean[k] * across[k])
        width = float(widths[k]) or 1.0
    radius = float(np.broadcast_to(seen.radius, bounds.shape)[k])
    bound, changing = float(bounds[k]), side * float(seen.z[k]) - radius * change / width
    if seen.there is None:
        return bound, changing
    more = least_room(seen.there, aside, slope, side)
    return bound + more[0], changing + more[1]


def _find_bounds(
    balls: Balls, middle: Floats, axes: Axes, edges: Sequence[Slopes]
) -> tuple[list[Bound], float]:
    """Return bounds: what leaves more room than all is not the first to touch an edge.

    Returns
    -------
    bounds, core
        The bounds; and how near to the middle the centres of balls are that leave more than all
        bounds, and are the first in no direction, 0 if that is not known of any.
    """
    count = len(balls.center)
    if not edges:
        return [], 0.0
    if count < MANY or not all(map(_is_usual, edges)):
        return [UNBOUNDED], 0.0
    # Numbers spread as the golden ratio does, in step with no order of the spheres.
    chosen = np.arange(SAMPLE) * (int(count * 0.6180339887) | 1) % count
    x, y, z = _turn(from_middle(some(balls, chosen).center, middle), axes)
    extent = float(balls.center.max()) - float(balls.center.min()) + float(np.max(balls.radius))
    # What is the same of all radii makes no difference between balls; discs may be edge-on.
    least = float(np.min(balls.radius)) if balls.toward is None else 0.0
    less = least - ROUNDING * extent - SMALLEST
    bounds = [
        Bound(aside, side, slope, room - less * math.sqrt(1.0 + slope * slope))
        for aside, (place, (low, high)) in enumerate(zip((x, y), edges, strict=True))
        for side, end in ((-1, low), (1, high))
        for slope, room in _least_rooms(place, z, side, (low + high) / 2, end)
    ]
    if balls.toward is not None:
        return bounds, 0.0
    # What is so near is farther than the others from all planes that are the edges of a bound.
    most = float(np.max(balls.radius))
    core = min(-bound.room / math.sqrt(1.0 + bound.slope * bound.slope) for bound in bounds) - most
    reached = min(min(float(c.max()), -float(c.min())) for c in (x, y, z)) - (most - least)
    return bounds, min(core, reached) - 2 * ROUNDING * extent - SMALLEST


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
