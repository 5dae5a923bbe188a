"""The plane: where a ray meets it, and what it hides."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.bundle import Bundle, Crossing, spread_along
from vtray.geometry.ray import Ray, Segment
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.shapes.columns import Columns, Place, to_kernels, world_point
from vtray.geometry.shapes.sides import Sides, all_sides
from vtray.geometry.shapes.stay import Stay
from vtray.geometry.shapes.surface import Surface
from vtray.geometry.shapes.unrolled import Unrolled, Upright, place_around
from vtray.geometry.vector import Vec, dot, magnitude, sub

SIZE = 6
"""Numbers of a plane in its columns: a point, and the unit normal."""


class PlaneShape(NamedTuple):
    """A plane in the kernels' space.

    Attributes
    ----------
    point, normal
        A point of it, and its unit normal.
    offset
        Its signed distance from the origin, along the normal.
    error_scale
        What its rounding errors are relative to.
    """

    point: Vec
    normal: Vec
    offset: float
    error_scale: float


@device
def load_plane(columns: Columns, slot: int, place: Place) -> PlaneShape:
    """Return one of the planes."""
    first, data = SIZE * slot, columns.data
    point = to_kernels(world_point(columns, first, place), place)
    normal = data[first + 3], data[first + 4], data[first + 5]
    return PlaneShape(point, normal, dot(point, normal), magnitude(point))


@device
def intersect_plane(height: float, descent: float) -> float:
    """Return the distance at which a ray meets a plane, ``inf`` if it is parallel.

    Parameters
    ----------
    height
        The signed distance from the ray's origin to the plane, along the plane's normal.
    descent
        The ray's unit direction times the plane's normal.
    """
    return height / descent if descent != 0.0 else math.inf


@device
def plane_distance(plane: PlaneShape, ray: Ray) -> float:
    """Return the distance at which a ray meets a plane, from the image plane on, or infinity.

    A small `descent` magnifies the error of the distance, so the bound is divided by it; that also
    ends the plane where, towards its horizon, rounding would decide what is hit. A ray that starts
    on the plane, as near as rounding can tell, does not meet it.
    """
    height = dot(sub(plane.point, ray.origin), plane.normal)
    descent = dot(ray.direction, plane.normal)
    distance = intersect_plane(height, descent)
    plane_depth = distance * ray.forward + ray.plane_depth
    error_scale = plane.error_scale + ray.error_scale + abs(distance)
    seen = plane_depth * abs(descent) > ROUNDING * error_scale
    if ray.error_bound > 0.0:
        seen = seen & (abs(height) > ray.error_bound) & (distance > 0.0)
    return distance if seen else math.inf


@device
def plane_stay(plane: PlaneShape, ray: Ray) -> Stay:
    """Return the part of a ray within a plane: the point where it meets it, if it does."""
    distance = plane_distance(plane, ray)
    return Stay(distance, distance if distance < math.inf else -math.inf)


@device
def plane_side(plane: PlaneShape, point: Vec) -> float:
    """Return the signed distance of a point from a plane."""
    side: float = dot(point, plane.normal) - plane.offset
    return side


@device
def end_side(plane: PlaneShape, end: Vec, end_scale: float) -> float:
    """Return the signed distance of a light from a plane, 0 if rounding could explain it."""
    side = plane_side(plane, end)
    return side if abs(side) > ROUNDING * (plane.error_scale + end_scale) else 0.0


@device
def plane_is_aside(plane: PlaneShape, ray: Ray) -> bool:  # noqa: ARG001
    """Return False: what tells that costs as much as `plane_distance`."""
    return False


@device
def plane_hides(plane: PlaneShape, segment: Segment) -> bool:
    """Tell whether a plane stands between two points, in front of the image plane."""
    return hides_side((plane, end_side(plane, segment.end, segment.end_scale)), segment)


@device
def hides_side(plane_and_end: tuple[PlaneShape, float], segment: Segment) -> bool:
    """Tell the same with the `end_side` of where the segment ends, for many that end there."""
    plane, end = plane_and_end
    start = plane_side(plane, segment.start)
    error_bound = ROUNDING * (segment.start_scale + plane.error_scale)
    return plane_blocks(start, end, segment.start_plane_depth, segment.end_plane_depth, error_bound)


@device
def plane_blocks(
    start: float, end: float, start_plane_depth: float, end_plane_depth: float, error_bound: float
) -> bool:
    """Tell whether a plane lies between a point and a light, in front of the image plane.

    Parameters
    ----------
    start
        The point's signed distance from the plane.
    end
        The light's, 0 if it lies in the plane: then nothing lies between.
    start_plane_depth, end_plane_depth
        Signed distances of point and light from the image plane.
    error_bound
        How far rounding may have moved the point: one nearer to the plane than that is on it.
    """
    opposite = ((start > error_bound) & (end < 0.0)) | ((start < -error_bound) & (end > 0.0))
    # The plane depth of the crossing is
    # (|start| end_plane_depth + |end| start_plane_depth) / (|start| + |end|).
    crossing = abs(start) * end_plane_depth + abs(end) * start_plane_depth
    return opposite & (crossing > error_bound * (abs(start) + abs(end)))


@device
def plane_sides(plane: PlaneShape, point: Vec, error_scale: float) -> Sides:  # noqa: ARG001
    """Return half-spaces that hold all directions: a plane is everywhere."""
    return all_sides()


@device
def plane_is_outside(plane: PlaneShape, point: Vec, normal: Vec) -> bool:  # noqa: ARG001
    """Return True: a plane has no inside."""
    return True


@device
def plane_crossing(plane: PlaneShape, bundle: Bundle) -> Crossing:
    """Return from where to where the rays of a bundle meet a plane.

    One divided by the distance is linear in the offset, so the bounds are those of two rays.
    """
    height = dot(sub(plane.point, bundle.origin), plane.normal)
    descent = dot(bundle.direction, plane.normal)
    side = -1.0 if height < 0.0 else 1.0
    height, descent = side * height, side * descent
    along = spread_along(bundle, plane.normal)
    wide, growth = bundle.width * along, bundle.growth * along
    most, least = descent + growth, descent - growth
    near = (height - wide) / most if most > 0.0 else math.inf
    far = (height + wide) / least if least > 0.0 else math.inf
    # Some rays start on its other side.
    near = -math.inf if height < wide else near
    far = math.inf if height < wide else far
    far = max(near, far)  # beyond a light, where it does not matter, the order is another
    is_met = (near < math.inf) & (far > bundle.first)
    is_clear = near > bundle.last
    return Crossing(
        max(near, bundle.first) if is_met else math.inf, far if is_met & is_clear else math.inf
    )


@device
def plane_surface(plane: PlaneShape, point: Vec, error_scale: float) -> Surface:  # noqa: ARG001
    """Return the surface of a plane, which is the same everywhere."""
    return Surface(plane.normal, False, plane.error_scale, False, False)


@device
def plane_unroll(plane: PlaneShape, point: Vec, upright: Upright) -> Unrolled:
    """Return where a point of a plane is, from the one that it is given by."""
    up, left = place_around(sub(point, plane.point), plane.normal, upright)
    return Unrolled(-left, -up, math.inf, math.inf, True)
