"""Cones as a drawing shows them: a plane cuts out what caps leave of ellipses or hyperbolas."""

from typing import Self

import numpy as np

from vtray.figures.drawn.cylinders import PLACES, DrawnCylinders, Lie, between
from vtray.figures.drawn.shapes import Floats
from vtray.figures.section import Section


class DrawnCones(DrawnCylinders):
    """Some cones, whose radii are those at both ends, (n, 2)."""

    @property
    def widest(self) -> Floats:
        """The larger of their radii, (n,)."""
        widest: Floats = self.radius.max(axis=1)
        return widest

    def inside(self, start: Floats, way: Floats) -> tuple[float, float]:
        """Return where a line enters and leaves, through the side or a cap."""
        first, last = self.points[0][0], self.points[1][0]
        length = float(np.linalg.norm(last - first))
        axis = (last - first) / length
        arm = start - first
        height, rise = float(arm @ axis), float(way @ axis)
        beside, aside = arm - height * axis, way - rise * axis
        narrow, wide = (float(radius) for radius in self.radius[0])
        slope = (wide - narrow) / length
        room, change = narrow + slope * height, slope * rise
        # |beside + t aside| = room + t change
        square = float(aside @ aside) - change * change
        half = float(beside @ aside) - room * change
        rest = float(beside @ beside) - room * room
        root = float(np.sqrt(max(half * half - square * rest, 0.0)))
        total = -half - root if half >= 0 else root - half
        found = [a / b for a, b in ((total, square), (rest, total)) if b != 0]
        places = [t for t in found if 0 <= height + t * rise <= length]
        for level, radius in ((0.0, narrow), (length, wide)):
            t = (level - height) / rise if rise else np.inf
            if np.isfinite(t) and np.linalg.norm(beside + t * aside) <= radius:
                places.append(t)
        return min(places, default=0.0), max(places, default=0.0)

    def halves(self) -> tuple[Self, Self]:
        """Return the halves at their starts, and those at their ends."""
        (start, end), middle, kind = self.points, self.middle, type(self)
        half = self.radius.mean(axis=1)
        one, other = (np.stack([radius, half], axis=1) for radius in self.radius.T)
        return kind([start, middle], one), kind([middle, end], other[:, ::-1])

    def _radius_at(self, lie: Lie, t: Floats) -> Floats:
        """Return the radii at some places of a drawing, (n, m)."""
        height = lie.rise[:, None] + lie.slope[:, None] * t
        first, slope = self.radius[:, 0], self._slope(lie)
        radii: Floats = np.maximum(first[:, None] + slope[:, None] * height, 0.0)
        return radii

    def _slope(self, lie: Lie) -> Floats:
        """Return by how much the radii grow with each unit of length along the axes, (n,)."""
        growth: Floats = self.radius[:, 1] - self.radius[:, 0]
        return growth / np.where(lie.length > 0, lie.length, 1.0)

    def _range(self, lie: Lie) -> tuple[Floats, Floats]:
        """Return the least and the greatest t in each; nowhere unless that is more."""
        near, far = between(lie.rise, lie.slope, 0.0, lie.length)
        slope = self._slope(lie)
        room, change = self.radius[:, 0] + slope * lie.rise, slope * lie.slope
        for side in (-1.0, 1.0):
            # Off the axis, the side is on both sides.
            ends = between(room + side * lie.off, change + side * lie.drift, 0.0, np.inf)
            near, far = np.maximum(near, ends[0]), np.minimum(far, ends[1])
        return near, far

    def _outline(self, section: Section) -> Floats:
        """Return the corners of the outline of the first: an arc of an ellipse for each cap."""
        lie = self._lie(section)
        first, last = (float(radius) for radius in self.radius[0])
        flat = abs(float(lie.drift[0]))
        apart, narrower = float(lie.length[0] * lie.slope[0]), flat * (first - last)
        # Where lines touch both ellipses; one may lie within the other.
        turn = np.arccos(
            np.clip(narrower / apart if apart > abs(narrower) else np.sign(first - last), -1, 1)
        )
        end = lie.start[0] + apart * lie.along[0]

        def arc(middle: Floats, radius: float, begin: float, after: float) -> Floats:
            angle = np.linspace(begin, after, PLACES)[:, None]
            ahead, aside = np.cos(angle) * flat * lie.along[0], np.sin(angle) * lie.beside[0]
            points: Floats = middle + radius * (ahead + aside)
            return points

        arcs = [arc(end, last, -turn, turn), arc(lie.start[0], first, turn, 2 * np.pi - turn)]
        if turn in (0.0, np.pi):
            return arcs[1 if turn == 0.0 else 0]
        return np.concatenate(arcs)
