"""What may stand between a point and a lamp: against the rays of the lamp, one by one."""

import math
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, once
from vtray import Scene
from vtray.base.compiler.compiled import kernel
from vtray.geometry.between import is_occluded
from vtray.geometry.packets.cone import (
    CLOSED,
    MANY,
    MOST,
    Cone,
    Touching,
    find_among,
    find_touching,
    new_touching,
)
from vtray.geometry.packets.fan import Spot, Start
from vtray.geometry.packets.stack import Stack, new_stack
from vtray.geometry.ray import Segment
from vtray.geometry.vector import add, dot, scale
from vtray.geometry.warps import cone_direction
from vtray.geometry.world import World
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.transport.lights.soft_light import Aim, aim_at, cone_from, cone_of
from vtray.transport.sampling.light_rays import length_to

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


@kernel
def ask(
    cone: Cone,
    spread: float,
    length: float,
    places: Any,
    world: World,
    touching: Touching,
    stack: Stack,
) -> tuple[int, int]:
    """Return what a cone tells, and how many of its rays something is in the way of."""
    start, blocked = cone.start, 0
    for k in range(places.shape[0]):
        direction = cone_direction(places[k, 0], places[k, 1], cone.axis, spread)
        end = add(start.point, scale(length, direction))
        depth = dot(end, cone.forward)
        segment = Segment(start.point, end, start.plane_depth, depth, start.error_scale, 0.0)
        blocked += 1 if is_occluded(world, segment, stack) else 0
    return find_touching(cone, world, touching, MOST, stack), blocked


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
        cone = Cone(start, 0.0, axis, 1 - spread, sine, length, length, forward)
        count, blocked = ask(cone, spread, length, random.random((RAYS, 2)), world, touching, stack)
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


@kernel
def count_blocked(cone: Cone, aim: Aim, places: Any, world: World, stack: Stack) -> int:
    """Return how many rays of a cone to a light something is in the way of."""
    start, blocked = cone.start, 0
    for k in range(places.shape[0]):
        direction = cone_direction(places[k, 0], places[k, 1], cone.axis, 1 - cone.cosine)
        way = scale(length_to(aim, start.point, direction), direction)
        end_depth = start.plane_depth + dot(way, cone.forward)
        end = add(start.point, way)
        segment = Segment(start.point, end, start.plane_depth, end_depth, start.error_scale, 0.0)
        blocked += 1 if is_occluded(world, segment, stack) else 0
    return blocked


