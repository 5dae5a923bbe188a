"""Cameras that go around a scene, their lights, and cameras between others."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import vtray
from conftest import compiled_only
from vtray.animation.between_cameras import between_cameras
from vtray.animation.keyframes import Keyframes
from vtray.animation.shots import camera_around
from vtray.animation.stage import Look
from vtray.animation.swept import fit_around, upright
from vtray.animation.turned_lights import turned_light
from vtray.base.errors import OutputError, SceneError
from vtray.scene.placing.moved import axes_of
from vtray.scene.scene import Scene

UP = (0.0, 0.0, 1.0)


def pair() -> Scene:
    """Return a scene that is not the same from all sides."""
    scene = vtray.Scene()
    scene.add_spheres([(-1, 0, 0), (1, 0, 0)], [1.0, 0.5], color=["red", "white"])
    return scene


def pixels(folder: Path) -> list[np.ndarray]:
    return [np.asarray(Image.open(path)).astype(int) for path in sorted(folder.glob("*.png"))]


@compiled_only
def test_pictures_are_those_of_a_camera_that_orbits(tmp_path: Path) -> None:
    scene = pair()
    scene.camera = vtray.Camera.look_at((0, -9, 2), (0, 0, 0), up=UP, size=(12, 9))
    before = scene.camera
    vtray.turntable(scene, tmp_path / "%d.png", seconds=0.4, fps=10, samples=2)
    assert scene.camera == before
    found = pixels(tmp_path)
    assert len(found) == 4
    for k, picture in enumerate(found):
        scene.camera = before.orbit(90 * k, about=scene)
        assert (vtray.render(scene, samples=2).pixels == picture).all()


@pytest.mark.parametrize("lights", ["turn", "still"])
def test_lights_go_with_the_camera(lights: str, tmp_path: Path) -> None:
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 0), 1.0, color="white")
    scene.camera = vtray.Camera.look_at((0, -6, 1), (0, 0, 0), up=UP, size=(12, 9))
    scene.lights = [vtray.Light((5, -9, 3)), vtray.Sun((1, 1, -1), 0.3)]
    vtray.turntable(scene, tmp_path / "%d.png", seconds=0.3, fps=10, lights=lights)
    first, second, third = pixels(tmp_path)
    # A ball looks the same from all sides, and so does its shade where that turns, too.
    same = np.abs(first - second).max() <= 1 and np.abs(first - third).max() <= 1
    assert same == (lights == "turn")


def test_each_kind_of_light_turns() -> None:
    middle = (1.0, 0.0, 0.0)

    def turned(light: object) -> object:
        return turned_light(light, 90.0, middle, UP)

    assert turned(vtray.Light((2, 0, 5))) == vtray.Light((1, 1, 5))
    ball = turned(vtray.SphereLight((2, 0, 5), 0.5, radiance=2))
    assert (ball.location, ball.radiance) == (vtray.Vector(1, 1, 5), 2)
    lamp = turned(vtray.RectangleLight((1, 1, 0), [(1, 0, 0), (0, 0, 1)]))
    assert lamp.location == vtray.Vector(0, 0, 0)
    assert [(e.x, e.y, e.z) for e in lamp.edges] == [(0, 1, 0), (0, 0, 1)]
    sun = turned(vtray.Sun((1, 0, -1))).direction
    assert (sun.x, sun.y, sun.z) == (0, 1, -1)
    assert turned(vtray.Sky()) == vtray.Sky()
    assert turned(vtray.Ambient(distance=3)) == vtray.Ambient(distance=3)
    gradient = vtray.Gradient()
    assert turned(vtray.Sky(gradient=gradient, rotation=10)).rotation == 100
    assert turned(vtray.Sky(gradient=gradient, up=(0, 0, -1))).rotation == -90
    tilted = turned(vtray.Sky(gradient=gradient, up=(1, 0, 0)))
    assert (tilted.up.x, tilted.up.y) == (0, 1)
    picture = vtray.Sky(image=np.ones((2, 4, 3)), up=(1, 0, 0))
    with pytest.raises(SceneError, match="turntable: lights: a sky with a picture turns about"):
        turned(picture)


def test_lights_that_stay_need_not_turn(tmp_path: Path) -> None:
    scene = pair()
    scene.lights = [vtray.Sky(image=np.ones((2, 4, 3)), up=(1, 0, 0))]
    how = {"seconds": 0.2, "fps": 10, "size": (4, 3), "samples": 1}
    vtray.turntable(scene, tmp_path / "a" / "%d.png", lights="still", **how)
    assert len(pixels(tmp_path / "a")) == 2
    with pytest.raises(SceneError, match="turntable: lights: a sky with a picture turns about"):
        vtray.turntable(scene, tmp_path / "b" / "%d.png", **how)


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_all_is_seen_from_all_sides(projection: str) -> None:
    generator = np.random.default_rng(3)
    points = generator.normal(size=(200, 3)) * [4, 1, 2]
    scene = vtray.Scene()
    scene.add_spheres(points, 0.3)
    scene.add_copies(vtray.Spheres([(0, 0, 0), (0, 0, 0.2)], 0.2), [(5, 1, 3), (0, 0, -6)])
    first = vtray.Camera.fit(scene, view=(20, 30), projection=projection, size=(120, 80))
    camera, about = fit_around(scene, first)
    assert axes_of(camera)[2] == pytest.approx(axes_of(first)[2])
    all_points = np.concatenate([points, [(5, 1, 3), (5, 1, 3.2), (0, 0, -6), (0, 0, -5.8)]])
    radius = np.r_[np.full(200, 0.3), np.full(4, 0.2)]
    least = np.inf
    for turn in range(0, 360, 15):
        there = camera.orbit(turn, about=about)
        right, down, _ = map(np.array, axes_of(there))
        for way in (right, -right, down, -down):  # what of balls reaches farthest, about
            column, row, _ = there.project(all_points + radius[:, None] * way).T
            edges = [column.min() + 0.5, 119.5 - column.max(), row.min() + 0.5, 79.5 - row.max()]
            least = min(least, *edges)
    assert 0 < least < 12
    assert fit_around(scene, first, 2.0)[0].resolution[0] * 2 == camera.resolution[0]


def test_scene_without_a_camera() -> None:
    scene = pair()
    camera, about = camera_around(scene, Look())
    assert (about.x, about.y, about.z) == (0, 0, 0)
    assert camera.up == vtray.Direction(*UP)


def test_cameras_go_around_what_is_upright() -> None:
    def axis(camera: vtray.Camera, tilt: float = 0.0) -> tuple[float, ...]:
        found = upright(camera, tilt)
        for one, other in zip(axes_of(found), axes_of(camera), strict=True):
            assert one == pytest.approx(other, abs=1e-9)
        return found.up.x, found.up.y, found.up.z

    scene = pair()
    for view in ("front", "iso", (30, 60)):
        assert axis(vtray.Camera.fit(scene, view=view)) == (0, 0, 1)
    assert axis(vtray.Camera.fit(scene, view="top")) == (0, 1, 0)
    leaning = vtray.Camera.look_at((0, -9, 2), (0, 0, 0), up=(1, 0, 3))
    assert axis(leaning) == (1, 0, 3)
    turned = vtray.Camera.fit(scene, direction=(1, 1, -1), up=(1, 2, 4))
    assert axis(turned) == (1, 2, 4)
    tilted = vtray.Camera.fit(scene, direction=(3, 4, 0), up=(-4, 3, 5), size=(8, 6))
    assert axis(tilted) == pytest.approx(np.array([-4, 3, 5]) / 50**0.5)
    lower = (-4 / 50**0.5 - 0.6) / 2**0.5
    assert axis(tilted, 45.0)[0] == pytest.approx(lower)


@pytest.mark.parametrize(
    ("wrong", "kind", "message"),
    [
        ({"seconds": 0}, SceneError, "seconds: expected a number > 0, got 0"),
        ({"seconds": 1e9}, SceneError, "seconds: expected at most 1000000 pictures, got 300000000"),
        ({"seconds": 1e308}, SceneError, "seconds: expected at most 1000000 pictures, got inf"),
        ({"aov": 5}, OutputError, "aov: expected names of depth, .*, got 5"),
        ({"degrees": np.inf}, SceneError, "degrees: expected a number, got "),
        ({"lights": np.arange(2)}, SceneError, "lights: expected 'turn' or 'still', got array"),
        ({"lights": "off"}, SceneError, "lights: expected 'turn' or 'still', got "),
        ({"sample": 4}, TypeError, r"turntable\(\) argument 'sample' is unknown"),
        ({"sampels": 4}, TypeError, "argument 'sampels' is unknown; did you mean \"samples\""),
        ({"degree": 4}, TypeError, "argument 'degree' is unknown; did you mean \"degrees\""),
        ({"scene": vtray.Scene()}, SceneError, "nothing has an end; expected at least one"),
    ],
)
def test_errors(
    wrong: dict[str, object], kind: type[Exception], message: str, tmp_path: Path
) -> None:
    with pytest.raises(kind, match=message):
        vtray.turntable(**{"scene": pair(), "path": tmp_path / "a.gif", **wrong})
    assert not [*tmp_path.iterdir()]


def keys_of(
    cameras: dict[float, vtray.Camera], pivot: tuple[float, float, float]
) -> Keyframes[vtray.Camera]:
    return Keyframes("camera", cameras, partial(between_cameras, pivot=pivot))


def test_keyframes_turn_about_the_middle() -> None:
    camera = vtray.Camera.look_at((3, -8, 2), (3, 0, 0), up=UP)
    middle = (3.0, 0.0, 0.0)
    keys = keys_of({30: camera.orbit(120), 10: camera}, middle)
    assert keys(0) == keys(10) == camera
    assert keys(30) == keys(99) == camera.orbit(120)
    for number, degrees in ((20, 60), (15, 120 * 0.15625)):  # a quarter: 3/16 - 2/64
        found, wanted = keys(number), camera.orbit(degrees)
        for one, other in zip(axes_of(found), axes_of(wanted), strict=True):
            assert one == pytest.approx(other, abs=1e-9)
        for name in "xyz":
            assert getattr(found.center, name) == pytest.approx(getattr(wanted.center, name))


def test_keyframes_zoom_evenly() -> None:
    camera = vtray.Camera.look_at((0, -8, 0), (0, 0, 0), up=UP)
    near = vtray.Camera.look_at((0, -2, 0), (0, 0, 0), up=UP)
    between = keys_of({0: camera, 2: near}, (0.0, 0.0, 0.0))(1)
    assert between.center.y == pytest.approx(-4)
    zoomed = keys_of({0: camera, 2: camera.zoomed(4)}, (0.0, 0.0, 0.0))(1)
    assert zoomed.resolution[0] == pytest.approx(camera.resolution[0] / 2)
    flat = vtray.Camera.orthographic((0, -8, 0), (0, 0, 0), 4, up=UP)
    beside = keys_of({0: flat, 2: flat.zoomed(4)}, (0.0, 9.0, 0.0))(1)
    assert beside.resolution[0] == pytest.approx(flat.resolution[0] / 2)
    assert beside.projection == "orthographic"


def test_keyframes_of_other_kinds() -> None:
    camera = vtray.Camera.look_at((0, -8, 0), (0, 0, 0), up=UP)
    words = r"camera\[5\]: expected a perspective camera of size \(800, 600\), as camera\[0\] is"
    with pytest.raises(SceneError, match=words):
        keys_of({0: camera, 5: camera.resized((8, 6))}, (0.0, 0.0, 0.0))
