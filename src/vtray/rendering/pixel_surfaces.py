"""What a number that rays have met stands for, as users are told it."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import uncompiled
from vtray.base.exact_math import hypotenuse
from vtray.figures.drawn.objects import where_met
from vtray.figures.traced_rays import Surface
from vtray.geometry.vector import Vec, add
from vtray.rendering.numbering import Numbering, find
from vtray.rendering.shape_kinds import KINDS
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.arrays import Arrays
from vtray.scene.copies import Copies
from vtray.scene.objects import Plane
from vtray.scene.placing.directions import unit
from vtray.scene.scene import Scene
from vtray.scene.vectors import Color, Vector


def find_surface(
    scene: Scene, numbering: Numbering, primitive: int, *, is_second: bool = False
) -> Surface:
    """Return the primitive of a number, its colour as on its first or its second half."""
    found = find(scene.objects, numbering, primitive)
    item: Any = scene.objects[found.place]
    copy = part = None
    shift, member = (0.0, 0.0, 0.0), found.member
    if isinstance(item, Copies):
        copy, shift = found.copy, _row(item, "at", found.copy)
        part, member = item.locate(member)
        item = item.objects[part]
    if isinstance(item, Plane):
        center, normal = _vec(item.center), unit(item.normal)
        return Surface(found.place, None, center, None, normal, rgb(item.color), item.lambert)
    (kind,) = (kind for kind in KINDS if isinstance(item, (kind.single, kind.arrays)))
    single = isinstance(item, kind.single)
    if single:
        points = [_vec(getattr(item, name)) for name in kind.points]
        radii = [getattr(item, name) for name in kind.radii]
        color, lambert, number = rgb(item.color), item.lambert, None
    else:
        points = [_row(item, name, member) for name in kind.points]
        halves = is_second and getattr(item, "color_end", None) is not None
        color = _row(item, "color_end" if halves else "color", member)
        radii = [_number(item, name, member) for name in kind.radii]
        lambert, number = _number(item, "lambert", member), member
    if copy is not None:
        points = [uncompiled(add)(point, shift) for point in points]
    (center, *ends), (radius, *others) = points, radii
    end, radius_end = (next(iter(rest), None) for rest in (ends, others))
    return Surface(
        found.place,
        number,
        center,
        radius,
        None,
        color,
        lambert,
        end,
        copy,
        part,
        radius_end=radius_end,
    )


def find_blocker(
    scene: Scene, numbering: Numbering, primitive: int, start: Vec, way: Vec
) -> Surface:
    """Return what blocks a ray, its colour as where the ray meets it.

    Parameters
    ----------
    scene, numbering
        The scene, and the numbers of its primitives.
    primitive
        The number of what blocks the ray.
    start, way
        Where the ray starts and its unit direction, in world space.
    """
    surface = find_surface(scene, numbering, primitive)
    if surface.end is None:
        return surface
    place = where_met(scene, surface, start, way)
    to_end, to_start = (
        (place[0] - end[0], place[1] - end[1], place[2] - end[2])
        for end in (surface.end, surface.center)
    )
    is_second = hypotenuse(*to_end) < hypotenuse(*to_start)
    return find_surface(scene, numbering, primitive, is_second=is_second)


def _vec(point: Vector) -> Vec:
    """Return a point as a tuple."""
    return point.x, point.y, point.z


def rgb(color: Color) -> Vec:
    """Return a colour as a tuple."""
    return float(color.r), float(color.g), float(color.b)


def as_vec(numbers: "Vec | NDArray[Any]") -> Vec:
    """Return three numbers as floats of Python."""
    x, y, z = map(float, numbers)
    return x, y, z


def _row(item: ArrayHolder, name: str, index: int) -> Vec:
    """Return a row of an array, in which one may stand for all."""
    column = getattr(item, name)
    return as_vec(column if column.ndim == 1 else column[index])


def _number(item: Arrays, name: str, index: int) -> float:
    """Return a number of an array, or the one that stands for all."""
    column = np.asarray(getattr(item, name))
    return float(column.item(index if column.size > 1 else 0))
