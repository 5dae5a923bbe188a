"""Which rays of a fan arrive: all at once through hierarchies, and one by one."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import vtray
from conftest import JIT, compiled_only, once
from vtray import Scene
from vtray.base.compiler.compiled import device, kernel, uncompiled
from vtray.geometry.between import is_occluded
from vtray.geometry.bits import count_bits, lowest_bit
from vtray.geometry.bvh.tree import SIDES, WIDTH, Bvh
from vtray.geometry.packets.batch import new_batch, spot_of
from vtray.geometry.packets.cone import MANY, Touching, new_touching
from vtray.geometry.packets.fan import (
    BLOCKED,
    DIRECTION,
    END,
    END_PLANE_DEPTH,
    FAN,
    LENGTH,
    SINGLES,
    START,
    Fan,
    Start,
    new_fan,
    set_direction,
    set_start,
    spot_at,
)
from vtray.geometry.packets.fan_rays import (
    View,
    balls_seen,
    narrow_directions,
    octet_within,
    rays_along,
    set_ball,
)
from vtray.geometry.packets.packet import (
    ERROR_SCALE,
    NORMAL,
    PLANE_DEPTH,
    POINT,
    new_packet,
    store,
)
from vtray.geometry.packets.stack import Stack, new_stack
from vtray.geometry.stopped import Bundle, stop_rays, way_of
from vtray.geometry.vector import Vec, add, dot, magnitude, scale
from vtray.geometry.warps import cosine_direction
from vtray.geometry.world import World
from vtray.rendering import hierarchy
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.transport.scene_arrays import SceneArrays

FANS = 150 if JIT else 6
RAYS = 64 if JIT else 16


def scene_of(kind: str, size: float, place: float) -> Scene:
    """Return shapes in a cube of side 2 around the origin, larger by a factor, and moved."""
    random = np.random.default_rng(7)
    scene = Scene()
    count = {"loose": 300, "packed": 700, "bonds": 60, "copies": 90}[kind]
    centers, radii = random.uniform(-1, 1, (count, 3)), random.uniform(0.02, 0.2, count)
    scene.add_spheres(centers * size + place, radii * size)
    if kind == "bonds":
        ends = centers + random.normal(size=(count, 3)) * 0.3
        scene.add_cylinders(centers * size + place, ends * size + place, 0.05 * size)
        # So few that they have no hierarchy, and so long that balls around them say nothing.
        scene.add_cones(centers[:3] * size + place, -4 * ends[:3] * size + place, 0.2 * size, 0)
    if kind == "copies":
        scene.add_copies(vtray.Sphere((0, 0, 0), 0.1), random.uniform(-1, 1, (20, 3)))
    return scene


def arrays_of(scene: Scene, size: float, place: float) -> SceneArrays:
    """Return a scene of `scene_of` for kernels; the image plane cuts it."""
    eye = place, place - 2.5 * size, place
    scene.camera = vtray.Camera(eye, (0, 1, 0), 2.0 * size, (8, 8), (size, size))
    return pack(scene, accelerate(scene)).arrays


def start_at(spot: np.ndarray, arrays: SceneArrays) -> Start:
    """Return where rays start that do so at a point of the scene."""
    point = tuple(float(x) for x in spot * arrays.world.scale - np.array(arrays.world.origin))
    return Start(point, dot(point, arrays.camera.forward), magnitude(point))


def spot_on_bond(bonds: Any, random: np.random.Generator) -> tuple[Any, Any]:
    """Return a point of the side of one of many cylinders, and the normal there."""
    which = random.integers(len(bonds))
    axis = bonds.end[which] - bonds.start[which]
    normal = np.cross(axis, random.normal(size=3))
    normal = normal / math.sqrt(normal @ normal)
    return bonds.start[which] + random.random() * axis + bonds.radius * normal, normal


def set_fan(
    fan: Fan,
    start: Start,
    normal: Vec,
    length: float,
    forward: Vec,
    seed: int,
    first: int = 0,
    rays: int = RAYS,
) -> None:
    """Set rays above a surface, the last of which nothing needs to ask any more."""
    for ray, (u, v) in enumerate(np.random.default_rng(seed).random((rays, 2)), first):
        direction = uncompiled(cosine_direction)(u, v, normal)
        end = add(start.point, scale(length, direction))
        for axis in range(3):
            fan[DIRECTION + axis * FAN + ray] = direction[axis]
            fan[END + axis * FAN + ray] = end[axis]
        fan[LENGTH + ray] = length
        fan[END_PLANE_DEPTH + ray] = dot(end, forward)
        fan[BLOCKED + ray] = 0.0
    fan[BLOCKED + first + rays - 1] = 1.0


@kernel
def ask(bundle: Bundle, world: World, touching: Touching, stack: Stack, hidden: Any) -> None:
    """Stop the rays of a fan together, and tell of each whether something is in its way, 1 or 0."""
    stop_rays(bundle, world, touching, MANY, stack)
    for ray in range(hidden.size):
        hidden[ray] = 1.0 if is_occluded(world, way_of(bundle, ray), stack) else 0.0


@once
@pytest.mark.parametrize(
    ("kind", "size", "place"),
    [
        ("loose", 1, 0),
        ("packed", 1, 0),
        ("bonds", 1, 0),
        ("copies", 1, 0),
        ("loose", 1, 1e6),
        ("packed", 1e-3, 1e7),
        ("packed", 1e-100, 0),
        ("loose", 1e100, 0),
    ],
)
def test_what_stops_a_fan_stops_each_of_its_rays(
    kind: str, size: float, place: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hierarchy, "FEW", 4)
    scene, random = scene_of(kind, size, place), np.random.default_rng(5)
    arrays = arrays_of(scene, size, place)
    world, forward, unit = arrays.world, arrays.camera.forward, arrays.world.scale
    stack, touching, fan, found = new_stack(), new_touching(), new_fan(), []
    spheres = next(item for item in scene.objects if isinstance(item, vtray.Spheres))
    for k in range(FANS):
        normal = random.normal(size=3)
        normal = normal / math.sqrt(normal @ normal)
        spot = random.uniform(-1.2, 1.2, 3) * size + place
        # Most start on a sphere, as all do that belong to a hit.
        if k % 4:
            which = random.integers(len(spheres.center))
            spot = spheres.center[which] + normal * np.asarray(spheres.radius)[which]
        if kind == "bonds" and k % 3 == 0:
            spot, normal = spot_on_bond(scene.objects[1], random)
        start = start_at(spot, arrays)
        if start.plane_depth <= 0:
            continue
        above = float(normal[0]), float(normal[1]), float(normal[2])
        length = float(random.choice([0.1, 2.0, 1e4])) * size * unit
        set_fan(fan, start, above, length, forward, k)
        set_start(fan, 0, start, start.error_scale)
        bundle = Bundle(fan, RAYS, RAYS.bit_length() - 1, spot_at(start, above), length)
        hidden = np.zeros(RAYS)
        ask(bundle, world, touching, stack, hidden)
        assert np.array_equal(fan[BLOCKED:][: RAYS - 1], hidden[:-1])
        assert fan[BLOCKED + RAYS - 1] == 1.0
        found.extend(hidden[:-1])
    assert (not JIT) or 0.03 < np.mean(found) < 0.97


@pytest.mark.parametrize(
    ("kind", "size", "place"),
    [
        ("loose", 1, 0),
        ("packed", 1, 0),
        ("bonds", 1, 0),
        ("copies", 1, 0),
        ("packed", 1, 1e6),
        ("packed", 1e-100, 0),
        ("loose", 1e100, 0),
    ],
)
def test_fans_that_start_apart_are_stopped_as_each_alone(
    kind: str, size: float, place: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From spots of all sizes up to that of the shapes, on surfaces that bend, and on others."""
    monkeypatch.setattr(hierarchy, "FEW", 4)
    scene, random = scene_of(kind, size, place), np.random.default_rng(6)
    scene.add_plane((place, place, place - 1.1 * size), normal=(0, 0, 1))
    arrays = arrays_of(scene, size, place)
    world, forward, unit = arrays.world, arrays.camera.forward, arrays.world.scale
    stack, touching, fan = new_stack(), new_touching(), new_fan()
    packet, batch = new_packet(), new_batch()
    spheres = next(item for item in scene.objects if isinstance(item, vtray.Spheres))
    found = []
    for k in range(FANS):
        shift = int(random.integers(1, RAYS.bit_length() - 1))
        count, together = RAYS >> shift, 1 << shift
        normal = random.normal(size=3)
        middle = random.uniform(-1.2, 1.2, 3) * size + place
        which, apart = random.integers(len(spheres.center)), 10 ** random.uniform(-3, 0)
        length = float(random.choice([0.1, 2.0, 1e4])) * size * unit
        is_before = True
        for member in range(count):
            above = normal + apart * random.normal(size=3)
            above /= math.sqrt(above @ above)
            # On a sphere, on the floor, and where nothing is.
            spot = spheres.center[which] + above * np.asarray(spheres.radius)[which]
            if k % 4 == 0:
                spot, above = middle + apart * random.normal(size=3) * size, np.array([0, 0, 1.0])
                spot[2] = place - 1.1 * size if k % 8 else spot[2]
            start = start_at(spot, arrays)
            is_before &= start.plane_depth > 0
            up = tuple(float(x) for x in above)
            set_fan(fan, start, up, length, forward, RAYS * k + member, member * together, together)
            set_start(fan, member, start, start.error_scale)
            store(packet, POINT, member, start.point)
            store(packet, NORMAL, member, up)
            packet[PLANE_DEPTH + member] = start.plane_depth
            packet[ERROR_SCALE + member] = start.error_scale
            batch.hit[member] = batch.active[member] = member
        if not is_before:
            continue
        bundle = Bundle(fan, RAYS, shift, spot_of(packet, batch, count), length)
        is_open, hidden = fan[BLOCKED:][:RAYS] == 0.0, np.zeros(RAYS)
        ask(bundle, world, touching, stack, hidden)
        assert np.array_equal(fan[BLOCKED:][:RAYS][is_open], hidden[is_open])
        found.extend(hidden[is_open])
    assert (not JIT) or 0.03 < np.mean(found) < 0.97


