"""Cameras and lights that are fitted to cylinders.

The oracle works with points on the edges of the caps, whose hulls cylinders are.
"""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from test_camera_fit import directions, project

import vtray
from conftest import once
from vtray import Camera, Cylinders, Scene, Spheres
from vtray.scene.placing import pieces, seen
from vtray.scene.placing.bounding_sphere import bounding_sphere
from vtray.scene.placing.bounds import Balls, balls_of

TURN = np.linspace(0, 2 * np.pi, 720, endpoint=False)


def caps(cylinders: Cylinders) -> list[Any]:
    """Return functions that give points on the edge of a cap at angles, (n, 3)."""
    start, end = cylinders.start.astype(float), cylinders.end.astype(float)
    radii = np.broadcast_to(cylinders.radius, len(cylinders)).astype(float)
    found = []
    for ends, radius in zip(np.stack([start, end], axis=1), radii, strict=True):
        axis = ends[1] - ends[0]
        side = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
        side /= np.linalg.norm(side)
        axes = np.array([side, np.cross(axis / np.linalg.norm(axis), side)]) * radius
        found += [
            lambda turn, center=center, axes=axes: (
                center + np.stack([np.cos(turn), np.sin(turn)], axis=1) @ axes
            )
            for center in ends
        ]
    return found


def edges(cylinders: Cylinders) -> Any:
    """Return points on the edges of all caps, (1440 n, 3)."""
    return np.concatenate([cap(TURN) for cap in caps(cylinders)])


def seen_range(camera: Camera, cylinders: Cylinders) -> tuple[Any, Any]:
    """Return the least and the greatest column, row and depth of all edges of caps."""
    ends = []
    for cap in caps(cylinders):
        places = project(camera, cap(TURN))
        for extreme in (places.argmin(axis=0), places.argmax(axis=0)):
            # Between two of the points it is a little more.
            near = [TURN[k] + TURN[1] * np.linspace(-1, 1, 721) for k in extreme]
            ends += [project(camera, cap(turn)) for turn in near]
    points = np.concatenate(ends)
    return points.min(axis=0), points.max(axis=0)


@once
@settings(max_examples=100)
@given(
    seed=st.integers(0, 10**6),
    count=st.integers(1, 8),
    scale=st.sampled_from([1.0, 1e-9, 1e6]),
    far=st.sampled_from([0.0, 1.0, 1e4]),
    largest=st.sampled_from([0.05, 1.0, 5.0]),
    squeeze=st.sampled_from([(1, 1, 1), (1, 1, 1e-6), (1, 0, 0), (0, 0, 1)]),
    direction=directions(),
    up=directions(),
    margin=st.sampled_from([0.0, 0.05, 0.45]),
    projection=st.sampled_from(["perspective", "orthographic"]),
    fov=st.sampled_from([1.0, 40.0, 130.0]),
    size=st.sampled_from([(800, 600), (31, 31), (640, 20)]),
    dtype=st.sampled_from([np.float32, np.float64]),
)
def test_fit_is_inside_tight_and_in_the_middle(
    seed: int,
    count: int,
    scale: float,
    far: float,
    largest: float,
    squeeze: Any,
    direction: Any,
    up: Any,
    margin: float,
    projection: Any,
    fov: float,
    size: tuple[int, int],
    dtype: Any,
) -> None:
    assume(np.linalg.norm(np.cross(direction, up)) > 0.01)
    random = np.random.default_rng(seed)
    start, end = ((random.normal(size=(2, count, 3)) * squeeze + far) * scale).astype(dtype)
    radius = (random.uniform(0.01, 1, count) * largest * scale).astype(dtype)
    cylinders = Cylinders(start, end, radius)
    assume(bool((cylinders.start != cylinders.end).any(axis=1).all()))
    camera = Camera.fit(cylinders, direction, up, margin, projection, fov, size)
    low, high = seen_range(camera, cylinders)
    lattice = np.array(size) - 1.0
    first, last = margin * lattice, (1 - margin) * lattice
    extent = np.array([*(high - low)[:2], 1])
    loose = 1e-7 * extent[:2] + 1e-8 * (1 + far) * max(size)
    assert np.all(low[:2] >= first - loose)
    assert np.all(high[:2] <= last + loose)
    assert low[2] > 0, "behind the image plane"
    free = np.array([low[:2] - first, last - high[:2]])
    assert np.all(np.abs(free[0] - free[1]) < 2 * loose), "not in the middle"
    assert np.any(np.all(np.abs(free) < loose, axis=0)), "not tight"


