"""Soft lights against what integrals say of them, over many pixels or many seeds."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import compiled_only
from vtray import render

pytestmark = compiled_only  # means over many rays

SIDE = 32
SEEDS = 200

NEAR = 1e-3
"""How near means over so many pixels come to integrals."""

Point = tuple[float, float, float]
UP = (0, 0, 1)


def at_point(light: Any, point: Point = (0, 0, 0), seen_from: Point = (0.3, 0, 9)) -> vtray.Scene:
    """Return a scene, still empty, of which all pixels see the same point, of a floor or else."""
    scene = vtray.Scene()
    center = tuple(p + s for p, s in zip(point, seen_from, strict=True))
    way = tuple(-s for s in seen_from)
    scene.camera = vtray.Camera(center, way, 1.0, (SIDE, SIDE), (1e-9, 1e-9))
    scene.lights = [light]
    return scene


def share(scene: vtray.Scene) -> float:
    """Return how bright white is where a scene is seen, on average over the pixels."""
    return float(render(scene, exposure=1.0).linear.mean()) / 255


def integral(density: Callable[[np.ndarray], np.ndarray], cone: float = math.pi / 2) -> float:
    """Return the integral of a function of directions, (n, 3), over those near (0, 0, 1)."""
    steps = 1500
    heights = 1 - (np.arange(steps) + 0.5) / steps * (1 - math.cos(cone))
    turns = (np.arange(2 * steps) + 0.5) / steps * math.pi
    total = 0.0
    for height in heights:
        aside = math.sqrt(1 - height * height)
        ways = [aside * np.cos(turns), aside * np.sin(turns), np.full(len(turns), height)]
        total += float(density(np.stack(ways, axis=-1)).mean())
    return total / steps * 2 * math.pi * (1 - math.cos(cone))


def misses(ways: np.ndarray, center: Point, radius: float) -> np.ndarray:
    """Tell which rays from the origin pass by a ball, (n,)."""
    middle = ways @ np.array(center)
    gap2 = np.dot(center, center) - middle * middle
    return (middle < 0) | (gap2 > radius * radius)


def turned(ways: np.ndarray, axis: Point) -> np.ndarray:
    """Return directions near (0, 0, 1) turned to be near another unit vector, (n, 3)."""
    beside = np.eye(3)[int(np.argmin(np.abs(axis)))]
    one = np.cross(axis, beside)
    one = one / np.sqrt(one @ one)
    return ways @ np.stack([one, np.cross(axis, one), np.array(axis)])


@pytest.mark.parametrize("light", [vtray.Ambient(), vtray.Sky(), vtray.Ambient(distance=1e4)])
def test_ambient_light_in_the_corner_of_three_planes(light: Any) -> None:
    # Of a room of three walls, an eighth of all directions is open, a quarter of them above each.
    scene = at_point(light, (1e-3, 2e-3, 0), (3, 3, 5))
    for normal in ((1, 0, 0), (0, 1, 0), UP):
        scene.add_plane((0, 0, 0), normal=normal)
    assert share(scene) == pytest.approx(0.25, abs=NEAR)


@pytest.mark.parametrize("distance", [0.5, 1.5, 4.0])
def test_ambient_light_near_a_wall_is_what_is_not_near_it(distance: float) -> None:
    scene = at_point(vtray.Ambient(distance=distance), (1, 0, 0), (3, 0, 5))
    scene.add_plane((0, 0, 0), normal=(1, 0, 0))
    scene.add_plane((0, 0, 0), normal=UP)
    # The wall is met within the distance where -x * distance > 1.
    expected = integral(lambda ways: ways[:, 2] / math.pi * (ways[:, 0] * distance >= -1))
    assert share(scene) == pytest.approx(expected, abs=NEAR)


@pytest.mark.parametrize("height", [-0.9, -0.3, 0.0, 0.4, 0.9])
def test_a_ball_partly_below_the_horizon(height: float) -> None:
    center, radius = (2.0, 0.0, height), 1.0
    scene = at_point(vtray.SphereLight(center, radius))
    scene.add_plane((0, 0, 0), normal=UP)
    # Each direction to the ball counts as much, and its cosine where that is above the horizon.
    distance = math.hypot(2, height)
    axis = (2 / distance, 0.0, height / distance)
    cone = math.asin(radius / distance)

    def cosine(ways: np.ndarray) -> np.ndarray:
        return np.maximum(turned(ways, axis)[:, 2], 0)

    expected = integral(cosine, cone) / integral(lambda ways: ways[:, 2], cone)
    assert share(scene) == pytest.approx(expected, abs=NEAR)


@pytest.mark.parametrize("beside", [0.0, 0.5, 1.1, 1.6])
def test_a_large_sun_partly_behind_a_ball(beside: float) -> None:
    way = (-0.48, 0.36, -0.8)
    scene = at_point(vtray.Sun(way, angle=60))
    scene.add_plane((0, 0, 0), normal=UP)
    ball, radius = (1.44 + beside, -1.08, 2.4), 0.9
    scene.add_sphere(ball, radius)
    axis, cone = (-way[0], -way[1], -way[2]), math.pi / 6

    def arriving(ways: np.ndarray) -> np.ndarray:
        open_ways = turned(ways, axis)
        return np.maximum(open_ways[:, 2], 0) * misses(open_ways, ball, radius)

    expected = integral(arriving, cone) / integral(lambda ways: ways[:, 2], cone)
    assert 0.2 < expected < 0.8
    assert share(scene) == pytest.approx(expected, abs=NEAR)


def test_a_ball_light_partly_behind_a_ball() -> None:
    center, lamp = (0.0, 3.0, 4.0), 1.2
    scene = at_point(vtray.SphereLight(center, lamp))
    scene.add_plane((0, 0, 0), normal=UP)
    scene.add_sphere((0.2, 1.2, 2.0), 0.4)
    # What is behind the lamp, or beside it, keeps off nothing.
    scene.add_sphere((0.0, 6.0, 8.0), 2.0)
    scene.add_sphere((3.0, 3.0, 4.0), 1.0)
    axis, cone = (0.0, 0.6, 0.8), math.asin(lamp / 5)

    def arriving(ways: np.ndarray) -> np.ndarray:
        open_ways = turned(ways, axis)
        return open_ways[:, 2] * misses(open_ways, (0.2, 1.2, 2.0), 0.4)

    expected = integral(arriving, cone) / integral(lambda ways: ways[:, 2], cone)
    assert 0.2 < expected < 0.7
    assert share(scene) == pytest.approx(expected, abs=NEAR)


def balls(count: int, radius: float) -> vtray.Scene:
    """Return white balls in cells of side 1, nothing else, and the camera that sees them."""
    random = np.random.default_rng(5)
    cells = np.stack(np.unravel_index(np.arange(count), (8, 8, 8)), axis=-1)
    scene = vtray.Scene()
    scene.add_spheres(cells + random.uniform(-0.1, 0.1, (count, 3)), radius)
    scene.camera = vtray.Camera.fit(scene, direction=(0.3, 1, -0.6), size=(3 * SIDE, 2 * SIDE))
    return scene


def surfaces(scene: vtray.Scene, samples: int) -> np.ndarray:
    """Return how bright the pixels are that show nothing but a surface, (n, 3)."""
    image = render(scene, exposure=1.0, samples=samples)
    found = image.linear[(image.alpha == 1) & (image.ids[..., 0] >= 0)]
    assert len(found) > SIDE
    shares: np.ndarray = found / 255
    return shares


@pytest.mark.parametrize("samples", [1, 4])
@pytest.mark.parametrize("light", [vtray.Sky(), vtray.Ambient()])
def test_a_white_ball_in_a_uniform_sky_is_as_the_sky(light: Any, samples: int) -> None:
    scene = balls(1, 0.3)
    scene.lights = [light]
    assert (surfaces(scene, samples) == 1).all()


@pytest.mark.parametrize("samples", [1, 4])
def test_white_balls_with_nothing_near_show_all_ambient_light(samples: int) -> None:
    scene = balls(300, 0.25)
    scene.lights = [vtray.Ambient(distance=0.25)]
    assert (surfaces(scene, samples) == 1).all()
    scene.lights = [vtray.Ambient(distance=3)]
    assert surfaces(scene, samples).min() < 0.9


def test_one_pixel_is_right_on_average_over_seeds() -> None:
    lamp, ball = (1.0, 1.5, 3.0), (0.6, 0.8, 1.6)
    scene = vtray.Scene()
    scene.camera = vtray.Camera((0.3, 0, 9), (-0.3, 0, -9), 1.0, (1, 1), (1e-9, 1e-9))
    scene.add_plane((0, 0, 0), normal=UP)
    scene.add_sphere(ball, 0.4)
    distance = math.sqrt(1 + 1.5**2 + 3**2)
    axis, cone = (1 / distance, 1.5 / distance, 3 / distance), math.asin(1.1 / distance)
    scene.lights = [vtray.SphereLight(lamp, 1.1)]
    assert_unbiased(
        scene,
        integral(lambda w: turned(w, axis)[:, 2] * misses(turned(w, axis), ball, 0.4), cone)
        / integral(lambda w: w[:, 2], cone),
    )
    scene.lights = [vtray.Sky()]
    assert_unbiased(scene, integral(lambda w: w[:, 2] / math.pi * misses(w, ball, 0.4)))


def assert_unbiased(scene: vtray.Scene, expected: float) -> None:
    """Compare the mean over many seeds of a picture of one pixel with what it should be."""
    found = [share_of_seed(scene, seed) for seed in range(SEEDS)]
    error = np.std(found, ddof=1) / math.sqrt(len(found))
    assert 0 < error < 0.01
    assert abs(np.mean(found) - expected) < 4 * error + 1e-5


def share_of_seed(scene: vtray.Scene, seed: int) -> float:
    """Return how bright the one pixel is."""
    return float(render(scene, exposure=1.0, seed=seed, threads=1).linear.mean()) / 255
