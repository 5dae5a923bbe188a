"""Lines around what is seen lie where it ends, and are as wide as they should be."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from examples import cylinder, light, plane, scene, sphere

import vtray
from conftest import JIT, compiled_only, once
from vtray.base.compiler.compiled import Device
from vtray.scene.style import Outline, Style

SIZE = 40 if JIT else 30
SIDE = {"size": [SIZE, SIZE], "resolution": [0.1, 0.1], "projection": "orthographic"}


def world(*objects: dict, **camera: Any) -> vtray.Scene:
    """Return a scene seen squarely along z, ten pixels for each unit of length."""
    return vtray.loads(json.dumps(scene([*objects], [light(0, 0, -10)], **{**SIDE, **camera})))


def lines_of(found: vtray.Scene, outline: object = True, **settings: Any) -> np.ndarray:
    """Return how much of each pixel lines hide: they are all that is in a dark scene."""
    dark = vtray.Scene(found.camera, [], found.objects)
    how = {"background": "transparent", "outline": outline, **settings}
    image = vtray.render(dark, warn=lambda _: None, **how)
    if not image.overlays:
        return np.zeros(image.linear.shape[:2])
    return image.overlays[-1].share


def ring(x: float, y: float, radius: float, width: float) -> np.ndarray:
    """Return how much of each pixel a circle hides that is drawn with a pen; all in pixels."""
    rows, columns = np.mgrid[:SIZE, :SIZE] - SIZE / 2
    off = np.abs(np.hypot(columns - x, rows - y) - radius)
    return np.clip(width / 2 + 0.5 - off, 0.0, min(width, 1.0))


@once
@pytest.mark.parametrize("width", [0.5, 1.0, 2.5])
@pytest.mark.parametrize("samples", [1, 4])
def test_a_ball_has_a_circle_around_it(width: float, samples: int) -> None:
    found = world(sphere((0.033, -0.021, 5), 0.83))
    drawn = lines_of(found, width, samples=samples)
    expected = ring(0.33, -0.21, 8.3, width)
    assert np.abs(drawn - expected).max() < 0.13
    assert abs(drawn.sum() / expected.sum() - 1) < 0.02


@once
def test_samples_do_not_change_lines() -> None:
    found = world(sphere((0, 0, 5), 1), sphere((0.7, 0.4, 5), 0.8), plane((0, 0, 9), (0, 1, -5)))
    np.testing.assert_array_equal(lines_of(found), lines_of(found, samples=4))


@once
@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_all_threads_and_tiles_draw_the_same(projection: str) -> None:
    found = world(
        *(sphere((k % 3 - 1, k // 3 - 1, 5 + k), 0.7) for k in range(9)), projection=projection
    )
    how = {"outline": 2, "fog": True, "samples": 2, "background": "white"}
    expected = vtray.render(found, threads=1, **how)
    for threads, tile in ((2, 16), (3, 7)):
        image = vtray.render(found, threads=threads, tile=tile, **how)
        np.testing.assert_array_equal(image.pixels, expected.pixels)


@once
def test_lines_between_objects_and_particles() -> None:
    # Two balls that meet in the plane x = 0, where no distance jumps.
    centers, radius = [(-0.5, 0, 5), (0.5, 0, 5)], 0.8
    apart = world(*(sphere(center, radius) for center in centers))
    together = vtray.Scene(
        apart.camera, apart.lights, [vtray.Spheres(centers, radius, (255, 0, 0), 1)]
    )
    middle = SIZE // 2, SIZE // 2
    for found, borders, expected in [
        (apart, "objects", True),
        (apart, "particles", True),
        (apart, "none", False),
        (together, "objects", False),
        (together, "particles", True),
        (together, "none", False),
    ]:
        drawn = lines_of(found, {"borders": borders})
        assert bool(drawn[middle] > 0.8) is expected
        assert drawn[SIZE // 2, SIZE // 2 - 13] > 0.4


def test_jumps_of_distance() -> None:
    # A line has its full width where it jumps by 3 % of the picture's width, and none for 1 %.
    for behind, expected in [(0.005, 0.0), (0.5, 1.0)]:
        found = world(
            plane((0, 0, 5 + behind * SIZE / 10), (0, 0, -1)), cylinder((-9, 0, 6), (9, 0, 6), 1.0)
        )
        drawn = lines_of(found, {"borders": "none"})
        column = drawn[:, SIZE // 2]
        assert column.max() == pytest.approx(expected, abs=0.15)


def test_creases() -> None:
    found = world(cylinder((0, 0, 5), (0.5, 1, 5.5), 0.9))
    plain, creased = (lines_of(found, {"normals": normals}) for normals in (False, True))
    assert (creased >= plain - 0.5).all()
    assert creased.sum() > plain.sum() + 5


def test_what_is_as_small_as_pixels_has_none() -> None:
    found = world(*(sphere((k % 7 / 3 - 1, k // 7 / 3 - 1, 5), 0.11) for k in range(49)))
    assert not lines_of(found).any()


def test_lines_are_as_wide_at_the_sides_of_the_picture() -> None:
    drawn = lines_of(world(cylinder((-9, 0.03, 5), (9, 0.03, 5), 1.2)))
    assert (drawn.max(axis=0) == drawn.max()).all()
    narrow = lines_of(world(cylinder((-9, 0.03, 5), (9, 0.03, 5), 1.2), size=[2, SIZE]))
    assert (narrow.max(axis=0) == drawn.max()).all()


@once
@pytest.mark.skipif(JIT, reason="its kernels take half a minute to compile")
def test_lines_around_bodies_from_within() -> None:
    scene = vtray.Scene(lights=[vtray.Light((0, 0, 0), 1)])
    centers = [(0, 0, 0), (0.2, 0.9, 0.1), (0.7, 0.2, 0.9)]
    scene.add_spheres(centers, [1.5, 1.5, 1.4], color="skyblue", opacity=0.8)
    scene.camera = vtray.Camera.look_at(
        (0, 0.2, 0), target=(2, 0.5, 0.6), up=(0, 0, 1), fov_degrees=90, size=(36, 24)
    )
    # The body has no inner walls, and its far side no jumps.
    assert not lines_of(scene, {"borders": "none"}).any()
    plain = lines_of(scene, {"borders": "particles"})
    foggy = lines_of(scene, {"borders": "particles"}, fog=(1.2, 2.5))
    assert 0.2 * plain.sum() < foggy.sum() < 0.7 * plain.sum()


def test_fog_hides_lines_too() -> None:
    found = world(sphere((0, 0, 5), 0.8))
    plain = lines_of(found)
    # The ball's rim is at a distance of 15.
    np.testing.assert_allclose(lines_of(found, fog=(10, 20)), plain / 2, atol=0.03)
    assert not lines_of(found, fog=(1, 2)).any()


@once
@pytest.mark.parametrize("background", ["black", "#204060", "transparent", "sky"])
def test_lines_are_laid_over_the_picture(background: str) -> None:
    found = world(sphere((0, 0, 5), 0.8))
    found.lights = [vtray.Sky(color=(128, 160, 192)), *found.lights]
    how = {"exposure": 0.4, "background": background, "samples": 2}
    plain = vtray.render(found, **how)
    image = vtray.render(found, outline=(2, (200, 100, 0)), **how)
    share = image.overlays[0].share
    np.testing.assert_array_equal(image.linear, plain.linear)
    np.testing.assert_array_equal(image.depth, plain.depth)
    color, before = np.array([200, 100, 0]), plain.pixels.astype(float)
    alpha = np.ones((*share.shape, 1))
    if background == "transparent":
        before, alpha = before[..., :3] * before[..., 3:] / 255, before[..., 3:] / 255
        after = image.pixels[..., 3:] / 255
        np.testing.assert_allclose(after, 1 - (1 - alpha) * (1 - share[..., None]), atol=0.005)
        found_pixels = image.pixels[..., :3] * after
    else:
        found_pixels = image.pixels.astype(float)
    expected = before * (1 - share[..., None]) + share[..., None] * color
    assert np.abs(found_pixels - expected).max() <= 2


@once
def test_other_lights_and_colours_have_the_same_lines(tmp_path: Path) -> None:
    found = world(sphere((0, 0, 5), 0.8), sphere((0.5, 0.5, 7), 0.9))
    found.style = Style(outline=2)
    kept = vtray.render(found, keep_lights=True, samples=2)
    for changed in (kept.relight([0.3]), kept.recolor(0, "lime")):
        expected = vtray.render(changed.scene, samples=2)
        np.testing.assert_array_equal(changed.pixels, expected.pixels)
    kept.save(tmp_path / "a.png")
    told = vtray.read_provenance(tmp_path / "a.png").style
    assert told == found.style
    plain = vtray.Scene(found.camera, found.lights, found.objects)
    again = vtray.render(plain, samples=2, outline=told.outline)
    np.testing.assert_array_equal(again.pixels, kept.pixels)


def test_a_pixel_is_explained() -> None:
    found = world(sphere((0, 0, 5), 0.8))
    image = vtray.render(found, outline=(3, "red"), exposure=1.0)
    x, y = SIZE // 2 - 7, SIZE // 2
    tree = vtray.trace_pixel(image, x, y)
    ((red, green, _),) = tree.exposed.overlays
    assert (red, green) == (pytest.approx(255 * image.overlays[0].share[y, x]), 0)
    assert tree.exposed.drawn == tuple(image.drawn[y, x])
    assert "what lines and shade leave of it" in str(tree)
    assert vtray.trace_pixel(image, SIZE // 2, y).exposed.drawn is None


@once
def test_eye_dome_lighting_as_it_is_told() -> None:
    found = world(plane((0, 0, 8), (0.2, 0, -1)), sphere((0, 0, 6), 1), sphere((1.5, 1, 3), 0.6))
    plain = vtray.render(found, exposure=1.0)
    image = vtray.render(found, exposure=1.0, eye_dome=(0.7, 2))
    np.testing.assert_array_equal(image.linear, plain.linear)
    depth = image.depth
    places = [(2, 0), (1, 1), (0, 2), (-1, 1), (-2, 0), (-1, -1), (0, -2), (1, -1)]
    places += [(1, 0), (0, 1), (-1, 0), (0, -1)]
    for y, x in [
        (SIZE // 2, SIZE // 2),
        (SIZE // 2, SIZE // 2 + 10),
        (0, 0),
        (SIZE // 2 + 8, SIZE // 2 + 8),
    ]:
        inside = [(a, b) for a, b in places if 0 <= x + a < SIZE and 0 <= y + b < SIZE]
        # Slopes: by how much the surroundings are nearer, over how far they are; 0.1 is a pixel.
        slopes = [
            max((depth[y, x] - depth[y + b, x + a]) / (0.1 * np.hypot(a, b)), 0) for a, b in inside
        ]
        darkness = 0.7 * float(np.mean(slopes))
        share = 1 / (1 + darkness + darkness**2 / 2)
        np.testing.assert_allclose(image.drawn[y, x], plain.linear[y, x] * share, rtol=2e-3)
    np.testing.assert_array_equal(
        vtray.render(found, exposure=1.0, eye_dome=(0.7, 2), threads=3, tile=7).pixels, image.pixels
    )


def test_eye_dome_lighting_of_a_wall_is_none() -> None:
    found = world(plane((0, 0, 5), (0, 0, -1)))
    image = vtray.render(found, eye_dome=True, samples=2)
    np.testing.assert_array_equal(image.drawn, image.linear)
    assert isinstance(Style(outline=True).outline, Outline)


@pytest.mark.skipif(JIT, reason="its kernels take half a minute to compile")
def test_lines_around_what_is_found_in_another_way() -> None:
    ball, other = sphere((0.2, 0, 5), 0.83), cylinder((-1, -1, 6), (1, 0.5, 7), 0.4)
    plain = world(ball, other)
    expected = lines_of(plain)
    assert expected.sum() > 60
    # Layers are asked for surfaces by themselves, and so are scenes with a lens.
    faded = world({**ball, "opacity": 0.9}, {**other, "opacity": 0.9})
    np.testing.assert_allclose(lines_of(faded), expected, atol=1e-6)
    with_lens = world(ball, other, projection="perspective", focus=20)
    sharp = lines_of(with_lens)
    with_lens.camera = with_lens.camera.replace(lens=vtray.Lens(radius=0.2, focus_distance=25))
    np.testing.assert_array_equal(lines_of(with_lens, samples=2), sharp)
    # What is placed is found through its place, and what is cut through its planes.
    placed = world({"type": "copies", "objects": [ball, other], "at": [{"x": 0, "y": 0, "z": 0}]})
    borders = {"borders": "particles"}
    np.testing.assert_array_equal(lines_of(placed, borders), lines_of(plain, borders))
    drawn = lines_of(world(ball), clip=vtray.ClipPlane((0, 1, 0), 0))
    halves = drawn[: SIZE // 2 - 1], drawn[SIZE // 2 + 2 :]
    assert min(half.sum() for half in halves) == 0.0
    assert drawn.sum() == pytest.approx(8.3 * (np.pi + 2), rel=0.05)


@compiled_only
def test_python_calls_no_function_of_kernels(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(self: Device, *arguments: object) -> None:
        raise AssertionError(self)  # it would load the compiler, which takes a second

    monkeypatch.setattr(Device, "__call__", refuse)
    given = vtray.Scene(lights=[vtray.Light((0, 9, 0))])
    given.add_sphere((0, 0, 3), 1)
    given.camera = vtray.Camera.panorama((0, 0, 0), (0, 0, 1), size=(16, 8))
    image = vtray.render(given, outline=Outline(normals=True), eye_dome=True, fog=True)
    assert image.pixels.any()
