"""The oracle's cone: how far outside points are, and what that is along lines.

How far a point of a line is outside of something convex is a convex function of the place on the
line: its least value is searched for, and where it is 0, by bisection. No equation of a cone is
solved. All is worked out in long doubles.
"""

import itertools
from typing import Any

import numpy as np
from oracle_cylinder import END_CAP, SIDE, START_CAP, Crossings, Cylinder

Array = np.ndarray

SHARE = (np.sqrt(np.longdouble(5)) - 1) / 2
"""The golden section, by which what may hold the least value shrinks with each step."""


class Cone(Cylinder):
    """A cone.

    Parameters
    ----------
    start, end
        Middles of its caps, relative to the image plane, (3,) of long doubles.
    radius, radius_end
        Its radii there.
    """

    def __init__(self, start: Array, end: Array, radius: float, radius_end: float) -> None:
        super().__init__(start, end, max(radius, radius_end))
        self.first, self.last = np.longdouble(radius), np.longdouble(radius_end)
        widening = self.last - self.first
        side = np.sqrt(self.length**2 + widening**2)
        self.cosine, self.sine = (self.length / side, widening / side) if side > 0 else (1, 0)

    def round_and_along(self, points: Array) -> tuple[Array, Array]:
        """Return how far points, (n, 3), are from the axis, and how far along it."""
        x, y, z = np.moveaxis(self.in_frame(points - self.start), -1, 0)
        return np.sqrt(x * x + y * y), z

    def faces(self, away: Array, z: Array, larger: Any) -> Array:
        """Return how far points are outside of the side, and of the caps, (3, ...)."""
        room = self.cosine * self.first + self.sine * z
        return np.stack([self.cosine * away - room, -z, z - self.length]) - larger

    def outside(self, points: Array, larger: Any = 0) -> Array:
        """Return how far points, (n, 3), are outside; below 0 inside."""
        away, z = self.round_and_along(points)
        bound = self.faces(away, z, larger).max(axis=0)
        # The corners of half a section of it, as far as there is one.
        low, high = (
            -np.broadcast_to(larger, z.shape),
            self.length + np.broadcast_to(larger, z.shape),
        )
        radii = [
            (self.cosine * self.first + larger + self.sine * level) / self.cosine
            for level in (low, high)
        ]
        corners = [(0 * z, low), (radii[0], low), (radii[1], high), (0 * z, high)]
        lengths = []
        for (one, h), (other, k) in itertools.pairwise(corners):
            r, s = np.maximum(one, 0), np.maximum(other, 0)
            length2 = (s - r) ** 2 + (k - h) ** 2
            share = ((away - r) * (s - r) + (z - h) * (k - h)) / np.where(length2 > 0, length2, 1)
            share = np.clip(share, 0, 1)
            lengths.append(np.hypot(away - r - share * (s - r), z - h - share * (k - h)))
        return np.where(bound > 0, np.maximum(np.min(lengths, axis=0), bound), bound)

    def cross_near(
        self, starts: Array, ways: Array, shift: Array, reach: Array, larger: Array
    ) -> Crossings:
        """Return where lines cross the surface; see `Cylinder.cross_near`."""
        length = np.sqrt((ways * ways).sum(axis=-1))
        x, y, z = np.moveaxis(self.in_frame(starts + shift[:, None] * ways - self.start), -1, 0)
        u, v, w = np.moveaxis(self.in_frame(ways), -1, 0)

        def beyond(t: Array) -> Array:
            away = np.hypot(x + t * u, y + t * v)
            return self.faces(away, z + t * w, larger)

        def bound(t: Array) -> Array:
            return beyond(t).max(axis=0)

        half = (self.length + 2 * self.radius + 4 * np.abs(larger)) / length
        low, high = -half, half
        for _ in range(80):
            one, other = high - SHARE * (high - low), low + SHARE * (high - low)
            left = bound(one) < bound(other)
            low, high = np.where(left, low, one), np.where(left, other, high)
        least = (low + high) / 2
        ends = []
        for end in (-half, half):
            inner, outer = least, end + 0 * least
            for _ in range(75):
                between = (inner + outer) / 2
                inside = bound(between) < 0
                inner, outer = np.where(inside, between, inner), np.where(inside, outer, between)
            ends.append(inner)
        at = np.array(ends)
        crosses = bound((at[0] + at[1]) / 2) < -reach
        found = [beyond(t).argmax(axis=0) for t in at]
        steepness = []
        for t, face in zip(at, found, strict=True):
            away = np.hypot(x + t * u, y + t * v)
            out = [
                np.where(away > 0, part / np.where(away > 0, away, 1), 0)
                for part in (x + t * u, y + t * v)
            ]
            slant = np.hypot(
                self.cosine * u - self.sine * w * out[0], self.cosine * v - self.sine * w * out[1]
            )
            slant = np.where(away > 0, slant, length)
            steepness.append(np.where(face == 0, slant, np.abs(w)) / length)
        at = np.where(crosses & ~np.bool_(self.is_nothing), at + shift, np.nan)
        return Crossings(
            at, np.array([SIDE, START_CAP, END_CAP])[np.array(found)], np.array(steepness)
        )

    def normal(self, points: Array, face: Array) -> Array:
        """Return the outward normals at points of some faces, (n, 3); 0 on the axis."""
        flat = super().normal(points, face)
        slanted = self.cosine * flat - self.sine * self.frame[2]
        return np.where((face == SIDE)[:, None], slanted, flat)

    def bend(self, points: Array) -> Array:
        """Return the radius of the side where it is round at points, (n, 3)."""
        return self.round_and_along(points)[0] / self.cosine
