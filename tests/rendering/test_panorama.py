"""Panoramas: where their rays go, and what they see, by formulas and an independent renderer."""

import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from examples import light, plane, sphere, xyz
from hierarchies import ALWAYS, NEVER
from hierarchies import render as render_scene
from oracle_whitted import Ball, Floor, View, seen
from scene_text import message_of

import vtray
from conftest import JIT, compiled_only, once
from vtray.base.compiler.compiled import uncompiled
from vtray.rendering import hierarchy as acceleration
from vtray.rendering.pack import _pack_camera
from vtray.transport.camera_rays import camera_ray

SIZE = (64, 32) if JIT else (12, 6)
BALLS = [
    ((3.0, 0.2, 1.0), 1.0),
    ((-2.0, 1.0, -3.0), 1.4),
    ((0.3, -4.0, 0.2), 0.8),
    ((-1.0, 1.5, 2.5), 0.5),
    ((1.0, -0.5, -6.0), 1.5),
]
FLOORS = [((0.0, 3.0, 0.0), (0.1, -1.0, 0.05)), ((0.0, 0.0, 9.0), (0.0, 0.3, -1.0))]
LAMPS = [((1.0, -8.0, 2.0), 1.0), ((-6.0, -1.0, -5.0), 0.5)]
EYE = (0.2, -0.3, 0.1)


def document(**camera: Any) -> Any:
    """Return what is all around a camera."""
    return {
        "camera": {
            "center": xyz(*EYE),
            "normal": xyz(0.2, 0.1, 1),
            "focus": 1,
            "size": list(SIZE),
            "resolution": [1, 1],
            "up": xyz(0.1, -1, 0),
            "projection": "panorama",
            **camera,
        },
        "lights": [light(*place, intensity=intensity) for place, intensity in LAMPS],
        "objects": [
            *(sphere(center, radius) for center, radius in BALLS),
            *(plane(center, normal) for center, normal in FLOORS),
        ],
    }


def render(given: Any, few: int = acceleration.FEW, **options: Any) -> vtray.Image:
    return render_scene(vtray.loads(json.dumps(given)), few, **options)


def directions(given: Any) -> np.ndarray:
    """Return where the pixels of a panorama look, (height, width, 3), in plain NumPy."""
    width, height = given["camera"]["size"]
    rows, columns = np.mgrid[0:height, 0:width]
    turn = 2 * np.pi * ((columns + 0.5) / width - 0.5)
    rise = np.pi * (0.5 - (rows + 0.5) / height)
    ahead, up = (
        np.array([given["camera"][name][axis] for axis in "xyz"], float)
        for name in ("normal", "up")
    )
    ahead = ahead / np.linalg.norm(ahead)
    up = up - ahead * (up @ ahead)
    up = up / np.linalg.norm(up)
    right = np.cross(ahead, up)
    level = np.cos(turn)[..., None] * ahead + np.sin(turn)[..., None] * right
    found: np.ndarray = np.cos(rise)[..., None] * level + np.sin(rise)[..., None] * up
    return found


class Everywhere(View):
    """There is no image plane."""

    def has(self, point: Any) -> bool:
        return True


def light_by_oracle(given: Any, ways: np.ndarray, kind: str = "matt", bounces: int = 0) -> Any:
    """Return the light along directions, (..., 3)."""
    white = np.full(3, 255.0)
    shapes: list[Any] = [Ball(np.array(center), radius, white, kind) for center, radius in BALLS]
    shapes += [
        Floor(np.array(center), np.array(normal) / np.linalg.norm(normal), white)
        for center, normal in FLOORS
    ]
    lamps = [(np.array(place), intensity) for place, intensity in LAMPS]
    view = Everywhere(np.zeros(3), np.zeros(3))
    start = np.array([given["camera"]["center"][axis] for axis in "xyz"])
    found = [
        seen(view, shapes, lamps, start, way, np.ones(3), bounces) for way in ways.reshape(-1, 3)
    ]
    return np.array(found).reshape(ways.shape)


