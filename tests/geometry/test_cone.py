"""What may stand between a point and a lamp: against the rays of the lamp, one by one."""

import math

import numpy as np
import pytest

import vtray
from conftest import JIT
from vtray import Scene
from vtray.geometry.between import is_occluded
from vtray.geometry.packets.cone import CLOSED, MANY, Cone, find_touching, new_touching
from vtray.geometry.packets.fan import Start
from vtray.geometry.packets.stack import new_stack
from vtray.geometry.ray import Segment
from vtray.geometry.vector import add, dot, scale
from vtray.geometry.warps import cone_direction
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack

CONES = 400 if JIT else 60
RAYS = 64 if JIT else 16


def scene_of(kind: str) -> Scene:
    random = np.random.default_rng(7)
    scene = Scene()
    count = {"few": 5, "many": 300, "bonds": 40, "copies": 6}[kind]
    centers = random.uniform(-1, 1, (count, 3))
    scene.add_spheres(centers, random.uniform(0.02, 0.3, count))
    if kind in ("bonds", "copies"):
        scene.add_cylinders(centers, centers + random.normal(size=(count, 3)) * 0.3, 0.05)
    if kind == "copies":
        scene.objects = [vtray.Copies(scene.objects, random.uniform(-1, 1, (4, 3)))]
    scene.add_plane((0, 0, -1.2), normal=(0, 0, 1))
    scene.camera = vtray.Camera((0, -6, 0), (0, 1, 0), 1.0, (8, 8), (1, 1))
    return scene


@pytest.mark.parametrize("kind", ["few", "many", "bonds", "copies"])
def test_a_cone_tells_what_all_its_rays_would(kind: str) -> None:
    scene, random = scene_of(kind), np.random.default_rng(5)
    arrays = pack(scene, accelerate(scene)).arrays
    world, forward, unit = arrays.world, arrays.camera.forward, arrays.world.scale
    stack, touching = new_stack(), new_touching()
    answers = {"open": 0, "closed": 0, "some": 0, "many": 0}
    for _ in range(CONES):
        place = random.uniform(-1.2, 1.2, 3)
        point = tuple(place * unit - np.array(world.origin))
        start = Start(point, dot(point, forward), sum(map(abs, point)))
        axis = random.normal(size=3)
        axis = tuple(axis / math.sqrt(axis @ axis))
        spread = 10 ** random.uniform(-6, -1)
        length = random.choice([1.0, 1e4]) * unit
        sine = math.sqrt(spread * (2 - spread))
        cone = Cone(start, axis, 1 - spread, sine, length, length, forward)
        count = find_touching(cone, world, touching, stack)
        blocked = 0
        for u, v in random.random((RAYS, 2)):
            end = add(point, scale(length, cone_direction(u, v, axis, spread)))
            depth = dot(end, forward)
            segment = Segment(point, end, start.plane_depth, depth, start.error_scale, 0.0)
            blocked += is_occluded(world, segment, stack)
        if count == 0:
            assert blocked == 0
        elif count == CLOSED:
            assert blocked == RAYS
        name = "many" if count == MANY else {0: "open", CLOSED: "closed"}.get(count, "some")
        answers[name] += 1
    least = 1 if JIT or kind == "many" else 0
    assert answers["open"] >= least
    assert answers["closed"] >= (3 if kind in ("few", "many") and JIT else 0)
    assert answers["some"] > 0


@pytest.mark.parametrize(("count", "expected"), [(30, 0), (9999, MANY)])
def test_what_lies_beside_a_cone_is_not_all_looked_at(count: int, expected: int) -> None:
    random = np.random.default_rng(2)
    axis = np.full(3, math.sqrt(1 / 3))
    cosine = math.cos(math.radians(24))
    # Of the directions whose components are those of some in the cone, which are not in it.
    ways = random.normal(size=(10**6, 3))
    ways /= np.sqrt((ways**2).sum(axis=1))[:, None]
    angles = np.degrees(np.arccos(ways))
    around = np.degrees(math.acos(axis[0]))
    is_held = (np.abs(angles - around) < 23.5).all(axis=1)
    ways = ways[is_held & (ways @ axis < math.cos(math.radians(25)))][:count]
    count = len(ways)
    scene = Scene()
    scene.add_spheres(ways * random.uniform(5, 10, (count, 1)), 0.001)
    scene.camera = vtray.Camera((0, 0, -1), (0, 0, 1), 1.0, (8, 8), (1, 1))
    arrays = pack(scene, accelerate(scene)).arrays
    unit = arrays.world.scale
    point = tuple(-np.array(arrays.world.origin))
    start = Start(point, dot(point, arrays.camera.forward), sum(map(abs, point)))
    sine = math.sqrt(1 - cosine * cosine)
    way = tuple(axis.tolist())
    cone = Cone(start, way, cosine, sine, 20 * unit, 20 * unit, arrays.camera.forward)
    assert find_touching(cone, arrays.world, new_touching(), new_stack()) == expected
