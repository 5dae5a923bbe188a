"""The rays from a glossy surface to lights, of each of which its coat shows something else."""

from typing import NamedTuple

from vtray.base.compiler.compiled import pinned
from vtray.figures.traced_rays import FanRay, Hit, ShadowFan, ShadowRay, Surface, WayToLight
from vtray.geometry.packets.packet import Packet
from vtray.geometry.packets.stack import Stack
from vtray.geometry.queries import NOTHING
from vtray.geometry.vector import Vec
from vtray.rendering.pixel import Pixel, in_world
from vtray.rendering.pixel_lights import (
    asked_lights,
    length_towards,
    middle_of,
    point_lights,
    way_to,
)
from vtray.rendering.pixel_surfaces import as_vec, find_blocker, rgb
from vtray.scene.light_types import AnyLight, Light, measure_of, strength_of
from vtray.transport.integrators.glossy_light import PICKED
from vtray.transport.integrators.single_path import Glossy, ToldRay, tell_lamp, tell_point
from vtray.transport.sampling.paths import Step


class Coat(NamedTuple):
    """A glossy hit of a path.

    Attributes
    ----------
    pixel, step
        The pixel, and the step of the path.
    packet
        Where the hit is, the first of it.
    hit, glossy
        The hit, and its material.
    stack
        Scratch memory.
    """

    pixel: Pixel
    step: Step
    packet: Packet
    hit: Hit
    glossy: Glossy
    stack: Stack


def coat_lights(coat: Coat) -> tuple[WayToLight, ...]:
    """Return the ways from a glossy hit to all lights."""
    packed, scene = coat.pixel.packed, coat.pixel.scene
    world, glossy, stack = packed.given, pinned(coat.glossy), pinned(coat.stack)
    ways: list[WayToLight] = []
    for number, (k, light) in enumerate(point_lights(scene)):
        told = tell_point(world, glossy, coat.packet, number, stack)
        ways.append(_to_point(coat, k, light, told))
    others, soft, asked = asked_lights(scene), packed.given_lights, {}
    if soft is not None:
        for number in range(min(len(others), PICKED)):
            told = tell_lamp(world, glossy, soft, coat.step, coat.packet, number, stack)
            asked[int(told.light)] = told
    ways += [_to_lamp(coat, k, light, asked.get(row)) for row, (k, light) in enumerate(others)]
    return tuple(sorted(ways, key=lambda way: way.light))


def _to_point(coat: Coat, number: int, light: Light, told: ToldRay) -> ShadowRay:
    """Return the ray to a point."""
    place = light.location.x, light.location.y, light.location.z
    way, distance = way_to(coat.hit, place)
    brings = max(told.brings) > 0.0
    cosine = sum(a * b for a, b in zip(coat.hit.normal, way, strict=True)) if brings else 0.0
    adds = _added(told)
    blocker = _blocker(coat, told, way) if brings else None
    color = rgb(light.color)
    return ShadowRay(number, place, light.intensity, way, distance, cosine, blocker, adds, color)


def _to_lamp(coat: Coat, number: int, light: AnyLight, told: ToldRay | None) -> ShadowFan:
    """Return the one ray to a light that is no point, or none if others were picked."""
    kind, middle = str(type(light).__struct_config__.tag), middle_of(coat.hit, light)
    rays: tuple[FanRay, ...] = ()
    adds, share = (0.0, 0.0, 0.0), 0.0
    if told is not None:
        way, to_end = way_to(coat.hit, in_world(coat.pixel, told.end))
        length = length_towards(light, to_end)
        weight, adds = 1.0 if max(told.brings) > 0.0 else 0.0, _added(told)
        rays = (FanRay(way, length, weight, _blocker(coat, told, way) if weight else None),)
        share = weight if rays[0].arrives else 0.0
    strength, measure, color = strength_of(light), measure_of(light), rgb(light.color)
    return ShadowFan(number, kind, strength, middle, rays, share, adds, color, measure)


def _added(told: ToldRay) -> Vec:
    """Return what a ray adds to the pixel."""
    if int(told.blocker) != NOTHING:
        return 0.0, 0.0, 0.0
    return as_vec(told.brings)


def _blocker(coat: Coat, told: ToldRay, way: Vec) -> Surface | None:
    """Return what is in the way of a ray."""
    primitive, pixel = int(told.blocker), coat.pixel
    if primitive == NOTHING:
        return None
    return find_blocker(pixel.scene, pixel.numbering, primitive, coat.hit.point, way)
