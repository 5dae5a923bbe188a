"""Where the rays of a fan go within a light, and what each of them counts.

A fan of rays goes from a point on a surface to many places of one light. What the light adds there
is the mean of the weights of those rays that arrive: one number, as the cosine of a point light is,
or three for a light whose colour changes with the direction.
"""

import math

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, part
from vtray.geometry.packets.fan import (
    BLOCKED,
    DIRECTION,
    END,
    END_PLANE_DEPTH,
    FAN,
    LENGTH,
    WEIGHT,
    Fan,
    Start,
    count_open,
    load_direction,
    set_direction,
)
from vtray.geometry.vector import Vec, add, dot, scale, sub
from vtray.geometry.warps import cone_direction, cosine_direction
from vtray.transport.lights.rectangle import SeenRectangle, length_of_ray
from vtray.transport.lights.sky import Skies
from vtray.transport.lights.soft_light import (
    ALL_AROUND,
    RECTANGLE,
    SPHERE,
    Aim,
    is_above,
    middle_share,
)
from vtray.transport.lights.spherical_rectangle import rectangle_direction
from vtray.transport.sampling.fans import fan_point
from vtray.transport.sampling.sky_rays import spread_to_sky


@part
def spread_fan(
    fan: Fan,
    rays: int,
    aim: Aim,
    start: Start,
    normal: Vec,
    forward: Vec,
    skies: Skies | None,
    points: NDArray[np.int64],
    first: int,
    offset: tuple[int, int],
    keys: tuple[int, int],
) -> int:
    """Set the rays of a fan to a light; return how many of them count.

    Parameters
    ----------
    fan, rays
        Out: so many rays.
    aim, start, normal
        The light, and the point with its unit normal.
    forward
        The unit direction in which the camera looks.
    skies
        The skies whose colour changes with the direction.
    points, first, offset, keys
        The points that choose the rays, from the first on, as `fans.fan_point` takes them.
    """
    # A loop for each step: only so are they vectorised.
    for ray in range(rays):
        fan[DIRECTION + ray], fan[DIRECTION + FAN + ray] = fan_point(
            points, first + ray, offset, keys
        )
    if not spread_to_sky(fan, rays, skies, aim.sky, normal):
        _spread_evenly(fan, rays, aim, normal)
    if aim.kind in (SPHERE, RECTANGLE):
        for ray in range(rays):
            set_end(fan, ray, aim, start, forward)
    else:
        for ray in range(rays):
            _set_end_at(fan, ray, aim.size, start, forward)
    return count_open(fan, rays)


@device
def _spread_evenly(fan: Fan, rays: int, aim: Aim, normal: Vec) -> None:
    """Turn points into directions to a light of one colour, and set what the rays count."""
    if aim.kind == RECTANGLE:
        _spread_over_rectangle(fan, rays, aim.seen)
    elif aim.spread == ALL_AROUND:
        for ray in range(rays):
            u, v, _ = load_direction(fan, ray)
            set_direction(fan, ray, cosine_direction(u, v, normal))
    else:
        for ray in range(rays):
            u, v, _ = load_direction(fan, ray)
            set_direction(fan, ray, cone_direction(u, v, aim.axis, aim.spread))
    for ray in range(rays):
        _set_weight(fan, ray, aim, normal)


@device
def direction_to(aim: Aim, u: float, v: float, normal: Vec) -> Vec:
    """Return a direction to a light of one colour, for a point of the unit square."""
    if aim.kind == RECTANGLE:
        return _direction_to_rectangle(u, v, aim.seen)
    if aim.spread == ALL_AROUND:
        return cosine_direction(u, v, normal)
    return cone_direction(u, v, aim.axis, aim.spread)


@device
def _direction_to_rectangle(u: float, v: float, seen: SeenRectangle | None) -> Vec:
    """Return a direction to a rectangle; no direction if a scene has none."""
    if seen is None:
        return 0.0, 0.0, 0.0
    return rectangle_direction(u, v, seen.shape)


