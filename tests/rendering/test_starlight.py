"""Points that shine: their light on the pixels, what hides it, and what else a picture does."""

import copy
import hashlib
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import compiled_only
from vtray.base.errors import RenderError, SceneError
from vtray.figures.projection import project
from vtray.rendering import starlight
from vtray.rendering.starlight import Starlight
from vtray.scene.default_light import lights_of, settings_of
from vtray.scene.fingerprint import scene_hash
from vtray.scene.particles.particles import Particles
from vtray.scene.placing.moved import axes_of
from vtray.scene.stars import Stars

CAMERA = vtray.Camera.orthographic((0, 0, 10), (0, 0, 0), 8, size=(10, 8))
LOOKING = vtray.Camera.look_at((0, -9, 2), (0, 0, 0), up=(0, 0, 1), size=(24, 16))


def light_of(stars: Stars, camera: vtray.Camera = CAMERA, depth: Any = None) -> Any:
    """Return the light of some points, and of something at a depth in front of some of them."""
    things = [] if depth is None else [vtray.Sphere((0, 0, 0), 1, (0, 0, 0), 1)]
    return Starlight(lambda: depth)(vtray.Scene(camera, [], [stars, *things]))


def by_loops(stars: Stars, camera: vtray.Camera) -> Any:
    """Return the light that adds up in pixels, (height, width, 3), point by point."""
    width, height = camera.size
    film = np.zeros((height, width, 3))
    found = project(camera, stars.center)
    for column, row, emission, color in zip(
        found.column, found.row, np.broadcast_to(stars.emission, len(stars)), stars.color,
        strict=True,
    ):  # fmt: skip
        for y in range(height):
            for x in range(width):
                far = abs(x - column), abs(y - row)
                shares = [0.75 - d * d if d <= 0.5 else 0.5 * max(1.5 - d, 0.0) ** 2 for d in far]
                film[y, x] += emission * shares[0] * shares[1] * color
    return film


def test_light_falls_on_nine_pixels() -> None:
    light = light_of(Stars([(0, 0, 0)], 3.0, stretch="linear", peak=3.0))
    near = [0.125, 0.75, 0.125]
    expected = np.zeros((8, 10))
    expected[3:6, 4:7] = np.outer(near, near)
    assert np.allclose(light, 255 * expected[..., None])
    # Wherever a point lies, all of its light falls into the picture.
    for shift in np.linspace(0, 1, 7):
        light = light_of(Stars([(shift, shift / 3, 0)], 3.0, stretch="linear", peak=30.0))
        assert light.sum() == pytest.approx(3 * 25.5)


@pytest.mark.parametrize("camera", [CAMERA, LOOKING])
def test_light_is_that_of_a_plain_loop(camera: vtray.Camera) -> None:
    generator = np.random.default_rng(1)
    points = generator.normal(size=(60, 3)) * 3
    emission, color = generator.uniform(size=60), generator.integers(0, 256, (60, 3))
    stars = Stars(points, emission, color, stretch="linear", peak=100.0)
    assert np.allclose(light_of(stars, camera), by_loops(stars, camera) / 100)


@pytest.mark.parametrize("stretch", ["linear", "asinh", "log"])
@pytest.mark.parametrize("softening", [None, 0.02])
def test_stretches(stretch: Any, softening: float | None) -> None:
    x = np.linspace(0, 1.5, 9)
    stars = [
        Stars([(0, 0, 0)], value / 0.5625 * 7, (200, 100, 0), stretch, softening, peak=7.0)
        for value in x
    ]
    found = [light_of(one)[4, 5] for one in stars]
    x = np.minimum(x, 1)
    s = softening or {"linear": 1.0, "asinh": 0.1, "log": 0.001}[stretch]
    expected = {
        "linear": x,
        "asinh": np.arcsinh(x / s) / np.arcsinh(1 / s),
        "log": np.log1p(x / s) / np.log1p(1 / s),
    }
    assert np.allclose(found, expected[stretch][:, None] * [200, 100, 0])


def test_usual_peak_is_that_of_few_pixels() -> None:
    generator = np.random.default_rng(3)
    camera = vtray.Camera.orthographic((0, 0, 10), (0, 0, 0), 40, size=(80, 80))
    emission = np.append(np.ones(500), 1e6)
    points = generator.uniform(-19, 19, (501, 3))
    light = light_of(Stars(points, emission, stretch="linear"), camera)
    assert light.max() == 255
    assert np.median(light[light > 0]) > 10


