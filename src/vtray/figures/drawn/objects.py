"""Which objects of a scene are drawn as which shapes, and what a drawing finds among them."""

from typing import TYPE_CHECKING, Any

import numpy as np

from vtray.figures.drawn.cylinders import DrawnCylinders
from vtray.figures.drawn.shapes import DrawnShapes, Floats
from vtray.figures.drawn.spheres import DrawnSpheres
from vtray.figures.section import Section
from vtray.figures.traced_rays import Surface
from vtray.geometry.vector import Vec
from vtray.scene.cylinders import Cylinders
from vtray.scene.objects import Cylinder, Object, Sphere
from vtray.scene.scene import Scene
from vtray.scene.spheres import Spheres
from vtray.scene.vectors import Vector

if TYPE_CHECKING:
    from matplotlib.patches import Patch

SHAPES: dict[type, type[DrawnShapes]] = {
    Sphere: DrawnSpheres,
    Spheres: DrawnSpheres,
    Cylinder: DrawnCylinders,
    Cylinders: DrawnCylinders,
}
"""How objects are drawn that have edges; planes have none."""

MOST_CUTS = 400
"""How many of the shapes that a drawing cuts are shown; the largest."""


def shapes_in(item: Object) -> DrawnShapes | None:
    """Return the shapes of an object; None if it has no edge, or is empty."""
    kind = SHAPES.get(type(item))
    if kind is None:
        return None
    given: Any = item
    hull = given.hull()
    points = [_rows(center) for center, _, _ in hull]
    radius = np.broadcast_to(np.asarray(hull[0][1], float), len(points[0]))
    return kind(points, radius) if len(radius) else None


def _rows(points: Any) -> Floats:  # noqa: ANN401
    """Return points, or one, as (n, 3)."""
    if isinstance(points, Vector):
        points = [(points.x, points.y, points.z)]
    return np.asarray(points, float)


def shape_of(scene: Scene, surface: Surface) -> DrawnShapes | None:
    """Return the shape that a surface is that of; None if it has no edge."""
    kind = SHAPES.get(type(scene.objects[surface.object]))
    if kind is None:
        return None
    points = [surface.center] if surface.end is None else [surface.center, surface.end]
    return kind([_rows([point]) for point in points], np.array([surface.radius], float))


def colored_parts(
    scene: Scene, surface: Surface, shape: DrawnShapes
) -> list[tuple[DrawnShapes, Vec]]:
    """Return the parts of the shape of a surface that have a colour each."""
    item: Any = scene.objects[surface.object]
    if not isinstance(shape, DrawnCylinders) or getattr(item, "color_end", None) is None:
        return [(shape, surface.color)]
    colors = [np.atleast_2d(column).tolist() for column in (item.color, item.color_end)]
    k = surface.index or 0
    return [
        (half, rows[k if len(rows) > 1 else 0])
        for half, rows in zip(shape.halves(), colors, strict=True)
    ]


def cut_shapes(scene: Scene, section: Section, box: Floats) -> "list[Patch]":
    """Return what a plane cuts out of shapes within a box; the largest if they are many."""
    found: list[tuple[float, Patch]] = []
    for item in scene.objects:
        shapes = shapes_in(item)
        if shapes is None:
            continue
        middle, reach = shapes.cut(section)
        near = (middle > box[0] - reach[:, None]) & (middle < box[1] + reach[:, None])
        rows = np.flatnonzero(near.all(axis=1))
        rows = rows[np.argsort(-reach[rows])[:MOST_CUTS]]
        found += zip(reach[rows].tolist(), shapes.some(rows).sections(section), strict=True)
    found.sort(key=lambda pair: -pair[0])
    return [patch for _, patch in found[:MOST_CUTS]]


def where_met(scene: Scene, surface: Surface, start: Vec, way: Vec) -> Floats:
    """Return where in world space a ray meets a surface, beyond its start.

    Parameters
    ----------
    scene
        The scene.
    surface
        What the ray meets.
    start, way
        Where it starts and its unit direction, in world space.
    """
    origin, direction = np.array(start), np.array(way)
    shape = shape_of(scene, surface)
    if shape is None:
        normal = np.array(surface.normal)
        arm = origin - np.array(surface.center)
        return origin - direction * float(normal @ arm) / float(normal @ direction)
    near, far = shape.inside(origin, direction)
    # A ray that starts on the surface, or inside, meets it where it leaves.
    return origin + direction * (near if near > 1e-9 * (far - near) else far)
