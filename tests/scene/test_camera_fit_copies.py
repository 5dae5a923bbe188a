"""Cameras and lights that are fitted to copies: as to the same objects written out."""

import time
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_camera_fit import directions
from written_out import written_out

import vtray
from conftest import once
from vtray import Camera, Copies, Cylinder, Cylinders, Plane, Scene, SceneError, Sphere, Spheres
from vtray.scene.placing import bounding_sphere as around
from vtray.scene.placing import seen
from vtray.scene.placing.bounding_sphere import bounding_sphere
from vtray.scene.placing.bounds import Balls, balls_of, box_of


def some_copies(seed: int, scale: float = 1.0, far: float = 0.0) -> Copies:
    """Return copies of objects of all kinds, with radii and extents of all sizes."""
    random = np.random.default_rng(seed)
    start, end = random.normal(size=(2, 5, 3)) * scale
    radius = random.uniform(0, scale, 5) * random.choice([0.01, 1, 5])
    parts: list[Any] = [
        Spheres(start.astype("f4"), radius),
        Cylinders(start, end, radius),
        Spheres(end, 0.1 * scale),
        Sphere(start[0], 2 * radius[0]),
        Cylinder(start[1], end[1], radius[1]),
        Spheres([], 1),
    ]
    chosen = [parts[k] for k in random.permutation(6)[: random.integers(1, 6)]]
    at = random.normal(size=(random.integers(1, 9), 3)) * random.choice([0.1, 1, 20]) + far
    return Copies([parts[random.integers(0, 3)], *chosen], at * scale)


def scenes(copies: Copies, *more: Any) -> tuple[Scene, Scene]:
    """Return a scene with copies, and the same with them written out."""
    objects = [*more, copies]
    return Scene(None, [], objects), Scene(None, [], written_out(objects))


def numbers(camera: Camera) -> np.ndarray:
    """Return what is fitted, as numbers: place, focus and pixels."""
    center = camera.center
    return np.array([center.x, center.y, center.z, camera.focus, *camera.resolution])


@once
@settings(max_examples=60)
@given(
    seed=st.integers(0, 10**6),
    scale=st.sampled_from([1.0, 1e-9, 1e6]),
    far=st.sampled_from([0.0, 1e4]),
    direction=directions(),
    projection=st.sampled_from(["perspective", "orthographic"]),
    fov=st.sampled_from([1.0, 40.0, 130.0]),
    size=st.sampled_from([(800, 600), (31, 31), (1, 20)]),
    is_alone=st.booleans(),
)
def test_fit_is_that_of_the_objects_written_out(
    seed: int,
    scale: float,
    far: float,
    direction: Any,
    projection: Any,
    fov: float,
    size: tuple[int, int],
    is_alone: bool,
) -> None:
    copies = some_copies(seed, scale, far)
    more = (
        [] if is_alone else [Sphere((scale, -scale, 2 * scale), scale), Plane((0, 0, 0), (1, 2, 3))]
    )
    how: Any = {"direction": direction, "projection": projection, "fov_degrees": fov, "size": size}
    one, other = (Camera.fit(scene, **how) for scene in scenes(copies, *more))
    extent = np.subtract(*box_of(balls_of(copies, "test"))[::-1]).max() + 10 * scale
    loose = 1e-9 * abs(numbers(other)) + 1e-12 * (1 + far) * extent
    assert np.all(abs(numbers(one) - numbers(other)) <= loose)
    if is_alone:
        assert Camera.fit(copies, **how) == one


