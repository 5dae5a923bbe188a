"""The oracle's cylinder: a quadratic in a frame of its own for the side, and two discs.

All is worked out in long doubles, and from a point of the ray beside the cylinder, so that what it
says is far nearer to the truth than any bound on rounding in doubles.
"""

from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray

SIDE, START_CAP, END_CAP = 0, 1, 2


class Crossings(NamedTuple):
    """Where lines cross the surface of a cylinder; NaN and no meaning where they do not.

    Attributes
    ----------
    at
        How far along the line, (2, n), the nearer first.
    face
        What is crossed there: the side, or one of the caps, (2, n).
    steepness
        What errors of `at` are divided by: of a cap the sine of the angle between it and the line,
        of the side that of the angle between axis and line, (2, n).
    """

    at: Array
    face: Array
    steepness: Array


class Cylinder:
    """A cylinder.

    Parameters
    ----------
    start, end
        Middles of its caps, relative to the image plane, (3,) of long doubles.
    radius
        Its radius.
    """

    def __init__(self, start: Array, end: Array, radius: float) -> None:
        way = end - start
        self.start, self.radius = start, np.longdouble(radius)
        largest = np.abs(way).max()
        unit = way / largest if largest > 0 else way
        self.length = np.sqrt((unit * unit).sum()) * largest
        self.is_nothing = not (self.length > 0 and self.radius > 0)
        along = way / self.length if self.length > 0 else np.array([0, 0, 1], np.longdouble)
        beside = np.eye(3, dtype=np.longdouble)[np.argmin(np.abs(along))]
        one = _cross(along, beside)
        one = one / np.sqrt((one * one).sum())
        self.frame = np.stack([one, _cross(along, one), along])
        self.middle = self.start + along * (self.length / 2)

    def inside_out(self, vectors: Array) -> Array:
        """Return vectors given in the frame, (n, 3), as they are outside of it."""
        return np.stack([(vectors * self.frame[:, k]).sum(axis=-1) for k in range(3)], axis=-1)

    def in_frame(self, vectors: Array) -> Array:
        """Return vectors, (n, 3), by their parts square to the axis, and that along it."""
        vectors = vectors.astype(np.longdouble)
        return np.stack([(vectors * axis).sum(axis=-1) for axis in self.frame], axis=-1)

    def outside(self, points: Array, larger: Any = 0) -> Array:
        """Return how far points, (n, 3), are outside; below 0 inside."""
        x, y, z = np.moveaxis(self.in_frame(points - self.start), -1, 0)
        beside = np.sqrt(x * x + y * y) - self.radius - larger
        beyond = np.maximum(-z, z - self.length) - larger
        away = np.hypot(np.maximum(beside, 0), np.maximum(beyond, 0))
        return np.where(away > 0, away, np.maximum(beside, beyond))

    def cross(self, starts: Array, ways: Array, reach: Any, larger: Any = 0) -> Crossings:
        """Return where lines cross the surface.

        Parameters
        ----------
        starts, ways
            Points of the lines, and their directions, (n, 3).
        reach
            Lines that come no farther inside than this cross nothing, (n,).
        larger
            By how much the cylinder is larger on all sides, (n,).
        """
        starts, ways = starts.astype(np.longdouble), ways.astype(np.longdouble)
        reach, larger = (np.broadcast_to(bound, len(starts)) for bound in (reach, larger))
        shift = ((self.middle - starts) * ways).sum(axis=-1) / (ways * ways).sum(axis=-1)
        beside = starts + shift[:, None] * ways - self.middle
        # Most lines pass by a ball around it, at a distance that no rounding makes up for.
        ball = 1.01 * (self.length / 2 + self.radius + np.abs(larger)) + reach
        near = (beside * beside).sum(axis=-1) <= ball * ball
        found = self.cross_near(starts[near], ways[near], shift[near], reach[near], larger[near])
        shape = 2, len(starts)
        at, steepness = np.full(shape, np.nan, np.longdouble), np.ones(shape, np.longdouble)
        face = np.zeros(shape, int)
        at[:, near], face[:, near], steepness[:, near] = found
        return Crossings(at, face, steepness)

    def cross_near(
        self, starts: Array, ways: Array, shift: Array, reach: Array, larger: Array
    ) -> Crossings:
        """Return where lines cross the surface that are beside its middle after `shift` ways."""
        x, y, z = np.moveaxis(self.in_frame(starts + shift[:, None] * ways - self.start), -1, 0)
        u, v, w = np.moveaxis(self.in_frame(ways), -1, 0)
        length = np.sqrt((ways * ways).sum(axis=-1))
        radius = np.maximum(self.radius + larger, 0)
        low, high = -larger, self.length + larger
        a, half_b = u * u + v * v, x * u + y * v
        c = x * x + y * y - radius * radius
        root = np.sqrt(a * radius * radius - (x * v - y * u) ** 2)
        q = -(half_b + np.where(half_b < 0, -root, root))
        candidates = []
        for t in (q / a, c / q):
            height = z + t * w
            on = (root > 0) & (height > low) & (height < high)
            candidates.append((np.where(on, t, np.nan), SIDE, np.sqrt(a) / length))
        for face, level in ((START_CAP, low), (END_CAP, high)):
            t = (level - z) / w
            on = (x + t * u) ** 2 + (y + t * v) ** 2 < radius * radius
            candidates.append((np.where(on & (low < high), t, np.nan), face, np.abs(w) / length))
        at = np.array([t for t, _, _ in candidates])
        # Two of them are crossings: a line may pass an edge so near that more or fewer seem to be.
        order = np.argsort(at, axis=0)[:2]
        crosses = (~np.isnan(at)).sum(axis=0) >= 2
        near_and_far = np.take_along_axis(at, order, axis=0) + shift
        between = near_and_far[:, crosses].mean(axis=0)[:, None]
        middle = starts[crosses] + between * ways[crosses]
        crosses[crosses] = self.outside(middle, larger[crosses]) < -reach[crosses]
        near_and_far[:, ~crosses | self.is_nothing] = np.nan
        steepness = np.array([np.broadcast_to(s, shift.shape) for _, _, s in candidates])
        faces = np.array([face for _, face, _ in candidates])
        return Crossings(near_and_far, faces[order], np.take_along_axis(steepness, order, axis=0))

    def normal(self, points: Array, face: Array) -> Array:
        """Return the outward normals at points of some faces, (n, 3); 0 on the axis."""
        x, y, z = np.moveaxis(self.in_frame(points - self.start), -1, 0)
        length = np.hypot(x, y)
        length = np.where(length > 0, length, 1)
        flat = face != SIDE
        sign = np.where(face == END_CAP, 1, -1)
        zero = np.zeros_like(z)
        local = np.stack(
            [
                np.where(flat, zero, x / length),
                np.where(flat, zero, y / length),
                np.where(flat, sign, zero),
            ],
            axis=-1,
        )
        return self.inside_out(local)

    def is_second(self, points: Array, reach: Array) -> Array:
        """Tell whether points, (n, 3), are in the half at the end, and farther than that in it."""
        return self.in_frame(points - self.start)[..., 2] > self.length / 2 + reach


def _cross(a: Array, b: Array) -> Array:
    return np.array([a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)])
