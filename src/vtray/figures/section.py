"""Geometry of a drawing: the plane in which it cuts a scene, and what lies there."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.figures.traced_rays import ShadowRay, TracedRays
from vtray.scene.scene import Scene, Sphere
from vtray.scene.spheres import Spheres

Floats = NDArray[np.float64]

MOST_CIRCLES = 400
"""How many of the spheres that a drawing cuts are shown; the largest."""


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

    def cut(self, centers: Floats, radii: Any) -> Floats:  # noqa: ANN401
        """Return the radii of the circles that it cuts out of spheres; NaN if it misses them."""
        off = (centers - self.origin) @ self.normal
        squared = np.asarray(radii, float) ** 2 - off**2
        return np.sqrt(np.where(squared > 0, squared, np.nan))


def choose_section(tree: TracedRays, ray: ShadowRay | None) -> Section:
    """Return the plane through the camera ray and a shadow ray, or upright if there is none.

    The drawing's right is where the camera looks, as far as it lies in the plane, so the image
    plane is a vertical line; up is up in the image, if the plane allows.
    """
    view = tree.view
    forward, down = np.array(view.forward), np.array(view.down)
    direction = np.array(tree.direction)
    other = -down if ray is None else np.array(ray.direction)
    normal = np.cross(direction, other)
    if np.linalg.norm(normal) < 1e-6:
        normal = np.cross(direction, -down)
    normal /= np.linalg.norm(normal)
    up = np.cross(normal, forward)
    up /= np.linalg.norm(up)
    rise = -up @ down
    if abs(rise) < 0.2 and ray is not None:
        rise = up @ other
    if rise < 0:
        up, normal = -up, -normal
    return Section(np.array(tree.origin), np.cross(up, normal), up, normal)


def spheres_of(item: Sphere | Spheres) -> tuple[Floats, Floats]:
    """Return centres, (n, 3), and radii, (n,), of one or many spheres."""
    if isinstance(item, Sphere):
        center = np.array([[item.center.x, item.center.y, item.center.z]])
        return center, np.array([item.radius])
    radii = np.broadcast_to(np.asarray(item.radius, float), len(item))
    return np.asarray(item.center, float), radii


def cut_spheres(scene: Scene, section: Section, box: Floats) -> tuple[Floats, Floats]:
    """Return the largest of the circles that a plane cuts out of spheres, within a box."""
    centers, radii = [np.zeros((0, 2))], [np.zeros(0)]
    for item in scene.objects:
        if not isinstance(item, (Sphere, Spheres)):
            continue
        center, radius = spheres_of(item)
        cut = section.cut(center, radius)
        flat = section(center)
        near = np.flatnonzero(
            ((flat > box[0] - cut[:, None]) & (flat < box[1] + cut[:, None])).all(1)
        )
        near = near[np.argsort(-cut[near])[:MOST_CIRCLES]]
        centers.append(flat[near])
        radii.append(cut[near])
    largest = np.argsort(-np.concatenate(radii))[:MOST_CIRCLES]
    return np.concatenate(centers)[largest], np.concatenate(radii)[largest]


def widen(box: Floats, aspect: float) -> Floats:
    """Return a box around another one, whose width over its height is the aspect."""
    width, height = box[1] - box[0]
    grow = np.array([max(aspect * height - width, 0.0), max(width / aspect - height, 0.0)]) / 2
    return np.array([box[0] - grow, box[1] + grow])


def where_blocked(tree: TracedRays, ray: ShadowRay) -> Floats:
    """Return where in world space a shadow ray meets its blocker."""
    hit, blocker = tree.hit, ray.blocker
    assert hit is not None  # noqa: S101
    assert blocker is not None  # noqa: S101
    start, way = np.array(hit.point), np.array(ray.direction)
    arm = start - np.array(blocker.center)
    if blocker.normal is not None:
        normal = np.array(blocker.normal)
        return start - way * float(normal @ arm) / float(normal @ way)
    assert blocker.radius is not None  # noqa: S101
    toward = -float(arm @ way)
    foot = arm + toward * way
    half = math.sqrt(max(blocker.radius**2 - float(foot @ foot), 0.0))
    outside = float(arm @ arm) > blocker.radius**2 * (1 + 1e-9)
    return start + way * (toward - half if outside else toward + half)
