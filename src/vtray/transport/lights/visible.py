"""Lamps that the camera sees: where a ray meets one, and where its outline passes near a ray."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.ray import Footprint, Ray, width_at
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.shapes.sphere import SphereShape, sphere_distance
from vtray.geometry.vector import Vec, add, dot, magnitude, scale, sub
from vtray.transport.lights import rectangle

SIZE = 4 + rectangle.SIZE
"""Numbers of a lamp: its middle, its radius, and those of a rectangle."""


class VisibleLamps(NamedTuple):
    """The lamps that the camera sees.

    Attributes
    ----------
    row
        The rows of their strengths in `Lights.intensity` and `Lights.color`, (n,).
    data
        ``SIZE`` numbers for each.
    error_scale
        What the rounding error of the places of all is relative to.
    light
        Their numbers among the soft lights, (n,).
    """

    row: NDArray[np.int64]
    data: NDArray[np.float64]
    error_scale: NDArray[np.float64]
    light: NDArray[np.int64]


class Panel(NamedTuple):
    """A rectangle in the kernels' space: its middle, unit vectors, and half its edges."""

    middle: Vec
    across: Vec
    up: Vec
    normal: Vec
    half: tuple[float, float]


@device
def lamp_count(lamps: VisibleLamps) -> int:
    """Return how many there are."""
    count: int = lamps.row.shape[0]
    return count


@device
def lamp_distance(lamps: VisibleLamps, k: int, ray: Ray) -> tuple[float, float]:
    """Return the distance at which a ray meets a lamp, and what rounding may add; or infinity."""
    error_scale = lamps.error_scale[k]
    if _is_ball(lamps, k):
        distance = sphere_distance(_ball(lamps, k), ray)
        return distance, ROUNDING * (error_scale + ray.error_scale)
    return _panel_distance(_panel(lamps, k), error_scale, ray)


@device
def lamp_outline(lamps: VisibleLamps, k: int, ray: Ray, footprint: Footprint) -> float:
    """Return the distance at which a ray passes the outline of a lamp, infinite if none is near."""
    if _is_ball(lamps, k):
        return _ball_outline(_ball(lamps, k), ray, footprint)
    panel = _panel(lamps, k)
    one, other = scale(panel.half[0], panel.across), scale(panel.half[1], panel.up)
    way = sub(panel.middle, ray.origin)
    nearest = math.inf
    for side in range(4):
        sign = 1.0 if side < 2 else -1.0
        aside, along = (one, other) if side % 2 == 0 else (other, one)
        start = add(way, scale(sign, aside))
        nearest = min(nearest, _edge_outline(start, along, ray, footprint))
    return nearest


@device
def _ball_outline(ball: SphereShape, ray: Ray, footprint: Footprint) -> float:
    """Return the distance at which a ray passes the outline of a ball, or infinity."""
    from_center = sub(ray.origin, ball.center)
    middle = -dot(from_center, ray.direction)
    approach = add(from_center, scale(middle, ray.direction))
    gap2 = dot(approach, approach)
    width = width_at(footprint, middle)
    outer, inner = ball.radius + width, max(ball.radius - width, 0.0)
    near = (gap2 < outer * outer) & (gap2 >= inner * inner) & (middle > -ray.plane_depth)
    entry = middle - math.sqrt(max(ball.radius * ball.radius - gap2, 0.0))
    return entry if near else math.inf


@device
def _is_ball(lamps: VisibleLamps, k: int) -> bool:
    """Tell whether a lamp is a ball."""
    half: float = lamps.data[SIZE * k + SIZE - 1]
    return half == 0.0


@device
def _ball(lamps: VisibleLamps, k: int) -> SphereShape:
    """Return a lamp that is a ball."""
    data, at = lamps.data, SIZE * k
    center, radius = (data[at], data[at + 1], data[at + 2]), data[at + 3]
    return SphereShape(center, radius, magnitude(center) + radius)


@device
def _panel(lamps: VisibleLamps, k: int) -> Panel:
    """Return a lamp that is a rectangle."""
    data, at = lamps.data, SIZE * k
    return Panel(
        (data[at], data[at + 1], data[at + 2]),
        (data[at + 4], data[at + 5], data[at + 6]),
        (data[at + 7], data[at + 8], data[at + 9]),
        (data[at + 10], data[at + 11], data[at + 12]),
        (data[at + 13], data[at + 14]),
    )


@device
def _panel_distance(panel: Panel, error_scale: float, ray: Ray) -> tuple[float, float]:
    """Return the distance at which a ray meets a rectangle, and what rounding may add to it."""
    way = sub(panel.middle, ray.origin)
    slope = dot(ray.direction, panel.normal)
    steep = slope if slope != 0.0 else 1.0
    distance = dot(way, panel.normal) / steep
    beside = sub(scale(distance, ray.direction), way)
    inside = (abs(dot(beside, panel.across)) <= panel.half[0]) & (
        abs(dot(beside, panel.up)) <= panel.half[1]
    )
    error_bound = ROUNDING * (abs(distance) + error_scale + ray.error_scale)
    before = distance * ray.forward + ray.plane_depth > error_bound
    is_met = inside & before & (slope != 0.0) & (distance > 0.0)
    return distance if is_met else math.inf, error_bound / abs(steep)


@device
def _edge_outline(start: Vec, along: Vec, ray: Ray, footprint: Footprint) -> float:
    """Return the distance at which a ray passes an edge within its footprint, or infinity.

    Parameters
    ----------
    start, along
        The edge goes from ``start - along`` to ``start + along``, as seen from the ray's start.
    ray, footprint
        The ray, and how wide it is.
    """
    # The gap between them, squared, less the width, squared, is a quadratic along the edge. It is
    # least where its slope is 0, or at an end.
    begin, rise = dot(start, ray.direction), dot(along, ray.direction)
    gap, drift = sub(start, scale(begin, ray.direction)), sub(along, scale(rise, ray.direction))
    width, growth = width_at(footprint, begin), footprint.growth * rise
    bend = dot(drift, drift) - growth * growth
    least = -(dot(gap, drift) - width * growth) / (bend if bend > 0.0 else 1.0)
    found = math.inf
    for place in range(3):
        at = max(min(least, 1.0), -1.0) if place == 2 else 2.0 * place - 1.0
        apart, distance = add(gap, scale(at, drift)), begin + at * rise
        reach = width_at(footprint, max(distance, 0.0))
        is_near = (dot(apart, apart) <= reach * reach) & (distance > -ray.plane_depth)
        found = min(found, distance if is_near else math.inf)
    return found