def test_rays_go_all_around() -> None:
    camera = vtray.loads(json.dumps(document())).camera
    frame, expected = _pack_camera(camera, 1.0), directions(document())
    for row in range(SIZE[1]):
        for column in range(SIZE[0]):
            ray = uncompiled(camera_ray)(frame, float(column), float(row))
            np.testing.assert_allclose(ray.direction, expected[row, column], atol=1e-15)
            assert ray.origin == (0.0, 0.0, 0.0)
    # A turn farther to a side is the same place, and beyond the pole is the other side.
    one, other = (
        uncompiled(camera_ray)(frame, *place).direction
        for place in ((1.25, -1.0), (1.25 + SIZE[0] / 2, 0.0))
    )
    np.testing.assert_allclose(one, other, atol=1e-15)


def test_picture_is_that_of_an_independent_renderer() -> None:
    image = render(document())
    np.testing.assert_allclose(
        image.linear, light_by_oracle(document(), directions(document())), atol=1e-9
    )
    assert (image.linear.max(axis=2) > 20).mean() > 0.3


@once
def test_mirrors_show_what_is_behind_the_camera() -> None:
    given = document(size=[24, 12])
    for item in given["objects"][: len(BALLS)]:
        item["material"] = "mirror"
    image = render(given, integrator="whitted", depth=3)
    expected = light_by_oracle(given, directions(given), "mirror", 3)
    np.testing.assert_allclose(image.linear, expected, atol=1e-7)


@once
def test_same_bytes_on_any_threads_and_tiles_and_with_any_hierarchy() -> None:
    one = render(document(), samples=5, threads=1)
    for few in (ALWAYS, NEVER):
        for options in ({"threads": 3}, {"threads": 2, "tile": 7}):
            other = render(document(), few, samples=5, **options)
            assert np.array_equal(one.linear, other.linear)
            assert np.array_equal(one.depth, other.depth)


@compiled_only
def test_pixels_without_samples_look_the_same_everywhere() -> None:
    # The oracle's rays through many places of such a pixel differ by no more than smooth light.
    image = render(document(), samples=2, keep_lights=True)
    marks = image._relighting._passes[1].first >= 0
    assert 0.05 < marks.mean() < 0.95
    whole = render(document(size=[512, 256]))
    fine = whole.linear.reshape(32, 8, 64, 8, 3)
    ids = whole.ids[..., 0].reshape(32, 8, 64, 8)
    for row, column in zip(*np.nonzero(~marks), strict=True):
        assert len(np.unique(ids[row, :, column])) == 1
        assert np.ptp(fine[row, :, column, :, 0]) < 40


@compiled_only
@pytest.mark.parametrize("place", [(0, 0, 5), (0, 5, 0), (0, 0, -5), (-3, -4, 0.1), (5, 0, 0)])
def test_solid_angles(place: tuple[float, ...]) -> None:
    given = document(center=xyz(0, 0, 0), size=[200, 100])
    given["objects"] = [sphere(place, 0.5)]
    cover = render(given, samples=64, filter="box").alpha
    rise = np.pi * (0.5 - (np.arange(100) + 0.5) / 100)
    angle = (cover * np.cos(rise)[:, None]).sum() * np.pi / 100 * 2 * np.pi / 200
    exact = 2 * np.pi * (1 - np.sqrt(1 - (0.5 / np.linalg.norm(place)) ** 2))
    assert angle == pytest.approx(exact, rel=2e-2)


def test_everything_exists_and_from_within_too() -> None:
    given = document(center=xyz(0, 0, 0))
    given["objects"] = [sphere((0.2, 0, 0.1), 2.0)]
    given["lights"] = [light(0, 0.5, 0)]
    for options in ({}, {"samples": 3}):
        image = render(given, **options)
        assert (image.alpha == 1).all()
        assert (image.linear > 0).all()
    expected = np.sqrt(4 - 0.05 + (directions(given) @ [0.2, 0, 0.1]) ** 2)
    np.testing.assert_allclose(
        render(given).depth, expected + directions(given) @ [0.2, 0, 0.1], rtol=1e-12
    )


@once
def test_tiny_pictures_and_all_that_goes_with_them() -> None:
    given = vtray.loads(json.dumps(document()))
    given.add_sphere((1, 0.5, 1), 0.8, "navy", opacity=0.4)
    given.add_cylinder((2, 0, -3), (2, 1, 4), 0.3, "red")
    given.add_light(vtray.SphereLight((0, -8, 0), 1.5, visible=True))
    given.add_light(vtray.Sky(gradient=vtray.Gradient(), radiance=0.3))
    given.style = vtray.Style(fog=(1, 40), outline=1.0, eye_dome=True)
    for size in ((64, 32), (1, 1), (2, 1), (4, 2), (3, 9)):
        options = {"samples": 8, "background": "sky", "size": size}
        one, other = (vtray.render(given, threads=n, **options) for n in (1, 3))
        assert np.array_equal(one.pixels, other.pixels)


