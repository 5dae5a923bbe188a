"""What a drawing of rays shows, and where: its plane, its edges, and how far rays go in it."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.figures.drawn.objects import placed_shapes, shape_of
from vtray.figures.fan_lines import DOME, fan_lines, is_around, lamp_shape
from vtray.figures.path_ends import path_ends
from vtray.figures.pen import Pen
from vtray.figures.section import Section, widen
from vtray.figures.traced_rays import Hit, ShadowFan, ShadowRay, TracedRays, WayToLight

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

FAR = 1.3
"""Lights farther away than this many camera rays are not drawn, only the way to them."""

LARGE = 0.5
"""Shining balls are not shown as a whole whose radius is more than this many camera rays."""

SUN = 1e3
"""A sun stands as many camera rays away, to find where the way to it leaves the drawing."""


class Stage(Pen):
    """The part of a plane in which the rays of a pixel are drawn.

    Attributes
    ----------
    tree, section
        The rays, and the plane.
    origin, pixel, end
        Where the camera ray starts, meets the image plane and ends, in the drawing.
    ray
        Its direction in the drawing.
    box
        The corners of what is shown: lower left, upper right.
    size
        How long its diagonal is.
    """

    def __init__(self, tree: TracedRays, section: Section, ax: "Axes") -> None:
        self.tree = tree
        super().__init__(ax)
        self.section = section
        self.origin = section(tree.origin)
        self.ray = section.turn(tree.direction)
        view = tree.view
        steep = float(np.dot(tree.direction, view.forward))
        self.pixel = self.origin + self.ray * (view.focus / steep)
        self.end = self.origin + self.ray * self._ray_length()
        self.box = self._find_box()
        self.size = float(np.hypot(*(self.box[1] - self.box[0])))

    def _ray_length(self) -> float:
        """Return how long the camera ray is drawn."""
        tree = self.tree
        if tree.hit is not None:
            return tree.hit.distance
        steep = float(np.dot(tree.direction, tree.view.forward))
        reach = 3 * tree.view.focus or 1.0  # a panorama has no image plane
        forward = np.array(tree.view.forward)
        for shapes, at in placed_shapes(tree.scene.objects):
            ahead = (shapes.middle - np.array(tree.origin)) @ forward
            # Not the median of all sums, of which there may be too many.
            middle = float(np.median(ahead)) + float(np.median(at @ forward))
            reach = max(reach, 1.15 * middle)
        return reach / steep

    def _find_box(self) -> Floats:
        """Return the corners of what is shown: lower left, upper right."""
        points = [self.origin, self.pixel, self.end, *self.image_plane()]
        length = float(np.hypot(*(self.end - self.origin)))
        hit = self.tree.hit
        if hit is not None:
            shape = shape_of(self.tree.scene, hit.surface)
            if shape is not None:
                low, high = shape.bounds(self.section)
                if (high - low).max() > length:
                    low, high = self.end - 0.5 * length, self.end + 0.5 * length
                points += [low, high]
            for way in self.tree.lights:
                points += self._points_of(way, hit)
            points += [self.section(end) for end in path_ends(self.tree.path)]
        corners = np.array(points)
        low, high = corners.min(0), corners.max(0)
        margin = 0.06 * float(np.hypot(*(high - low)))
        return widen(
            np.array([low - margin, high + np.array([2 * margin, margin])]), self._aspect()
        )

    def _points_of(self, way: WayToLight, hit: Hit) -> list[Floats]:
        """Return what of the way to a light is shown at least."""
        radius = 0.0
        if isinstance(way, ShadowFan):
            if is_around(way):
                lines = fan_lines(self.tree.scene, hit, way, 1.0, DOME * hit.distance)
                return [*self.section(lines.arriving), *self.section(lines.stopped)]
            lamp = lamp_shape(self.tree.scene, way)
            radius = 0.0 if lamp is None or lamp.radius > LARGE * hit.distance else lamp.radius
        place = self.place_of(way)
        to_light = place - self.end
        distance = float(np.hypot(*to_light))
        points = [self.end + to_light * min(1.0, 0.6 * hit.distance / max(distance, 1e-300))]
        if distance < FAR * hit.distance:
            points += [place - radius, place + radius]
        return points

    def place_of(self, way: WayToLight) -> Floats:
        """Return where the middle of a light is in the drawing, which may be far outside of it."""
        assert self.tree.hit is not None  # noqa: S101
        if isinstance(way, ShadowRay):
            return self.section(way.location)
        lamp = lamp_shape(self.tree.scene, way)
        if lamp is not None:
            return self.section(lamp.place)
        away = SUN * self.tree.hit.distance
        return self.section(np.array(self.tree.hit.point) + away * np.array(way.direction))

    def _aspect(self) -> float:
        """Return the width of the axes over their height."""
        area = self.ax.get_window_extent()
        return float(area.width / area.height)

    def image_plane(self) -> tuple[Floats, Floats]:
        """Return the ends of the image in the drawing."""
        view, tree = self.tree.view, self.tree
        up = self.section.up
        along = np.array([up @ view.right, up @ view.down])
        steep = float(np.dot(tree.direction, view.forward))
        place = (
            np.array(tree.origin) + np.array(tree.direction) * (view.focus / steep) - view.center
        )
        pixel = np.array([place @ view.right, place @ view.down])
        half = np.array(view.size) * view.resolution / 2
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = np.stack([(-half - pixel) / along, (half - pixel) / along])
        first = np.nanmax(np.where(along == 0, -np.inf, ends.min(0)))
        last = np.nanmin(np.where(along == 0, np.inf, ends.max(0)))
        straight = np.array([0.0, 1.0])
        return self.pixel + first * straight, self.pixel + last * straight

    def frame(self) -> None:
        """Set up the axes."""
        self.ax.set_aspect("equal")
        self.ax.set_xlim(*map(float, self.box[:, 0]))
        self.ax.set_ylim(*map(float, self.box[:, 1]))
        self.ax.set_axis_off()

    def front(self, artist: Any) -> Any:  # noqa: ANN401
        """Show an artist only in front of the image plane, where objects exist."""
        from matplotlib.patches import Rectangle

        (left, bottom), (right, top) = self.box
        start = max(left, min(self.pixel[0], right))
        region = Rectangle(
            (start, bottom), right - start, top - bottom, transform=self.ax.transData
        )
        artist.set_clip_path(region)
        return artist

    def light_place(self, to_light: WayToLight) -> tuple[Floats, bool]:
        """Return where the way to a light ends in the drawing, and whether the light is there."""
        place = self.place_of(to_light)
        low, high = self.box
        if (low <= place).all() and (place <= high).all():
            return place, True
        way = place - self.end
        inner = np.array([low, high]) * 0.78 + self.box.mean(0) * 0.22  # room for the text
        with np.errstate(divide="ignore", invalid="ignore"):
            steps = np.where(way > 0, (inner[1] - self.end) / way, (inner[0] - self.end) / way)
        step = float(np.where(way == 0, np.inf, steps).min())
        return self.end + way * max(step, 0.0), False
