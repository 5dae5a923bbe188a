"""Ready-made lights: where they stand, how strong they are, and what they need."""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import once
from vtray import Camera, Scene, SceneError, lights

NAMES = ["rembrandt", "loop", "split", "butterfly", "ring", "cloudy", "lightbox"]
SOFT = ["ring", "cloudy", "lightbox"]
WITH_SIDE = ["rembrandt", "loop", "split"]


def scene_of(up: Any = (0, 1, 0), scale: float = 1.0) -> Scene:
    scene = Scene()
    scene.add_spheres(np.array([(1, 2, 3), (3, 2, 3), (2, 3, 3.5)]) * scale, radius=scale)
    scene.camera = Camera.fit(scene, (1, 2, -3), up=up)
    return scene


def makers(name: str) -> Callable[..., list[Any]]:
    """Return a function that makes lights of points."""
    return partial(getattr(lights, name), points=True)


def lamp_makers(name: str) -> Callable[..., list[Any]]:
    """Return a function that makes lights of lamps with a size."""
    maker: Callable[..., list[Any]] = getattr(lights, name)
    return maker


def places(found: list[vtray.Light]) -> Any:
    return np.array([(light.location.x, light.location.y, light.location.z) for light in found])


def angles(found: list[vtray.Light], scene: Scene) -> Any:
    """Return the angles of lights to the right of the camera and above, in degrees, (n, 2)."""
    forward = np.array([scene.camera.normal.x, scene.camera.normal.y, scene.camera.normal.z])
    forward = forward / np.linalg.norm(forward)
    assert scene.camera.up is not None
    up = np.array([scene.camera.up.x, scene.camera.up.y, scene.camera.up.z])
    up = up - np.dot(up, forward) * forward
    up = up / np.linalg.norm(up)
    right = np.cross(forward, up)
    rays = places(found) - np.array([2, 2.5, 3.25])
    rays = rays / np.linalg.norm(rays, axis=1)[:, None]
    aside = np.degrees(np.arctan2(rays @ right, -rays @ forward))
    return np.stack([aside, np.degrees(np.arcsin(rays @ up))], axis=1)


@pytest.mark.parametrize("up", [(0, 1, 0), (0, 0, 1), (1, -2, 0.5)])
@pytest.mark.parametrize(
    ("name", "where", "ratio"),
    [
        ("rembrandt", [(45, 45), (-30, 10)], 4),
        ("loop", [(35, 30), (-30, 10)], 3),
        ("split", [(90, 10), (0, 5)], 8),
        ("butterfly", [(0, 50), (0, 5)], 3),
    ],
)
def test_key_and_fill(name: str, where: Any, ratio: float, up: Any) -> None:
    scene = scene_of(up)
    options = [{"side": "right"}, {"side": "left"}] if name in WITH_SIDE else [{}]
    for sign, option in zip((1, -1), options, strict=False):
        key, fill = found = makers(name)(scene, 0.5, **option)
        assert angles(found, scene) == pytest.approx(np.array(where) * [sign, 1], abs=1e-9)
        assert (key.intensity, key.intensity / fill.intensity) == (0.5, ratio)
    assert makers(name)(scene, ratio=2)[1].intensity == 0.5
    first = makers(name)(scene)[0]
    assert first == makers(name)(scene, **({"side": "left"} if name in WITH_SIDE else {}))[0]