@once
def test_panorama_of_a_sky_is_its_picture() -> None:
    rng = np.random.default_rng(7)
    picture = rng.uniform(0.1, 1.0, (16, 32, 3)).astype(np.float32)
    made = vtray.Scene(vtray.Camera.panorama((0, 0, 0), (0, 0, 1), up=(0, 1, 0), size=(32, 16)))
    made.lights = [vtray.Sky(image=picture)]
    made.add_sphere((0, -50, 0), 0.1)
    image = vtray.render(made, background="sky", exposure=1.0)
    found = image.pixels / 255.0
    shifts = [np.abs(np.roll(picture, k, axis=1)[1:-1] - found[1:-1]).max() for k in range(32)]
    assert min(shifts) < 0.01


def test_project_and_pick() -> None:
    camera = vtray.loads(json.dumps(document(size=[64, 32]))).camera
    ways = directions(document(size=[64, 32]))
    rows, columns = np.mgrid[0:32, 0:64]
    distance = np.linspace(0.1, 9, rows.size).reshape(rows.shape)
    found = camera.project(np.array(EYE) + distance[..., None] * ways)
    np.testing.assert_allclose(found, np.stack([columns, rows, distance], axis=-1), atol=1e-9)
    assert np.isnan(camera.project(EYE)).all()


def test_cameras_made_of_panoramas() -> None:
    camera = vtray.Camera.panorama((0, -8, 1), (0, 0, 1), up=(0, 0, 1), size=(8, 4))
    assert camera.center == vtray.Vector(0, -8, 1)
    assert camera.projection == "panorama"
    turned = camera.orbit(90)
    place = (turned.center.x, turned.center.y, turned.center.z)
    np.testing.assert_allclose(place, (8, 0, 1), atol=1e-6)
    np.testing.assert_allclose((turned.normal.x, turned.normal.y), (-1, 0), atol=1e-9)
    assert camera.resized((4, 2)).size == (4, 2)
    subject = vtray.Scene()
    subject.add_sphere((0, 0, 0), 1)
    for call, words in (
        (lambda: camera.stereo(0.1), "Camera.stereo: not for a panorama"),
        (lambda: camera.zoomed(2), "Camera.zoomed: not for a panorama"),
        (
            lambda: vtray.Camera.fit(subject, projection="panorama"),  # type: ignore[arg-type]
            'Camera.fit: projection: expected "perspective" or "orthographic", got',
        ),
        (lambda: camera.replace(lens=vtray.Lens(0.1, 5)), "lens: expected none beside the proj"),
        (lambda: vtray.Camera.panorama((0, 0, 0), (0, 0, 0)), "Camera.panorama: target: "),
        (lambda: vtray.Camera.panorama((0, 0, 0), (0, 1, 0)), "Camera.panorama: up: "),
    ):
        with pytest.raises(vtray.SceneError, match=words):
            call()


@pytest.mark.parametrize("integrator", ["direct", "path"])
def test_rays_are_told(integrator: str) -> None:
    given = vtray.loads(json.dumps(document()))
    image = vtray.render(given, integrator=integrator, exposure=1)
    height, width = image.depth.shape
    for y in range(0, height, 3):
        for x in range(0, width, 3):
            tree = vtray.trace_pixel(image, x, y)
            assert tree.light == tuple(image.linear[y, x])
            assert tree.origin == EYE
            assert (math.inf if tree.hit is None else tree.hit.distance) == image.depth[y, x]
            assert tree.view.forward == tree.direction
            assert abs(np.dot(tree.view.down, tree.direction)) < 1e-12


@pytest.mark.parametrize("where", [(0, 0), (2, 1), (4, 3)])
def test_rays_are_drawn(where: tuple[int, int]) -> None:
    tree = vtray.trace_pixel(vtray.loads(json.dumps(document())), *where)
    axes = tree.draw()
    words = [text.get_text() for text in axes.texts]
    assert "eye" in words
    assert not any("image plane" in text for text in words)