def test_colors_are_means_whatever_the_stretch() -> None:
    stars = Stars([(0, 0, 0)] * 2, [3.0, 1.0], [(200, 0, 0), (0, 200, 0)], peak=99.0)
    red, green, blue = light_of(stars)[4, 5]
    assert red == pytest.approx(3 * green)
    assert blue == 0 < green
    same = Stars([(0, 0, 0)] * 2, [3.0, 1.0], [(200, 10, 0)] * 2, peak=99.0)
    one = Stars([(0, 0, 0)], 4.0, (200, 10, 0), peak=99.0)
    assert np.array_equal(light_of(same), light_of(one))


def test_no_size_of_numbers_is_too_large() -> None:
    for factor in (1e-300, 1e300):
        stars = Stars([(0, 0, 0), (2, 1, 0)], np.array([1.0, 2.0]) * factor, peak=2 * factor)
        expected = light_of(Stars([(0, 0, 0), (2, 1, 0)], [1.0, 2.0], peak=2.0))
        assert np.allclose(light_of(stars), expected)
    assert light_of(Stars([(0, 0, 0)], 1e300, peak=1e-300)).max() == 255
    assert light_of(Stars([(1e308, 0, -1e308)] * 2, 1.0), LOOKING).max() == 0
    assert light_of(Stars([(0, 0, 0)], 0.0)).max() == 0
    assert light_of(Stars(np.zeros((0, 3)))).max() == 0


def test_what_is_behind_something_is_hidden() -> None:
    depth = np.full((8, 10), np.inf)
    depth[4, 5] = 9.5
    hidden, beside, before = (0, 0, 0), (2, 0, 0), (0, 0, 1)
    light = [
        light_of(Stars([place], peak=1.0), CAMERA, depth) for place in (hidden, beside, before)
    ]
    assert [float(one.max()) > 0 for one in light] == [False, True, True]
    behind_the_image = Stars([(0, -10, 2.2)], peak=1.0)
    assert light_of(behind_the_image, LOOKING).max() == 0


def test_what_hides_is_nearer_along_the_view() -> None:
    right, down, forward = axes_of(LOOKING)
    eye = np.array([0, -9, 2.0])
    pixel = LOOKING.resolution[0] / LOOKING.focus
    across, below = 11 * pixel, -7 * pixel  # near a corner
    rows, columns = (np.indices((16, 24)) - [[[8]], [[12]]]) * pixel
    wall = 5.0 * np.sqrt(1 + rows * rows + columns * columns)  # 5 from the eye along the view
    for far, is_seen in ((4.99, True), (5.01, False)):
        place = eye + far * (np.array(forward) + across * np.array(right) + below * np.array(down))
        light = light_of(Stars([place], peak=1.0), LOOKING, wall)
        assert (light[1, 23].max() > 0) == is_seen


def test_many_points_are_added_in_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    generator = np.random.default_rng(6)
    stars = Stars(generator.normal(size=(50, 3)), generator.uniform(size=50), peak=4.0)
    whole = light_of(stars)
    monkeypatch.setattr(starlight, "PIECE", 7)
    assert np.allclose(light_of(stars), whole)


def test_light_is_the_same_everywhere() -> None:
    points = (np.arange(300).reshape(100, 3) * 37 % 101 - 50) / 16
    colors = np.arange(300).reshape(100, 3) * 53 % 256
    found = hashlib.sha256()
    for stretch in ("asinh", "log"):
        stars = Stars(points, np.arange(100) % 7 + 0.5, colors, stretch)  # type: ignore[arg-type]
        found.update(light_of(stars, LOOKING).tobytes())
    assert found.hexdigest()[:16] == "c558a92ccae25bb5"


def test_scene_has_no_lights_and_is_black() -> None:
    scene = vtray.Scene(CAMERA, objects=[Stars([(0, 0, 0)])])
    assert lights_of(scene) == []
    assert settings_of(scene).background == "black"
    scene.add_sphere((0, 0, 0), 1)
    assert len(lights_of(scene)) > 0
    assert settings_of(scene).background == "black"


