"""The rays from what the ray of a pixel hits to the lights, as users get them."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import pinned, uncompiled
from vtray.base.exact_math import hypotenuse
from vtray.figures.traced_rays import FanRay, Hit, ShadowFan, ShadowRay, WayToLight
from vtray.geometry.caps import Caps, new_caps
from vtray.geometry.packets.cone import Touching, new_touching
from vtray.geometry.packets.fan import DIRECTION, END, FAN, WEIGHT, Fan, new_fan
from vtray.geometry.packets.layer_notes import Walk, new_walk
from vtray.geometry.packets.stack import Stack, new_stack
from vtray.geometry.queries import NOTHING
from vtray.geometry.vector import Vec, scale, sub
from vtray.geometry.world import body_count
from vtray.rendering.numbering import Numbering
from vtray.rendering.pack import Packed
from vtray.rendering.pack_surroundings import is_even, is_everywhere
from vtray.rendering.pixel_surfaces import as_vec, find_blocker, rgb
from vtray.scene.colors.color_light import light_of
from vtray.scene.light_types import (
    Ambient,
    AnyLight,
    Lamp,
    Light,
    SphereLight,
    Sun,
    measure_of,
    strength_of,
)
from vtray.scene.placing.directions import unit
from vtray.scene.scene import Scene
from vtray.transport.integrators.reference import TracedPixel, trace_fan, trace_lamp
from vtray.transport.lights.light import Lights
from vtray.transport.lights.soft_light import component_count
from vtray.transport.sampling.fans import Fans, fans_of_share


class Lit(NamedTuple):
    """A hit to which light comes.

    Attributes
    ----------
    scene, numbering
        The scene, and the numbers of its primitives.
    hit
        The hit.
    color
        Its colour as light, 255 for white, by how much of it is seen.
    """

    scene: Scene
    numbering: Numbering
    hit: Hit
    color: Vec


def point_lights(scene: Scene) -> list[tuple[int, Light]]:
    """Return the lights that are points, and their places in the scene."""
    return [(k, light) for k, light in enumerate(scene.lights) if isinstance(light, Light)]


def asked_lights(scene: Scene) -> list[tuple[int, AnyLight]]:
    """Return the lights that are no points to which shadow rays go, and their places in the scene.

    Rays of paths find those that are the same from everywhere.
    """
    is_path = scene.render.integrator == "path"
    lights = [(k, light) for k, light in enumerate(scene.lights) if not isinstance(light, Light)]
    return [(k, light) for k, light in lights if not (is_path and is_even(light))]


def place_of_lamp(scene: Scene, lights: Lights, row: int) -> int | None:
    """Return the place in the scene of a lamp, given its row; None for ``NOTHING``."""
    if row == NOTHING:
        return None
    assert lights.soft is not None  # noqa: S101 - there is a lamp
    place, _ = asked_lights(scene)[int(np.searchsorted(lights.soft.row, row))]
    return place


def shadow_rays(
    lit: Lit, cosines: NDArray[np.float64], blockers: NDArray[np.int64]
) -> list[WayToLight]:
    """Return the rays to all point lights, given what `reference.trace_pixel` writes."""
    return [
        _shadow_ray(lit, number, light, float(cosine), int(blocker))
        for (number, light), cosine, blocker in zip(
            point_lights(lit.scene), cosines, blockers, strict=True
        )
    ]


def trace_fans(
    lit: Lit,
    packed: Packed,
    traced: TracedPixel,
    pixel: tuple[int, int],
    fans: Fans | None,
    count: int,
    seed: int,
) -> tuple[list[WayToLight], Vec]:
    """Trace the rays to all lights that are no points, each of which has its own.

    Parameters
    ----------
    lit
        The hit.
    packed
        The arrays of its scene.
    traced
        The pixel with the light of the points.
    pixel
        Its column and row.
    fans, count
        Which rays are cast to such lights, None without any; and how many fans to each.
    seed
        The seed of the picture.

    Returns
    -------
    fans, light
        The rays, and the pixel's light with all that they add.
    """
    ways: list[WayToLight] = []
    soft, lamps = packed.arrays.lights.soft, packed.given_lights
    if fans is None or soft is None or lamps is None:
        return ways, traced.value
    spent, scratch, around = 0.0, _scratch(packed, traced, fans), _around()
    _, fan, blockers, _ = scratch
    start, length = traced.interaction.point, packed.unit
    world, cast = packed.given, pinned(fans)
    for k, light in asked_lights(lit.scene):
        known = world, lamps, traced, *pixel, len(ways), cast, count
        lamp = trace_lamp(*known, spent, seed, *scratch, *around)
        components = uncompiled(component_count)(soft, len(ways))
        rays: list[FanRay] = []
        for number in range(0 if is_everywhere(light) else lamp.fans):
            trace_fan(*known, number, seed, *scratch)
            rays += [
                fan_ray(lit, light, SpreadRay(fan, ray, start, length, components), int(blocker))
                for ray, blocker in enumerate(blockers)
            ]
        ways.append(shadow_fan(lit, k, light, tuple(rays), lamp.shares[:components]))
        traced = traced._replace(value=lamp.value)
        spent += lamp.counted
    return ways, traced.value


def variance_on_trial(
    packed: Packed, traced: TracedPixel, pixel: tuple[int, int], fans: Fans, seed: int
) -> float:
    """Return the variance of one fan to each light that is no point, as a part of what it may be.

    The parameters are those of `trace_fans`.
    """
    soft, lamps = packed.arrays.lights.soft, packed.given_lights
    assert soft is not None  # noqa: S101 - they have fans
    assert lamps is not None  # noqa: S101
    spent, scratch, around = 0.0, _scratch(packed, traced, fans), _around()
    world, cast = packed.given, pinned(fans)
    for light in range(len(soft.kind)):
        known = world, lamps, traced, *pixel, light, cast, 1
        lamp = trace_lamp(*known, spent, seed, *scratch, *around)
        spent += lamp.counted
    return spent


def _scratch(
    packed: Packed, traced: TracedPixel, fans: Fans
) -> tuple[Stack, Fan, NDArray[np.int64], Walk]:
    """Return scratch memory of a hit's fans, with the rays of one and what blocks them."""
    rays = uncompiled(fans_of_share)(fans, traced.share).rays
    walk = new_walk(body_count(packed.arrays.world))
    return pinned(new_stack()), new_fan(), np.full(rays, NOTHING), pinned(walk)


