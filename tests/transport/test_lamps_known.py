"""Rectangle lamps, and lamps of a radiance, against what integrals say of them."""

import math
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import compiled_only
from vtray import RectangleLight, SphereLight, render

pytestmark = compiled_only  # means over many rays

SIDE = 32
NEAR = 1e-3
"""How near means over so many pixels come to integrals."""

Point = tuple[float, float, float]
UP = (0, 0, 1)
FLAT = ((3, 0, 0), (0, 1, 0))
"""Edges of a rectangle that lies on its back."""


def at_point(light: Any, normal: Point = UP, way: Point | None = None) -> vtray.Scene:
    """Return a scene of one white plane, of which all pixels see the origin."""
    scene = vtray.Scene()
    way = way or (0.3 - 9 * normal[0], 0.2 - 9 * normal[1], 0.1 - 9 * normal[2])
    scene.camera = vtray.Camera((-way[0], -way[1], -way[2]), way, 1.0, (SIDE, SIDE), (1e-9, 1e-9))
    scene.add_plane((0, 0, 0), normal=normal)
    scene.lights = [light]
    return scene


def share(scene: vtray.Scene) -> float:
    """Return how bright white is where a scene is seen, on average over the pixels."""
    return float(render(scene, exposure=1.0).linear.mean()) / 255


def corner_factor(x: float, y: float, height: float) -> float:
    """Return the form factor of a rectangle above a floor from below a corner to (x, y)."""
    one, other = math.hypot(height, x), math.hypot(height, y)
    return (x / one * math.atan(y / one) + y / other * math.atan(x / other)) / (2 * math.pi)


def form_factor(x: float, y: float, height: float) -> float:
    """Return how much of what a floor sees is a rectangle of 3 by 1 with its middle there."""
    total = 0.0
    for right in (-1, 1):
        for top in (-1, 1):
            total += right * top * corner_factor(x + right * 1.5, y + top * 0.5, height)
    return total


def sum_of(
    light: RectangleLight, point: Point, normal: Point, ball: tuple[Point, float] | None = None
) -> float:
    """Return the integral of the cosine over what is seen of a rectangle, by small parts of it."""
    one, other = (np.array([edge.x, edge.y, edge.z]) for edge in light.edges)
    middle = np.array([light.location.x, light.location.y, light.location.z])
    steps = 700
    at = (np.arange(steps) + 0.5) / steps - 0.5
    places = middle + at[:, None, None] * one + at[:, None] * other
    ways = places - np.array(point)
    lengths = np.sqrt((ways**2).sum(axis=-1))
    square = np.cross(one, other)
    cosines = np.maximum(ways @ np.array(normal), 0) * np.abs(ways @ square)
    if ball is not None:
        arm = np.array(ball[0]) - np.array(point)
        along = ways @ arm / lengths
        cosines *= (arm @ arm - along**2 > ball[1] ** 2) | (along < 0)
    return float((cosines / lengths**4).sum()) / steps**2


@pytest.mark.parametrize("height", [0.02, 0.5, 2.0, 30.0])
@pytest.mark.parametrize("aside", [(0.0, 0.0), (1.5, 0.5), (3.0, -0.2), (-2.0, 4.0)])
def test_radiance_of_a_rectangle_above_a_floor(height: float, aside: tuple[float, float]) -> None:
    x, y = aside
    light = RectangleLight((x, y, height), FLAT, radiance=1)
    expected = form_factor(x, y, height)
    assert share(at_point(light)) == pytest.approx(expected, rel=2 * NEAR)
    # From below it is the same.
    light = light.replace(location=(x, y, -height))
    assert share(at_point(light, normal=(0, 0, -1))) == pytest.approx(expected, rel=2 * NEAR)


@pytest.mark.parametrize("height", [0.6, 1.0, 4.0, 50.0])
@pytest.mark.parametrize("aside", [0.0, 1.0, 8.0])
def test_radiance_of_a_ball_above_a_floor(height: float, aside: float) -> None:
    light = SphereLight((aside, 0, height), 0.5, radiance=3)
    distance = math.hypot(aside, height)
    expected = 3 * (0.5 / distance) ** 2 * height / distance
    assert share(at_point(light)) == pytest.approx(expected, rel=2 * NEAR)


def test_in_a_ball_of_some_radiance_all_is_as_bright() -> None:
    assert share(at_point(SphereLight((0, 0, 0), 4, radiance=0.5))) == 0.5
    assert share(at_point(SphereLight((0, 0, 3), 0, radiance=0.5))) == 0.0


TILTED = RectangleLight((0.7, 0.4, 1.0), ((1.2, 0, -1.2), (0.5, 1.5, 0.5)), radiance=math.pi)


@pytest.mark.parametrize("height", [1.0, 0.5, 0.1, -0.5, -1.0])
def test_a_tilted_rectangle_partly_below_the_horizon(height: float) -> None:
    light = TILTED.replace(location=(0.7, 0.4, height))
    expected = sum_of(light, (0, 0, 0), UP)
    assert share(at_point(light)) == pytest.approx(expected, abs=NEAR * math.pi)


