"""Directions to look in: those that have a name, and the one that shows the shape of what is there.

The z axis is up. A view says where the viewer is, by the azimuth, the angle from the x axis towards
the y axis, and by the elevation above the plane of both.
"""

import math
from collections.abc import Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.base.exact_math import cosine, sine
from vtray.base.number import count_of
from vtray.scene.checks.limits import Real
from vtray.scene.checks.scene_words import either, nearest, quoted, show
from vtray.scene.placing.bounds import Balls, balls_of, box_of, from_middle
from vtray.scene.placing.directions import Vec, cross, dot, times

Floats = NDArray[np.float64]

Matrix = list[list[float]]
"""Rows of three."""

DIAGONAL = 35.264389682754654
"""The elevation at which a corner of a cube is seen, in degrees."""

AUTO = "auto"

VIEWS = MappingProxyType(
    {
        "x": (0.0, 0.0),
        "-x": (180.0, 0.0),
        "y": (90.0, 0.0),
        "-y": (-90.0, 0.0),
        "z": (-90.0, 90.0),
        "-z": (-90.0, -90.0),
        "top": (-90.0, 90.0),
        "bottom": (-90.0, -90.0),
        "front": (-90.0, 0.0),
        "back": (90.0, 0.0),
        "left": (180.0, 0.0),
        "right": (0.0, 0.0),
        "iso": (-45.0, DIAGONAL),
    }
)
"""Azimuth and elevation of the views that have a name; an axis points to the viewer."""

TILT = 20.0
"""How far above the shortest axis the viewer is who is shown the shape, in degrees."""

ALIKE = 0.75
"""Two axes are not told apart if the mean square along one is so large a part of the other."""

EVEN = 0.6
"""Nor are all three: as much may differ by chance alone for some hundred points in a cube."""

SIDES: Vec = (1.0, -2.0, 4.0)
"""On the side of this direction the viewer is: rather above than below, in front than behind."""

UPS: Vec = (1.0, 2.0, 4.0)
"""On the side of this direction is what points up."""


class View(NamedTuple):
    """Where a camera looks, and what points up in its picture: unit vectors in world space."""

    direction: Vec
    up: Vec


def view_of(subject: object, view: object, call: str) -> View:
    """Return what a view is, by its name or its angles.

    Parameters
    ----------
    subject
        What is looked at, as for `Camera.fit`.
    view
        As for `Camera.fit`.
    call
        What messages begin with.

    Raises
    ------
    SceneError
        If there is no such view.
    """
    if isinstance(view, str):
        if view == AUTO:
            return _view_of_shape(balls_of(subject, call))
        if view in VIEWS:
            return view_from(*VIEWS[view])
        names = [*VIEWS, AUTO]
        words = f"{either(map(quoted, names))}, or azimuth and elevation in degrees"
        close = nearest(view, names, cutoff=0.6)
        hint = f"; did you mean {close}?" if close else ""
        raise SceneError(f"{call}: view: expected {words}, got {quoted(view)}{hint}")
    from vtray.scene.checks.scene_check import from_code

    if count_of(view) != 2:
        words = "azimuth and elevation in degrees, or the name of a view"
        raise SceneError(f"{call}: view: expected {words}, got {view!r}")
    azimuth, elevation = from_code(view, tuple[Real, Real], f"{call}: view")
    if not -90 <= elevation <= 90:
        words = "expected an elevation from -90 to 90 degrees"
        raise SceneError(f"{call}: view[1]: {words}, got {show(elevation)}")
    return view_from(azimuth, elevation)


def view_from(azimuth: float, elevation: float) -> View:
    """Return the view of someone who looks from two angles, in degrees, to the origin."""
    (a, b), (c, d) = ((cosine(angle), sine(angle)) for angle in (azimuth, elevation))
    return View((-a * c, -b * c, -d), (-a * d, -b * d, c))


def tilt_of(subject: object, call: str) -> float:
    """Return how far the viewer is above what points up, who is shown the shape; in degrees.

    Parameters
    ----------
    subject, call
        As for `view_of`.
    """
    shape = _shape_of(balls_of(subject, call))
    return TILT if shape is None else shape.tilt


class _Shape(NamedTuple):
    """How something lies: what the viewer is to look along, towards them, and what is to point up.

    The viewer is above what points up, or below it by a tilt, in degrees.
    """

    short: Vec
    up: Vec
    tilt: float


def _view_of_shape(parts: Sequence[Balls]) -> View:
    """Return the view that shows the shape of what is there.

    The viewer looks along the shortest of the principal axes of all centres, from a little above,
    or below where it is more upright than what points up in the picture; the longest is horizontal
    there. Where two are alike, what is between them is up to the world's axes.
    """
    shape = _shape_of(parts)
    if shape is None:
        return view_from(*VIEWS["iso"])
    short, up, tilt = shape
    toward = _sum(times(cosine(tilt), short), times(sine(tilt), up))
    upward = _sum(times(cosine(tilt), up), times(-sine(tilt), short))
    return View(times(-1.0, toward), upward)