@device
def ask_octet(singles: Any, first: Any, step: Any, way: Any, least: Any) -> Any:
    return octet_within(singles, first, step, way, least)


@device
def ask_along(fan: Any, balls: Any, way: Any, tangent2: Any, apart: Any) -> Any:
    set_ball(balls, 0, way, tangent2, apart, False)
    return rays_along(fan, FAN, (balls[0], balls[8], balls[16]), balls[24])


@pytest.mark.parametrize("apart", [0.0, 0.5, 3.0])
def test_rays_that_start_apart_are_left_out_if_none_of_them_can_meet_a_ball(apart: float) -> None:
    fan, balls, far, radius = new_fan(), np.zeros(4 * WIDTH, np.float32), 200.0, 1.0
    beside = np.linspace(0, 2.5 * (radius + apart), FAN)
    for ray, sine in enumerate((beside / far).tolist()):
        set_direction(fan, ray, (sine, 0.0, math.sqrt(1 - sine * sine)))
    narrow_directions(fan, FAN)
    wide = radius + apart
    near = int(ask_along(fan, balls, (0.0, 0.0, far), far * far - wide * wide, apart))
    found = np.array([near >> ray & 1 for ray in range(FAN)], bool)
    assert found[beside <= wide].all()
    assert not found[beside > 1.1 * wide].any()


