"""What is known of a whole packet holds for each of its points, to the last bit."""

from typing import Any

import numpy as np
import pytest

import vtray
from conftest import once
from vtray.geometry.packets.occlusion import (
    Target,
    block_by_planes,
    bound_points,
    find_sides,
    height_range,
    own_sphere,
)
from vtray.geometry.packets.packet import (
    BLOCKED,
    ERROR_SCALE,
    MET,
    NORMAL,
    PLANE_DEPTH,
    POINT,
    REACH,
    SETTLED,
    SOURCE,
    join_met,
    load,
    new_packet,
    store,
)
from vtray.geometry.packets.patch import MIDDLE, OPEN, UNEVEN_ALREADY, widest_reach
from vtray.geometry.packets.workspace import new_workspace
from vtray.geometry.ray import Segment
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.shapes.plane import load_plane, plane_hides
from vtray.geometry.shapes.sphere import load_sphere, sphere_hides
from vtray.geometry.world import PLANE, SPHERE, World, load_group
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.transport.lights.lighting import find_facing
from vtray.transport.materials.lambert import is_above

HITS = 40


def world_of(*objects: vtray.Sphere | vtray.Plane) -> World:
    """Return objects as they are, in the unit and from the origin of world space."""
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 1, (9, 9), (0.1, 0.1))
    scene = vtray.Scene(camera, [], list(objects))
    return pack(scene, accelerate(scene, 1)).arrays.world._replace(scale=1.0, origin=(0.0,) * 3)


def points(random: np.random.Generator, spread: float) -> Any:
    """Return a packet of points near each other, with normals near each other."""
    packet = new_packet()
    middle, normal = random.normal(size=3), random.normal(size=3)
    for lane in range(HITS):
        point = middle + spread * random.uniform(-1, 1, 3)
        turned = normal + spread * random.uniform(-1, 1, 3)
        store(packet, POINT, lane, tuple(point.tolist()))
        store(packet, NORMAL, lane, tuple((turned / np.linalg.norm(turned)).tolist()))
        packet[PLANE_DEPTH + lane] = point[2] + 1.0
        packet[ERROR_SCALE + lane] = np.abs(point).sum() + 2.0
    return packet


def one_light(random: np.random.Generator, packet: Any) -> Target:
    """Return a light, now and then near the horizon of the first point."""
    place = random.normal(size=3) * random.choice([1, 3, 30])
    if random.random() < 0.5:
        level = np.cross(load(packet, NORMAL, 0), random.normal(size=3))
        place = np.array(load(packet, POINT, 0)) + level
    x, y, z = place.tolist()
    return Target((x, y, z), z + 1.0, abs(x) + abs(y) + abs(z) + 1.0)


def segment_of(packet: Any, lane: int, target: Target) -> Segment:
    """Return a shadow ray."""
    start, plane_depth = load(packet, POINT, lane), packet[PLANE_DEPTH + lane]
    scale = packet[ERROR_SCALE + lane]
    return Segment(start, target.place, plane_depth, target.plane_depth, scale, target.error_scale)


@once
@pytest.mark.parametrize("spread", [0.0, 1e-15, 1e-3, 0.3])
def test_points_that_face_a_light(spread: float) -> None:
    random = np.random.default_rng(1)
    seen = set()
    for _ in range(60):
        packet = points(random, spread)
        target = one_light(random, packet)
        bounds = bound_points(packet, HITS)
        least, most = height_range(bounds, target.place)
        expected = []
        for lane in range(HITS):
            (a, b, c), point = load(packet, NORMAL, lane), load(packet, POINT, lane)
            x, y, z = to_light = tuple(p - q for p, q in zip(target.place, point, strict=True))
            assert least <= a * x + b * y + c * z <= most
            error_bound = ROUNDING * (packet[ERROR_SCALE + lane] + target.error_scale)
            expected.append(is_above((a, b, c), to_light, error_bound))
        packet[BLOCKED : BLOCKED + HITS] = 7.0
        assert find_facing(packet, HITS, bounds, target) == sum(expected)
        if any(expected):
            assert np.array_equal(packet[BLOCKED : BLOCKED + HITS] == 0.0, expected)
        seen.add((most <= 0.0, least > 0.0))
    assert {(True, False), (False, True)} <= seen


