"""The picture with a hierarchy equals that without, and that of the oracle, to the last bit."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import oracle
import pytest
from clouds import CLOUDS, cloud
from hierarchies import ALWAYS, NEVER, render
from hypothesis import given
from plain import NOTHING, trace_pixel
from strategies import crowd, may_be_dark, scenes

import vtray
from conftest import JIT, compiled_only, once
from vtray.commands.explain import explain_pixel
from vtray.geometry.packets.layer_notes import new_walk
from vtray.geometry.packets.stack import new_stack
from vtray.rendering import hierarchy as acceleration
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.transport.integrators import reference


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Return a function that sets for how many spheres no hierarchy is used."""
    return lambda count: monkeypatch.setattr(acceleration, "FEW", count)


def assert_same(scene: vtray.Scene, **options: Any) -> vtray.Image:
    """Render a scene with the hierarchy and without, and compare."""
    image, expected = render(scene, ALWAYS, **options), render(scene, NEVER)
    np.testing.assert_array_equal(image.linear, expected.linear)
    np.testing.assert_array_equal(image.pixels, expected.pixels)
    assert image.stats["rays"] == expected.stats["rays"]
    return image


@once
@may_be_dark
@given(scenes())
def test_equals_oracle(scene: dict) -> None:
    image = render(vtray.loads(json.dumps(scene)), ALWAYS)
    linear = oracle.render(scene)
    np.testing.assert_array_equal(image.linear, linear)
    np.testing.assert_array_equal(image.pixels, oracle.develop(linear))


@compiled_only
@pytest.mark.parametrize("seed", range(100, 130))
def test_equals_oracle_with_hundreds_of_objects(seed: int) -> None:
    scene = crowd(seed)
    linear = render(vtray.loads(json.dumps(scene)), ALWAYS).linear
    np.testing.assert_array_equal(linear, oracle.render(scene))


def as_objects(spheres: vtray.Spheres) -> list[vtray.Sphere]:
    """Return arrays of spheres as single ones."""
    radius, lambert = (
        np.broadcast_to(values, len(spheres)).tolist()
        for values in (spheres.radius, spheres.lambert)
    )
    color = np.broadcast_to(spheres.color, (len(spheres), 3)).tolist()
    return [
        vtray.Sphere(*columns)
        for columns in zip(spheres.center.tolist(), radius, color, lambert, strict=True)
    ]


def part_of(spheres: vtray.Spheres, part: slice) -> vtray.Spheres:
    """Return some of the spheres."""
    radius = spheres.radius if isinstance(spheres.radius, float) else spheres.radius[part]
    return vtray.Spheres(spheres.center[part], radius, spheres.color[part], spheres.lambert[part])


def view(spheres: vtray.Spheres, seed: int, **camera: Any) -> vtray.Scene:
    """Return a scene that looks at spheres from a random place, with lights and planes at random.

    The camera may stand inside of spheres, as lights may; planes may cut through everything.
    """
    random = np.random.default_rng(seed)
    center, radius = spheres.center.astype(float), np.broadcast_to(spheres.radius, len(spheres))
    low, high = np.percentile(center, 3, axis=0), np.percentile(center, 97, axis=0)
    size = max(*(high / 2 - low / 2).tolist(), 2 * float(np.median(radius)), 1e-300)
    size = 2 * min(size, 1e290)

    def some_place() -> np.ndarray:
        kind = random.integers(4)
        if kind == 0:
            return center[random.integers(len(center))]
        if kind == 1:
            k = random.integers(len(center))
            return center[k] + radius[k] * random.uniform(-1, 1, 3)
        middle = low / 2 + high / 2
        return middle + (size if kind == 2 else size * 30) * random.uniform(-1, 1, 3)

    width, height = random.integers(1, 40, 2).tolist() if JIT else (5, 4)
    focus = size * random.choice([1e-3, 0.3, 3.0, 1e3, 1e8])
    pixel = size * random.choice([1e-9, 0.5, 2.0]) / max(width, height)
    target = center[random.integers(len(center))]
    start = some_place()
    normal = target - start
    if not normal.any():
        normal = random.normal(size=3)
    settings = {
        "center": start,
        "normal": normal,
        "focus": focus,
        "size": (width, height),
        "resolution": (pixel, pixel * random.uniform(0.5, 2)),
        **camera,
    }
    lights = [vtray.Light(some_place(), random.uniform(0.1, 2)) for _ in range(random.integers(5))]
    lights.append(vtray.Light(start - normal, 1.0))
    planes = [
        vtray.Plane(some_place(), random.normal(size=3), random.integers(0, 256, 3), 0.7)
        for _ in range(random.integers(3))
    ]
    return vtray.Scene(vtray.Camera(**settings), lights, [*planes, spheres])