@pytest.mark.parametrize("direction", [(0, 0, -1), (1, 2, -1)])
def test_few_are_chosen_of_many(direction: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(5)
    start, end = random.random((2, 2000, 3))
    copies = Copies([Spheres(start, 0.1), Cylinders(start, end, 0.2)], 3 * random.random((3000, 3)))
    for fov in (1, 40, 120):
        cameras = []
        for many in (10**6, 1):
            monkeypatch.setattr(seen, "MANY", many)
            monkeypatch.setattr(seen, "SAMPLE", 128)
            cameras.append(Camera.fit(copies, direction, fov_degrees=fov))
        assert cameras[0] == cameras[1]


@pytest.mark.parametrize("slope", [-0.7, 1.3])
def test_bounds_change_with_the_slope_as_they_say(slope: float) -> None:
    axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    balls = Balls(np.array([(1.0, 2, 3)]), 2.0, at=np.array([(0.0, 5, -7), (1.0, 2, 4)]))
    look = seen.look(balls, np.zeros(3), axes, [(-2, 2), (-2, 2)])
    for aside, side in ((0, -1), (0, 1), (1, -1), (1, 1)):
        less, more = (seen.least_room(look, aside, slope + step, side)[0] for step in (-1e-6, 1e-6))
        change = seen.least_room(look, aside, slope, side)[1]
        assert change == pytest.approx((more - less) / 2e-6, rel=1e-6)


@settings(max_examples=30)
@given(seed=st.integers(0, 10**6), expanded=st.sampled_from([1, 4, 30, 10**6]))
def test_sphere_around_copies(seed: int, expanded: int) -> None:
    copies = some_copies(seed)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(around, "EXPANDED", expanded)
        middle, radius = bounding_sphere(*balls_of(copies, "test"))
    expected, reach = bounding_sphere(*balls_of(scenes(copies)[1], "test"))
    assert middle.tolist() == expected.tolist()
    assert radius == pytest.approx(reach, rel=1e-15)


@once
@pytest.mark.parametrize("kind", ["box", "ball", "shell", "same"])
@pytest.mark.parametrize("other", ["box", "ball", "shell", "same"])
def test_the_farthest_pair_of_many_is_found(
    kind: str, other: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    random = np.random.default_rng(3)
    monkeypatch.setattr(around, "EXPANDED", 64)

    def points(kind: str, count: int) -> np.ndarray:
        ways = random.normal(size=(count, 3))
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        ways[:6] = [*np.eye(3), *-np.eye(3)]
        inside = random.random((count, 1))
        of_kind = {"box": 2 * random.random((count, 3)) - 1, "ball": ways * inside, "shell": ways}
        return of_kind.get(kind, np.ones((count, 3)))

    for scale in (1.0, 7.0, 1e-200, 1e300):
        centers, at = points(kind, 70), points(other, 50) * 3
        copies = Copies(Spheres(centers * scale, random.random(70) * scale / 9), at * scale)
        found = bounding_sphere(*balls_of(copies, "test"))
        expected = bounding_sphere(*balls_of(scenes(copies)[1], "test"))
        assert repr(found) == repr(expected)


def test_extremes_of_doubles() -> None:
    far = Copies(Sphere((1e308, -1e308, 0), 1), [(7e307, -7e307, 0), (-7e307, 7e307, 1e308)])
    one, other = (bounding_sphere(*balls_of(scene, "test")) for scene in scenes(far))
    assert repr(one) == repr(other)
    for projection in ("perspective", "orthographic"):
        messages = []
        for scene in scenes(far):
            with pytest.raises(SceneError) as caught:
                Camera.fit(scene, projection=projection)  # type: ignore[arg-type]
            messages.append(str(caught.value))
        assert messages[0] == messages[1]


def test_lights_stand_as_around_the_objects_written_out() -> None:
    one, other = scenes(some_copies(4), Plane((0, 9, 0), (0, -1, 0)))
    for scene in (one, other):
        scene.camera = Camera.fit(other, (1, 2, -1))
    for preset in (vtray.lights.rembrandt, vtray.lights.cloudy):
        for first, second in zip(preset(one, points=True), preset(other, points=True), strict=True):
            places = [(p.x, p.y, p.z) for p in (first.location, second.location)]
            assert places[0] == pytest.approx(places[1], rel=1e-13, abs=1e-13)


def test_copies_at_no_place_are_none() -> None:
    none = Copies(Sphere((0, 0, 0), 1), [])
    for subject in (none, Scene(None, [], [none]), Copies(Spheres([], 1), [(0, 0, 0)])):
        with pytest.raises(SceneError, match=r"Camera.fit: nothing has an end"):
            Camera.fit(subject)
    ball = Sphere((1, 2, 3), 1)
    assert Camera.fit(Scene(None, [], [none, ball])) == Camera.fit(Scene(None, [], [ball]))


def test_very_many_copies_are_fitted_in_little_time() -> None:
    random = np.random.default_rng(2)
    scene = Scene()
    scene.add_copies(Spheres(random.normal(size=(10**5, 3)), 0.1), random.random((10**5, 3)) * 50)
    start = time.perf_counter()
    scene.camera = Camera.fit(scene)
    vtray.lights.rembrandt(scene)
    assert time.perf_counter() - start < 5, "written out, they would take minutes"
