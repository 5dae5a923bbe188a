"""The one place of the kernels where kinds of shapes are told apart.

What is done with a shape, an action, is a device function that is given the shape and what shapes
of its kind can do. It is compiled once for each kind, so the loops in it are as fast as if there
were no other. Nothing is compiled for cylinders and cones where there are none: their columns are
None then; nor for clip planes where there are none.
"""

from collections.abc import Callable
from typing import Any

from vtray.base.compiler.compiled import device, seldom
from vtray.geometry.shapes.columns import Columns, Place
from vtray.geometry.shapes.cone import (
    cone_chord,
    cone_crossing,
    cone_distance,
    cone_hides,
    cone_is_aside,
    cone_is_outside,
    cone_outside,
    cone_passage,
    cone_power,
    cone_sides,
    cone_stay,
    cone_surface,
    cone_unroll,
    load_cone,
)
from vtray.geometry.shapes.cut import (
    Solid,
    cut_crossing,
    cut_distance,
    cut_hides,
    cut_is_aside,
    cut_is_outside,
    cut_power,
    cut_shape,
    cut_sides,
    cut_stay,
    cut_surface,
    cut_unroll,
)
from vtray.geometry.shapes.cut_plane import (
    cut_plane,
    cut_plane_crossing,
    cut_plane_distance,
    cut_plane_hides,
    cut_plane_is_aside,
    cut_plane_is_outside,
    cut_plane_power,
    cut_plane_sides,
    cut_plane_stay,
    cut_plane_surface,
    cut_plane_unroll,
)
from vtray.geometry.shapes.cylinder import (
    cylinder_chord,
    cylinder_crossing,
    cylinder_distance,
    cylinder_hides,
    cylinder_is_aside,
    cylinder_is_outside,
    cylinder_outside,
    cylinder_passage,
    cylinder_power,
    cylinder_sides,
    cylinder_stay,
    cylinder_surface,
    cylinder_unroll,
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
    plane_stay,
    plane_surface,
    plane_unroll,
)
from vtray.geometry.shapes.room import ACROSS, load_room, relation_to
from vtray.geometry.shapes.sphere import (
    load_sphere,
    sphere_chord,
    sphere_crossing,
    sphere_distance,
    sphere_hides,
    sphere_is_aside,
    sphere_is_outside,
    sphere_outside,
    sphere_passage,
    sphere_power,
    sphere_sides,
    sphere_stay,
    sphere_surface,
    sphere_unroll,
)
from vtray.geometry.shapes.surface import no_power
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.world import CONE, CUT, CYLINDER, PLANE, Clip, Group, Solids, World

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
            no_power,
            plane_stay,
            plane_unroll,
        )
        return action(plane, verbs, group.number + world.planes.number[slot], arguments)
    return with_bounded(world.solids, group, slot, action, arguments)


@device
def with_bounded(
    solids: Solids,
    group: Group,
    slot: int,
    action: Action,
    arguments: Any,  # noqa: ANN401
) -> Any:  # noqa: ANN401
    """Return what an action returns for a shape of a group that is none of whole planes."""
    spheres, cylinders, cones = solids.spheres, solids.cylinders, solids.cones
    return _with_one_of(spheres, cylinders, cones, solids.clip, group, slot, action, arguments)


@device
def _with_one_of(
    spheres: Columns,
    cylinders: Columns | None,
    cones: Columns | None,
    clip: Clip | None,
    group: Group,
    slot: int,
    action: Action,
    arguments: Any,  # noqa: ANN401
) -> Any:  # noqa: ANN401
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if clip is not None:  # noqa: SIM102
        if group.kind >= CUT:
            return _with_cut(
                spheres, cylinders, cones, clip, clip.flat, group, slot, action, arguments
            )
    if cylinders is not None:  # noqa: SIM102
        if group.kind == CYLINDER:
            cylinder = load_cylinder(cylinders, slot, group.place)
            number = group.number + cylinders.number[slot]
            return action(cylinder, _verbs_of_cylinders(), number, arguments)
    if cones is not None:  # noqa: SIM102
        if group.kind == CONE:
            cone = load_cone(cones, slot, group.place)
            return action(cone, _verbs_of_cones(), group.number + cones.number[slot], arguments)
    sphere = load_sphere(spheres, slot, group.place)
    return action(sphere, _verbs_of_spheres(), group.number + spheres.number[slot], arguments)


