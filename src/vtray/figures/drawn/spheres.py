"""Spheres as a drawing shows them: a plane cuts circles out of them."""

from typing import TYPE_CHECKING, Any

import numpy as np

from vtray.figures.drawn.shapes import Cuts, DrawnShapes, Floats
from vtray.figures.section import Section

if TYPE_CHECKING:
    from matplotlib.patches import Patch


class DrawnSpheres(DrawnShapes):
    """Some spheres."""

    @property
    def middle(self) -> Floats:
        """Their centres."""
        return self.points[0]

    @property
    def extent(self) -> Floats:
        """Their radii."""
        return self.radius

    def cut(self, section: Section) -> Cuts:
        """Return the circles that a plane cuts out of them."""
        (center,) = self.points
        squared = self.radius**2 - section.height(center) ** 2
        return Cuts(section(center), np.sqrt(np.where(squared > 0, squared, np.nan)))

    def sections(self, section: Section, **style: Any) -> "list[Patch]":  # noqa: ANN401
        """Return circles."""
        return [_circle(*circle, style) for circle in zip(*self.cut(section), strict=True)]

    def share(self, section: Section) -> float:
        """Return the radius of the circle, in parts of the sphere's."""
        return float(self.cut(section).reach[0] / self.radius[0])

    def outline(self, section: Section, **style: Any) -> "Patch":  # noqa: ANN401
        """Return a circle."""
        return _circle(section(self.middle[0]), self.radius[0], style)

    def bounds(self, section: Section) -> tuple[Floats, Floats]:
        """Return the box around a circle."""
        middle, radius = section(self.middle[0]), self.radius[0]
        return middle - radius, middle + radius

    def inside(self, start: Floats, way: Floats) -> tuple[float, float]:
        """Return where a line enters and leaves."""
        arm = start - self.middle[0]
        toward = -float(arm @ way)
        foot = arm + toward * way
        half = float(np.sqrt(max(self.radius[0] ** 2 - foot @ foot, 0.0)))
        return toward - half, toward + half


def _circle(middle: Floats, radius: float, style: dict[str, Any]) -> "Patch":
    """Return a circle to be drawn."""
    from matplotlib.patches import Circle

    return Circle((float(middle[0]), float(middle[1])), float(radius), **style)