@pytest.mark.parametrize("beside", [0.0, 0.2, 0.35])
def test_a_rectangle_partly_behind_a_ball(beside: float) -> None:
    ball = ((0.3 + beside, 0.2, 0.6), 0.2)
    scene = at_point(TILTED, way=(6, 5, -3))
    scene.add_sphere(*ball)
    expected = sum_of(TILTED, (0, 0, 0), UP, ball)
    assert 0.1 < expected < 0.9 * sum_of(TILTED, (0, 0, 0), UP)
    assert share(scene) == pytest.approx(expected, abs=2 * NEAR * math.pi)


@pytest.mark.parametrize("height", [1e-3, 0.3, 2.0, 1e3])
@pytest.mark.parametrize("size", [1e-9, 0.1, 1.0, 30.0])
def test_straight_in_front_the_intensity_is_seen(height: float, size: float) -> None:
    edges = ((3 * size, 0, 0), (0, size, 0))
    light = RectangleLight((0, 0, height), edges, 0.75)
    assert share(at_point(light)) == pytest.approx(0.75, rel=2 * NEAR)


@pytest.mark.parametrize(
    ("place", "normal"),
    [((2, 0, 3), UP), ((-5, 4, 0.5), UP), ((-2, 1, 1), (-0.6, 0, 0.8)), ((4, 0, 3), (0.6, 0, 0.8))],
)
def test_from_aside_a_small_one_is_foreshortened(place: Point, normal: Point) -> None:
    distance = math.hypot(*place)
    cosine = sum(p * n for p, n in zip(place, normal, strict=True)) / distance
    light = RectangleLight(place, ((3e-6, 0, 0), (0, 1e-6, 0)))
    expected = cosine * place[2] / distance
    assert share(at_point(light, normal=normal)) == pytest.approx(expected, rel=1e-5)


def test_no_point_gets_more_than_the_intensity() -> None:
    random = np.random.default_rng(2)
    scene = vtray.Scene()
    scene.add_spheres(random.uniform(-1, 1, (60, 3)), 0.15)
    scene.camera = vtray.Camera.fit(scene, direction=(0.3, 1, -0.6), size=(SIDE, SIDE))
    for edges in (((2, 0, 0), (0, 2, 0)), ((2, 0, 0), (0, 1e-3, 0)), ((1e-3, 0, 0), (0, 0, 2))):
        scene.lights = [RectangleLight((0, 0, 0), edges)]
        linear = render(scene, exposure=1.0).linear
        assert 0.3 < linear.max() / 255 < 1 + 5 * NEAR


DARK = [
    pytest.param((0, 0, 0), ((1, 0, 0), (0, 1, 0)), id="in the floor"),
    pytest.param((5, 0, 0), ((1, 0, 0), (0, 1, 0)), id="in the floor, elsewhere"),
    pytest.param((3, 0, 0), ((0, 0, 4), (1, 0, 0)), id="edge-on"),
    pytest.param((0, 0, -1), ((1, 0, 0), (0, 1, 0)), id="below the floor"),
    pytest.param((0, 0, 3), ((1, 0, 0), (0, 0, 1)), id="edge-on, above"),
]


@pytest.mark.parametrize(("place", "edges"), DARK)
@pytest.mark.parametrize("strength", [{}, {"radiance": 1}])
def test_where_no_light_comes_from(place: Point, edges: Any, strength: Any) -> None:
    # Pixels are 1e-9 apart, so not all lie in the plane of a lamp seen edge-on.
    assert share(at_point(RectangleLight(place, edges, **strength))) < 1e-7


def test_a_rectangle_in_a_wall_lights_the_floor() -> None:
    light = RectangleLight((0, -1, 1), ((1, 0, 0), (0, 0, 1)), radiance=math.pi)
    scene = at_point(light)
    expected = sum_of(light, (0, 0, 0), UP)
    assert share(scene) == pytest.approx(expected, rel=5 * NEAR)
    bare = render(scene).linear
    scene.add_plane((0, -1, 0), normal=(0, 1, 0))
    np.testing.assert_array_equal(render(scene).linear, bare)
    scene.objects[-1] = vtray.Plane((0, -0.999, 0), (0, 1, 0), (255, 255, 255), 1)
    assert share(scene) == 0.0


def test_a_rectangle_in_an_object_lights_nothing_outside() -> None:
    light = RectangleLight((0, 0, 3), ((1, 0, 0), (0, 1, 0)))
    scene = at_point(light, way=(6, 5, -3))
    scene.add_sphere((0, 0, 3), 0.8)
    assert share(scene) == 0.0
    scene.objects[-1] = scene.objects[-1].replace(radius=0.3)  # type: ignore[union-attr]
    assert 0.1 < share(scene) < 0.9


def test_a_rectangle_behind_the_image_plane_shines_through_it() -> None:
    light = RectangleLight((0, 0, 40), ((9, 0, 0), (0, 9, 0)), 0.5)
    scene = at_point(light)
    bare = render(scene).linear
    scene.add_sphere((0, 0, 30), 5)
    np.testing.assert_array_equal(render(scene).linear, bare)
    assert share(scene) == pytest.approx(0.5, rel=2 * NEAR)