def _around() -> tuple[Touching, Caps]:
    """Return scratch memory of what is around a hit."""
    return pinned(new_touching()), pinned(new_caps())


def _shadow_ray(lit: Lit, number: int, light: Light, cosine: float, primitive: int) -> ShadowRay:
    """Return the ray from a hit to a point light; `primitive` is the number of what blocks it."""
    place = light.location.x, light.location.y, light.location.z
    way, distance = way_to(lit.hit, place)
    is_free, blocker = primitive == NOTHING, None
    if not is_free:
        blocker = find_blocker(lit.scene, lit.numbering, primitive, lit.hit.point, way)
    arriving = cosine if is_free else 0.0
    adds = added(lit, light, (arriving, arriving, arriving))
    color = rgb(light.color)
    return ShadowRay(number, place, light.intensity, way, distance, cosine, blocker, adds, color)


def shadow_fan(
    lit: Lit, number: int, light: AnyLight, rays: tuple[FanRay, ...], shares: tuple[float, ...]
) -> ShadowFan:
    """Return the rays from a hit to a light that is no point."""
    kind = str(type(light).__struct_config__.tag)
    share, color = sum(shares) / len(shares), rgb(light.color)
    middle = middle_of(lit.hit, light)
    red, green, blue = shares if len(shares) == 3 else 3 * shares
    adds = added(lit, light, (red, green, blue))
    several = None if len(shares) == 1 else (red, green, blue)
    strength, measure = strength_of(light), measure_of(light)
    return ShadowFan(number, kind, strength, middle, rays, share, adds, color, measure, several)


class SpreadRay(NamedTuple):
    """A ray of a fan in the kernels' space.

    Attributes
    ----------
    fan, ray
        The ray.
    start
        Where it starts.
    unit
        The length of a unit there in scene units.
    components
        How many weights it has.
    """

    fan: Fan
    ray: int
    start: Vec
    unit: float
    components: int

    def weight(self) -> float:
        """Return what the ray counts, the mean of its weights."""
        begin, end = WEIGHT + self.ray, WEIGHT + self.components * FAN
        return float(sum(self.fan[begin:end:FAN])) / self.components

    def vector(self, field: int) -> Vec:
        """Return a field that is a vector."""
        return as_vec(self.fan[field + self.ray : field + self.ray + 3 * FAN : FAN])


def fan_ray(lit: Lit, light: AnyLight, ray: SpreadRay, primitive: int) -> FanRay:
    """Return a ray of a fan; `primitive` is the number of what blocks it."""
    direction = ray.vector(DIRECTION)
    to_end = math.inf
    if isinstance(light, Lamp):
        to_end = hypotenuse(*uncompiled(sub)(ray.vector(END), ray.start)) * ray.unit
    length = length_towards(light, to_end)
    blocker = None
    if primitive != NOTHING:
        blocker = find_blocker(lit.scene, lit.numbering, primitive, lit.hit.point, direction)
    return FanRay(direction, length, ray.weight(), blocker)


def length_towards(light: AnyLight, to_end: float) -> float:
    """Return how far a ray to a light that is no point goes; a lamp is as far as its end."""
    if isinstance(light, Ambient):
        return light.distance
    return to_end if isinstance(light, Lamp) else math.inf


def way_to(hit: Hit, place: Vec) -> tuple[Vec, float]:
    """Return the unit direction from a hit to a place, 0 if it is there, and how far that is."""
    way = uncompiled(sub)(place, hit.point)
    distance = hypotenuse(*way)
    if not distance:
        return (0.0, 0.0, 0.0), 0.0
    return (way[0] / distance, way[1] / distance, way[2] / distance), distance


def middle_of(hit: Hit, light: AnyLight) -> Vec:
    """Return the direction from a hit to the middle of a light."""
    if isinstance(light, Sun):
        return uncompiled(scale)(-1.0, unit(light.direction))
    if isinstance(light, Lamp):
        way, distance = way_to(hit, (light.location.x, light.location.y, light.location.z))
        if distance > (light.radius if isinstance(light, SphereLight) else 0.0):
            return way
    return hit.normal


def added(lit: Lit, light: AnyLight, shares: Vec) -> Vec:
    """Return what a light adds to a pixel, of whose red, green and blue so much arrives."""
    # In the order of the kernels, so that the sum has the same bits.
    surface = lit.hit.surface
    strengths = [share * surface.lambert * strength_of(light) for share in shares]
    red, green, blue = as_vec(lit.color)
    tint = light_of(light.color, lit.scene.render.tonemap)
    return (
        strengths[0] * red * (tint[0] / 255),
        strengths[1] * green * (tint[1] / 255),
        strengths[2] * blue * (tint[2] / 255),
    )