def test_rays_straight_up_and_down_are_drawn() -> None:
    given = vtray.Scene(vtray.Camera.panorama((0, 0, 0), (0, 1, 0), up=(0, 0, 1), size=(3, 1)))
    given.camera = given.camera.replace(normal=(0, 0, 1), up=(0, 1, 0))
    given.add_sphere((0, 0, 5), 1)
    assert vtray.trace_pixel(given, 1, 0).hit is not None
    assert vtray.trace_pixel(given, 0, 0).draw().texts


def test_what_cannot_be_had_is_refused() -> None:
    given = vtray.loads(json.dumps(document()))
    image = vtray.render(given)
    with pytest.raises(vtray.VtrayError, match="scalebar: lengths differ"):
        image.figure(scalebar="nm")
    assert "camera.projection" in message_of(json.dumps(document(projection="fisheye")))
    assert '"panorama"' in message_of(json.dumps(document(projection="fisheye")))


def test_focus_and_resolution_say_nothing() -> None:
    one, other = document(), document(focus=1e-5, resolution=[3, 1e9])
    assert np.array_equal(render(one).linear, render(other).linear)


def rolled(picture: Callable[[tuple[int, int, int]], np.ndarray]) -> int:
    """Return how far a picture is at the most from that of who looks the other way."""
    one, other = (picture(target).astype(int) for target in ((0, 0, 1), (0, 0, -1)))
    return np.abs(np.roll(one, one.shape[1] // 2, axis=1) - other).max()


@once
@pytest.mark.parametrize(
    "style",
    [
        {},
        {"outline": 2},
        {"outline": 5, "samples": 4},
        {"outline": vtray.Outline(normals=True)},
        {"eye_dome": (3, 8)},
    ],
    ids=str,
)
def test_what_is_drawn_goes_on_at_the_other_edge(style: dict[str, Any]) -> None:
    size = (96, 48) if JIT else (32, 16)

    def picture(target: tuple[int, int, int]) -> np.ndarray:
        scene = vtray.Scene(lights=[vtray.Ambient(distance=1e-9)])
        scene.add_cylinder((0.5, -9, -5), (0.5, 9, -5), 0.5)  # whose left edge is at the seam
        scene.add_cylinder((-5, -9, -5), (2, 9, -5), 0.3)
        scene.add_sphere((0.02, 3, -6), 0.7)
        scene.add_plane((0, -4, 0), (0, 1, 0))
        scene.camera = vtray.Camera.panorama((0, 0, 0), target, size=size)
        return vtray.render(scene, exposure=0.8, background="white", **style).pixels

    # Places of samples are of the picture, not of the world.
    assert rolled(picture) <= (1 if style.get("samples", 1) == 1 else 40)


def test_small_panoramas_have_lines_wider_than_themselves() -> None:
    scene = vtray.Scene(camera=vtray.Camera.panorama((0, 0, 0), (0, 0, 1), size=(2, 1)))
    scene.add_sphere((0, 0, 3), 1)
    assert vtray.render(scene, outline=9, eye_dome=(2, 30)).pixels.shape == (1, 2, 3)


def test_figures_have_no_scale_bar_unless_one_is_asked_for() -> None:
    pytest.importorskip("matplotlib")
    scene = vtray.Scene(camera=vtray.Camera.panorama((0, 0, 0), (0, 0, 1), size=(40, 20)))
    scene.add_sphere((0, 0, 3), 1)
    image = vtray.render(scene)
    assert image.figure() is not None
    with pytest.raises(vtray.VtrayError, match="scalebar: lengths differ"):
        image.figure(scalebar="nm")


@once
@pytest.mark.parametrize("point", [(0, 5, 0), (0, -5, 0), (0, 0, -5), (1e-12, 0, -5)])
def test_labels_at_all_edges_are_shown(point: tuple[float, ...]) -> None:
    size = (300, 150) if JIT else (80, 40)
    scene = vtray.Scene(camera=vtray.Camera.panorama((0, 0, 0), (0, 0, 5), size=size))
    scene.add_sphere((0, 0, 9), 1)
    image = vtray.render(scene, background="white")
    marked = image.annotated(labels=[("X", point)], fontsize=8)
    assert (marked.pixels != image.pixels).any()