@device
def _spread_over_rectangle(fan: Fan, rays: int, seen: SeenRectangle | None) -> None:
    """Set the directions of rays to a rectangle."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if seen is not None:
        for ray in range(rays):
            u, v, _ = load_direction(fan, ray)
            set_direction(fan, ray, rectangle_direction(u, v, seen.shape))


@device
def _set_weight(fan: Fan, ray: int, aim: Aim, normal: Vec) -> None:
    """Set what a ray counts; one that counts nothing is not cast."""
    weight = weight_of(aim, dot(normal, load_direction(fan, ray)))
    fan[WEIGHT + ray] = weight
    fan[BLOCKED + ray] = 0.0 if weight > 0.0 else 1.0


@device
def weight_of(aim: Aim, cosine: float) -> float:
    """Return what a ray counts, given its cosine."""
    return 1.0 if aim.spread == ALL_AROUND else aim.share * max(cosine, 0.0)


@device
def set_end(fan: Fan, ray: int, aim: Aim, start: Start, forward: Vec) -> None:
    """Set where a ray ends."""
    length = length_to(aim, start.point, load_direction(fan, ray))
    _set_end_at(fan, ray, length, start, forward)


@device
def _set_end_at(fan: Fan, ray: int, length: float, start: Start, forward: Vec) -> None:
    """Set where a ray ends, given its length."""
    way = scale(length, load_direction(fan, ray))
    x, y, z = add(start.point, way)
    fan[END + ray] = x
    fan[END + FAN + ray] = y
    fan[END + 2 * FAN + ray] = z
    fan[LENGTH + ray] = length
    fan[END_PLANE_DEPTH + ray] = start.plane_depth + dot(way, forward)


@device
def length_to(aim: Aim, point: Vec, direction: Vec) -> float:
    """Return how long a ray is: to a rectangle, a sphere, or the far side of one from inside."""
    way = sub(aim.place, point)
    middle = dot(way, direction)
    approach = sub(way, scale(middle, direction))
    half_chord = math.sqrt(max(aim.size * aim.size - dot(approach, approach), 0.0))
    side = middle + half_chord if aim.spread == ALL_AROUND else middle - half_chord
    length = side if aim.kind == SPHERE else aim.size
    return length_of_ray(aim.seen, direction) if aim.kind == RECTANGLE else length


@device
def arriving_shares(
    fan: Fan, rays: int, components: int, aim: Aim, normal: Vec
) -> tuple[Vec, float]:
    """Return how much of each component of a light arrives, and the variance of that.

    This is the mean weight of all rays, 0 for those stopped; the variance is that of the noisiest
    component. Of a cone of which all arrives, it is known without noise: the cosine at its middle.

    Parameters
    ----------
    fan, rays
        The rays, so many.
    components
        How many weights each of them has: 1, which comes first, or 3.
    aim, normal
        The light, and the unit normal of the surface.
    """
    if is_above(aim, normal) and count_open(fan, rays) == rays:
        return (middle_share(aim, normal), 0.0, 0.0), 0.0
    if aim.spread == ALL_AROUND and components == 1 and _count_whole(fan, rays) == rays:
        share, spread = _counted_share(fan, rays)
        return (share, 0.0, 0.0), spread
    first, spread = _arriving_share(fan, rays, 0)
    if components == 1:
        return (first, 0.0, 0.0), spread
    second, second_spread = _arriving_share(fan, rays, 1)
    third, third_spread = _arriving_share(fan, rays, 2)
    return (first, second, third), max(spread, second_spread, third_spread)


@device
def _count_whole(fan: Fan, rays: int) -> int:
    """Return how many rays arrive as a whole, or not at all."""
    count = 0
    for ray in range(rays):
        count += 1 if fan[BLOCKED + ray] in (0.0, 1.0) else 0
    return count


@device
def _counted_share(fan: Fan, rays: int) -> tuple[float, float]:
    """Return what `_arriving_share` does, for rays that all count 1 where they arrive.

    Sums are whole numbers then, the same in any order: loops over several rays at once find them.
    """
    changes = 0
    for pair in range(rays // 2):
        one, other = fan[BLOCKED + 2 * pair], fan[BLOCKED + 2 * pair + 1]
        changes += 1 if one != other else 0
    return count_open(fan, rays) / rays, changes / (rays * rays)


@device
def _arriving_share(fan: Fan, rays: int, component: int) -> tuple[float, float]:
    """Return the mean of one of the weights of the rays, and the variance of that."""
    total = 0.0
    for ray in range(rays):
        total += _brought(fan, ray, component)
    squares = 0.0
    for pair in range(rays // 2):
        one, other = 2 * pair, 2 * pair + 1
        difference = _brought(fan, one, component) - _brought(fan, other, component)
        squares += difference * difference
    return total / rays, squares / (rays * rays)


@device
def _brought(fan: Fan, ray: int, component: int) -> float:
    """Return what a ray brings: of one of its weights what is not blocked."""
    blocked = fan[BLOCKED + ray]
    return fan[WEIGHT + component * FAN + ray] * (1.0 - blocked) if blocked < 1.0 else 0.0
