"""How noisy soft light may be: what is estimated, and how far from a long render pictures are."""

from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, compiled_only, once
from vtray import render

SIZE = (48, 36) if JIT else (6, 5)
SEEDS = range(6)
SUN = vtray.Sun((0.5, 0.6, -1), 0.8, angle=30)
LIGHTS: dict[str, list[Any]] = {
    "ambient": [vtray.Ambient()],
    "large sun": [SUN],
    "three": [SUN, vtray.SphereLight((-4, -2, 5), 1.5, 0.4), vtray.Ambient(0.5)],
}


def scene_of(lights: list[Any], kind: str = "balls") -> vtray.Scene:
    """Return white balls on a floor, or what is made to fool those who look at few rays."""
    random = np.random.default_rng(3)
    scene = vtray.Scene()
    if kind == "balls":
        centers = random.uniform((-2, -2, 0.2), (2, 2, 2.4), (60, 3))
        scene.add_spheres(centers, random.uniform(0.1, 0.5, 60))
    elif kind == "thin shadows":
        bars = np.linspace(-3, 3, 60)
        starts = np.stack([bars, np.full(60, -9.0), np.full(60, 2.0)], axis=1)
        scene.add_cylinders(starts, starts + np.array([0, 18, 0]), 0.012)
    else:  # a wall of balls with a hole
        x, y = (side.ravel() for side in np.meshgrid(np.arange(-9, 10), np.arange(-9, 10)))
        wall = np.stack([x, y, np.full(len(x), 2.0)], axis=1)
        scene.add_spheres(wall[(x != 0) | (y != 0)], 0.8)
    scene.add_plane((0, 0, 0), normal=(0, 0, 1))
    eye = (0, -9, 5) if kind == "balls" else (0, -4, 1.2)
    scene.camera = vtray.Camera.look_at(eye, (0, 0, 0.3), (0, 0, 1), 35, SIZE)
    scene.lights = lights
    return scene


@compiled_only
@pytest.mark.parametrize("kind", ["balls", "thin shadows", "hole"])
@pytest.mark.parametrize("lights", LIGHTS.values(), ids=LIGHTS)
def test_errors_are_what_is_off_from_a_long_render(lights: list[Any], kind: str) -> None:
    scene = scene_of(lights, kind)
    long = render(scene, exposure=1.0, tolerance=2e-3, seed=9)
    seen = np.isfinite(long.depth)
    for tolerance in (0.03, 0.008):
        # Pixels of one picture are not independent.
        images = [render(scene, exposure=1.0, tolerance=tolerance, seed=seed) for seed in SEEDS]
        errors = np.array([image.error for image in images])
        # What no ray may see counts as well: half a ray of each light.
        assert errors.max() <= np.hypot(tolerance, 0.5 / 64 * 1.5) * long.white
        off = np.array([np.abs(image.linear - long.linear).max(axis=2) for image in images])
        allowed = np.hypot(errors, long.error)
        # Not too small on the whole, nor by far anywhere; bars finer than rays fool it most.
        honest = 1.0 if kind == "balls" else 1.2
        assert (off[:, seen] ** 2).mean() < honest**2 * (allowed[:, seen] ** 2).mean()
        assert (off > 3 * allowed + 1e-9).mean() < 0.02
        assert (off[0] < 6 * allowed[0] + 1e-9).all()
        assert (off > 6 * allowed + 1e-9).mean() < 1 / errors[0].size
    # Nor useless.
    if kind == "balls":
        assert errors[:, seen].mean() < 4 * off[:, seen].mean() + 1e-3 * long.white


@compiled_only
def test_a_smaller_tolerance_takes_more_rays_and_is_nearer() -> None:
    scene = scene_of(LIGHTS["three"])
    long = render(scene, exposure=1.0, tolerance=1e-3, seed=9)
    images = [render(scene, exposure=1.0, tolerance=part) for part in (1.0, 0.01, 0.003)]
    rays = [image.stats["rays"] for image in images]
    off = [np.abs(image.linear - long.linear).mean() for image in images]
    assert rays == sorted(rays)
    assert rays[2] > 2 * rays[0]
    assert off == sorted(off, reverse=True)
    assert off[2] < 0.5 * off[0]


@once
def test_tolerance_is_meant_of_what_becomes_white() -> None:
    scene = scene_of(LIGHTS["ambient"])
    image = render(scene, tolerance=0.02)
    assert image.error.max() <= 0.02 * image.white
    faint = scene_of([vtray.Ambient(1e-3)])
    assert np.abs(render(faint, tolerance=0.02).pixels - 1.0 * image.pixels).max() <= 1


@compiled_only
def test_errors_of_samples_are_what_seeds_differ_by() -> None:
    scene = scene_of(LIGHTS["three"])
    images = [render(scene, exposure=1.0, samples=8, seed=seed) for seed in range(24)]
    spread = np.std([image.linear for image in images], axis=0).max(axis=2)
    estimated = np.sqrt(np.mean([image.error**2 for image in images], axis=0))
    edges = spread > 2.0
    assert edges.sum() > 100
    ratio = estimated[edges] / spread[edges]
    assert ratio.mean() > 1.0
    assert (ratio > 0.6).mean() > 0.98


