"""Fans whose rays go to many lights: each ray to one that is chosen by how much it can bring.

The points of a fan choose their lights by the first coordinate: along the lights, in an order in
which those near each other follow each other, each takes of it in proportion to what it would bring
with nothing in the way. Where within its part a point lies is the first coordinate within a light.
A ray counts what it brings of its light, divided by how likely that light was; so all rays count
about the same, and the mean of those that arrive is the light of all lights, without a bias.

References
----------
Shirley, Wang, Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", ACM
Transactions on Graphics 15 (1), 1996, section 4 (many lights as one, by what each brings).
"""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.fan import (
    BLOCKED,
    DIRECTION,
    FAN,
    LENGTH,
    WEIGHT,
    Fan,
    Start,
    count_open,
    load_direction,
    set_direction,
    set_start,
)
from vtray.geometry.packets.workspace import Shared
from vtray.geometry.vector import Vec, add, dot
from vtray.transport.lights.crowd import Crowd
from vtray.transport.lights.light import Powers, load_power, soft_worth
from vtray.transport.lights.sky import Skies
from vtray.transport.lights.soft_light import (
    NO_SKY,
    Aim,
    SoftLights,
    aim_at,
    soft_count,
    unhindered_share,
)
from vtray.transport.materials.material import Material, scattered
from vtray.transport.sampling.fans import NO_OFFSET, fan_point
from vtray.transport.sampling.light_rays import direction_to, set_end, weight_of
from vtray.transport.sampling.sky_rays import sky_direction, sky_weights
from vtray.transport.sampling.table import find_part, part_of


@device
def weigh_lights(
    powers: Powers,
    soft: SoftLights,
    crowd: Crowd,
    start: Start,
    normal: Vec,
    material: Material,
    sums: NDArray[np.float64],
) -> float:
    """Return about what all soft lights would bring to a point with nothing in the way.

    Parameters
    ----------
    powers, soft, crowd
        How strong the lights are, and the lights.
    start, normal, material
        The point, the unit normal of its surface, and what that is made of.
    sums
        Out: the sum of what the lights before each bring, in the order of the crowd, and at last of
        all, (n + 1,).
    """
    total = 0.0
    sums[0] = 0.0
    for place in range(soft_count(soft)):
        light = crowd.order[place]
        aim = aim_at(soft, light, start, normal)
        share = unhindered_share(aim, start, normal) * _brightness(soft.skies, aim.sky)
        total += share * soft_worth(powers, soft, light, material)
        sums[place + 1] = total
    return total


@device
def _brightness(skies: Skies | None, sky: int) -> float:
    """Return the mean brightness of a light whose colour changes, 1 for all others."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if skies is None:
        return 1.0
    return 1.0 if sky == NO_SKY else skies.bright.level[sky]


@device
def spread_among(
    fan: Fan,
    rays: int,
    powers: Powers,
    soft: SoftLights,
    crowd: Crowd,
    start: Start,
    normal: Vec,
    material: Material,
    forward: Vec,
    points: NDArray[np.int64],
    first: int,
    keys: tuple[int, int],
    shared: Shared,
) -> int:
    """Set the rays of a fan to all soft lights; return how many of them count.

    Parameters
    ----------
    fan, rays
        Out: so many rays. Each has three weights: the light that it brings.
    powers, soft, crowd
        How strong the lights are, and the lights.
    start, normal, material
        The point, the unit normal of its surface, and what that is made of.
    forward
        The unit direction in which the camera looks.
    points, first, keys
        The points that choose the rays, from the first on, and what they are scrambled by.
    shared
        The sums of `weigh_lights`; out: the light of each ray.
    """
    for ray in range(rays):
        u, v = fan_point(points, first + ray, NO_OFFSET, keys)
        fan[DIRECTION + ray], fan[DIRECTION + FAN + ray] = u, v
    count = soft_count(soft)
    total = shared.sums[count]
    seen = crowd.order[0]
    aim = aim_at(soft, seen, start, normal)
    for ray in range(rays):
        u, v, _ = load_direction(fan, ray)
        place = find_part(shared.sums, 0, count, u * total)
        likely = shared.sums[place + 1] - shared.sums[place]
        light = crowd.order[place]
        shared.light[ray] = light
        fan[BLOCKED + ray] = 1.0
        # The least numbers round so that one may lie behind all parts.
        if likely > 0.0:
            u = min(part_of(shared.sums, place, u * total), BELOW_1)
            if light != seen:
                aim = aim_at(soft, light, start, normal)
                seen = light
            factor = total / likely
            row = soft.row[light]
            brought = _set_ray(
                fan, ray, aim, normal, u, v, powers, row, material, factor, soft.skies
            )
            set_end(fan, ray, aim, start, forward)
            set_start(fan, ray, start, aim.error_scale + start.error_scale)
            fan[WEIGHT + ray] = brought[0]
            fan[WEIGHT + FAN + ray] = brought[1]
            fan[WEIGHT + 2 * FAN + ray] = brought[2]
            fan[BLOCKED + ray] = 0.0 if max(brought[0], brought[1], brought[2]) > 0.0 else 1.0
    return count_open(fan, rays)


BELOW_1 = 1.0 - 2.0**-32
"""The largest coordinate of a point."""


@device
def _set_ray(
    fan: Fan,
    ray: int,
    aim: Aim,
    normal: Vec,
    u: float,
    v: float,
    powers: Powers,
    row: int,
    material: Material,
    factor: float,
    skies: Skies | None,
) -> Vec:
    """Set the direction of a ray, and return the light that it brings, times a factor."""
    if skies is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if aim.sky != NO_SKY:
            direction = sky_direction(u, v, normal, skies, skies.bright, aim.sky)
            set_direction(fan, ray, direction)
            weights = sky_weights(direction, normal, skies, skies.bright, aim.sky)
            brought = (0.0, 0.0, 0.0)
            for component in range(3):
                power = load_power(powers, row + component)
                part = scattered(material, factor * weights[component], power)
                brought = add(brought, part)
            return brought
    direction = direction_to(aim, u, v, normal)
    set_direction(fan, ray, direction)
    weight = weight_of(aim, dot(normal, direction))
    return scattered(material, factor * weight, load_power(powers, row))


@device
def longest_of(fan: Fan, rays: int) -> float:
    """Return the length of the longest ray that is cast."""
    longest = 0.0
    for ray in range(rays):
        if fan[BLOCKED + ray] == 0.0:
            longest = max(longest, fan[LENGTH + ray])
    return longest