@device
def ask_bits(bits: Any) -> Any:
    return count_bits(bits), lowest_bit(bits)


def test_octets_are_asked_as_numpy_asks_them() -> None:
    random = np.random.default_rng(2)
    singles = new_fan().view(np.float32)
    singles[2 * SINGLES : 2 * START] = random.normal(size=4 * FAN)
    singles[2 * SINGLES : 2 * SINGLES + FAN] = np.round(singles[2 * SINGLES : 2 * SINGLES + FAN])
    for _ in range(100):
        way = tuple(np.float32(x) for x in np.round(random.normal(size=3)))
        least = np.float32(np.round(random.normal()))
        first = 2 * SINGLES + 8 * int(random.integers(8))
        met = ask_octet(singles, first, FAN, way, least)
        assert met == uncompiled(octet_within)(singles, first, FAN, way, least)


@device
def ask_balls(bvh: Any, view: Any, balls: Any) -> Any:
    return balls_seen(bvh, SIDES, view, balls)


@compiled_only
@given(
    st.lists(st.floats(-4, 4, width=32), min_size=SIDES, max_size=SIDES),
    st.lists(st.floats(-1e3, 1e3, width=32), min_size=10, max_size=10),
)
def test_balls_are_seen_as_numpy_has_them(sides: list[float], numbers: list[float]) -> None:
    bvh = Bvh(np.float32([0.0] * SIDES + sides), np.zeros(2 * WIDTH, np.int32))
    values = tuple(map(np.float32, numbers))
    view = View(values[:3], values[3:6], *map(abs, values[6:]))
    balls, expected = np.zeros((2, 4 * WIDTH), np.float32)
    assert ask_balls(bvh, view, balls) == uncompiled(balls_seen)(bvh, SIDES, view, expected)
    assert balls.tobytes() == expected.tobytes()


def test_bits_are_counted_and_found() -> None:
    for bits in (1, 6, 2**63, 2**64 - 1, 2**40 + 2**63):
        assert ask_bits(np.uint64(bits)) == (bits.bit_count(), (bits & -bits).bit_length() - 1)
