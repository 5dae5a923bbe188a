"""How noisy soft light may be where nobody says it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vtray as vt
from conftest import once
from vtray.scene.default_light import SAMPLES, settings_of
from vtray.scene.grain import COARSEST, FINEST, LITTLE_GRAIN, LOOKED_AT, NO_GRAIN, tolerance_of
from vtray.scene.settings import TOLERANCE

PIXEL = 0.25


def camera_at(z: float = -50.0) -> vt.Camera:
    """Return a camera without perspective that looks along z."""
    camera = vt.Camera((0, 0, z), (0, 0, 1), 10, (64, 48), (PIXEL, PIXEL))
    return camera.replace(projection="orthographic")


def grain_on(pixels: float) -> Any:
    """Return about the tolerance for things of a radius in pixels, apart from its bounds."""
    expected = max(NO_GRAIN / pixels, LITTLE_GRAIN / pixels**0.5)
    return pytest.approx(expected, abs=0.0006)


@pytest.mark.parametrize("pixels", [3.0, 5.0, 10.0, 40.0])
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_smaller_balls_may_have_more_grain(pixels: float, kind: type) -> None:
    scene = vt.Scene(camera_at())
    places = np.random.default_rng(1).uniform(-5, 5, (100, 3)).astype(kind)
    scene.add_spheres(places, pixels * PIXEL, color="white")
    assert tolerance_of(scene, scene.camera) == grain_on(pixels)


@pytest.mark.parametrize(("pixels", "tolerance"), [(0.0, COARSEST), (0.1, COARSEST), (90, FINEST)])
def test_grain_has_bounds(pixels: float, tolerance: float) -> None:
    scene = vt.Scene(camera_at())
    scene.add_spheres([(0, 0, 0)], pixels * PIXEL, color="white")
    assert tolerance_of(scene, scene.camera) == tolerance


def test_size_counts_of_what_has_most_area() -> None:
    scene = vt.Scene(camera_at())
    scene.add_cylinders(np.zeros((9, 3)), np.ones((9, 3)), 4 * PIXEL, color="white")
    scene.add_sphere((0, 0, 0), 12 * PIXEL, color="white")
    assert tolerance_of(scene, scene.camera) == grain_on(4)
    scene.objects[-1] = vt.Sphere((0, 0, 0), 50 * PIXEL, (9, 9, 9), 1)
    assert tolerance_of(scene, scene.camera) == FINEST
    parts = [vt.Spheres(np.zeros((50, 3)), 5 * PIXEL, (255, 255, 255), 1)]
    scene.add_copies(parts, at=[(0, 0, 1), (0, 1, 0)])
    assert tolerance_of(scene, scene.camera) == grain_on(5)


def test_of_many_some_are_looked_at() -> None:
    scene = vt.Scene(camera_at())
    radii = np.linspace(2, 6, 3 * LOOKED_AT + 1) * PIXEL
    scene.add_spheres(np.zeros((len(radii), 3)), radii, color="white")
    usual = ((2**3 + 6**3) / 2) ** (1 / 3)
    assert tolerance_of(scene, scene.camera) == grain_on(usual)
    scene.add_sphere((0, 0, 0), 30 * PIXEL, color="white")
    assert tolerance_of(scene, scene.camera) == grain_on(usual)


def test_planes_have_the_least_grain() -> None:
    scene = vt.Scene(camera_at())
    assert tolerance_of(scene, scene.camera) == TOLERANCE
    scene.add_sphere((0, 0, 0), 0.1, color="white")
    assert tolerance_of(scene, scene.camera) == COARSEST
    scene.add_plane((0, 0, 90), (0, 0, -1), color="white")
    assert tolerance_of(scene, scene.camera) == TOLERANCE


def test_what_is_not_in_sight_does_not_count() -> None:
    scene = vt.Scene(camera_at(z=50.0))
    scene.add_sphere((0, 0, 0), 0.1, color="white")
    assert tolerance_of(scene, scene.camera) == FINEST


def test_settings_in_default_light_are_those_that_were_set_and_else_smooth() -> None:
    scene = vt.Scene(camera_at())
    scene.add_sphere((0, 0, 0), 5 * PIXEL, color="white")
    found = settings_of(scene)
    assert (found.samples, found.tolerance) == (SAMPLES, 0.0362)
    assert settings_of(scene, {"size": (128, 96)}).tolerance == 0.0256
    scene.render = vt.RenderSettings(samples=9, tolerance=0.5, size=(128, 96))
    assert (settings_of(scene).samples, settings_of(scene).tolerance) == (9, 0.5)
    scene.lights = []
    scene.render = vt.RenderSettings()
    assert settings_of(scene) == vt.RenderSettings()


@once
def test_a_picture_in_default_light_has_smooth_edges_unless_it_is_said_otherwise() -> None:
    scene = vt.Scene(camera_at())
    scene.add_sphere((0, 0, 0), 5 * PIXEL, color="black")
    smooth, rough = vt.render(scene), vt.render(scene, samples=1)
    assert {0, 255} < set(smooth.pixels.ravel().tolist())
    assert set(rough.pixels.ravel().tolist()) == {0, 255}


@once
def test_saved_files_show_the_same(tmp_path: Path) -> None:
    scene = vt.Scene(camera_at())
    scene.add_sphere((0, 0, 0), 5 * PIXEL, color="orange")
    scene.save(f"{tmp_path}/scene.json")
    again = vt.load(f"{tmp_path}/scene.json")
    assert (vt.render(again).pixels == vt.render(scene).pixels).all()
    assert (vt.render(vt.load_dict(scene.to_dict())).pixels == vt.render(scene).pixels).all()


@pytest.mark.parametrize(
    ("size", "words"),
    [
        ("800x600", "RenderSettings.size: expected an array of two integers > 0, got '800x600'"),
        ((3, 0.5), r"RenderSettings.size\[1\]: expected an integer from 1"),
        (5, "RenderSettings.size: expected an array"),
    ],
)
def test_bad_sizes_are_told_in_default_light_as_ever(size: object, words: str) -> None:
    scene = vt.Scene(camera_at())
    scene.add_sphere((0, 0, 0), 1, color="white")
    with pytest.raises(vt.SceneError, match=words):
        vt.render(scene, size=size)  # type: ignore[arg-type]
