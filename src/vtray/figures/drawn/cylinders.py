"""Cylinders as a drawing shows them: a plane cuts out ellipses, cut off by caps, or rectangles."""

from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from vtray.figures.drawn.shapes import Cuts, DrawnShapes, Floats
from vtray.figures.section import Section

if TYPE_CHECKING:
    from matplotlib.patches import Patch

PLACES = 97
"""Corners on each side of what a plane cuts out of a cylinder."""


class Lie(NamedTuple):
    """How cylinders lie to a plane.

    A point of the plane is t along the axis, as that lies in the drawing, and s beside it, both
    from where the start lies there. In space it is ``rise + slope * t`` along the axis, and off it
    s in one direction, and ``off + drift * t`` in the other.

    Attributes
    ----------
    start
        Where cylinders start, in the drawing, (n, 2).
    along, beside
        The unit directions of t and s in the drawing, (n, 2).
    rise, slope, off, drift
        As above, (n,).
    length
        Of the cylinders, (n,).
    """

    start: Floats
    along: Floats
    beside: Floats
    rise: Floats
    slope: Floats
    off: Floats
    drift: Floats
    length: Floats


class DrawnCylinders(DrawnShapes):
    """Some cylinders."""

    @property
    def widest(self) -> Floats:
        """Their radii where they are widest, (n,)."""
        return self.radius

    @property
    def extent(self) -> Floats:
        """From their middles to the edges of their caps."""
        start, end = self.points
        extent: Floats = np.hypot(np.linalg.norm(end - start, axis=1) / 2, self.widest)
        return extent

    def cut(self, section: Section) -> Cuts:
        """Return circles around what a plane cuts out of them."""
        lie = self._lie(section)
        low, high = self._range(lie)
        meets = (low < high) & (self.widest > 0)
        low, high = np.where(meets, low, np.nan), np.where(meets, high, np.nan)
        middle = lie.start + lie.along * ((low + high) / 2)[:, None]
        return Cuts(middle, np.hypot((high - low) / 2, self.widest))

    def sections(self, section: Section, **style: Any) -> "list[Patch]":  # noqa: ANN401
        """Return polygons."""
        from matplotlib.patches import Polygon

        return [Polygon(corners, **style) for corners in self.corners(section)]

    def corners(self, section: Section) -> Floats:
        """Return the corners of what a plane, which cuts all, cuts out of them, (n, m, 2)."""
        lie = self._lie(section)
        low, high = self._range(lie)
        # Closer together towards the ends, where an ellipse bends.
        steps = np.cos(np.linspace(np.pi, 0, PLACES))
        t = ((low + high) / 2)[:, None] + ((high - low) / 2)[:, None] * steps
        off = lie.off[:, None] + t * lie.drift[:, None]
        s = np.sqrt(np.maximum(np.square(self._radius_at(lie, t)) - np.square(off), 0.0))
        middle = lie.start[:, None] + lie.along[:, None] * t[..., None]
        side = lie.beside[:, None] * s[..., None]
        return np.concatenate([middle + side, (middle - side)[:, ::-1]], axis=1)

    def share(self, section: Section) -> float:
        """Return the root of the area that a plane cuts out, in parts of that of the outline."""
        if np.isnan(self.cut(section).reach[0]):
            return 0.0
        areas = _area(self.corners(section)[0]), _area(self._outline(section))
        return float(np.sqrt(areas[0] / areas[1]))

    def outline(self, section: Section, **style: Any) -> "Patch":  # noqa: ANN401
        """Return a polygon."""
        from matplotlib.patches import Polygon

        return Polygon(self._outline(section), **style)

    def bounds(self, section: Section) -> tuple[Floats, Floats]:
        """Return the box around a polygon."""
        corners = self._outline(section)
        return corners.min(axis=0), corners.max(axis=0)

    def inside(self, start: Floats, way: Floats) -> tuple[float, float]:
        """Return where a line enters and leaves, through the side or a cap."""
        first, last = self.points[0][0], self.points[1][0]
        length = float(np.linalg.norm(last - first))
        axis = (last - first) / length
        arm = start - first
        height, rise = float(arm @ axis), float(way @ axis)
        low, high = between(np.array([height]), np.array([rise]), 0.0, np.array([length]))
        beside, aside = arm - height * axis, way - rise * axis
        square = float(aside @ aside)
        if square == 0.0:
            return float(low[0]), float(high[0])
        toward = -float(beside @ aside) / square
        foot = beside + toward * aside
        half = float(np.sqrt(max(self.radius[0] ** 2 - foot @ foot, 0.0) / square))
        return max(float(low[0]), toward - half), min(float(high[0]), toward + half)

    def halves(self) -> tuple[Self, Self]:
        """Return the halves at their starts, and those at their ends."""
        (start, end), middle, kind = self.points, self.middle, type(self)
        return kind([start, middle], self.radius), kind([middle, end], self.radius)

    def _lie(self, section: Section) -> Lie:
        """Return how they lie to a plane."""
        start, end = self.points
        length = np.linalg.norm(end - start, axis=1)
        axis = (end - start) / np.where(length > 0, length, 1.0)[:, None]
        shown, steep = section.turn(axis), axis @ section.normal
        slope = np.hypot(*shown.T)
        along = np.where(
            slope[:, None] > 0, shown / np.where(slope > 0, slope, 1.0)[:, None], (1.0, 0.0)
        )
        beside = np.stack([-along[:, 1], along[:, 0]], axis=1)
        below = -section.height(start)
        return Lie(
            section(start), along, beside, below * steep, slope, below * slope, -steep, length
        )

    def _radius_at(self, lie: Lie, t: Floats) -> Floats:  # noqa: ARG002
        """Return the radii at some places of a drawing, (n, 1) or (n, m)."""
        return self.radius[:, None]

    def _range(self, lie: Lie) -> tuple[Floats, Floats]:
        """Return the least and the greatest t in each; nowhere unless that is more."""
        first, last = between(lie.rise, lie.slope, 0.0, lie.length)
        near, far = between(lie.off, lie.drift, -self.radius, self.radius)
        return np.maximum(first, near), np.minimum(last, far)

    def _outline(self, section: Section) -> Floats:
        """Return the corners of the outline of the first: half an ellipse for each cap."""
        lie = self._lie(section)
        turn = np.linspace(-np.pi / 2, np.pi / 2, PLACES)[:, None]
        ahead = abs(lie.drift[0]) * np.cos(turn) * lie.along[0]
        cap = self.radius[0] * (ahead + np.sin(turn) * lie.beside[0])
        end = lie.start[0] + lie.length[0] * lie.slope[0] * lie.along[0]
        return np.concatenate([end + cap, lie.start[0] - cap])


def between(
    begin: Floats, change: Floats, low: Floats | float, high: Floats | float
) -> tuple[Floats, Floats]:
    """Return from which t to which ``begin + change * t`` is between two values, (n,)."""
    level = change == 0
    divisor = np.where(level, 1.0, change)
    with np.errstate(over="ignore"):
        ends = (low - begin) / divisor, (high - begin) / divisor
    always = np.where((low < begin) & (begin < high), -np.inf, np.inf)
    return (
        np.where(level, always, np.minimum(*ends)),
        np.where(level, -always, np.maximum(*ends)),
    )


def _area(corners: Floats) -> float:
    """Return the area of a polygon, (m, 2)."""
    x, y = (corners - corners[0]).T
    return abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1))) / 2
