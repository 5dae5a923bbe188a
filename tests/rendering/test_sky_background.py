"""The sky behind all that there is, as the camera sees it."""

from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest

import vtray
from conftest import JIT, compiled_only
from vtray import render

SIZE = (24, 16) if JIT else (6, 4)
UP = (0, 0, 1)
BASIC = vtray.Gradient((255, 0, 0), (0, 255, 0), (0, 0, 255))


def looking_at(*lights: Any, **camera: Any) -> vtray.Scene:
    """Return a scene with a ball before the horizon, seen along y."""
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 0), 0.5)
    options = {"up": UP, "fov_degrees": 60, "size": SIZE, **camera}
    scene.camera = vtray.Camera.look_at((0, -3, 0), (0, 0, 0), **options)
    scene.lights = list(lights)
    return scene


def ways(camera: vtray.Camera) -> np.ndarray:
    """Return the directions through the middles of the pixels, for a camera along y."""
    width, height = camera.size
    across = (np.arange(width) - width / 2) * camera.resolution[0]
    down = (np.arange(height)[:, None] - height / 2) * camera.resolution[1]
    way = np.stack(np.broadcast_arrays(across, camera.focus, -down), axis=-1)
    return way / np.sqrt((way**2).sum(axis=-1, keepdims=True))


def shown(scene: vtray.Scene, **options: Any) -> np.ndarray:
    """Return the light of a picture with the sky behind, 1 for white."""
    return render(scene, background="sky", exposure=1.0, **options).with_sky / 255


def gradient(way: np.ndarray) -> np.ndarray:
    """Return the colour of the gradient in directions, by its formula."""
    height = way[..., 2]
    zenith = np.where(height > 0, height * (2 - height), 0)
    horizon = np.where(height > 0, 1 - zenith, (1 - abs(height)) ** 8)
    return np.stack([zenith, horizon, 1 - zenith - horizon], axis=-1)


def test_a_gradient_is_seen_as_its_formula_says() -> None:
    scene = looking_at(vtray.Sky(0.5, (255, 255, 51), gradient=BASIC))
    seen, empty = shown(scene), render(scene).ids[..., 0] < 0
    expected = 0.5 * gradient(ways(scene.camera)) * (1, 1, 0.2)
    np.testing.assert_allclose(seen[empty], expected[empty], atol=1e-4)
    assert empty.any()
    assert not empty.all()


