"""Light that passes bodies in part: layers, shadows, bodies, against a plain oracle."""

from pathlib import Path
from typing import Any

import numpy as np
import oracle_layers
import pytest

import vtray
from conftest import JIT, compiled_only, once
from vtray.rendering.guides import Guiding
from vtray.rendering.hierarchy import accelerate
from vtray.scene.fingerprint import scene_hash

SIZE = (36, 28) if JIT else (14, 10)


def camera(**changes: Any) -> vtray.Camera:
    """Return a camera that looks along y at the origin."""
    view = vtray.Camera.look_at((0, -12, 3), (0, 0, 0), fov_degrees=35, size=SIZE)
    return view.replace(**changes)


def random_scene(seed: int) -> vtray.Scene:
    """Return a scene of faded and opaque balls that overlap, over a floor or in the dark."""
    rng = np.random.default_rng(seed)
    scene = vtray.Scene(camera(projection=("perspective", "orthographic")[seed % 2]), [], [])
    for _ in range(2):
        x, y, z = rng.normal(size=3) * 6
        scene.add_light((x, y - 8, z + 6), float(rng.random() + 0.3))
    for opacity in (float(rng.choice([0.2, 0.5, 0.9])), rng.choice([0.0, 0.3, 0.7, 1.0], 5)):
        centers = rng.normal(size=(5, 3)) * 1.2
        colors = rng.integers(0, 256, (5, 3))
        scene.add_spheres(centers, 0.4 + rng.random(5), colors, opacity=opacity)
    scene.add_sphere(rng.normal(size=3), 0.8, "white", opacity=float(rng.choice([0.4, 1.0])))
    if seed % 3:
        scene.add_plane((0, 0, -2), (0, 0.1, 1), "tan", opacity=(1.0, 0.6)[seed % 3 - 1])
    return scene


def differing(image: vtray.Image, light: Any, cover: Any) -> int:
    """Return how many pixels are not as an oracle has them."""
    is_light = np.isclose(image.linear, light, rtol=1e-6, atol=1e-4).all(axis=-1)
    return int(np.count_nonzero(~(is_light & np.isclose(image.alpha, cover, atol=1e-4))))


@once
@pytest.mark.parametrize("seed", range(12 if JIT else 2))
def test_light_is_that_of_the_oracle(seed: int) -> None:
    scene = random_scene(seed)
    light, cover = oracle_layers.render(scene)
    # Where rounding decides, at outlines and edges of shadows, a pixel may be another.
    assert differing(vtray.render(scene), light, cover) <= 1


def soft_scene() -> vtray.Scene:
    """Return a scene with several kinds of lights and shapes."""
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 0.4)], [])
    scene.lights.append(vtray.SphereLight((-5, -8, 6), 1.5, 0.8))
    scene.lights.append(vtray.Ambient(0.4))
    rng = np.random.default_rng(3)
    scene.add_spheres(rng.normal(size=(12, 3)) * 1.3, 0.9, "skyblue", opacity=0.3)
    scene.add_cylinder((-2, 0, -1), (2, 0.5, 1), 0.4, "orange", opacity=0.6)
    scene.add_spheres(rng.normal(size=(3, 3)) * 1.5, 0.5, "red")
    scene.add_plane((0, 0, -2), (0, 0, 1), "white")
    return scene


@compiled_only
def test_threads_and_tiles_change_nothing() -> None:
    scene = soft_scene()
    image = vtray.render(scene, samples=4, threads=1)
    other = vtray.render(scene, samples=4, threads=2, tile=16)
    for name in ("linear", "alpha", "depth", "ids", "normals"):
        np.testing.assert_array_equal(getattr(image, name), getattr(other, name))


@compiled_only
@pytest.mark.parametrize("fog", [None, (9.0, 22.0), (9.0, 22.0, "blue")])
def test_what_is_opaque_covers_its_pixels_beside_a_faded_body(fog: Any) -> None:
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0)], [])
    scene.add_sphere((-1.4, 0, 0), 2.0, "gold")
    scene.add_sphere((2.2, 0, 0), 0.8, "skyblue", opacity=0.4)
    one, some = (vtray.render(scene, samples=n, fog=fog, exposure=1.0) for n in (1, 4))
    # The pixels whose neighbours see the same need no samples.
    is_gold = one.ids[..., 0] == 0
    inside = is_gold[2:-2, 2:-2].copy()
    for y in range(5):
        for x in range(5):
            inside &= is_gold[y : y + inside.shape[0], x : x + inside.shape[1]]
    assert np.count_nonzero(inside) > 20
    for name, near in (("alpha", 0.02), ("linear", 8.0)):
        found, expected = (getattr(image, name)[2:-2, 2:-2][inside] for image in (some, one))
        np.testing.assert_allclose(found, expected, atol=near)
    if fog is None:
        assert (some.alpha[2:-2, 2:-2][inside] == 1.0).all()


