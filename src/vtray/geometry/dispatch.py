"""The one place of the kernels where kinds of shapes are told apart.

What is done with a shape, an action, is a device function that is given the shape and what shapes
of its kind can do. It is compiled once for each kind, so the loops in it are as fast as if there
were no other. Nothing is compiled for cylinders and cones where there are none: their columns are
None then.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.bundle import Bundle, Crossing
from vtray.geometry.ray import Ray, Segment
from vtray.geometry.shapes.columns import Columns
from vtray.geometry.shapes.cone import (
    cone_crossing,
    cone_distance,
    cone_hides,
    cone_is_aside,
    cone_is_outside,
    cone_sides,
    cone_surface,
    load_cone,
)
from vtray.geometry.shapes.cylinder import (
    cylinder_crossing,
    cylinder_distance,
    cylinder_hides,
    cylinder_is_aside,
    cylinder_is_outside,
    cylinder_sides,
    cylinder_surface,
    load_cylinder,
)
from vtray.geometry.shapes.plane import (
    load_plane,
    plane_crossing,
    plane_distance,
    plane_hides,
    plane_is_aside,
    plane_is_outside,
    plane_sides,
    plane_surface,
)
from vtray.geometry.shapes.sides import Sides
from vtray.geometry.shapes.sphere import (
    load_sphere,
    sphere_crossing,
    sphere_distance,
    sphere_hides,
    sphere_is_aside,
    sphere_is_outside,
    sphere_sides,
    sphere_surface,
)
from vtray.geometry.shapes.surface import Surface
from vtray.geometry.vector import Vec
from vtray.geometry.world import CONE, CYLINDER, PLANE, Group, World

Shape = Any
"""The numbers of a shape in the kernels' space. Each kind has a type of its own; all have an
``error_scale``, and bounded ones ``center`` and ``radius`` of a ball around them."""


class Verbs(NamedTuple):
    """What shapes of a kind can do: the functions of its module.

    Attributes
    ----------
    distance_to
        Returns the distance at which a ray first meets a shape, or infinity.
    is_aside
        Tells whether a ray is sure to miss a shape, at less cost: worth asking one ray at a time.
    hides
        Tells whether a shape stands between two points.
    sides
        Returns half-spaces in which a shape lies as it is seen from a point.
    is_outside
        Tells whether a point of the surface is looked at from outside, given the normal there.
    crossing
        Returns from where to where the rays of a bundle first meet a shape.
    surface
        Returns the surface at a point, whose rounding error is relative to a number beside the
        shape.
    """

    distance_to: Callable[[Shape, Ray], float]
    is_aside: Callable[[Shape, Ray], bool]
    hides: Callable[[Shape, Segment], bool]
    sides: Callable[[Shape, Vec, float], Sides]
    is_outside: Callable[[Shape, Vec, Vec], bool]
    crossing: Callable[[Shape, Bundle], Crossing]
    surface: Callable[[Shape, Vec, float], Surface]


Action = Callable[[Shape, Verbs, int, Any], Any]
"""What is done with a shape: given the shape, its verbs, its number, and arguments of its own."""


@device
def with_any(world: World, group: Group, slot: int, action: Action, arguments: Any) -> Any:  # noqa: ANN401
    """Return what an action returns for a shape of a group of any kind."""
    if group.kind == PLANE:
        plane = load_plane(world.planes, slot, group.place)
        verbs = Verbs(
            plane_distance,
            plane_is_aside,
            plane_hides,
            plane_sides,
            plane_is_outside,
            plane_crossing,
            plane_surface,
        )
        return action(plane, verbs, group.number + world.planes.number[slot], arguments)
    return with_bounded(world, group, slot, action, arguments)


@device
def with_bounded(world: World, group: Group, slot: int, action: Action, arguments: Any) -> Any:  # noqa: ANN401
    """Return what an action returns for a shape of a group that is none of planes."""
    return _with_one_of(world.spheres, world.cylinders, world.cones, group, slot, action, arguments)


@device
def _with_one_of(
    spheres: Columns,
    cylinders: Columns | None,
    cones: Columns | None,
    group: Group,
    slot: int,
    action: Action,
    arguments: Any,  # noqa: ANN401
) -> Any:  # noqa: ANN401
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if cylinders is not None:  # noqa: SIM102
        if group.kind == CYLINDER:
            cylinder = load_cylinder(cylinders, slot, group.place)
            verbs = Verbs(
                cylinder_distance,
                cylinder_is_aside,
                cylinder_hides,
                cylinder_sides,
                cylinder_is_outside,
                cylinder_crossing,
                cylinder_surface,
            )
            return action(cylinder, verbs, group.number + cylinders.number[slot], arguments)
    if cones is not None:  # noqa: SIM102
        if group.kind == CONE:
            cone = load_cone(cones, slot, group.place)
            verbs_of_cones = Verbs(
                cone_distance,
                cone_is_aside,
                cone_hides,
                cone_sides,
                cone_is_outside,
                cone_crossing,
                cone_surface,
            )
            return action(cone, verbs_of_cones, group.number + cones.number[slot], arguments)
    sphere = load_sphere(spheres, slot, group.place)
    verbs_of_spheres = Verbs(
        sphere_distance,
        sphere_is_aside,
        sphere_hides,
        sphere_sides,
        sphere_is_outside,
        sphere_crossing,
        sphere_surface,
    )
    return action(sphere, verbs_of_spheres, group.number + spheres.number[slot], arguments)
