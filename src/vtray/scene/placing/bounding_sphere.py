"""A sphere around all bounded shapes of a scene."""

import itertools
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.scene.placing.bounds import Balls, box_of, box_of_points, from_middle, normals_of, some
from vtray.scene.placing.pieces import by_pieces

Floats = NDArray[np.float64]

EXPANDED = 2**18
"""So many balls or discs at places are written out at once."""

ROUNDING = 1.0 + 2.0**-40
"""More than rounding changes a distance, as a factor."""

COSINE_ROUNDING = 2.0**-24
"""More than rounding changes the cosine of a difference of angles."""


def bounding_sphere(*parts: Balls) -> tuple[Floats, float]:
    """Return centre and radius of a sphere around all balls and discs.

    Its centre is that of the box around their centres, so it may be larger than need be: its radius
    is at most the square root of 3 times that of the smallest.
    """
    low, high = box_of(parts)
    middle = low / 2 + high / 2
    # In a unit in which no square overflows.
    unit = float(max((high - middle).max(), (middle - low).max())) or 1.0
    return middle, max(
        _reach_of(part, middle, unit) if part.at is None else _reach_of_copies(part, middle, unit)
        for part in parts
    )


def _reach_of(balls: Balls, middle: Floats, unit: float) -> float:
    """Return how far the farthest point of balls or discs is from the middle."""

    def reach(rows: slice) -> float:
        part = some(balls, rows)
        squares = sum(np.square(column / unit) for column in from_middle(part.center, middle))
        return float((np.sqrt(squares) * unit + part.radius).max())

    larger = max(unit, float(np.max(balls.radius)))

    def reach_of_discs(rows: slice) -> float:
        part = some(balls, rows)
        normals = normals_of(part)
        columns = [column / larger for column in from_middle(part.center, middle)]
        # The farthest of a disc is beyond its centre, as seen from the middle's foot in its plane.
        height = sum(c * n for c, n in zip(columns, normals, strict=True))
        aside = sum(np.square(c - height * n) for c, n in zip(columns, normals, strict=True))
        beyond = np.sqrt(aside) + part.radius / larger
        return float((np.sqrt(np.square(height) + np.square(beyond)) * larger).max())

    return max(by_pieces(len(balls.center), reach if balls.toward is None else reach_of_discs))


class Placed(NamedTuple):
    """Balls or discs at several places, with offsets of which each pair adds up to one centre.

    Attributes
    ----------
    balls
        The balls or discs, with their places.
    own, there
        Offsets of the balls or discs, (n, 3), and of the places, (m, 3), whose sums are relative to
        the middle of all, in parts of a length.
    radius
        Radii in parts of this length, (n,) or one for all.
    """

    balls: Balls
    own: Floats
    there: Floats
    radius: Floats | float

    def some(self, own: Any, there: Any) -> "Placed":  # noqa: ANN401 - whatever NumPy takes
        """Return those balls or discs, and those places, that two indices choose."""
        balls, radius = self.balls, self.radius
        assert balls.at is not None  # noqa: S101
        return Placed(
            some(balls, own)._replace(at=balls.at[there]),
            self.own[own],
            self.there[there],
            radius if isinstance(radius, float) else radius[own],
        )


def _reach_of_copies(balls: Balls, middle: Floats, unit: float) -> float:
    """Return how far the farthest point of balls or discs at several places is from the middle.

    Both are divided into those of smaller and smaller boxes, without what cannot reach farthest,
    until they are few enough to be written out. How they are divided does not change the result.
    """
    assert balls.at is not None  # noqa: S101
    low, high = box_of_points(balls.at)
    away = low / 2 + high / 2
    scale = max(unit, float(np.max(balls.radius)), float(abs(middle).max()), float(abs(away).max()))
    own = balls.center / scale - (middle / scale - away / scale)
    radius = balls.radius / scale
    whole = Placed(balls, own, balls.at / scale - away / scale, radius)
    farthest = _reach_of(_written_out(_far_pair(whole)), middle, unit)
    todo = [whole]
    while todo:
        part = _that_may_reach(todo.pop(), farthest / scale)
        count = len(part.own) * len(part.there)
        if count > EXPANDED:
            todo += _halves(part)
        elif count:
            farthest = max(farthest, _reach_of(_written_out(part), middle, unit))
    return farthest