COUNT = 700 if JIT else 12


@once
@pytest.mark.parametrize("seed", range(8 if JIT else 1))
@pytest.mark.parametrize("name", CLOUDS)
def test_equals_brute_force(name: str, seed: int) -> None:
    spheres = cloud(name, COUNT, seed)
    assert_same(view(spheres, seed))


@compiled_only
@pytest.mark.parametrize("focus", [1e-9, 1e-6, 1e-3, 1.0])
@pytest.mark.parametrize("few", [ALWAYS, NEVER])
def test_a_tiny_sphere_in_the_way_of_each_ray_is_hit(focus: float, few: int) -> None:
    # In a wide view the rays at the edge are nearly parallel to the image plane.
    center, normal = np.array((0.3, 0.2, -0.1)), (0.35, 0.82, 0.33)
    camera = vtray.Camera(center, normal, focus, (48, 32), (0.1, 0.07))
    packed = pack(vtray.Scene(camera, [], []), accelerate(vtray.Scene(camera, [], [])))
    nothing = np.zeros(0), np.zeros(0, np.int64)
    ways = [
        trace_pixel(packed.arrays, k % 48, k // 48, *nothing).ray.direction for k in range(48 * 32)
    ]
    eye = np.array(packed.arrays.camera.eye) * packed.unit + center
    spheres = vtray.Spheres(eye + 10 * np.array(ways), 1e-12, (255, 255, 255), 1)
    image = render(vtray.Scene(camera, [vtray.Light(eye, 1)], [spheres]), few)
    assert (image.linear > 0).all()


@compiled_only
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("pixel", [1e-13, 1e-5, 1e6])
def test_equals_brute_force_for_pixels_of_any_size(pixel: float, seed: int) -> None:
    spheres = cloud("uniform", 300, seed)
    assert_same(view(spheres, seed, resolution=(pixel, pixel), size=(33, 17)))


@compiled_only
@pytest.mark.parametrize(
    ("threads", "tile"), [(1, 64), (2, 64), (7, 16), (3, 5), (5, 1), (2, 9999)]
)
def test_is_the_same_for_any_threads_and_tiles(threads: int, tile: int) -> None:
    scene = view(cloud("uniform", 3000, 1), 4, size=(51, 35))
    assert_same(scene, threads=threads, tile=tile)


@pytest.mark.parametrize("few", [ALWAYS, NEVER])
def test_of_coincident_spheres_the_first_is_seen(few: int) -> None:
    place, size = (0.5, -0.25, 6.0), (20, 20) if JIT else (6, 6)
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 3, size, (4 / size[0], 4 / size[1]))
    lights = [vtray.Light((2, -3, -1), 1), vtray.Light((-2, 3, -4), 1)]
    colors = np.arange(36).reshape(12, 3)

    def single(k: int) -> vtray.Sphere:
        return vtray.Sphere(place, 2, colors[k], 1)

    def several(begin: int, end: int) -> vtray.Spheres:
        return vtray.Spheres([place] * (end - begin), 2, colors[begin:end], 1)

    wall = vtray.Plane((0, 0, 7), (0, 0, -1), (255, 255, 255), 1)
    mixes = [
        [several(3, 12), several(0, 3), wall],
        [single(3), wall, several(0, 3), single(11), several(4, 11)],
        [vtray.Spheres([], 1, (0, 0, 0), 1), wall, *map(single, (3, 0, 1, 2, *range(4, 12)))],
    ]
    expected = render(vtray.Scene(camera, lights, [single(3), wall]), NEVER)
    assert expected.linear.max() > 0
    for objects in mixes:
        image = render(vtray.Scene(camera, lights, objects), few)
        np.testing.assert_array_equal(image.linear, expected.linear)