def test_cylinders_are_fitted_more_closely_than_balls_at_their_ends() -> None:
    upright = Cylinders([(0, 0, 0)], [(0, 2, 0)], 3)
    camera = Camera.fit(
        upright, (0, 0, -1), margin=0, projection="orthographic", size=(601, 201), up=(0, 1, 0)
    )
    assert camera.resolution == pytest.approx((0.01, 0.01))


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_cylinders_without_radius_or_length_are_their_ends(projection: Any) -> None:
    random = np.random.default_rng(4)
    start, end = random.normal(size=(2, 9, 3))
    fit = {"direction": (1, 2, -1), "projection": projection, "up": (0, 1, 0)}
    assert Camera.fit(Cylinders(start, end, 0), **fit) == Camera.fit(
        Spheres(np.concatenate([start, end]), 0), **fit
    )
    assert Camera.fit(Cylinders(start, start, 5), **fit) == Camera.fit(Spheres(start, 0), **fit)


def test_fit_takes_all_kinds_of_objects() -> None:
    random = np.random.default_rng(6)
    start, end = random.normal(size=(2, 30, 3))
    radius = random.random(30)
    scene = Scene()
    scene.add_spheres(start, 0.7)
    scene.add_cylinders(start[:20], end[:20], radius[:20])
    for k in range(20, 30):
        scene.add_cylinder(start[k], end[k], radius[k])
    balls, starts, ends = balls_of(scene, "test")
    assert (len(balls.center), len(starts.center), len(ends.center)) == (30, 30, 30)
    np.testing.assert_array_equal(starts.center, ends.toward)
    camera = Camera.fit(scene, (1, 2, -1), margin=0, size=(300, 300))
    points = edges(Cylinders(start, end, radius))
    # A ball is the hull of discs in all directions.
    turns = random.normal(size=(200, 3))
    turns *= 0.7 / np.linalg.norm(turns, axis=1)[:, None]
    points = np.concatenate([points, *(start + turn for turn in turns)])
    places = project(camera, points)
    assert places[:, :2].min() > -1e-6
    assert places[:, :2].max() < 299 + 1e-6
    assert places[:, :2].max() - places[:, :2].min() == pytest.approx(299, rel=1e-2)


@once
@pytest.mark.parametrize("direction", [(0, 0, -1), (1, 2, -1)])
def test_fit_of_many_cylinders(direction: Any, monkeypatch: Any) -> None:
    """What is worked out piece by piece, of few chosen among many, is the same to the last bit."""
    random = np.random.default_rng(7)
    start = random.random((3000, 3))
    for reach, radius in ((0.1, 0.02), (0.1, 1.0), (2.0, random.uniform(0, 2, 3000))):
        cylinders = Cylinders(start, start + reach * random.normal(size=(3000, 3)), radius)
        cameras, around = [], []
        for many, piece in ((10**6, 10**6), (1, 256)):
            monkeypatch.setattr(seen, "MANY", many)
            monkeypatch.setattr(seen, "SAMPLE", 128)
            monkeypatch.setattr(pieces, "PIECE", piece)
            cameras.append([Camera.fit(cylinders, direction, fov_degrees=f) for f in (1, 40, 120)])
            around.append(repr(bounding_sphere(*balls_of(cylinders, "test"))))
        assert cameras[0] == cameras[1]
        assert around[0] == around[1]


@pytest.mark.parametrize("slope", [-0.7, 0.0, 1.3])
def test_bounds_change_with_the_slope_as_they_say(slope: float) -> None:
    axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    for normal in np.random.default_rng(9).normal(size=(9, 3)):
        disc = Balls(np.array([(1.0, 2, 3)]), 2.0, np.array([(1.0, 2, 3)]) + normal)
        seen_disc = seen.look(disc, np.zeros(3), axes, [(-2, 2), (-2, 2)])
        for aside, side in ((0, -1), (0, 1), (1, -1), (1, 1)):
            less, more = (
                seen.least_room(seen_disc, aside, slope + step, side)[0] for step in (-1e-6, 1e-6)
            )
            change = seen.least_room(seen_disc, aside, slope, side)[1]
            assert change == pytest.approx((more - less) / 2e-6, rel=1e-6, abs=1e-6)


def test_sphere_around_cylinders() -> None:
    random = np.random.default_rng(8)
    start, end = random.normal(size=(2, 6, 3))
    for cylinders in (Cylinders(start, end, 1.5), Cylinders(start, end, random.random(6) * 1e200)):
        middle, radius = bounding_sphere(*balls_of(cylinders, "test"))
        farthest = np.abs(edges(cylinders) - middle).max()
        distances = np.linalg.norm((edges(cylinders) - middle) / farthest, axis=1) * farthest
        assert radius == pytest.approx(distances.max(), rel=1e-5)
        assert radius >= distances.max() * (1 - 1e-15)
    # Of the same balls, the discs are nearer.
    assert bounding_sphere(Balls(start, 1.5, end))[1] < bounding_sphere(Balls(start, 1.5))[1]


def test_lights_stand_outside_of_cylinders() -> None:
    scene = Scene()
    scene.add_cylinder((0, 0, 0), (10, 0, 0), 1)
    scene.camera = Camera.fit(scene)
    for light in vtray.lights.cloudy(scene, points=True) + vtray.lights.rembrandt(scene):
        place = light.location
        assert math.dist((place.x, place.y, place.z), (5, 0, 0)) > 6 * math.hypot(5, 1) * 0.99