def test_a_picture_is_seen_as_from_within() -> None:
    pixels = np.zeros((8, 16, 3), np.float32) + 0.1
    pixels[:, :4] = (1, 0, 0)  # from behind, over the left ...
    pixels[:, 4:8] = (0, 1, 0)  # ... to the front, as one looks to where the middle is
    scene = looking_at(vtray.Sky(image=pixels, rotation=90))
    seen = shown(scene)
    left, right = seen[0, SIZE[0] // 4], seen[0, -1]
    np.testing.assert_allclose(left, (0, 1, 0), atol=1e-6)
    np.testing.assert_allclose(right, 0.1, atol=1e-6)
    assert shown(looking_at(vtray.Sky(image=pixels, rotation=-90)))[0, -1] == pytest.approx(
        np.array([1.0, 0, 0]), abs=1e-6
    )


def test_pixels_are_those_of_the_light() -> None:
    scene = looking_at(vtray.Sky(0.4, (200, 100, 50)), vtray.Sky(0.2))
    image = render(scene, background="sky", exposure=1.0)
    empty = image.ids[..., 0] < 0
    expected = np.array([200, 100, 50]) * 0.4 + 255 * 0.2
    np.testing.assert_allclose(image.with_sky[empty], np.broadcast_to(expected, (empty.sum(), 3)))
    np.testing.assert_array_equal(image.pixels[empty], np.floor(image.with_sky[empty]))
    np.testing.assert_array_equal(image.with_sky[~empty], image.linear[~empty])
    np.testing.assert_array_equal(image.linear[empty], 0)
    fine = image.develop(16)[empty]
    np.testing.assert_array_equal(fine, np.floor(65535 * image.with_sky[empty] / 255))


def test_brightest_is_the_scene_not_the_sky() -> None:
    pixels = np.ones((8, 16, 3))
    pixels[4, 12] = 1e4
    scene = looking_at(vtray.Sky(image=pixels))
    image, other = render(scene, background="sky"), render(scene)
    assert image.white == other.white == other.linear.max()


@pytest.mark.parametrize("samples", [2, 9] if JIT else [2])
def test_samples_blend_with_what_is_before_it(samples: int) -> None:
    scene = looking_at(vtray.Sky(0.5), vtray.Light((3, -3, 3), 0.5))
    image = render(scene, samples=samples, background="sky", exposure=1.0)
    behind = (1 - image.alpha[..., None]) * 255 * 0.5
    np.testing.assert_allclose(image.with_sky, image.linear + behind, rtol=1e-12)
    assert not JIT or ((image.alpha > 0) & (image.alpha < 1)).any()
    clear = render(scene, samples=samples, background="transparent", exposure=1.0)
    np.testing.assert_array_equal(image.linear, clear.linear)


@compiled_only
@pytest.mark.parametrize("filter_name", ["box", "blackman-harris", "mitchell"])
def test_samples_smooth_what_is_finer_than_pixels(filter_name: str) -> None:
    pixels = np.indices((512, 1024)).sum(axis=0) % 2 * np.ones((3, 1, 1))
    scene = looking_at(vtray.Sky(image=np.moveaxis(pixels, 0, -1)))
    one = shown(scene)
    many = shown(scene, samples=256, filter=filter_name)
    empty = render(scene, samples=256).alpha == 0
    assert one[empty].std() > 0.1
    assert many[empty] == pytest.approx(0.5, abs=0.1)
    sun = np.zeros((64, 128, 3))
    sun[24, 96] = 1e4
    options: dict[str, Any] = {"samples": 16, "filter": filter_name}
    image = render(looking_at(vtray.Sky(image=sun)), background="sky", **options)
    assert (image.with_sky - image.linear).min() >= 0


@compiled_only
def test_threads_and_relighting_change_nothing() -> None:
    pixels = np.random.default_rng(3).random((16, 32, 3))
    scene = looking_at(vtray.Sky(image=pixels), vtray.Sky(0.1), size=(150, 90))
    options: dict[str, Any] = {"samples": 4, "background": "sky", "keep_lights": True}
    image = render(scene, threads=1, **options)
    np.testing.assert_array_equal(image.with_sky, render(scene, threads=3, **options).with_sky)
    relit = image.relight([0.3, 0.7])
    again = render(relit.scene, **options)
    np.testing.assert_array_equal(relit.with_sky, again.with_sky)
    np.testing.assert_array_equal(relit.pixels, again.pixels)
    exposed = image.expose(2)
    np.testing.assert_array_equal(exposed.with_sky, image.with_sky)


def test_without_a_sky() -> None:
    scene = looking_at(vtray.Ambient(), vtray.Light((3, -3, 3)))
    words = 'background: "sky" shows the skies among the lights, and there are none; add one by '
    with pytest.raises(vtray.RenderError, match=words):
        render(scene, background="sky")


def test_parallel_rays_see_one_color() -> None:
    scene = looking_at(vtray.Sky(gradient=BASIC))
    scene.camera = vtray.Camera.orthographic((0, -3, -3), (0, 0, 0), 3, up=UP, size=SIZE)
    seen, empty = shown(scene), render(scene).ids[..., 0] < 0
    way = np.array([0, np.sqrt(0.5), np.sqrt(0.5)])
    np.testing.assert_allclose(seen[empty], np.tile(gradient(way), (empty.sum(), 1)), atol=1e-4)


def test_files_and_words(tmp_path: Path) -> None:
    scene = looking_at(vtray.Sky(0.5, gradient=BASIC))
    scene.render = vtray.RenderSettings(background="sky")
    assert scene.render.background == "sky"
    image = render(scene)
    image.save(tmp_path / "sky.exr")
    with OpenEXR.File(str(tmp_path / "sky.exr"), separate_channels=True) as found:
        assert set(found.channels()) == {"R", "G", "B"}
        green = found.channels()["G"].pixels
    np.testing.assert_array_equal(green, (image.with_sky[..., 1] / 255).astype(np.float32))
    scene.save(tmp_path / "sky.json")
    assert vtray.load(tmp_path / "sky.json").render == scene.render
    found = vtray.read_provenance(tmp_path / "sky.exr")
    assert found.background == "sky"
    text = str(vtray.trace_pixel(image, 0, 0))
    sky = ", ".join(f"{part:.6g}" for part in image.with_sky[0, 0])
    assert f"sky          ({sky}), seen in 100 % of the pixel" in text
    assert "light        (0, 0, 0), the sum over all lights" in text
    assert str(vtray.trace_pixel(render(scene, background="white"), 0, 0)).count("sky ") == 0