@pytest.mark.parametrize("name", SOFT)
@pytest.mark.parametrize("count", [1, 2, 16, 50])
def test_soft_lights(name: str, count: int) -> None:
    scene = scene_of()
    found = makers(name)(scene, 2, count=count)
    total = sum(light.intensity for light in found)
    if name == "lightbox":
        assert len(found) >= count
        assert len(found) == 3 * math.isqrt(len(found) // 3) ** 2
        assert total == pytest.approx(6)
    else:
        assert len(found) == count
    if name == "ring":
        assert total == pytest.approx(2)
        rays = np.radians(angles(found, scene))
        off_axis = np.cos(rays[:, 0]) * np.cos(rays[:, 1])
        assert np.degrees(np.arccos(off_axis)) == pytest.approx(12)


@pytest.mark.parametrize("up", [(0, 1, 0), (0, 0, 1), (0, 0, -2), (1, 1, 1)])
def test_sky_is_above(up: Any) -> None:
    scene = scene_of(up)
    found = lights.cloudy(scene, 3, points=True)
    upward = np.array(up) / np.linalg.norm(up)
    rays = places(found) - np.array([2, 2.5, 3.25])
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    heights = rays @ upward
    assert heights.min() > 0
    light = np.array([light.intensity for light in found])
    assert light @ heights == pytest.approx(3)
    # Spread over all sides, and brighter above.
    level = (rays - heights[:, None] * upward) * light[:, None]
    assert np.abs(level.sum(axis=0)).max() < 0.05 * light.sum()
    assert light / light[0] == pytest.approx((1 + 2 * heights) / (1 + 2 * heights[0]))


@pytest.mark.parametrize("name", NAMES)
def test_lights_go_with_the_scale_and_do_not_change(name: str) -> None:
    found = makers(name)(scene_of())
    assert found == makers(name)(scene_of())
    for scale in (1e-9, 1e12):
        scaled = makers(name)(scene_of(scale=scale))
        assert places(scaled) / scale == pytest.approx(places(found), rel=1e-6, abs=1e-6)
        assert [light.intensity for light in scaled] == [light.intensity for light in found]


@pytest.mark.parametrize("name", NAMES)
def test_lights_stand_outside_of_the_subject(name: str) -> None:
    scene = scene_of()
    for place in places(makers(name)(scene)):
        assert np.linalg.norm(place - np.array([2, 2.5, 3.25])) > 5


@pytest.mark.parametrize("name", NAMES)
def test_camera_without_up(name: str) -> None:
    """For a camera of the plain format that looks along z, y points down in the picture."""
    scene = Scene(Camera((0, 0, -9), (0, 0, 1), 1, (9, 9), (0.1, 0.1)))
    scene.add_sphere((0, 0, 0), 1)
    found = places(makers(name)(scene))
    scene.camera = Camera((0, 0, -9), (0, 0, 1), 1, (9, 9), (0.1, 0.1), up=(0, -1, 0))
    assert found == pytest.approx(places(makers(name)(scene)))
    assert found[:, 1].mean() < 1e-9


def scene_on(*planes: tuple[Any, Any], direction: Any = (0, 0, -1)) -> Scene:
    """Return a layer of balls with planes, seen as `Camera.fit` sees it."""
    scene = Scene()
    scene.add_spheres([(x, y, 0.1 * x) for x in range(4) for y in range(3)], radius=0.3)
    for place, normal in planes:
        scene.add_plane(place, normal)
    scene.camera = Camera.fit(scene, direction)
    return scene


FLOOR = ((0, 0, -0.5), (0, 0, 1))
OF_THE_PLACE = ["cloudy", "lightbox"]


@pytest.mark.parametrize("direction", [(0, 0, -1), (0, 1e-4, -1), (0, 0.01, -1), (1, 1, -0.2)])
@pytest.mark.parametrize("floor", [FLOOR, ((0, 0, -0.5), (0, 0, -2))])
@pytest.mark.parametrize("name", OF_THE_PLACE)
def test_no_light_below_the_floor(name: str, floor: Any, direction: Any) -> None:
    """Above all on a map: from straight above, what is up in the picture is north."""
    found = places(makers(name)(scene_on(floor, direction=direction)))
    assert found[:, 2].min() > -0.5


@pytest.mark.parametrize("name", OF_THE_PLACE)
def test_what_is_up_in_the_world(name: str) -> None:
    seen_from_above, without = scene_on(FLOOR), scene_on()
    maker = makers(name)
    assert maker(seen_from_above) == maker(without, up=(0, 0, 3)) == maker(without, up=FLOOR[1])
    # Without a plane, it is the camera that knows.
    assert maker(without) == maker(without, up=(0, 1, 0))
    # What is given wins over the floor, and a floor that the camera stands upright on over a wall.
    assert maker(seen_from_above, up=(0, 1, 0)) == maker(without)
    assert maker(scene_on(FLOOR, ((0, -1, 0), (0, -1, 0)))) == maker(without)
    with pytest.raises(SceneError, match=rf"^lights\.{name}: up: expected numbers x, y and z that"):
        maker(without, up=(0, 0, 0))


def test_sky_straight_above_the_camera() -> None:
    scene = scene_of()
    forward = scene.camera.normal
    scene.camera = Camera.fit(scene, forward, up=(forward.x + 1e-5, forward.y, forward.z))
    assert len(lights.cloudy(scene, points=True)) == 64


@pytest.mark.parametrize("name", NAMES)
def test_what_is_missing(name: str) -> None:
    scene = Scene()
    scene.add_plane((0, 0, 0), (0, 1, 0))
    remedy = "set scene.camera first, for instance to vtray.Camera.fit(scene)"
    with pytest.raises(SceneError) as caught:
        makers(name)(scene)
    words = f"there is no camera to place lights around; {remedy}"
    assert str(caught.value) == f"lights.{name}: {words}"
    scene.camera = scene_of().camera
    with pytest.raises(SceneError, match=rf"^lights\.{name}: nothing has an end; expected at"):
        makers(name)(scene)


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("rembrandt", {"intensity": -1}, "intensity: expected a number ≥ 0, got -1"),
        ("loop", {"side": "up"}, 'side: expected "left" or "right", got \'up\''),
        ("split", {"ratio": 0.5}, "ratio: expected a number ≥ 1, got 0.5"),
        ("butterfly", {"ratio": math.nan}, "ratio: expected a finite number, got nan"),
        ("ring", {"count": 0}, "count: expected an integer from 1 to 4096, got 0"),
        ("cloudy", {"count": 2.5}, "count: expected an integer from 1 to 4096, got 2.5"),
        ("lightbox", {"count": 5000}, "count: expected an integer from 1 to 4096, got 5000"),
    ],
)
def test_wrong_arguments(name: str, options: Any, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        makers(name)(scene_of(), **options)
    assert str(caught.value) == f"lights.{name}: {message}"


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("loop", {"points": 2}, "points: expected true or false, got 2"),
        ("cloudy", {"points": "yes"}, "points: expected true or false, got 'yes'"),
        *(
            (
                name,
                {"count": 9},
                "count: how many points there are, only beside points=True; "
                "leave it out, or add that",
            )
            for name in SOFT
        ),
    ],
)
def test_wrong_arguments_of_lamps(name: str, options: Any, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        lamp_makers(name)(scene_of(), **options)
    assert str(caught.value) == f"lights.{name}: {message}"


MIDDLE = np.array([2, 2.5, 3.25])


def vector(given: Any) -> Any:
    return np.array([given.x, given.y, given.z])


@pytest.mark.parametrize("name", ["rembrandt", "loop", "split", "butterfly"])
def test_lamps_stand_where_points_do(name: str) -> None:
    scene = scene_of()
    key, fill = lamps = lamp_makers(name)(scene, 2)
    points = makers(name)(scene, 2)
    assert [(lamp.location, lamp.intensity) for lamp in lamps] == [
        (point.location, point.intensity) for point in points
    ]
    for lamp, degrees in ((key, 20), (fill, 40)):
        far = np.linalg.norm(vector(lamp.location) - MIDDLE)
        assert 2 * np.degrees(np.arcsin(lamp.radius / far)) == pytest.approx(degrees)


def test_ring_is_around_the_lens() -> None:
    scene = scene_of()
    (lamp,) = lights.ring(scene, 2)
    assert lamp.intensity == 2
    away = vector(lamp.location) - MIDDLE
    towards = -vector(scene.camera.normal)
    assert away / np.linalg.norm(away) == pytest.approx(towards / np.linalg.norm(towards))
    (edge,) = lights.ring(scene, points=True, count=1)
    off_axis = np.linalg.norm(np.cross(vector(edge.location) - MIDDLE, away)) / (away @ away)
    assert lamp.radius / np.linalg.norm(away) == pytest.approx(off_axis)


@once
def test_an_overcast_sky() -> None:
    scene = scene_of(up=(0, 0, 1))
    (sky,) = lights.cloudy(scene, 3)
    assert vector(sky.up) == pytest.approx([0, 0, 1])
    colors = sky.gradient
    assert colors.zenith.r == 3 * colors.horizon.r
    assert (colors.ground.r, colors.ground.g, colors.ground.b) == (0, 0, 0)
    # A white floor with nothing above it shows the intensity.
    floor = Scene(Camera((0, 0, 5), (0, 0, -1), 5, (4, 4), (1, 1)), [sky])
    floor.add_plane((0, 0, 0), (0, 0, 1), color="white", lambert=1)
    shown = vtray.render(floor, exposure=1, tolerance=0.002).linear
    assert shown == pytest.approx(255 * 3, rel=0.01)


def test_panels_face_the_subject_and_are_as_wide_as_far() -> None:
    scene = scene_of()
    panels = lights.lightbox(scene, 2)
    points = lights.lightbox(scene, 2, points=True, count=12)
    assert len(panels) == 3
    for panel, grid in zip(panels, np.array_split(places(points), 3), strict=True):
        away, edges = vector(panel.location) - MIDDLE, [vector(edge) for edge in panel.edges]
        assert panel.intensity == 2
        assert [np.linalg.norm(edge) for edge in edges] == pytest.approx([np.linalg.norm(away)] * 2)
        assert [edge @ away for edge in edges] == pytest.approx([0, 0], abs=1e-9)
        assert grid.mean(axis=0) == pytest.approx(vector(panel.location))


@pytest.mark.parametrize("name", NAMES)
def test_lamps_go_with_the_scale(name: str) -> None:
    usual, scaled = (lamp_makers(name)(scene_of(scale=scale)) for scale in (1.0, 1e9))
    for one, other in zip(usual, scaled, strict=True):
        if isinstance(one, vtray.Sky):
            assert vector(one.up) == pytest.approx(vector(other.up), abs=1e-9)
            continue
        assert vector(other.location) / 1e9 == pytest.approx(vector(one.location), rel=1e-6)
        if isinstance(one, vtray.SphereLight):
            assert other.radius / 1e9 == pytest.approx(one.radius, rel=1e-6)


@pytest.mark.parametrize("given", [None, "scene.json", 5, np.zeros((3, 3)), Camera, Scene])
@pytest.mark.parametrize("name", ["butterfly", "cloudy", "lightbox", "ring", "split", "studio"])
def test_lights_of_what_is_no_scene(name: str, given: Any) -> None:
    message = rf"^lights\.{name}: scene: expected a vtray\.Scene with a camera, got "
    with pytest.raises(SceneError, match=message):
        getattr(lights, name)(given)