@compiled_only
@pytest.mark.parametrize("opacity", [0.1, 0.4])
def test_error_is_what_other_rays_show(opacity: float) -> None:
    scene = vtray.Scene(camera(), [vtray.Ambient(1.0)], [])
    scene.add_spheres(np.random.default_rng(3).normal(size=(40, 3)) * 1.5, 0.6, opacity=opacity)
    images = [vtray.render(scene, seed=seed, exposure=1.0, tolerance=0.1) for seed in range(12)]
    spread = np.std([image.linear for image in images], axis=0, ddof=1).max(axis=-1)
    seen = images[0].error > 0.0
    assert np.count_nonzero(seen) > 100
    # The estimate is rather too much than too little.
    found, told = (np.sqrt(np.mean(x[seen] ** 2)) for x in (spread, images[0].error))
    assert 0.1 * told < found < told


@compiled_only
def test_rays_of_a_pixel_tell_its_light() -> None:
    image = vtray.render(soft_scene())
    layers = 0
    for y in range(2, SIZE[1], 5):
        for x in range(1, SIZE[0], 5):
            tree = vtray.trace_pixel(image, x, y)
            assert tree.light == tuple(image.linear[y, x])
            shares = [layer.share for layer in tree.layers]
            assert sum(shares) + tree.share == pytest.approx(1.0)
            layers = max(layers, len(shares))
    assert layers >= 2
    assert "layer" in str(vtray.trace_pixel(image, SIZE[0] // 2, SIZE[1] // 2))


def test_what_is_within_a_body_is_not_seen() -> None:
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0)], [])
    scene.add_spheres([(0, 0, 0)], 1.5, "red", opacity=0.4)
    alone = vtray.render(scene)
    scene.objects.clear()
    scene.add_spheres(
        [(0, 0, 0), (0.5, 0.2, 0), (-0.3, 0, 0.4)], [1.5, 0.6, 0.7], "red", opacity=0.4
    )
    np.testing.assert_array_equal(vtray.render(scene).linear, alone.linear)


def test_opacity_of_1_is_that_of_none_and_of_0_is_nothing() -> None:
    plain = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0)], [])
    plain.add_spheres([(0, 0, 0), (1, 0, 0)], 0.9, "red")
    full = vtray.Scene(plain.camera, plain.lights, [])
    full.add_spheres([(0, 0, 0), (1, 0, 0), (0, -3, 0)], 0.9, "red", opacity=[1.0, 1.0, 0.0])
    full.add_sphere((0, 0, 1), 1.0, opacity=0.0)
    np.testing.assert_array_equal(vtray.render(plain).linear, vtray.render(full).linear)


def test_nearly_opaque_is_nearly_the_same() -> None:
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0)], [])
    scene.add_spheres([(0, 0, 0), (1, 0, 0)], 0.9, "red")
    scene.add_plane((0, 0, -1), (0, 0, 1))
    faded = vtray.Scene(scene.camera, scene.lights, [])
    faded.add_spheres([(0, 0, 0), (1, 0, 0)], 0.9, "red", opacity=1 - 1e-9)
    faded.add_plane((0, 0, -1), (0, 0, 1))
    found, expected = vtray.render(faded).linear, vtray.render(scene).linear
    assert np.count_nonzero(~np.isclose(found, expected, rtol=1e-6, atol=1e-5)) <= 3


def test_depth_and_ids_are_those_of_what_is_opaque_enough() -> None:
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0)], [])
    scene.add_sphere((0, 0, 0), 1.5, opacity=0.4)
    scene.add_sphere((0, 0, 0), 1.0, opacity=0.8)
    scene.add_sphere((0, 0, 0), 0.5)
    image = vtray.render(scene)
    middle = SIZE[1] // 2, SIZE[0] // 2
    assert tuple(image.ids[middle]) == (1, 0)
    assert image.depth[middle] == pytest.approx(np.sqrt(153) - 1.0, abs=0.2)