def _far_pair(placed: Placed) -> Placed:
    """Return one ball or disc at one place, far from the middle."""
    ways = np.array([way for way in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(way)])
    best, length = placed.some([0], [0]), 0.0
    for first in ways:
        way = first
        for _ in range(3):
            reach = _products(placed.own, way) + placed.radius * _length(way)
            there = _products(placed.there, way)
            pair = placed.some([int(reach.argmax())], [int(there.argmax())])
            way = pair.own[0] + pair.there[0]
            found = _length(way) + float(np.max(pair.radius))
            if found <= length:
                break
            best, length = pair, found
    return best


def _that_may_reach(placed: Placed, farthest: float) -> Placed:
    """Return those balls or discs, and those places, that may reach beyond a distance together."""
    least = farthest / ROUNDING
    bound = _most(placed.own, placed.there) + placed.radius
    part = placed.some(np.flatnonzero(bound > least), slice(None))
    if len(part.own) == 0:
        return part
    bound = _most(part.there, part.own) + float(np.max(part.radius))
    return part.some(slice(None), np.flatnonzero(bound > least))


def _most(points: Floats, others: Floats) -> Floats:
    """Return bounds on the length of the sums of each point and any of some others, (n,).

    They are the least of what a box, a ball and a cone around the others allow.
    """
    low, high = others.min(axis=0), others.max(axis=0)
    in_box = _lengths(np.maximum(abs(points + low), abs(points + high)))
    middle = (low + high) / 2
    in_ball = _lengths(points + middle) + float(_lengths(others - middle).max())
    one, two = _lengths(points), _lengths(others)
    longest = float(two.max())
    # In the plane of a point and the axis of the cone, it is apart from the nearest by an angle.
    edge, aside = float(_cosines(others, two, middle).min()), _cosines(points, one, middle)
    sines = np.sqrt(1 - edge * edge) * np.sqrt(1 - np.square(aside))
    apart = np.where(aside < edge, edge * aside + sines + COSINE_ROUNDING, 1.0)
    squares = np.square(one) + np.maximum(longest * (longest + 2 * one * apart), 0.0)
    bounds: Floats = np.minimum(np.minimum(in_box, in_ball), np.sqrt(squares))
    return bounds


def _cosines(vectors: Floats, lengths: Floats, axis: Floats) -> Floats:
    """Return cosines of the angles of vectors to an axis, (n,); -1 for those of no length."""
    products = lengths * _length(axis)
    cosines = np.full(len(vectors), -1.0)
    np.divide(_products(vectors, axis), products, out=cosines, where=products > 0)
    clipped: Floats = np.clip(cosines, -1.0, 1.0)
    return clipped


def _products(vectors: Floats, axis: Floats) -> Floats:
    """Return the scalar products of vectors and an axis, (n,)."""
    x, y, z = vectors.T
    products: Floats = x * axis[0] + y * axis[1] + z * axis[2]
    return products


def _length(vector: Floats) -> float:
    """Return the length of a vector."""
    return float(_lengths(vector[np.newaxis])[0])


def _lengths(vectors: Floats) -> Floats:
    """Return the lengths of vectors, (n,)."""
    x, y, z = vectors.T
    lengths: Floats = np.sqrt(x * x + y * y + z * z)
    return lengths


def _halves(placed: Placed) -> Iterator[Placed]:
    """Return two halves, of balls or discs, or of places, whichever are farther apart."""
    extents = [points.max(axis=0) - points.min(axis=0) for points in (placed.own, placed.there)]
    is_own = len(placed.there) == 1 or (
        len(placed.own) > 1 and extents[0].max() >= extents[1].max()
    )
    points, extent = (placed.own, extents[0]) if is_own else (placed.there, extents[1])
    order = points[:, extent.argmax()].argsort(kind="stable")
    half = len(order) // 2
    for rows in (order[:half], order[half:]):
        yield placed.some(rows, slice(None)) if is_own else placed.some(slice(None), rows)


def _written_out(placed: Placed) -> Balls:
    """Return all balls or discs at all places."""
    center, radius, toward, at = placed.balls
    assert at is not None  # noqa: S101
    centers, *towards = (
        (points[:, np.newaxis] + at.astype(np.float64)).reshape(-1, 3)
        for points in (center, toward)
        if points is not None
    )
    radii = radius if isinstance(radius, float) else np.repeat(radius, len(at))
    return Balls(centers, radii, towards[0] if towards else None)
