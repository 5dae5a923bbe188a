"""The surface at a point: its normal, for shapes of any kind."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.shapes.columns import Columns
from vtray.geometry.shapes.cylinder import cylinder_pole, is_second_half, load_cylinder
from vtray.geometry.shapes.plane import load_plane
from vtray.geometry.shapes.sphere import load_sphere
from vtray.geometry.vector import Vec, dot, scale, sub
from vtray.geometry.world import PLANE, SPHERE, Group, World


class Surface(NamedTuple):
    """What a surface is like at a point.

    Attributes
    ----------
    pole
        The unit normal of a flat surface; of a round one the point that it is round, from which its
        normal leads away.
    is_round
        Which of the two it is.
    error_scale
        What the rounding errors of the shape are relative to.
    is_second
        Whether it is in the second half of a shape that has two, which may differ in colour.
    """

    pole: Vec
    is_round: bool
    error_scale: float
    is_second: bool


@device
def surface_of(world: World, group: Group, slot: int, point: Vec, error_scale: float) -> Surface:
    """Return the surface of a shape of a group at a point.

    Parameters
    ----------
    world, group, slot
        The shape.
    point
        The point.
    error_scale
        What its rounding error is relative to, beside the shape.
    """
    if group.kind == PLANE:
        plane = load_plane(world.planes, slot, group.place)
        return Surface(plane.normal, False, plane.error_scale, False)
    if group.kind == SPHERE:
        sphere = load_sphere(world.spheres, slot, group.place)
        return Surface(sphere.center, True, sphere.error_scale, False)
    return _cylinder_surface(world.cylinders, group, slot, point, error_scale)


@device
def _cylinder_surface(
    cylinders: Columns | None, group: Group, slot: int, point: Vec, error_scale: float
) -> Surface:
    """Return the surface of a cylinder at a point."""
    if cylinders is None:
        return Surface(point, False, 0.0, False)
    cylinder = load_cylinder(cylinders, slot, group.place)
    pole, is_round = cylinder_pole(cylinder, point)
    is_second = is_second_half(cylinder, point, error_scale)
    return Surface(pole, is_round, cylinder.error_scale, is_second)


@device
def normal_at(pole: Vec, is_round: bool, point: Vec, direction: Vec) -> Vec:
    """Return the unit normal at a point, on the side that a ray of a direction comes from.

    That of a round surface so small that rounding put the point on its pole is towards the ray.
    """
    outward = sub(point, pole)
    length2 = dot(outward, outward)
    length = math.sqrt(length2) if length2 > 0.0 else -1.0
    x = outward[0] if length2 > 0.0 else direction[0]
    y = outward[1] if length2 > 0.0 else direction[1]
    z = outward[2] if length2 > 0.0 else direction[2]
    normal = (
        x / length if is_round else pole[0],
        y / length if is_round else pole[1],
        z / length if is_round else pole[2],
    )
    side = -1.0 if dot(normal, direction) > 0.0 else 1.0
    return scale(side, normal)