@once
@pytest.mark.parametrize("kind", ["few", "many", "bonds", "copies"])
def test_what_a_cone_from_a_spot_finds_is_all_that_those_from_its_points_touch(kind: str) -> None:
    scene, random = scene_of(kind), np.random.default_rng(6)
    scene.lights = [
        vtray.Sun((0.3, 0.5, -1), angle=8),
        vtray.SphereLight((1, -3, 2), 0.4),
        vtray.SphereLight((0.2, 0.3, 0.4), 0.1),
    ]
    arrays = pack(scene, accelerate(scene)).arrays
    world, forward, unit = arrays.world, arrays.camera.forward, arrays.world.scale
    soft, normal = arrays.lights.soft, (0.0, 0.0, 1.0)
    stack, touching, own = new_stack(), new_touching(), new_touching()
    answers = {"open": 0, "closed": 0, "some": 0, "unknown": 0}

    def start_at(place: np.ndarray) -> Start:
        point = tuple(float(x) for x in place * unit - np.array(world.origin))
        return Start(point, dot(point, forward), sum(map(abs, point)))

    for k in range(CONES):
        middle, extent = random.uniform(-1.2, 1.2, 3), 10 ** random.uniform(-4, -0.5)
        spot = Spot(start_at(middle), extent * unit, normal, 2.0, extent * unit)
        around = cone_from(aim_at(soft, k % 3, spot.start, normal), spot, forward)
        count = find_touching(around, world, touching, MOST, stack) if around.cosine > 0 else MANY
        if count < 0:
            answers["unknown"] += 1
            continue
        for _ in range(4):
            way = random.normal(size=3)
            way *= random.choice([0.99, 0.5]) * extent / math.sqrt(way @ way)
            start = start_at(middle + way)
            aim = aim_at(soft, k % 3, start, normal)
            cone = cone_of(aim, start, forward)
            found = find_among(cone, world, touching, count, own)
            answers[{0: "open", CLOSED: "closed"}.get(found, "some")] += 1
            ways = random.random((RAYS // 4, 2))
            blocked = count_blocked(cone, aim, ways, world, stack)
            if found == 0:
                assert blocked == 0
            elif found == CLOSED:
                assert blocked == len(ways)
    assert min(answers["open"], answers["some"]) > 10
    assert answers["closed"] > (3 if kind in ("few", "many") and JIT else -1)
    assert answers["unknown"] > (3 if kind in ("many", "bonds") and JIT else -1)


def test_what_lies_beside_a_cone_in_its_beam_is_not_looked_at() -> None:
    random = np.random.default_rng(2)
    axis = np.full(3, math.sqrt(1 / 3))
    cosine = math.cos(math.radians(24))
    # Of the directions whose components are those of some in the cone, which are not in it.
    ways = random.normal(size=(10**6, 3))
    ways /= np.sqrt((ways**2).sum(axis=1))[:, None]
    angles = np.degrees(np.arccos(ways))
    around = np.degrees(math.acos(axis[0]))
    is_held = (np.abs(angles - around) < 23.5).all(axis=1)
    ways = ways[is_held & (ways @ axis < math.cos(math.radians(25)))]
    scene = Scene()
    scene.add_spheres(ways * random.uniform(5, 10, (len(ways), 1)), 0.001)
    assert ask_from_middle(scene, axis, cosine) == 0


@once
@pytest.mark.parametrize(("count", "expected"), [(300, 0), (100_000, MANY)])
def test_not_all_boxes_are_looked_at_that_touch_a_cone(count: int, expected: int) -> None:
    # They do, as they are around several balls on a wider cone.
    random = np.random.default_rng(2)
    turn = random.uniform(0, 2 * math.pi, count)
    angle = np.radians(random.uniform(24.02, 24.04, count))
    ways = np.stack([np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn), np.cos(angle)], 1)
    scene = Scene()
    scene.add_spheres(ways * random.uniform(5, 10, (count, 1)), 0.0005)
    assert ask_from_middle(scene, np.array([0.0, 0.0, 1.0]), math.cos(math.radians(24))) == expected


@once
@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 1, 0), (0.6, 0, -0.8)])
def test_a_cone_to_both_sides_of_an_axis_looks_ahead_only(axis: tuple[float, ...]) -> None:
    random = np.random.default_rng(3)
    middle = np.array(axis)
    ways = random.normal(size=(10**5, 3))
    ways /= np.sqrt((ways**2).sum(axis=1))[:, None]
    ways = ways[ways @ middle < math.cos(math.radians(15))]
    scene = Scene()
    scene.add_spheres(ways * random.uniform(5, 10, (len(ways), 1)), 0.001)
    assert ask_from_middle(scene, middle, math.cos(math.radians(10))) == 0


def ask_from_middle(scene: Scene, axis: np.ndarray, cosine: float) -> int:
    """Return how many shapes touch a cone from the origin."""
    scene.camera = vtray.Camera((0, 0, -1), (0, 0, 1), 1.0, (8, 8), (1, 1))
    arrays = pack(scene, accelerate(scene)).arrays
    unit = arrays.world.scale
    point = tuple(-np.array(arrays.world.origin))
    start = Start(point, dot(point, arrays.camera.forward), sum(map(abs, point)))
    sine = math.sqrt(1 - cosine * cosine)
    way = tuple(axis.tolist())
    cone = Cone(start, 0.0, way, cosine, sine, 20 * unit, 20 * unit, arrays.camera.forward)
    count: int = find_touching(cone, arrays.world, new_touching(), MOST, new_stack())
    return count
