"""Light on glossy surfaces: by shadow rays to lights, and by the rays that go on from surfaces.

Either finds what the other does not: shadow rays small lights, rays that go on what is mirrored
almost sharply. Both count light of lamps with a size and of skies with a picture, each as much as
its own density is of both, squared; so together they count it once, with little noise.

References
----------
Veach, Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995
(the power heuristic).
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device, seldom
from vtray.geometry.between import is_occluded
from vtray.geometry.packets.fan import Start
from vtray.geometry.packets.stack import Stack
from vtray.geometry.ray import Ray, Segment
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.vector import Vec, add, dot, scale, sub
from vtray.geometry.world import World
from vtray.transport.lights.light import Lights, light_count, load_power
from vtray.transport.lights.rectangle import solid_angle_of
from vtray.transport.lights.sky import Skies
from vtray.transport.lights.soft_light import (
    ALL_AROUND,
    NO_SKY,
    RECTANGLE,
    SPHERE,
    SUN,
    Aim,
    SoftLights,
    aim_at,
    soft_count,
)
from vtray.transport.lights.surroundings import (
    LEAST_SPREAD,
    Discs,
    Surroundings,
    disc_count,
    is_towards,
    light_of_disc,
)
from vtray.transport.lights.visible import VisibleLamps, lamp_count, lamp_distance
from vtray.transport.materials.facets import PI
from vtray.transport.materials.gloss import Gloss, seen_light
from vtray.transport.materials.lambert import is_above
from vtray.transport.materials.look import Albedos, Looks
from vtray.transport.sampling.light_rays import direction_to, length_to
from vtray.transport.sampling.paths import PICK, Step, lamp_point, path_point
from vtray.transport.sampling.sky_brightness import bright_density
from vtray.transport.sampling.sky_map import light_towards, map_place
from vtray.transport.sampling.sky_rays import sky_direction
from vtray.transport.scene_arrays import LitWorld

PICKED = 16
"""So many of the lights with a size have shadow rays from each glossy surface, at the most."""


class GlossRay(NamedTuple):
    """A shadow ray from a glossy surface.

    Attributes
    ----------
    segment
        Where it goes.
    light
        The light that it brings, 255 for white, if nothing is in the way.
    """

    segment: Segment
    light: Vec


@seldom
def light_gloss(
    looks: Looks,
    albedos: Albedos,
    gloss: Gloss,
    start: Start,
    lit: LitWorld,
    lights: Lights,
    step: Step,
    stack: Stack,
) -> tuple[Vec, int]:
    """Return what all lights bring to a glossy surface, and how many shadow rays were cast.

    Light that is the same from everywhere is left to the rays that go on.

    Parameters
    ----------
    looks, albedos, gloss
        The surface.
    start
        Where rays start.
    lit, lights
        The scene, and its lights.
    step
        The step of the path.
    stack
        Scratch memory.

    Returns
    -------
    light, rays
        The light, 255 for white, and the number of rays.
    """
    light, rays = _light_of_points(looks, albedos, gloss, start, lit, lights, lights.points, stack)
    more, cast = _light_of_lamps(
        looks, albedos, gloss, start, lit, lights, lights.soft, step, stack
    )
    return add(light, more), rays + cast


@device
def _light_of_points(
    looks: Looks,
    albedos: Albedos,
    gloss: Gloss,
    start: Start,
    lit: LitWorld,
    lights: Lights,
    points: int | None,
    stack: Stack,
) -> tuple[Vec, int]:
    """Return what points bring; see `light_gloss`."""
    light, rays = (0.0, 0.0, 0.0), 0
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if points is None:
        return light, rays
    for k in range(light_count(lights)):
        ray = ray_to_point(looks, albedos, gloss, start, lights, k)
        more, cast = _brought(lit.world, ray, stack)
        light, rays = add(light, more), rays + cast
    return light, rays


@device
def _light_of_lamps(
    looks: Looks,
    albedos: Albedos,
    gloss: Gloss,
    start: Start,
    lit: LitWorld,
    lights: Lights,
    soft: SoftLights | None,
    step: Step,
    stack: Stack,
) -> tuple[Vec, int]:
    """Return what lights that are no points bring; see `light_gloss`."""
    light, rays = (0.0, 0.0, 0.0), 0
    if soft is None:
        return light, rays
    _, choice = path_point(step, PICK)
    for k in range(picked_count(soft)):
        number = picked_lamp(soft, k, choice)
        ray = ray_to_lamp(looks, albedos, gloss, start, lit.forward, lights, soft, number, step)
        more, cast = _brought(lit.world, ray, stack)
        light, rays = add(light, scale(soft_count(soft) / picked_count(soft), more)), rays + cast
    return light, rays


@device
def picked_count(soft: SoftLights) -> int:
    """Return how many of the lights that are no points have a shadow ray."""
    return min(soft_count(soft), PICKED)


@device
def picked_lamp(soft: SoftLights, k: int, choice: float) -> int:
    """Return which light is the k-th of those picked, for a number from 0 to 1 that chooses."""
    count = soft_count(soft)
    return int((k + choice) * count / PICKED) if count > PICKED else k


@device
def _brought(world: World, ray: GlossRay, stack: Stack) -> tuple[Vec, int]:
    """Return what a shadow ray brings, and how many were cast: none where it would be nothing."""
    dark = (0.0, 0.0, 0.0)
    if not max(ray.light[0], ray.light[1], ray.light[2]) > 0.0:
        return dark, 0
    return (dark if is_occluded(world, ray.segment, stack) else ray.light), 1


@device
def ray_to_point(
    looks: Looks, albedos: Albedos, gloss: Gloss, start: Start, lights: Lights, k: int
) -> GlossRay:
    """Return the shadow ray to a point; the parameters are those of `light_gloss`."""
    end, error_scale = (lights.x[k], lights.y[k], lights.z[k]), lights.error_scale[k]
    depth, way = lights.plane_depth[k], sub(end, start.point)
    segment = Segment(start.point, end, start.plane_depth, depth, start.error_scale, error_scale)
    if not is_above(gloss.normal, way, ROUNDING * (start.error_scale + error_scale)):
        return GlossRay(segment, (0.0, 0.0, 0.0))
    unit = scale(1.0 / math.sqrt(dot(way, way)), way)
    return GlossRay(segment, _shown(seen_light(looks, albedos, gloss, unit).share, lights, k, PI))


@device
def ray_to_lamp(
    looks: Looks,
    albedos: Albedos,
    gloss: Gloss,
    start: Start,
    forward: Vec,
    lights: Lights,
    soft: SoftLights,
    number: int,
    step: Step,
) -> GlossRay:
    """Return the shadow ray to one of the lights that are no points.

    Parameters
    ----------
    looks, albedos, gloss, start, lights, step
        As for `light_gloss`.
    forward
        The unit direction in which the camera looks.
    soft, number
        The light.
    """
    aim = aim_at(soft, number, start, gloss.normal)
    u, v = lamp_point(step, number)
    way, density, color = _towards_lamp(aim, u, v, gloss.normal, soft.skies)
    length = length_to(aim, start.point, way)
    end, end_depth = add(start.point, scale(length, way)), start.plane_depth
    end_depth += length * dot(way, forward)
    end_scale = soft.error_scale[number] + start.error_scale
    segment = Segment(start.point, end, start.plane_depth, end_depth, start.error_scale, end_scale)
    cosine = dot(gloss.normal, way)
    if not (cosine > 0.0 and density > 0.0):
        return GlossRay(segment, (0.0, 0.0, 0.0))
    seen, weight = seen_light(looks, albedos, gloss, way), 1.0
    if _is_met(aim, end_depth):
        weight = _power(density * _picked_share(soft), seen.density)
    per_density = PI / cosine if aim.spread == ALL_AROUND else PI * aim.share
    if aim.sky != NO_SKY:
        per_density = 1.0 / density
    factor = weight * per_density
    return GlossRay(segment, _of_components(seen.share, lights, soft, number, factor, color))


@device
def _of_components(
    share: Vec, lights: Lights, soft: SoftLights, number: int, factor: float, color: Vec
) -> Vec:
    """Return the light of all components of a light, each times its part of a colour."""
    row = soft.row[number]
    if soft.sky[number] == NO_SKY:
        return _shown(share, lights, row, factor)
    light = _shown(share, lights, row, factor * color[0])
    light = add(light, _shown(share, lights, row + 1, factor * color[1]))
    return add(light, _shown(share, lights, row + 2, factor * color[2]))


@device
def _shown(share: Vec, lights: Lights, row: int, factor: float) -> Vec:
    """Return so much of a component of a light, 255 for white."""
    power = load_power(lights, row)
    strength = 255.0 * factor * power.intensity
    return (
        strength * share[0] * power.color[0],
        strength * share[1] * power.color[1],
        strength * share[2] * power.color[2],
    )


@device
def _towards_lamp(
    aim: Aim, u: float, v: float, normal: Vec, skies: Skies | None
) -> tuple[Vec, float, Vec]:
    """Return a direction to a light, its density, and the colour of a sky there."""
    white = (1.0, 1.0, 1.0)
    if skies is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if aim.sky != NO_SKY:
            way = sky_direction(u, v, normal, skies, skies.bright, aim.sky)
            density = _sky_density(skies, aim.sky, way, normal)
            return way, density, light_towards(skies, aim.sky, way)
    way = direction_to(aim, u, v, normal)
    return way, _lamp_density(aim, way, normal), white


@device
def _lamp_density(aim: Aim, way: Vec, normal: Vec) -> float:
    """Return the density with which shadow rays take a direction to a light of one colour.

    That of a light without a size is infinite, and of one that is not seen 0.
    """
    if aim.kind == RECTANGLE:
        angle = solid_angle_of(aim.seen)
        return 1.0 / angle if aim.share > 0.0 else 0.0
    if aim.spread == ALL_AROUND:
        return max(dot(way, normal), 0.0) / PI
    return _cone_density(aim.spread) if aim.spread > 0.0 else math.inf


@device
def _cone_density(spread: float) -> float:
    """Return the density of directions that are all as likely within a cone."""
    return 0.5 / (PI * spread)


@device
def _sky_density(skies: Skies, sky: int, way: Vec, normal: Vec) -> float:
    """Return the density with which shadow rays take a direction to a sky."""
    share, cosine = skies.bright.share[sky], max(dot(way, normal), 0.0)
    density = (1.0 - share) * cosine
    if share > 0.0:
        density += share * bright_density(skies, skies.bright, sky, map_place(skies, sky, way))
    shown: float = density / PI
    return shown


@device
def _is_met(aim: Aim, end_depth: float) -> bool:
    """Tell whether rays that go on meet a light: a lamp or sun with a size, a sky with a map."""
    is_lamp = aim.kind in (SPHERE, RECTANGLE) and aim.spread > 0.0 and end_depth > 0.0
    is_disc = aim.kind == SUN and aim.spread >= LEAST_SPREAD
    return is_lamp or is_disc or aim.sky != NO_SKY


@device
def _picked_share(soft: SoftLights) -> float:
    """Return the share of lights that have shadow rays from each surface."""
    count = soft_count(soft)
    return PICKED / count if count > PICKED else 1.0


@device
def _power(own: float, other: float) -> float:
    """Return what a way of finding light counts, given the densities of both."""
    if not own > 0.0:
        return 0.0
    ratio = other / own
    return 1.0 / (1.0 + ratio * ratio)


@seldom
def light_met(lights: Lights, ray: Ray, normal: Vec, distance: float, density: float) -> Vec:
    """Return the light of lamps, skies and suns that a ray from a glossy surface meets, weighed.

    Lamps do not stop each other's light, as they do not for shadow rays.

    Parameters
    ----------
    lights
        All lights.
    ray, normal
        The ray, and the unit normal of the surface that it comes from.
    distance
        How far it goes until it meets a surface.
    density
        That with which its direction was chosen.
    """
    start = Start(ray.origin, ray.plane_depth, ray.error_scale)
    return add(
        _lamps_met(lights, lights.soft, lights.mirrored, ray, start, normal, distance, density),
        _far_light_met(lights.soft, lights.surroundings, ray, normal, distance, density),
    )


@device
def _lamps_met(
    lights: Lights,
    soft: SoftLights | None,
    lamps: VisibleLamps | None,
    ray: Ray,
    start: Start,
    normal: Vec,
    distance: float,
    density: float,
) -> Vec:
    """Return the light of lamps; see `light_met`."""
    light, all_seen = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
    if lamps is None:
        return light
    if soft is None:
        return light
    for k in range(lamp_count(lamps)):
        met, error_bound = lamp_distance(lamps, k, ray)
        if met < distance + error_bound:
            aim = aim_at(soft, lamps.light[k], start, normal)
            own = _lamp_density(aim, ray.direction, normal)
            # As bright as it must be to bring what it brings.
            radiance = 1.0 if aim.spread == ALL_AROUND else PI * aim.share * own
            weight = _power(density, own * _picked_share(soft))
            light = add(light, _shown(all_seen, lights, lamps.row[k], weight * radiance))
    return light


@device
def _far_light_met(
    soft: SoftLights | None,
    surroundings: Surroundings | None,
    ray: Ray,
    normal: Vec,
    distance: float,
    density: float,
) -> Vec:
    """Return the light of suns, and of skies that change with the direction; see `light_met`."""
    if surroundings is None:
        return 0.0, 0.0, 0.0
    if soft is None:
        return 0.0, 0.0, 0.0
    light = _maps_met(soft, surroundings, surroundings.skies, ray, normal, distance, density)
    return _add_discs_met(light, soft, surroundings.discs, ray, distance, density)


@device
def _maps_met(
    soft: SoftLights,
    surroundings: Surroundings,
    skies: Skies | None,
    ray: Ray,
    normal: Vec,
    distance: float,
    density: float,
) -> Vec:
    """Return the light of skies, those with a map; see `light_met`."""
    red = green = blue = 0.0
    if skies is not None:  # noqa: SIM102
        if distance == math.inf:
            color = surroundings.color
            for sky in range(color.shape[0]):
                own = _sky_density(skies, sky, ray.direction, normal)
                weight = _power(density, own * _picked_share(soft))
                light = scale(weight, light_towards(skies, sky, ray.direction))
                red += color[sky, 0] * light[0]
                green += color[sky, 1] * light[1]
                blue += color[sky, 2] * light[2]
    return red, green, blue


@device
def _add_discs_met(
    light: Vec, soft: SoftLights, discs: Discs, ray: Ray, distance: float, density: float
) -> Vec:
    """Return light, and that of suns; see `light_met`."""
    if distance == math.inf:
        for sun in range(disc_count(discs)):
            if is_towards(discs, sun, ray.direction):
                own = _cone_density(discs.spread[sun])
                weight = _power(density, own * _picked_share(soft))
                light = add(light, scale(weight, light_of_disc(discs, sun)))
    return light