def test_scenes_with_stars_are_told_apart(tmp_path: Path) -> None:
    scenes = [
        vtray.Scene(CAMERA, [], [Stars([(0, 0, 0)], **options)])
        for options in ({}, {"stretch": "log"}, {"softening": 0.2}, {"peak": 2.0})
    ]
    assert len({scene_hash(scene) for scene in scenes}) == 4
    assert scenes[0].objects[0] == Stars([(0, 0, 0)], softening=0.1)
    assert scenes[0].objects[0] != scenes[1].objects[0]
    for write in (lambda: scenes[0].save(tmp_path / "scene.json"), scenes[0].to_dict):
        with pytest.raises(SceneError, match=r"Scene.objects\[0\]: scene files hold no stars"):
            write()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"emission": -1}, "Stars.emission: expected a number ≥ 0, got -1"),
        ({"stretch": "sqrt"}, 'Stars.stretch: expected "linear", "asinh" or "log", got \'sqrt\''),
        ({"softening": 0}, "Stars.softening: expected a number from 1e-9 to 1e9, got 0"),
        ({"peak": 0}, "Stars.peak: expected a number > 0, got 0"),
    ],
)
def test_wrong_stars(options: Any, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        Stars([(0, 0, 0)], **options)


def test_pictures_of_stars() -> None:
    scene = vtray.Scene(CAMERA, [vtray.Light((0, 0, 9))], [Stars([(3, 0, 0)], peak=0.5)])
    with pytest.raises(RenderError, match="cannot hold stars, as the light of stars is added"):
        vtray.render(scene, background="transparent")
    scene.add_sphere((0, 0, 0), 1)
    scene.objects.append(Stars([(0, 0, -3)], 9.0))
    image = vtray.render(scene, exposure=1, keep_lights=True)
    assert image.pixels[4, 8].tolist() == [255, 255, 255]
    assert image.ids[4, 8].tolist() == [-1, -1]
    assert image.ids[4, 5].tolist() == [1, 0]
    assert image.pick(8, 4) is None
    dark = image.relight([0.0])
    assert np.array_equal(dark.linear, Starlight(lambda: image.depth)(scene))
    assert image.linear[4, 5].min() > 0 == dark.linear[4, 5].max()
    lines = str(vtray.trace_pixel(image, 8, 4)).splitlines()
    assert lines[-3] == "stars        (255, 255, 255), added to that"
    assert not any(line.startswith("samples") for line in lines)
    red = image.recolor(0, "red")
    assert red.pixels[4, 8].tolist() == [255, 0, 0]
    assert np.array_equal(red.linear, vtray.render(red.scene, exposure=1).linear)


def test_growing_pictures_have_stars() -> None:
    shapes = [vtray.Sphere((0, 0, 0), 1, (9, 9, 9), 1), Stars([(3, 0, 0), (0, 0, -3)], peak=0.5)]
    scene = vtray.Scene(CAMERA, [vtray.Light((0, 0, 9))], shapes)
    seen: list[vtray.Image] = []
    image = vtray.render(scene, on_update=seen.append, update_seconds=0, exposure=1, tile=2)
    assert seen
    assert all(part.pixels[4, 8].min() == 255 for part in seen)
    assert image.pixels[4, 5].max() < 20


def test_stars_are_the_same_after_copying() -> None:
    stars = Stars([(0, 0, 0), (1, 1, 1)], 2.0, (1, 2, 3), "log", 0.5, 4.0)
    assert pickle.loads(pickle.dumps(stars)) == stars == copy.deepcopy(stars)
    assert stars.replace(peak=None) != stars


@compiled_only
def test_figures_of_stars() -> None:
    particles = Particles(np.random.default_rng(4).normal(size=(200, 3)), {"heat": np.arange(200)})
    scene = vtray.Scene()
    drawn = scene.add_particles(particles, emission=1.0, color="heat", cmap="plasma")
    assert drawn.stars is scene.objects[0]
    scene.camera = vtray.Camera.fit(scene, size=(120, 90))
    image = vtray.render(scene)
    assert image.pixels.max() > 200
    assert image.pixels[0, 0].max() < 20
    shown = image.annotated(colorbar=True, axes=True, scalebar=True)
    assert shown.pixels.shape == (90, 120, 3)
    assert len(image.figure().axes) == 3
