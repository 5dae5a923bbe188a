"""Which objects of a scene are drawn as which shapes, and what a drawing finds among them."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from vtray.figures.drawn.cones import DrawnCones
from vtray.figures.drawn.cylinders import DrawnCylinders
from vtray.figures.drawn.shapes import DrawnShapes, Floats
from vtray.figures.drawn.spheres import DrawnSpheres
from vtray.figures.section import Section
from vtray.figures.traced_rays import Surface
from vtray.geometry.vector import Vec
from vtray.scene.cones import Cones
from vtray.scene.copies import Copies
from vtray.scene.cylinders import Cylinders
from vtray.scene.objects import Cone, Cylinder, Object, Sphere
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
    Cone: DrawnCones,
    Cones: DrawnCones,
}
"""How objects are drawn that have edges; planes have none."""

MOST_CUTS = 400
"""How many of the shapes that a drawing cuts are shown; the largest."""

PAIRS = 1 << 18
"""How many shapes at places are looked at together at the most, if those at one are not more."""


def placed_shapes(objects: Sequence[Object]) -> Iterator[tuple[DrawnShapes, Floats]]:
    """Give the shapes of objects that have edges, each with the translations to where they are.

    Yields
    ------
    shapes, at
        At least one shape, as given, and at least one translation in world space, (n, 3).
    """
    for item in objects:
        if isinstance(item, Copies):
            if len(item):
                at = _rows(item.at)
                yield from ((shapes, at) for shapes, _ in placed_shapes(item.objects))
        elif type(item) in SHAPES and (shapes := _shapes_of(item)).count:
            yield shapes, np.zeros((1, 3))


def _shapes_of(item: Any) -> DrawnShapes:  # noqa: ANN401
    """Return the shapes of an object that has edges."""
    hull = item.hull()
    points = [_rows(center) for center, _, _ in hull]
    radii = [np.broadcast_to(np.asarray(radius, float), len(points[0])) for _, radius, _ in hull]
    kind = SHAPES[type(item)]
    return kind(points, np.stack(radii, axis=1) if kind is DrawnCones else radii[0])


def _rows(points: Any) -> Floats:  # noqa: ANN401
    """Return points, or one, as (n, 3)."""
    if isinstance(points, Vector):
        points = [(points.x, points.y, points.z)]
    return np.asarray(points, float)


def _item_of(scene: Scene, surface: Surface) -> Any:  # noqa: ANN401
    """Return the object that a surface belongs to, of those that are copied, if it is a copy."""
    item: Any = scene.objects[surface.object]
    return item if surface.part is None else item.objects[surface.part]


def shape_of(scene: Scene, surface: Surface) -> DrawnShapes | None:
    """Return the shape that a surface is that of, where it is; None if it has no edge."""
    kind = SHAPES.get(type(_item_of(scene, surface)))
    if kind is None:
        return None
    points = [surface.center] if surface.end is None else [surface.center, surface.end]
    radii = surface.radius if surface.radius_end is None else (surface.radius, surface.radius_end)
    return kind([_rows([point]) for point in points], np.array([radii], float))


def colored_parts(
    scene: Scene, surface: Surface, shape: DrawnShapes
) -> list[tuple[DrawnShapes, Vec]]:
    """Return the parts of the shape of a surface that have a colour each."""
    item = _item_of(scene, surface)
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
    found: list[tuple[float, DrawnShapes]] = []
    for shapes, at in placed_shapes(scene.objects):
        for near in _near(shapes, at, section, box):
            middle, reach = near.cut(section)
            inside = (middle > box[0] - reach[:, None]) & (middle < box[1] + reach[:, None])
            rows = np.flatnonzero(inside.all(axis=1))
            rows = rows[np.argsort(-reach[rows])[:MOST_CUTS]]
            found += [(float(reach[row]), near.some(np.array([row]))) for row in rows]
            found = sorted(found, key=lambda pair: -pair[0])[:MOST_CUTS]
    return [patch for _, shape in found for patch in shape.sections(section)]


def _near(shapes: DrawnShapes, at: Floats, section: Section, box: Floats) -> Iterator[DrawnShapes]:
    """Give the shapes that a plane may cut where they are, some of them at a time.

    Parameters
    ----------
    shapes, at
        The shapes, and the translations to where they are, (n, 3).
    section, box
        The plane, and the part of it that is looked at.
    """
    middle, extent = shapes.middle, shapes.extent
    # Leave out places where a ball around all shapes is not met.
    low, high = (np.array([end(column) for column in middle.T]) for end in (np.min, np.max))
    ball, around = (low + high) / 2, float(np.linalg.norm(high - low)) / 2 + float(extent.max())
    place = section(ball + at)
    met = ((place > box[0] - around) & (place < box[1] + around)).all(axis=1)
    at = at[met & (np.abs(section.height(ball + at)) < around)]
    height, rise = section.height(middle), at @ section.normal
    step = max(PAIRS // len(height), 1)
    for k in range(0, len(at), step):
        of, row = np.nonzero(np.abs(height + rise[k : k + step, None]) < extent)
        if len(row):
            yield shapes.some(row).moved(at[k + of])


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