@once
@pytest.mark.parametrize("seed", range(12 if JIT else 4))
def test_albedo_is_that_of_the_oracle(seed: int) -> None:
    scene = random_scene(seed)
    found = vtray.render(scene, fog=(8, 14) if seed == 3 else None).albedo
    is_wrong = ~np.isclose(found, oracle_layers.albedo(scene), rtol=1e-6, atol=1e-9).all(axis=-1)
    assert np.count_nonzero(is_wrong) <= 1


@once
@pytest.mark.parametrize("samples", [1, 4])
def test_albedo_has_as_much_of_each_layer_as_is_seen(samples: int) -> None:
    scene = vtray.Scene(camera(size=(6, 4)), [vtray.Light((4, -9, 8), 1.0)], [])
    scene.add_plane((0, 0, 0), (0, -1, 0), (204, 0, 0), opacity=0.3)
    middle = 2, 3
    for solid_from in (0.2, 0.5):
        image = vtray.render(scene, samples=samples, solid_from=solid_from)
        assert image.albedo[middle] == pytest.approx([0.24, 0, 0])
        assert image.ids[middle][0] == (0 if solid_from == 0.2 else -1)
    scene.add_plane((0, 2, 0), (0, -1, 0), (0, 0, 255), lambert=0.5)
    image = vtray.render(scene, samples=samples)
    assert image.albedo[middle] == pytest.approx([0.24, 0, 0.35])


@once
def test_guides_have_the_normals_of_what_ids_show() -> None:
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0)], [])
    scene.add_plane((0, 0, 0), (0, -1, 0.3), opacity=0.3)
    for solid_from in (0.2, 0.5):
        style, kept = vtray.Style(solid_from=solid_from), accelerate(scene)
        guides = Guiding(kept, vtray.RenderSettings(), style, 1)(scene)
        image = vtray.render(scene, solid_from=solid_from)
        np.testing.assert_array_equal(guides.normals, image.normals)
        np.testing.assert_allclose(guides.cover, image.alpha, rtol=1e-12)


def test_other_lights_and_colors_are_those_of_a_new_picture() -> None:
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0), vtray.Light((-4, -9, 1), 0.5)], [])
    scene.add_spheres([(0, 0, 0), (1, 0, 0)], 0.9, "red", opacity=0.5)
    scene.add_sphere((0, 2, 0), 1.0, "blue")
    image = vtray.render(scene, keep_lights=True)
    other = vtray.Scene(scene.camera, [scene.lights[0], scene.lights[1].replace(intensity=2.0)], [])
    other.objects.extend(scene.objects)
    np.testing.assert_array_equal(image.relight([1.0, 2.0]).linear, vtray.render(other).linear)
    other.objects[0] = vtray.Spheres([(0, 0, 0), (1, 0, 0)], 0.9, (0, 255, 0), opacity=0.5)
    recolored = image.relight([1.0, 2.0]).recolor(0, "lime")
    np.testing.assert_array_equal(recolored.linear, vtray.render(other).linear)


def test_copies_are_one_body() -> None:
    at = [(0, 0, 0), (0.7, 0, 0), (0, 0, 0.8)]
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0)], [])
    part = vtray.Spheres([(0, 0, 0), (0.4, 0, 0)], 0.6, (255, 0, 0), opacity=0.5)
    scene.add_copies([part, vtray.Sphere((0, 1, 0), 0.5, (0, 0, 255))], at)
    written = vtray.Scene(scene.camera, scene.lights, [])
    moved = np.concatenate([part.center + np.array(shift) for shift in at])
    written.add_spheres(moved, 0.6, (255, 0, 0), opacity=0.5)
    written.add_spheres(np.array([(0, 1, 0)]) + np.array(at), 0.5, (0, 0, 255))
    image = vtray.render(scene)
    np.testing.assert_array_equal(image.linear, vtray.render(written).linear)
    assert set(np.unique(image.ids[..., 0])) <= {-1, 0}


def test_opacity_is_kept_in_files(tmp_path: Path) -> None:
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0)], [])
    scene.add_sphere((0, 0, 0), 1.0, opacity=0.25)
    scene.add_spheres([(0, 0, 0), (1, 0, 0)], 0.5, opacity=[0.5, 1.0])
    scene.add_cylinders([(0, 0, 0)], [(1, 0, 0)], 0.5, opacity=0.75)
    scene.save(tmp_path / "scene.json")
    again = vtray.load(tmp_path / "scene.json")
    assert again.objects == scene.objects


