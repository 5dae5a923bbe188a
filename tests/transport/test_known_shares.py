"""What is known of lamps without rays is what many rays tell, one by one."""

import math
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, once
from vtray.base.compiler.compiled import kernel
from vtray.geometry.between import is_occluded
from vtray.geometry.caps import UNKNOWN, Caps, new_caps
from vtray.geometry.packets.cone import Touching, new_touching
from vtray.geometry.packets.fan import Start
from vtray.geometry.packets.stack import Stack, new_stack
from vtray.geometry.ray import Segment
from vtray.geometry.vector import Vec, add, dot, scale
from vtray.geometry.warps import cone_direction
from vtray.geometry.world import World
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.transport.integrators.soft_known import share_at
from vtray.transport.lights.soft_light import SoftLights, aim_at
from vtray.transport.sampling.fans import Fans, Noise, fans_of_middles
from vtray.transport.sampling.light_rays import length_to, weight_of

POINTS = 400
ASIDE = 3
"""The number of the light from aside."""
HARD = 6
"""That of the one that is no cone."""
ROWS = 40 if JIT else 10


@kernel
def ask(
    soft: SoftLights,
    light: int,
    start: Start,
    normal: Vec,
    forward: Vec,
    world: World,
    fans: Fans,
    places: Any,
    touching: Touching,
    caps: Caps,
    stack: Stack,
) -> tuple[float, float, int]:
    """Return what is known of a light, and what rays tell, and how many of them arrive."""
    aim = aim_at(soft, light, start, normal)
    known = share_at(aim, start, normal, forward, world, fans, touching, caps, stack)
    total, arrive = 0.0, 0
    if known != UNKNOWN:
        for k in range(places.shape[0]):
            direction = cone_direction(places[k, 0], places[k, 1], aim.axis, aim.spread)
            way = scale(length_to(aim, start.point, direction), direction)
            end, depth = add(start.point, way), start.plane_depth + dot(way, forward)
            segment = Segment(start.point, end, start.plane_depth, depth, start.error_scale, 0.0)
            weight = weight_of(aim, dot(normal, direction))
            if weight > 0.0 and not is_occluded(world, segment, stack):
                total += weight
                arrive += 1
    return known, total / places.shape[0], arrive


def balls_of(kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the centres and radii of the balls of a scene."""
    random, count = np.random.default_rng(4), {"few": 4, "many": 60, "floor": 8, "tilted": 4}[kind]
    return random.uniform(-1, 1, (count, 3)), random.uniform(0.1, 0.4, count)


def scene_of(kind: str) -> vtray.Scene:
    """Return balls, some with a floor, in front of the image plane and behind it."""
    scene = vtray.Scene()
    scene.add_spheres(*balls_of(kind))
    if kind == "floor":
        scene.add_plane((0, -1.2, 0), normal=(0, 1, 0))
    if kind == "tilted":
        scene.add_plane((0, -1.5, 0), normal=(0.3, 1, 0.2))
    scene.camera = vtray.Camera((0, 0, 0.8), (0, 0, -1), 1.0, (8, 8), (1, 1))
    scene.lights = [
        vtray.Sun((-0.3, -0.1, -1), angle=20),
        vtray.Sun((0.1, 0.05, -1), angle=40),
        vtray.Sun((0.5, -0.3, 1), angle=8),
        vtray.Sun((1, 0.1, 0.05), angle=30),
        vtray.SphereLight((3, 2, 1), 0.8),
        vtray.SphereLight((0.2, 0.3, -2), 0.4),
        vtray.Sun((0.2, -0.5, -1), angle=0),
    ]
    return scene


def points_of(kind: str, random: np.random.Generator) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return points on the balls of a scene, and in between, with unit normals."""
    centers, radii = balls_of(kind)
    points = []
    for k in range(POINTS):
        normal = random.normal(size=3)
        normal /= math.sqrt(normal @ normal)
        if k % 4 == 0:
            points.append((random.uniform(-1.5, 1.5, 3), normal))
        else:
            ball = random.integers(len(centers))
            points.append((centers[ball] + radii[ball] * normal, normal))
    return points


@once
@pytest.mark.parametrize("kind", ["few", "many", "floor", "tilted"])
def test_what_is_known_is_what_rays_tell(kind: str) -> None:
    scene, random = scene_of(kind), np.random.default_rng(7)
    arrays = pack(scene, accelerate(scene)).arrays
    world, forward, unit = arrays.world, arrays.camera.forward, arrays.world.scale
    soft, fans = arrays.lights.soft, fans_of_middles(Noise(math.inf, by_light=True))
    assert soft is not None
    stack, touching, caps = new_stack(), new_touching(), new_caps()
    middles = (np.arange(ROWS) + 0.5) / ROWS
    places = np.stack(np.meshgrid(middles, middles), axis=-1).reshape(-1, 2)
    partly, unknown = np.zeros((2, len(scene.lights)), int)
    for k, (place, normal) in enumerate(points_of(kind, random)):
        point = tuple(float(x) for x in place * unit - np.array(world.origin))
        depth = dot(point, forward) + arrays.camera.middle_depth
        if depth <= 0:
            continue
        start, light = Start(point, depth, sum(map(abs, point))), k % len(scene.lights)
        way = tuple(float(x) for x in normal)
        known, told, arrive = ask(
            soft, light, start, way, forward, world, fans, places, touching, caps, stack
        )
        if known == UNKNOWN:
            unknown[light] += 1
            continue
        assert known == pytest.approx(told, abs=2.0 / ROWS), (k, light)
        partly[light] += 0 < arrive < len(places)
    # From aside, floors are met before the image plane and behind it, and rays are cast.
    assert partly[ASIDE] > 0 or kind in ("floor", "tilted")
    assert partly[HARD] == 0
    assert unknown[HARD] > 0
    assert (np.delete(partly, [ASIDE, HARD]) > 0).all()