@once
@pytest.mark.parametrize("name", ["uniform", "float32", "same_place_and_radius"])
def test_arrays_are_the_same_as_single_spheres_and_as_a_file(name: str, tmp_path: Path) -> None:
    spheres = cloud(name, COUNT // 3, 5)
    scene = view(spheres, 3, size=(31, 20) if JIT else (4, 3))
    expected = assert_same(scene)
    lights = scene.lights
    single = vtray.Scene(scene.camera, lights, [*scene.objects[:-1], *as_objects(spheres)])
    np.testing.assert_array_equal(assert_same(single).linear, expected.linear)
    scene.save(tmp_path / "scene.json")
    loaded = vtray.load(tmp_path / "scene.json")
    np.testing.assert_array_equal(assert_same(loaded).linear, expected.linear)
    half = len(spheres) // 2
    halves = [part_of(spheres, slice(half)), part_of(spheres, slice(half, None))]
    several = vtray.Scene(scene.camera, lights, [*halves, *scene.objects[:-1]])
    np.testing.assert_array_equal(assert_same(several).linear, expected.linear)


@once
@pytest.mark.parametrize("count", [0, 1, 2, 23, 24, 25, 26])
def test_any_number_of_spheres(count: int) -> None:
    spheres = cloud("uniform", 26, 3)
    fewer = part_of(spheres, slice(count))
    scene = view(spheres, 2, size=(20, 20) if JIT else (3, 3))
    scene.objects = [*scene.objects[:-1], fewer]
    image = assert_same(scene)
    np.testing.assert_array_equal(vtray.render(scene).linear, image.linear)
    assert (len(accelerate(scene).bvh.child) > 0) == (count > acceleration.FEW)


@pytest.mark.parametrize("name", ["uniform", "rounded", "float32"])
def test_equals_the_plain_path(name: str, few: Callable[[int], None]) -> None:
    few(ALWAYS)
    scene = view(cloud(name, COUNT, 2), 11, size=(23, 18) if JIT else (3, 2))
    image = vtray.render(scene, threads=1)
    arrays = pack(scene, accelerate(scene)).arrays
    cosines, blockers = np.zeros(len(scene.lights)), np.zeros(len(scene.lights), np.int64)
    for row, column in np.ndindex(*image.linear.shape[:2]):
        traced = trace_pixel(arrays, column, row, cosines, blockers)
        assert tuple(image.linear[row, column]) == traced.value
        assert (traced.primitive == NOTHING) == np.isinf(traced.distance)
        stack, kept = new_stack(), (cosines.copy(), blockers.copy())
        assert (
            reference.trace_pixel(arrays, column, row, stack, cosines, blockers, new_walk(0))
            == traced
        )
        np.testing.assert_array_equal((cosines, blockers), kept)


def test_a_pixel_is_explained_by_the_sphere_of_an_array(few: Callable[[int], None]) -> None:
    few(ALWAYS)
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 1000, (8, 8), (1, 1))
    grid = [(x, y, 5.0) for y in range(-4, 4) for x in range(-4, 4)]
    color = np.arange(3 * 64).reshape(64, 3)
    near = vtray.Spheres(grid, 0.25, color, np.linspace(0, 1, 64))
    roof = vtray.Spheres([(x, -2, 1) for x in range(-5, 5)], 0.75, (1, 2, 3), 1)
    wall = vtray.Plane((0, 0, 30), (0, 0, -1), (200, 200, 200), 1)
    lights = [vtray.Light((0, 0, 1), 2), vtray.Light((-1, -5, -3), 1)]
    scene = vtray.Scene(camera, lights, [roof, wall, near])
    text = explain_pixel(scene, vtray.render(scene, threads=1), 4, 4)
    assert "hit          objects[2], sphere 36, 1004.75 away" in text
    assert "material   color (108, 109, 110), lambert 0.571429" in text
    assert "adds       (123.429, 124.571, 125.714) = cosine 1 x lambert 0.571429 x" in text
    assert "adds       nothing: objects[0], sphere 4, is in the way" in text