@once
@pytest.mark.parametrize("spread", [0.0, 1e-15, 1e-3, 0.3])
def test_points_that_a_plane_hides(spread: float) -> None:
    random = np.random.default_rng(2)
    outcomes = []
    for _ in range(150):
        hits = int(random.choice([1, 2, HITS]))
        packet = points(random, spread)
        target = one_light(random, packet)
        # Some planes pass through a point, or through the light.
        through = [random.normal(size=3), load(packet, POINT, 0), target.place]
        place = through[random.choice(3, p=[0.6, 0.3, 0.1])]
        normal = tuple(random.normal(size=3).tolist())
        world = world_of(vtray.Plane(tuple(map(float, place)), normal))
        group = load_group(world, 0)
        assert group.kind == PLANE
        plane, work = load_plane(world.planes, 0, group.place), new_workspace(world)
        find_sides(packet, hits, world, work)
        expected = [plane_hides(plane, segment_of(packet, k, target)) for k in range(hits)]
        packet[BLOCKED : BLOCKED + hits] = 0.0
        bounds = bound_points(packet, hits)
        left = block_by_planes(packet, hits, bounds, world, group, target, work)
        assert np.array_equal(packet[BLOCKED : BLOCKED + hits] != 0.0, expected)
        assert left is not all(expected)
        outcomes.append(sum(expected) / hits)
    assert 0 in outcomes
    assert 1 in outcomes


@once
@pytest.mark.parametrize("radius", [1e-3, 1.0, 1e6])
def test_a_sphere_hides_no_point_on_it_that_faces_the_light(radius: float) -> None:
    random = np.random.default_rng(3)
    for _ in range(40):
        center = random.normal(size=3) * random.choice([1, 1e3])
        floor = vtray.Plane((0, 0, 1), (0, 0, 1))
        world = world_of(vtray.Sphere(tuple(center.tolist()), radius), floor)
        group = load_group(world, 1)
        assert group.kind == SPHERE
        sphere, packet = load_sphere(world.spheres, 0, group.place), new_packet()
        numbers = packet.view(np.int64)
        for lane in range(HITS):
            out = random.normal(size=3)
            point = center + radius * out / np.linalg.norm(out)
            outward = point - center
            store(packet, POINT, lane, tuple(point.tolist()))
            store(packet, NORMAL, lane, tuple((outward / np.linalg.norm(outward)).tolist()))
            packet[ERROR_SCALE + lane] = sphere.error_scale + np.abs(point).sum()
            packet[PLANE_DEPTH + lane] = 1.0
            numbers[SOURCE + lane] = HITS - 1 - lane
            numbers[MET + lane] = join_met(1, 0)
        assert own_sphere(packet, HITS, world) == 0
        for lane in range(HITS):
            point, normal = load(packet, POINT, lane), load(packet, NORMAL, lane)
            # Lights that are hardly above the horizon, before and behind the image plane.
            side = np.cross(normal, random.normal(size=3))
            place = np.array(point) + side + 10.0 ** random.integers(-12, 2) * np.array(normal)
            plane_depth = float(random.choice([-1.0, 1.0]))
            target = Target(tuple(place.tolist()), plane_depth, float(np.abs(place).sum()))
            to_light = tuple((place - np.array(point)).tolist())
            error_bound = ROUNDING * (packet[ERROR_SCALE + lane] + target.error_scale)
            if is_above(normal, to_light, error_bound):
                assert not sphere_hides(sphere, segment_of(packet, lane, target))
        # From inside, or of two, no sphere is left out.
        store(packet, NORMAL, 5, tuple(-part for part in load(packet, NORMAL, 5)))
        assert own_sphere(packet, HITS, world) == -1
        assert own_sphere(packet, 5, world) == 0
        numbers[MET + numbers[SOURCE + 4]] = join_met(0, 0)  # a plane
        assert own_sphere(packet, 5, world) == -1


def test_patches_that_are_settled_widen_nothing() -> None:
    packet = new_packet()
    packet[BLOCKED : BLOCKED + 4] = 0.0, 1.0, 0.0, 0.0
    packet[SETTLED : SETTLED + 4] = OPEN, MIDDLE, UNEVEN_ALREADY, MIDDLE
    # A plane towards its horizon is seen by patches of any size, which get samples whatever light
    # they have. If they counted, shadow rays of all others were looked for in all of the scene.
    packet[REACH : REACH + 4] = 0.5, 70.0, 1e30, 0.25
    assert widest_reach(packet, 0, 4, True) == 0.5
    assert widest_reach(packet, 1, 4, True) == 0.25
    assert widest_reach(packet, 1, 3, True) == 0.0