@seldom
def _with_cut(
    spheres: Columns,
    cylinders: Columns | None,
    cones: Columns | None,
    clip: Clip,
    flat: Columns | None,
    group: Group,
    slot: int,
    action: Action,
    arguments: Any,  # noqa: ANN401
) -> Any:  # noqa: ANN401
    """Return what an action returns for a shape of a group that clip planes may cut."""
    place, (shift, size, _) = group.place, group.place
    # The relation to the planes is found in world space, where no camera has a say.
    here, there = Place((0.0, 0.0, 0.0), size, place.origin), (0.0, 0.0, 0.0)
    rows = clip.room.shape[0]
    own, is_placed = group.row % rows, group.row >= rows
    row, is_capped = clip.room[own], clip.is_capped[own]
    begin, end = clip.begin[row], clip.begin[row + 1]
    planes, still = clip.planes, Place(there, size, there)
    room = load_room(planes, begin, end, here)
    moved = Place(shift, size, there)
    if flat is not None:  # noqa: SIM102
        if group.kind == CUT + PLANE:
            plane = cut_plane(load_plane(flat, slot, place), room)
            number = group.number + flat.number[slot]
            return action(plane, _verbs_of_cut_planes(), number, arguments)
    if cylinders is not None:  # noqa: SIM102
        if group.kind == CUT + CYLINDER:
            cylinder = cut_shape(
                load_cylinder(cylinders, slot, place),
                _verbs_of_cylinders(),
                Solid(cylinder_chord, cylinder_outside, cylinder_power, cylinder_passage, False),
                room,
                _relation_of(
                    load_cylinder(cylinders, slot, moved), is_placed, planes, begin, end, still
                ),
                is_capped,
            )
            number = group.number + cylinders.number[slot]
            return action(cylinder, _verbs_of_cut_shapes(), number, arguments)
    if cones is not None:  # noqa: SIM102
        if group.kind == CUT + CONE:
            cone = cut_shape(
                load_cone(cones, slot, place),
                _verbs_of_cones(),
                Solid(cone_chord, cone_outside, cone_power, cone_passage, False),
                room,
                _relation_of(load_cone(cones, slot, moved), is_placed, planes, begin, end, still),
                is_capped,
            )
            number = group.number + cones.number[slot]
            return action(cone, _verbs_of_cut_shapes(), number, arguments)
    sphere = cut_shape(
        load_sphere(spheres, slot, place),
        _verbs_of_spheres(),
        Solid(sphere_chord, sphere_outside, sphere_power, sphere_passage, True),
        room,
        _relation_of(load_sphere(spheres, slot, moved), is_placed, planes, begin, end, still),
        is_capped,
    )
    return action(sphere, _verbs_of_cut_shapes(), group.number + spheres.number[slot], arguments)


@device
def _relation_of(
    shape: Shape, is_placed: bool, planes: Columns, begin: int, end: int, place: Place
) -> int:
    """Return how a shape lies to a room, both in world space.

    Of those that stand where they are given, only the ones that planes cut are in such groups.
    """
    if is_placed:
        return relation_to(planes, begin, end, place, shape.center, shape.radius)
    return ACROSS


@device
def _verbs_of_spheres() -> Verbs:
    return Verbs(
        sphere_distance,
        sphere_is_aside,
        sphere_hides,
        sphere_sides,
        sphere_is_outside,
        sphere_crossing,
        sphere_surface,
        no_power,
        sphere_stay,
        sphere_unroll,
    )


@device
def _verbs_of_cylinders() -> Verbs:
    return Verbs(
        cylinder_distance,
        cylinder_is_aside,
        cylinder_hides,
        cylinder_sides,
        cylinder_is_outside,
        cylinder_crossing,
        cylinder_surface,
        no_power,
        cylinder_stay,
        cylinder_unroll,
    )


@device
def _verbs_of_cones() -> Verbs:
    return Verbs(
        cone_distance,
        cone_is_aside,
        cone_hides,
        cone_sides,
        cone_is_outside,
        cone_crossing,
        cone_surface,
        no_power,
        cone_stay,
        cone_unroll,
    )


@device
def _verbs_of_cut_shapes() -> Verbs:
    return Verbs(
        cut_distance,
        cut_is_aside,
        cut_hides,
        cut_sides,
        cut_is_outside,
        cut_crossing,
        cut_surface,
        cut_power,
        cut_stay,
        cut_unroll,
    )


@device
def _verbs_of_cut_planes() -> Verbs:
    return Verbs(
        cut_plane_distance,
        cut_plane_is_aside,
        cut_plane_hides,
        cut_plane_sides,
        cut_plane_is_outside,
        cut_plane_crossing,
        cut_plane_surface,
        cut_plane_power,
        cut_plane_stay,
        cut_plane_unroll,
    )