@pytest.mark.parametrize("opacity", [-0.1, 1.5, float("nan"), [0.5], "red"])
def test_an_opacity_is_a_number_from_0_to_1(opacity: Any) -> None:
    scene = vtray.Scene()
    with pytest.raises(vtray.SceneError, match="opacity"):
        scene.add_spheres([(0, 0, 0), (1, 0, 0)], 0.5, opacity=opacity)


def test_fog_takes_its_share_of_each_layer() -> None:
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0)], [])
    scene.add_sphere((0, 0, 0), 1.5, "red", opacity=0.4)
    scene.add_sphere((0, 4, 0), 2.5, "white", opacity=0.7)
    scene.add_plane((0, 9, 0), (0, 1, 0), "white")
    image = vtray.render(scene, fog=(9.0, 22.0, "blue"))
    for y in range(2, SIZE[1], 9):
        for x in range(1, SIZE[0], 9):
            tree = vtray.trace_pixel(image, x, y)
            assert tree.light == tuple(image.linear[y, x])


def cut_scene(opacity: float) -> vtray.Scene:
    """Return a scene of all kinds of objects that a plane through the origin cuts."""
    scene = vtray.Scene(camera(), [vtray.Light((4, -9, 8), 1.0)], [])
    generator = np.random.default_rng(8)
    scene.add_spheres(generator.normal(size=(14, 3)), 0.7, "skyblue", opacity=opacity)
    if not JIT:  # Compiling this for one more kind of shape takes a minute.
        scene.add_cylinder((-2, 0, -1), (2, 0.5, 1), 0.4, "orange", opacity=opacity)
    scene.add_copies(
        vtray.Sphere((0, 0, 1.5), 0.5, (0, 255, 0), opacity=opacity), [(0, 0, 0), (1, 1, 0)]
    )
    scene.add_sphere((0, 1, 0), 0.8, "red")
    scene.add_plane((0, 0, -1.5), (0, 0, 1), "white", opacity=opacity)
    return scene


def test_what_clip_planes_leave_of_a_body_is_closed() -> None:
    clip = {"clip": (0.3, -1, 0.2, 0.1), "cap": True}
    expected = vtray.render(cut_scene(1.0), **clip)
    found = vtray.render(cut_scene(1 - 1e-9), **clip)
    is_same = np.isclose(found.linear, expected.linear, rtol=1e-6, atol=1e-5)
    # Of faces in one plane that overlap, another may be seen.
    assert np.count_nonzero(~is_same.all(axis=-1)) <= (30 if JIT else 8)


@once
def test_cut_bodies_are_closed_without_a_cap_too() -> None:
    scene = cut_scene(0.7)
    del scene.objects[-2]  # the opaque ball is open
    closed, other = (
        vtray.render(scene, clip=(0.3, -1, 0.2, 0.1), cap=cap) for cap in (True, False)
    )
    for name in ("depth", "alpha", "normals", "linear"):
        np.testing.assert_array_equal(getattr(other, name), getattr(closed, name))


def test_bodies_beyond_clip_planes_are_not_there() -> None:
    scene = cut_scene(0.4)
    left = vtray.Scene(scene.camera, scene.lights, [])
    spheres = scene.objects[0]
    is_left = np.random.default_rng(1).random(14) < 0.5
    far = np.where(is_left[:, None], spheres.center, spheres.center + np.array([0, 0, 50]))
    scene.objects[:] = [spheres.replace(center=far)]
    left.objects[:] = [spheres.replace(center=spheres.center[is_left])]
    for samples in (1, 2):
        image = vtray.render(scene, samples=samples, clip=(0, 0, 1, 20))
        np.testing.assert_array_equal(image.linear, vtray.render(left, samples=samples).linear)


def test_equal_opacities_have_equal_hashes() -> None:
    one, other = vtray.Scene(camera(), [], []), vtray.Scene(camera(), [], [])
    one.add_sphere((0, 0, 0), 1.0)
    other.add_sphere((0, 0, 0), 1.0, opacity=float("1.0"))
    assert scene_hash(one) == scene_hash(other)
    other.objects[0] = vtray.Sphere((0, 0, 0), 1.0, opacity=0.5)
    assert scene_hash(one) != scene_hash(other)
    assert "opacity" not in one.to_dict()["objects"][0]