@compiled_only
def test_samples_cast_fewer_rays_to_weak_lights_for_the_same_error() -> None:
    rays: list[float] = []
    off: list[float] = []
    for strength in (1.0, 0.3):
        scene = scene_of([vtray.Ambient(strength), vtray.Ambient(1.0 - strength, distance=0)])
        settings = {"samples": 4, "exposure": 1.0}
        long = render(scene, tolerance=1e-3, **settings)
        image = render(scene, tolerance=0.012, **settings)
        seen = np.isfinite(image.depth)
        rays.append(image.stats["rays"])
        off.append(float(np.sqrt(np.mean((image.linear - long.linear)[seen] ** 2))))
    assert rays[1] < rays[0] / 4
    assert off[1] < off[0]


@once
def test_fans_to_weak_lights_have_fewer_rays_where_that_is_known() -> None:
    def halvings(lights: list[Any], **settings: Any) -> int:
        image = render(scene_of(lights), samples=4, tolerance=0.012, **settings)
        assert image.noise is not None
        return image.noise.halvings

    weak = [vtray.Ambient(0.5, color=(153, 102, 0)), vtray.Ambient(distance=0)]
    assert halvings([vtray.Ambient(0.3)], exposure=1.0) == 3
    assert halvings(weak, exposure=1.0) == 3
    assert halvings(4 * [vtray.Ambient(0.2)], exposure=1.0) == 2  # together as one of 0.4
    assert halvings([*weak, SUN], exposure=1.0) == 0
    assert halvings(weak, exposure=3.0) == 0  # as 0.9 of white
    assert halvings([vtray.Ambient(9)], exposure=1.0) == 0
    # A sky of many colours may be brighter than its radiance says; kept lights may become so.
    assert halvings([vtray.Sky(0.3, gradient=vtray.Gradient())], exposure=1.0) == 0
    assert halvings([vtray.Ambient(0.3)], exposure=1.0, keep_lights=True) == 0


@once
def test_hard_lights_have_no_error_and_changed_pictures_none_that_is_known() -> None:
    scene = scene_of([vtray.Light((3, -4, 9))])
    image = render(scene)
    assert not image.error.any()
    assert image.error.shape == image.depth.shape
    kept = render(scene_of(LIGHTS["ambient"]), keep_lights=True, tolerance=1.0)
    assert kept.error.any()
    assert kept.expose(0.5).error.any()
    assert np.isnan(kept.relight([0.5]).error).all()


def test_error_of_a_lamp_with_a_radiance_is_a_part_of_its_light() -> None:
    # Its rays count little, as it is small: what none of them meets is no more than that.
    lamp = vtray.SphereLight((3, -4, 9), 0.2, radiance=400.0)
    image = render(scene_of([lamp], "thin shadows"), exposure=1.0, tolerance=1e6)
    assert 0 < image.error.max() < 0.2 * image.linear.max()


def test_light_that_is_known_without_rays_has_no_error() -> None:
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1))
    scene.add_sphere((0, 0, 1), 0.5)
    scene.camera = vtray.Camera.look_at((0, -6, 4), (0, 0, 0.5), up=(0, 0, 1), size=(48, 36))
    scene.lights = [vtray.Sun((0.5, 0.5, -1), angle=20)]
    image = vtray.render(scene, exposure=1.0)
    assert not image.error.any()
    # Half-shadows are between light and dark, and even.
    floor = image.linear[image.normals[..., 2] > 0.99][:, 0]
    assert ((floor > 0.1 * floor.max()) & (floor < 0.9 * floor.max())).sum() > 10
    assert floor.min() == 0.0


@compiled_only
@pytest.mark.parametrize("samples", [1, 4])
def test_kept_light_does_not_look_at_light(samples: int) -> None:
    scene = scene_of(LIGHTS["three"])
    options: dict[str, Any] = {"keep_lights": True, "tolerance": 0.01, "samples": samples}
    image = render(scene, **options)
    relit = image.relight([0.0, 3.0, 0.1])
    np.testing.assert_array_equal(relit.linear, render(relit.scene, **options).linear)


@pytest.mark.parametrize("value", [0, -1, "x", float("nan"), float("inf")])
def test_wrong_tolerances_are_one_line(value: object) -> None:
    with pytest.raises(vtray.SceneError, match="tolerance: .*got"):
        render(scene_of(LIGHTS["ambient"]), tolerance=value)


@compiled_only
@pytest.mark.parametrize("samples", [4, 16])
@pytest.mark.parametrize("tolerance", [0.002, 0.008])
def test_samples_make_nothing_brighter(samples: int, tolerance: float) -> None:
    # A floor, and beside the picture a black ball before some of the sky.
    radius, scene = 1.2, vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1))
    scene.add_sphere((3, 0, 3), radius, color="black")
    scene.lights = [vtray.Sky(1.0)]
    # A lens that is nearly a point, as pixels have samples then.
    lens = vtray.Lens(1e-6, focus_distance=10)
    scene.camera = vtray.Camera.look_at((0, 0, 10), (0, 0, 0), (0, 1, 0), 0.01, (32, 32), lens=lens)
    # The ball's share of the cosine-weighted sky: its solid angle's sine squared times the cosine.
    share = 1 - radius**2 / 18 * np.sqrt(0.5)
    image = render(scene, samples=samples, tolerance=tolerance, exposure=1.0)
    off = image.linear[..., 0] / 255 - share
    assert abs(off.mean()) < 0.001
    assert np.sqrt((off * off).mean()) < 1.2 * image.error.mean() / 255
