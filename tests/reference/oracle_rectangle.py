"""Rectangle lamps by the rules alone, in long doubles: solid angles as sums of arc tangents.

Where a line divides a rectangle is found by halving, not by the formulas of vtray.
"""

from typing import NamedTuple

import numpy as np

Array = np.ndarray
Long = np.longdouble

PI = 4 * np.arctan(Long(1))
HALVINGS = 90


class Panel(NamedTuple):
    """A rectangle as it is seen from a point.

    Attributes
    ----------
    across, up, toward
        Unit vectors along the edges, and from the point to the plane of the rectangle, (3,).
    x, y, height
        Its middle along these.
    half
        Half the lengths of the edges.
    """

    across: Array
    up: Array
    toward: Array
    x: Long
    y: Long
    height: Long
    half: tuple[Long, Long]

    def angle(self, right: Array) -> Array:
        """Return the solid angle of its part up to x = right, (n,)."""
        total = Long(0)
        for x, side in ((right, 1), (np.array([self.x - self.half[0]]), -1)):
            for y, other in ((self.y + self.half[1], 1), (self.y - self.half[1], -1)):
                far = self.height * np.sqrt(x * x + y * y + self.height**2)
                total = total + side * other * np.arctan2(x * y, far)
        return total

    @property
    def solid_angle(self) -> Long:
        """The whole solid angle; of a small one as if it were flat, as arc tangents cancel."""
        distance2 = self.x**2 + self.y**2 + self.height**2
        area = 4 * self.half[0] * self.half[1]
        if max(self.half) ** 2 < Long(2) ** -40 * distance2:
            return area * self.height / distance2 ** Long(1.5)
        return self.angle(np.array([self.x + self.half[0]]))[0]

    @property
    def square_integral(self) -> Long:
        """What a surface gets that is squarely before it, as far away as its nearest point is."""
        gaps = [abs(self.x) - self.half[0], abs(self.y) - self.half[1]]
        distance2 = self.height**2 + sum(max(gap, Long(0)) ** 2 for gap in gaps)
        total = Long(0)
        for one, other in (self.half, self.half[::-1]):
            away = np.sqrt(distance2 + one * one)
            total += 2 * one / away * np.arctan(other / away)
        return total

    def ways(self, points: Array) -> tuple[Array, Array]:
        """Return unit vectors to it for points of the unit square, and how exact they are."""
        u, v = points.astype(Long).T
        low = np.full(len(u), self.x - self.half[0])
        high = np.full(len(u), self.x + self.half[0])
        whole = self.angle(high)
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            is_left = self.angle(middle) < u * whole
            low, high = np.where(is_left, middle, low), np.where(is_left, high, middle)
        x, bottom, top = (low + high) / 2, self.y - self.half[1], self.y + self.half[1]
        distance2 = x * x + self.height**2
        lower, upper = (y / np.sqrt(distance2 + y * y) for y in (bottom, top))
        sine = lower + v * (upper - lower)
        y = np.clip(sine * np.sqrt(distance2 / (1 - sine * sine)), bottom, top)
        length = np.sqrt(distance2 + y * y)
        parts = (
            (x / length, self.across),
            (y / length, self.up),
            (self.height / length, self.toward),
        )
        slope = 1 + np.abs(x) / self.height + np.abs(y) / np.sqrt(distance2)
        return sum(part[:, None] * axis for part, axis in parts), slope


def panel_of(way: Array, edges: tuple[Array, Array]) -> Panel:
    """Return how a rectangle is seen, given the way to its middle and its edges."""
    lengths = [np.sqrt(edge @ edge) for edge in edges]
    across = edges[0] / lengths[0]
    up = edges[1] / lengths[1]
    for _ in range(2):
        up = up - (up @ across) * across
        up = up / np.sqrt(up @ up)
    toward = np.cross(across, up)
    toward = toward if toward @ way >= 0 else -toward
    half = lengths[0] / 2, lengths[1] / 2
    return Panel(across, up, toward, way @ across, way @ up, way @ toward, half)