def _shape_of(parts: Sequence[Balls]) -> _Shape | None:
    """Return how something lies; None where all axes are alike."""
    variances, axes = principal_axes(moments(parts))
    (least, middle, most), (short, _, long) = variances, axes
    if least >= EVEN * most:
        return None
    if least >= ALIKE * middle:
        short = _beside(SIDES, long)
    if dot(short, SIDES) < 0:
        short = times(-1.0, short)
    if middle >= ALIKE * most:
        is_level = abs(short[2]) > cosine(TILT)
        up = _beside((0.0, 1.0, 0.0) if is_level else (0.0, 0.0, 1.0), short)
    else:
        up = cross(short, long)
        if dot(up, UPS) < 0:
            up = times(-1.0, up)
    # What lies flat is seen from its lower side in the picture, so that this is nearer.
    return _Shape(short, up, -TILT if abs(short[2]) > abs(up[2]) else TILT)


def moments(parts: Sequence[Balls]) -> Matrix:
    """Return the mean products of the coordinates of all centres, relative to their mean.

    Lengths are in parts of that of the box around them. Sums have an order that depends on the
    number of centres alone, so they are the same on every machine.
    """
    low, high = box_of(parts)
    middle = low / 2 + high / 2
    unit = math.ldexp(1.0, math.frexp(float((high / 2 - low / 2).max()))[1])
    found = [_moments_of(part, middle, unit) for part in parts]
    total = math.fsum(weight for weight, _, _ in found)
    mean = [math.fsum(weight * m[k] for weight, m, _ in found) / total for k in range(3)]
    return [
        [
            math.fsum(
                weight * (second[i][j] + (m[i] - mean[i]) * (m[j] - mean[j]))
                for weight, m, second in found
            )
            / total
            for j in range(3)
        ]
        for i in range(3)
    ]


def _moments_of(balls: Balls, middle: Floats, unit: float) -> tuple[float, list[float], Matrix]:
    """Return how many centres there are, their mean, and the mean products relative to it."""
    if balls.at is not None:
        # Those of all sums of two points are the sums of both.
        away = box_of([Balls(balls.at, 0.0)])
        there = away[0] / 2 + away[1] / 2
        one = _moments_of(balls._replace(at=None), middle - there, unit)
        other = _moments_of(Balls(balls.at, 0.0), there, unit)
        mean = [a + b for a, b in zip(one[1], other[1], strict=True)]
        second = [
            [a + b for a, b in zip(*rows, strict=True)]
            for rows in zip(one[2], other[2], strict=True)
        ]
        return one[0] * other[0], mean, second
    count = len(balls.center)
    columns = [column / unit for column in from_middle(balls.center, middle)]
    mean = [_total(column) / count for column in columns]
    around = [column - m for column, m in zip(columns, mean, strict=True)]
    return float(count), mean, [[_total(a * b) / count for b in around] for a in around]


def _total(values: Floats) -> float:
    """Return a sum, whose order is always the same: of the halves of an array, again and again."""
    values = values.astype(np.float64)
    while len(values) > 1:
        half = len(values) // 2
        rest = values[2 * half :]
        values = np.concatenate([values[:half] + values[half : 2 * half], rest])
    return float(values[0]) if len(values) else 0.0


def principal_axes(matrix: Matrix) -> tuple[list[float], list[Vec]]:
    """Return the eigenvalues of a symmetric matrix from the least on, and their unit vectors.

    References
    ----------
    Jacobi's method: Golub and Van Loan, *Matrix Computations*, 4th edition, section 8.5.
    """
    rows, axes = [list(row) for row in matrix], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    for _ in range(30):
        for p, q in ((0, 1), (0, 2), (1, 2)):
            if abs(rows[p][q]) <= 2.0**-60 * (abs(rows[p][p]) + abs(rows[q][q])):
                continue
            ratio = (rows[q][q] - rows[p][p]) / (2.0 * rows[p][q])
            t = (1.0 if ratio >= 0 else -1.0) / (abs(ratio) + math.sqrt(1.0 + ratio * ratio))
            c = 1.0 / math.sqrt(1.0 + t * t)
            _turn(rows, p, q, c, t * c)
            rows = [list(column) for column in zip(*rows, strict=True)]
            _turn(rows, p, q, c, t * c)
            _turn(axes, p, q, c, t * c)
    order = sorted(range(3), key=lambda k: rows[k][k])
    return [rows[k][k] for k in order], [(axes[k][0], axes[k][1], axes[k][2]) for k in order]


def _turn(rows: Matrix, p: int, q: int, c: float, s: float) -> None:
    """Turn two rows by an angle of a cosine and a sine."""
    pairs = list(zip(rows[p], rows[q], strict=True))
    rows[p] = [c * a - s * b for a, b in pairs]
    rows[q] = [s * a + c * b for a, b in pairs]


def _beside(vector: Vec, axis: Vec) -> Vec:
    """Return the unit vector of what of a vector is square to a unit axis."""
    found = _sum(vector, times(-dot(vector, axis), axis))
    return times(1.0 / math.sqrt(dot(found, found)), found)


def _sum(one: Vec, other: Vec) -> Vec:
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]
