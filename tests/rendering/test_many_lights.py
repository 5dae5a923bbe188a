"""Many soft lights, which share their rays: against fans for each, and ray by ray."""

import math
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, compiled_only, once
from vtray import render
from vtray.geometry.packets.cone import new_touching
from vtray.geometry.packets.fan import new_fan
from vtray.geometry.packets.layer_notes import new_walk
from vtray.geometry.packets.stack import new_stack
from vtray.geometry.packets.workspace import new_shared
from vtray.geometry.queries import NOTHING
from vtray.rendering import pack_lights
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.transport.integrators import reference
from vtray.transport.sampling.fans import fans_of_middles

SIZE = (28, 21) if JIT else (10, 8)
STEP = 2 if JIT else 3
MANY = 150 if JIT else 14


@pytest.fixture(autouse=True)
def _fewer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let fewer lights share fans where they cost most."""
    if not JIT:
        monkeypatch.setattr(pack_lights, "FEW", 8)


def lamps_around(count: int, radius: float = 0.4) -> list[Any]:
    """Return equal lamps on a dome."""
    ways = np.random.default_rng(2).normal(size=(count, 3))
    ways[:, 2] = np.abs(ways[:, 2])
    ways *= 12 / np.linalg.norm(ways, axis=1)[:, None]
    return [vtray.SphereLight(tuple(way), radius, 2 / count) for way in ways.tolist()]


def mixed_lamps(count: int) -> list[Any]:
    """Return lights of all kinds: also black, without size, around all, and below the horizon."""
    random = np.random.default_rng(7)
    spots = random.lognormal(sigma=1, size=(8, 16, 3))
    lights: list[Any] = [
        vtray.Sun((0.5, 0.6, -1), 0.6, angle=8, color=(255, 224, 192)),
        vtray.Light((3, -4, 9), 0.1),
        vtray.Ambient(0.1, distance=0.7),
        vtray.Sky(0.05, image=spots),
        vtray.Sky(0.05, (90, 120, 255), vtray.Gradient(), up=(0, 0.2, 1)),
        vtray.SphereLight((0, 0, 0), 50, 0.05),
        vtray.SphereLight((1, 1, -9), 2, 1.0),
        vtray.SphereLight((1, 1, 0), 1.0, 0.3),
        vtray.SphereLight((2, 1, 5), 0.0, 0.1),
        vtray.SphereLight((2, 3, 5), 1.0, 0.0),
        vtray.RectangleLight((-1, 0.5, 6), ((4, 0, 0), (0, 3, 0)), radiance=0.5),
    ]
    while len(lights) < count:
        place = tuple(random.uniform((-8, -8, 3), (8, 8, 9)).tolist())
        color = tuple(random.integers(0, 256, 3).tolist())
        if len(lights) % 3:
            lights.append(vtray.SphereLight(place, float(random.uniform(0, 1)), 0.02, color=color))
        else:
            lights.append(vtray.RectangleLight(place, ((1, 0, 1), (0, 1, 0)), 0.02, color=color))
    return lights


def scene_of(lights: list[Any]) -> vtray.Scene:
    """Return balls on a floor."""
    random = np.random.default_rng(3)
    scene = vtray.Scene()
    count = 150 if JIT else 9
    centers = random.uniform((-3, -3, 0.2), (3, 3, 3), (count, 3))
    scene.add_spheres(centers, random.uniform(0.1, 0.4, count), color="#c0d0e0")
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color="#f4f1de")
    scene.camera = vtray.Camera.fit(scene, direction=(0.3, 1, -0.6), size=SIZE)
    scene.lights = lights
    return scene


LIGHTS = {"equal": lamps_around, "mixed": mixed_lamps}


@once
@pytest.mark.parametrize("lights", LIGHTS.values(), ids=LIGHTS)
def test_shared_fans_tell_what_each_ray_alone_would(lights: Any) -> None:
    scene = scene_of(lights(MANY))
    image = render(scene, seed=5)
    arrays, fan, touching = pack(scene, accelerate(scene)).arrays, new_fan(), new_touching()
    fans, soft, crowd = fans_of_middles(image.noise), arrays.lights.soft, arrays.lights.crowd
    assert soft is not None
    assert crowd is not None
    points = len(arrays.lights.x)
    stack, cosines, blockers = new_stack(), np.zeros(points), np.full(points, NOTHING)
    shared, on_ways = new_shared(len(soft.kind)), np.full(fans.rays, NOTHING)
    most = hits = 0
    for y in range(0, SIZE[1], STEP):
        for x in range(0, SIZE[0], STEP):
            traced = reference.trace_pixel(arrays, x, y, stack, cosines, blockers, new_walk(0))
            value = traced.value
            if traced.primitive != NOTHING:
                found = reference.trace_crowd(
                    arrays,
                    soft,
                    crowd,
                    traced,
                    x,
                    y,
                    fans,
                    5,
                    stack,
                    fan,
                    on_ways,
                    shared,
                    touching,
                    new_walk(0),
                )
                value, most, hits = found.value, max(most, found.fans), hits + 1
            assert tuple(image.linear[y, x]) == value
    assert hits > 5
    assert most > 1


@compiled_only
@pytest.mark.parametrize("samples", [1, 9])
def test_threads_and_tiles_change_nothing(samples: int) -> None:
    scene = scene_of(mixed_lamps(MANY))
    image = render(scene, threads=1, samples=samples)
    other = render(scene, threads=3, samples=samples, tile=16)
    np.testing.assert_array_equal(image.linear, other.linear)
    assert not np.array_equal(image.linear, render(scene, samples=samples, seed=1).linear)


def by_each(scene: vtray.Scene, monkeypatch: pytest.MonkeyPatch, **options: Any) -> Any:
    """Return a picture in which each light has its own fans."""
    with monkeypatch.context() as patch:
        patch.setattr(pack_lights, "FEW", 10**9)
        return render(scene, **options)


@compiled_only
@pytest.mark.parametrize("lights", LIGHTS.values(), ids=LIGHTS)
def test_light_and_error_are_those_of_fans_for_each(
    lights: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene, tolerance = scene_of(lights(MANY)), 0.008
    options: dict[str, Any] = {"exposure": 1.0, "seed": 9}
    long = by_each(scene, monkeypatch, tolerance=0.002, **options).linear
    images = [render(scene, exposure=1.0, tolerance=tolerance, seed=seed) for seed in range(4)]
    seen = np.isfinite(images[0].depth)
    off = np.array([image.linear - long for image in images])[:, seen]
    error = np.array([image.error for image in images])[:, seen]
    worst = np.abs(off).max(axis=2)
    # There is a limit to the rays, too.
    assert (error > tolerance * 255).mean() < 0.1
    # Not too small on the whole, nor by far anywhere; nor useless.
    assert np.sqrt((worst**2).mean()) < np.sqrt((error**2).mean())
    assert (worst > 3 * error + 0.1).mean() < 0.005
    assert np.sqrt((error**2).mean()) < 4 * np.sqrt((worst**2).mean()) + 0.1
    # No bias.
    assert (
        np.abs(off.mean(axis=(0, 1))).max() < 5 * np.sqrt((off**2).mean() / off[..., 0].size) + 0.1
    )
    # As near for pixels with samples.
    several = render(scene, samples=16, tolerance=tolerance, exposure=1.0)
    each = by_each(scene, monkeypatch, samples=16, tolerance=tolerance, exposure=1.0)
    allowed = np.hypot(several.error, each.error)
    assert (np.abs(several.linear - each.linear).max(axis=2) > 4 * allowed + 4).mean() < 0.005


@compiled_only
def test_the_light_is_what_can_be_worked_out() -> None:
    """Half of the lamps are behind a ball that fills all of one side."""
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1))
    scene.camera = vtray.Camera((1, 1, 1e3), (0, 0, -1), 1.0, (16, 16), (1e-7, 1e-7), up=(0, 1, 0))
    random = np.random.default_rng(4)
    total, tilt = 0.0, math.sqrt(0.5)
    for k in range(200):
        side = 1 if k % 2 else -1
        way = np.array([side * tilt, random.uniform(-0.3, 0.3), tilt])
        strength = random.uniform(0, 0.02)
        scene.add_sphere_light((1 + 9 * way[0], 1 + 9 * way[1], 9 * way[2]), 0.2, strength)
        total += strength * way[2] / np.linalg.norm(way) if side > 0 else 0.0
    scene.add_sphere((-4, 1, 5), 4.0)
    image = render(scene, exposure=1.0)
    off = image.linear.mean() / 255 - total
    assert abs(off) < 3 * float(np.sqrt((image.error**2).mean())) / 255 / 16


@compiled_only
def test_rays_do_not_grow_with_the_number_of_lights() -> None:
    rays = []
    for count in (150, 400, 1000):
        image = render(scene_of(lamps_around(count)), exposure=1.0)
        rays.append(image.stats["rays"] / np.isfinite(image.depth).sum())
    assert max(rays) < 1200, rays


@compiled_only
def test_kept_light_is_that_of_each() -> None:
    scene = scene_of(mixed_lamps(MANY))
    image = render(scene, keep_lights=True)
    strengths = np.random.default_rng(1).uniform(0, 0.1, len(scene.lights)).tolist()
    relit = image.relight(strengths)
    again = render(relit.scene, keep_lights=True)
    np.testing.assert_array_equal(relit.linear, again.linear)
    plain = render(relit.scene)
    allowed = np.hypot(plain.error, again.error)
    assert (np.abs(plain.linear - relit.linear).max(axis=2) > 3 * allowed + 0.1).mean() < 0.02


@compiled_only
@pytest.mark.parametrize("spread", [0.0, 0.05, 12.0])
def test_edges_of_shadows_of_many_lamps_get_samples(spread: float) -> None:
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 2), 0.7)
    scene.add_plane((0, 0, 0), normal=(0, 0, 1))
    scene.camera = vtray.Camera((0, 0, 9), (0, 0, -1), 1.0, (12, 9), (0.04, 0.04), up=(0, 1, 0))
    places = np.random.default_rng(5).normal(size=(300, 3)) * spread + (0, 40, 40)
    scene.lights = [vtray.SphereLight(tuple(place), 0.05, 1 / 300) for place in places.tolist()]
    fine = render(scene, size=(12 * 48, 9 * 48), exposure=1.0, tolerance=0.03).linear
    # The middles of the first pixels are in the same place.
    fine = np.roll(fine, (24, 24), axis=(0, 1))
    fine = fine.reshape(9, 48, 12, 48, 3).mean(axis=(1, 3))
    image = render(scene, samples=256, exposure=1.0, tolerance=0.004, filter="box").linear
    assert np.abs(image - fine)[1:, 1:].max() < 8


@once
def test_rays_of_a_pixel_tell_where_they_go() -> None:
    scene = scene_of(mixed_lamps(MANY))
    image = render(scene)
    y, x = np.argwhere(np.isfinite(image.depth))[len(scene.lights) % 7]
    tree = vtray.trace_pixel(image, int(x), int(y))
    assert tree.light == tuple(image.linear[y, x])
    assert [way.light for way in tree.lights] == list(range(len(scene.lights)))
    np.testing.assert_allclose(sum(np.array(way.adds) for way in tree.lights), tree.light)
    fans = [way for way in tree.lights if isinstance(way, vtray.figures.ray_tree.ShadowFan)]
    cast = sum(len(way.rays) for way in fans)
    assert cast == 0 or cast & (cast - 1) == 0
    for way in fans:
        weights = [ray.weight if ray.arrives else 0.0 for ray in way.rays]
        if weights:
            assert way.share == pytest.approx(np.mean(weights))
    text = str(tree)
    assert "other lights have no ray of those that all share" in text
    assert text.count("\nlights[") < len(scene.lights)
