"""Geometry of a drawing: the plane in which it cuts a scene."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.figures.traced_rays import TracedRays
from vtray.geometry.vector import Vec

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Section:
    """The plane of the drawing.

    Attributes
    ----------
    origin
        A point of it in world space, (0, 0) in the drawing.
    across, up
        Its unit axes in world space, to the right and upwards in the drawing.
    normal
        Square to both.
    """

    origin: Floats
    across: Floats
    up: Floats
    normal: Floats

    def __call__(self, points: Any) -> Floats:  # noqa: ANN401
        """Return points in world space, (..., 3), in the drawing, (..., 2)."""
        way = np.asarray(points, float) - self.origin
        return np.stack([way @ self.across, way @ self.up], axis=-1)

    def turn(self, direction: Any) -> Floats:  # noqa: ANN401
        """Return a direction in world space as one in the drawing."""
        return self(np.asarray(direction) + self.origin)

    def height(self, points: Any) -> Floats:  # noqa: ANN401
        """Return how far points in world space, (..., 3), are on the side of the normal, (...)."""
        off: Floats = (np.asarray(points, float) - self.origin) @ self.normal
        return off


def choose_section(tree: TracedRays, along: Vec | None) -> Section:
    """Return the plane through the camera ray and another direction, or upright without one.

    The drawing's right is where the camera looks, as far as it lies in the plane, so the image
    plane is a vertical line; up is up in the image, if the plane allows.
    """
    view = tree.view
    forward, down = np.array(view.forward), np.array(view.down)
    direction = np.array(tree.direction)
    other = -down if along is None else np.array(along)
    normal = np.cross(direction, other)
    if np.linalg.norm(normal) < 1e-6:
        normal = np.cross(direction, -down)
    normal /= np.linalg.norm(normal)
    up = np.cross(normal, forward)
    up /= np.linalg.norm(up)
    rise = -up @ down
    if abs(rise) < 0.2 and along is not None:
        rise = up @ other
    if rise < 0:
        up, normal = -up, -normal
    return Section(np.array(tree.origin), np.cross(up, normal), up, normal)


def widen(box: Floats, aspect: float) -> Floats:
    """Return a box around another one, whose width over its height is the aspect."""
    width, height = box[1] - box[0]
    grow = np.array([max(aspect * height - width, 0.0), max(width / aspect - height, 0.0)]) / 2
    return np.array([box[0] - grow, box[1] + grow])
