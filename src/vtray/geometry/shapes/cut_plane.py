"""Planes that clip planes cut: what is left of one is the part of it that is within a room."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device, seldom
from vtray.geometry.bundle import Bundle, Crossing
from vtray.geometry.ray import Ray, Segment, ray_point
from vtray.geometry.shapes.plane import (
    PlaneShape,
    end_side,
    plane_crossing,
    plane_distance,
    plane_hides,
    plane_side,
    plane_surface,
    plane_unroll,
)
from vtray.geometry.shapes.room import Room, all_within, any_within, room_side
from vtray.geometry.shapes.sides import Sides, all_sides
from vtray.geometry.shapes.stay import Stay
from vtray.geometry.shapes.surface import Surface
from vtray.geometry.shapes.unrolled import Unrolled, Upright
from vtray.geometry.vector import Vec, add, scale, sub


class CutPlane(NamedTuple):
    """A plane that clip planes cut, in the kernels' space.

    Attributes
    ----------
    whole, room
        The plane, and what clip planes leave.
    center, radius
        A ball around it, which holds everything.
    error_scale
        What its rounding errors are relative to.
    """

    whole: PlaneShape
    room: Room
    center: Vec
    radius: float
    error_scale: float


@device
def cut_plane(whole: PlaneShape, room: Room) -> CutPlane:
    """Return a plane that is cut."""
    return CutPlane(whole, room, whole.point, math.inf, whole.error_scale)


@seldom
def cut_plane_distance(cut: CutPlane, ray: Ray) -> float:
    """Return the distance at which a ray meets what is left of a plane, or infinity."""
    distance = plane_distance(cut.whole, ray)
    return distance if room_side(cut.room, ray_point(ray, distance)) <= 0.0 else math.inf


@device
def cut_plane_stay(cut: CutPlane, ray: Ray) -> Stay:
    """Return the part of a ray within what is left of a plane: a point, if it meets it."""
    distance = cut_plane_distance(cut, ray)
    return Stay(distance, distance if distance < math.inf else -math.inf)


@device
def cut_plane_is_aside(cut: CutPlane, ray: Ray) -> bool:  # noqa: ARG001
    """Return False: what tells that costs as much as `cut_plane_distance`."""
    return False


@seldom
def cut_plane_hides(cut: CutPlane, segment: Segment) -> bool:
    """Tell whether what is left of a plane stands between two points."""
    if not plane_hides(cut.whole, segment):
        return False
    start = plane_side(cut.whole, segment.start)
    end = end_side(cut.whole, segment.end, segment.end_scale)
    met = scale(start / (start - end), sub(segment.end, segment.start))
    return room_side(cut.room, add(segment.start, met)) <= 0.0


@device
def cut_plane_sides(cut: CutPlane, point: Vec, error_scale: float) -> Sides:  # noqa: ARG001
    """Return half-spaces that hold all directions."""
    return all_sides()


@device
def cut_plane_is_outside(cut: CutPlane, point: Vec, normal: Vec) -> bool:  # noqa: ARG001
    """Return True: a plane has no inside."""
    return True


@seldom
def cut_plane_crossing(cut: CutPlane, bundle: Bundle) -> Crossing:
    """Return from where to where the rays of a bundle meet what is left of a plane."""
    whole, some = plane_crossing(cut.whole, bundle), any_within(cut.room, bundle)
    near, far = max(whole.near, some.near), min(whole.far, some.far)
    if near > far or far <= bundle.first:
        return Crossing(math.inf, math.inf)
    every = all_within(cut.room, bundle)
    is_clear = (every.near <= whole.near) & (whole.far <= every.far)
    return Crossing(near, whole.far if is_clear else math.inf)


@device
def cut_plane_surface(cut: CutPlane, point: Vec, error_scale: float) -> Surface:
    """Return the surface of a plane, which is the same everywhere."""
    return plane_surface(cut.whole, point, error_scale)


@device
def cut_plane_power(cut: CutPlane, point: Vec) -> float:  # noqa: ARG001
    """Return 0: a plane has no inside."""
    return 0.0


@device
def cut_plane_unroll(cut: CutPlane, point: Vec, upright: Upright) -> Unrolled:
    """Return where a point of a plane is, from the one that it is given by."""
    return plane_unroll(cut.whole, point, upright)
