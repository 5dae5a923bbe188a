"""Cones against values worked out by hand, against cylinders, and their boxes."""

import math

import numpy as np
import pytest

from conftest import JIT
from vtray.geometry.bundle import Bundle, image_plane_range
from vtray.geometry.ray import Footprint, Ray, Segment
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.shapes.axis_line import is_second_half, line_beside
from vtray.geometry.shapes.columns import Columns, Place
from vtray.geometry.shapes.cone import (
    ConeShape,
    cone_crossing,
    cone_distance,
    cone_hides,
    cone_pole,
    cone_surface,
    load_cone,
    signed_distance,
)
from vtray.geometry.shapes.cone_columns import GivenCones
from vtray.geometry.shapes.cylinder import cylinder_distance, load_cylinder
from vtray.geometry.shapes.surface import bend_at, normal_at

Point = tuple[float, float, float]

INF = math.inf
HERE = Place((0.0, 0.0, 0.0), 1.0, (0.0, 0.0, 0.0))


def cone(start: Point, end: Point, radius: float, radius_end: float) -> ConeShape:
    data = np.array([*start, *end, radius, radius_end], float)
    return load_cone(Columns(data, np.zeros(1, np.int32)), 0, HERE)


POINTED = (0, 0, 8), (0, 0, 4), 2, 0
"""The tip is at a height of 4, and at 8 it is 2 wide to each side."""

CUT = (0, 0, 4), (0, 0, 8), 1, 3
"""Cut off, 1 wide at a height of 4 and 3 at 8."""

ACROSS, UP, DOWN = (1, 0, 0), (0, 0, 1), (0, 0, -1)
SLANTED = (0, 0.6, 0.8)
SIDE = 1 / math.sqrt(5), 0, 2 / math.sqrt(5)
"""Along the side of the pointed one."""


def floats(point: tuple[float, ...]) -> Point:
    x, y, z = map(float, point)
    return x, y, z


def test_loading_brings_it_into_the_kernels_space() -> None:
    data = np.array([9] * 8 + [1, 2, 3, 4, 6, 3, 0.5, 8.0], float)
    place = Place((1.0, 0.0, 0.0), 2.0, (0.0, 1.0, 2.0))
    shape = load_cone(Columns(data, np.zeros(2, np.int32)), 1, place)
    assert (shape.start, shape.axis, shape.length) == ((4, 3, 4), (0.6, 0.8, 0), 10)
    side = math.sqrt(100 + 225)
    assert (shape.cosine, shape.sine, shape.room) == (10 / side, 15 / side, 10 / side)
    assert shape.center == (7, 7, 4)
    assert shape.radius == math.sqrt(256 + 25)
    assert shape.error_scale == 11 + 10 + 16


@pytest.mark.parametrize(
    ("shape", "origin", "direction", "plane_depth", "expected"),
    [
        (POINTED, (0, 0, 0), UP, 1, 4),  # to the tip
        (POINTED, (0, 1, 0), UP, 1, 6),
        (POINTED, (0, 2, 0), UP, 1, INF),  # a touch
        (POINTED, (0, 0, 9), DOWN, 1, 1),
        (POINTED, (0, 1.5, 9), DOWN, 1, 1),
        (POINTED, (0, 0, 9), UP, 1, INF),
        (POINTED, (-3, 0, 6), ACROSS, 1, 2),
        (POINTED, (-3, 0, 3), ACROSS, 1, INF),  # where it would be beyond the tip
        (POINTED, (-3, 0, 4), ACROSS, 1, INF),
        (POINTED, (-3, 0, 4 + 1e-6), ACROSS, 1, 3),
        (POINTED, (-3, 1e-6, 4 + 4e-6), ACROSS, 1, 3),
        (POINTED, (-3, 1e-6, 4 + 1e-6), ACROSS, 1, INF),
        (POINTED, (0, 0, 6), UP, 0, 2),  # from within
        (POINTED, (0, 0, 6), DOWN, 0, 2),
        (POINTED, (0, 0, 6), ACROSS, 0, 1),
        (POINTED, (0.1, 0, 4), SIDE, 0, INF),  # beside its side
        (POINTED, (-0.1, 0, 4), SIDE, 0, math.sqrt(5) * 0.05),  # as long inside as it goes
        (POINTED, (0, -5 / 3, 0), (0, 5 / 13, 12 / 13), 1, 13 / 3),  # through the tip
        (POINTED, (0, -3, 0), SLANTED, 1, INF),  # past it
        (CUT, (0, 0, 0), UP, 1, 4),
        (CUT, (0, 0.9, 0), UP, 1, 4),
        (CUT, (0, 1.5, 0), UP, 1, 5),
        (CUT, (0, 3, 0), UP, 1, INF),
        (CUT, (-5, 0, 6), ACROSS, 1, 3),
        (CUT, (0, 2, 0), UP, -5, 6),  # the image plane is before it
        (CUT, (0, 2, 0), UP, -7, 8),  # or cuts it
        (CUT, (0, 2, 0), UP, -8, INF),
    ],
)
def test_distance(
    shape: tuple[Point, Point, float, float],
    origin: Point,
    direction: Point,
    plane_depth: float,
    expected: float,
) -> None:
    start, end, radius, radius_end = shape
    ray = Ray(floats(origin), floats(direction), float(plane_depth), 1.0, 0.0, 0.0)
    for ends in (shape, (end, start, radius_end, radius)):
        assert cone_distance(cone(*ends), ray) == pytest.approx(expected, abs=2e-6)


@pytest.mark.parametrize(
    ("origin", "direction", "expected"),
    [
        ((1, 0, 6), ACROSS, INF),  # outwards
        ((1, 0, 6), (-1, 0, 0), 2),  # through the inside
        ((1 - 1e-15, 0, 6), ACROSS, INF),  # rounding moved it inwards
        ((1 + 1e-15, 0, 6), (-1, 0, 0), 2),
        ((1, 0, 6), SIDE, INF),  # along the side
        ((1, 0, 6), UP, 2),
        ((1, 0, 6), DOWN, INF),
        ((0, 0, 8), DOWN, 4),  # from the cap to the tip
        ((0, 0, 8), UP, INF),
        ((0, 0, 4), UP, 4),  # from the tip
        ((0, 0, 4), DOWN, INF),
        ((0, 0, 4), ACROSS, INF),
        ((2, 0, 8), (-1, 0, 0), INF),  # along the cap
        ((3, 0, 6), (-1, 0, 0), 2),  # from elsewhere
    ],
)
def test_distance_from_its_own_surface(origin: Point, direction: Point, expected: float) -> None:
    ray = Ray(floats(origin), floats(direction), 1.0, 0.0, 0.0, 1e-13)
    assert cone_distance(cone(*POINTED), ray) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("start", "end", "hides"),
    [
        ((-3, 0, 6), (3, 0, 6), True),  # through the side
        ((-3, 0, 6), (-2, 0, 6), False),  # it lies beyond the light
        ((-3, 0, 6), (-9, 0, 6), False),  # it lies behind the point
        ((-3, 1, 6), (3, 1, 6), False),  # a touch
        ((-3, 0, 2), (3, 0, 2), False),  # where it would be beyond the tip
        ((0, 0, 0), (0, 0, 9), True),  # along the axis
        ((-3, 0, 6), (0, 0, 6), True),  # the light is inside
        ((0, 0, 6), (3, 0, 6), True),  # the point is inside
        ((0, 0, 6), (0, 0.5, 6), False),  # both are
        ((1, 0, 6), (3, 0, 6), False),  # from the side outwards
        ((1, 0, 6), (-3, 0, 6), True),  # and through the inside
        ((1, 0, 6), (-0.5, 0, 6), False),  # to a light inside
        ((1, 0, 6), (2, 0, 8), False),  # along the side
        ((0, 0, 4), (0, 0, 0), False),  # from the tip outwards
        ((0, 0, 4), (0, 0, 9), True),  # and inwards
        ((0, 0, 8), (1, 0, 9), False),  # from the cap
        ((1 - 1e-15, 0, 6), (3, 0, 6), False),  # rounding off the surface
        ((1 + 1e-15, 0, 6), (3, 0, 6), False),
        ((-3, 0, 6), (-1, 0, 6), False),  # a light on the near side
        ((-3, 0, 6), (1, 0, 6), True),  # on the far side
    ],
)
def test_hides(start: Point, end: Point, hides: bool) -> None:
    segment = Segment(floats(start), floats(end), 1.0, 1.0, 2.0, 2.0)
    first, last, radius, radius_end = POINTED
    for ends in (POINTED, (last, first, radius_end, radius)):
        assert bool(cone_hides(cone(*ends), segment)) is hides


@pytest.mark.parametrize(
    "ends",
    [
        ((0, 0, 4), (0, 0, 8), 0, 0),
        ((0, 0, 6), (0, 0, 6), 1, 0),
        ((0, 0, 6), (0, 0, 6), 1, 2),
        ((0, 0, 6), (0, 0, 6), 0, 0),
        ((0, 0, 6), (0, 0, 6 + 1e-200), 1, 0),
    ],
)
@pytest.mark.parametrize("direction", [UP, ACROSS, SLANTED])
def test_without_length_or_radii_it_is_nothing(
    ends: tuple[Point, Point, float, float], direction: Point
) -> None:
    shape, way = cone(*ends), floats(direction)
    for far in (5.0, 0.0):
        origin = floats(tuple(m - far * w for m, w in zip((0, 0, 6), way, strict=True)))
        for bound in (0.0, 1e-13):
            assert cone_distance(shape, Ray(origin, way, 1.0, 1.0, 0.0, bound)) == INF
        beyond = floats(tuple(m + w for m, w in zip((0, 0, 6), way, strict=True)))
        assert not cone_hides(shape, Segment(origin, beyond, 1.0, 1.0, 2.0, 2.0))


def random_rays(count: int) -> list[tuple[Point, Point]]:
    """Return rays that start 10 away from the middle, and pass it nearby."""
    random = np.random.default_rng(5)
    ways = random.normal(size=(count, 3))
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    places = random.uniform(-1, 1, (count, 3)) * 10.0 ** random.uniform(-9, 0.3, (count, 1))
    return [(floats(p - 10 * w), floats(w)) for p, w in zip(places, ways, strict=True)]


@pytest.mark.parametrize("flare", [0.0, 1e-15, 1e-9, 1e-3, 0.5, 1.0, 30.0, 1e6])
def test_points_that_are_met_are_on_the_surface(flare: float) -> None:
    """However near the tip, and whatever the taper is, also where rays hit it edge-on."""
    length = 2 / max(flare, 1.0)
    for narrow in (0.0, 1e-7, 0.4):
        shape = cone((0, 0, -length / 4), (0, 0, 3 * length / 4), narrow, narrow + flare * length)
        met = 0
        for origin, way in random_rays(300 if JIT else 60):
            for turned in (0, 1, 2):  # rays pass the tip from all sides
                moved = (origin[0], origin[1], origin[2] - (turned == 1) * length / 4)
                distance = cone_distance(shape, Ray(moved, way, 1.0, 0.0, 10.0, 0.0))
                if distance == INF:
                    continue
                met += 1
                point = floats(tuple(o + distance * w for o, w in zip(moved, way, strict=True)))
                off = signed_distance(shape, line_beside(shape, point, way))
                assert abs(off) <= 0.5 * ROUNDING * (shape.error_scale + 10.0 + distance)
        assert met > 10 or narrow + flare < 1e-3


def test_equal_radii_make_a_cylinder() -> None:
    data = np.array([0.1, -0.5, 0.3, 0.4, 0.9, -0.2, 0.6])
    round_one = load_cylinder(Columns(data, np.zeros(1, np.int32)), 0, HERE)
    shape = load_cone(Columns(np.append(data, 0.6), np.zeros(1, np.int32)), 0, HERE)
    for origin, way in random_rays(200 if JIT else 40):
        ray = Ray(origin, way, 1.0, 0.0, 0.0, 0.0)
        assert cone_distance(shape, ray) == pytest.approx(
            cylinder_distance(round_one, ray), abs=1e-9
        )


@pytest.mark.parametrize(
    ("point", "normal", "is_round", "is_second"),
    [
        ((1, 0, 6), (2, 0, -1), True, False),
        ((0, -0.5, 5), (0, -2, -1), True, True),
        ((0, -1e-9, 4 + 2e-9), (0, -2, -1), True, True),
        ((0.5, 0.5, 8), (0, 0, 1), False, False),
    ],
)
def test_surface(point: Point, normal: Point, is_round: bool, is_second: bool) -> None:
    shape, place = cone(*POINTED), floats(point)
    pole, found_round = cone_pole(shape, place)
    unit = np.array(normal) / np.linalg.norm(normal)
    toward = floats(tuple(-unit))
    assert normal_at(pole, found_round, place, toward) == pytest.approx(tuple(unit), abs=1e-6)
    assert bool(found_round) is is_round
    assert bool(is_second_half(shape, place, 1.0)) is is_second
    if is_round:
        # Its smallest circle is square to the side.
        away = math.hypot(place[0], place[1])
        bend = bend_at(cone_surface(shape, place, 1.0), place)
        assert 1 / bend == pytest.approx(away * math.sqrt(5) / 2, rel=1e-5)


def bundle_of(ray: Ray, width: float, growth: float = 0.0) -> Bundle:
    first, last = image_plane_range(ray, Footprint(width, growth))
    return Bundle(ray.origin, ray.direction, width, growth, 1.0, None, None, first, last, True)


@pytest.mark.parametrize(
    ("origin", "direction", "is_one"),
    [
        ((-3, 0, 6.5), ACROSS, True),  # one of its halves
        ((-3, 0, 6.0), ACROSS, False),  # both
        ((-3, 0.9, 6), ACROSS, False),  # an outline: hit
        ((-3, 1.05, 6), ACROSS, False),  # and just missed
        ((-3, 0, 4.02), ACROSS, False),  # the tip
        ((0, 0, 0), UP, False),
        ((0, 0.5, 9), DOWN, True),  # the cap
        ((0, 1.95, 9), DOWN, False),  # its edge
        ((0, 1.3, 0), UP, True),
    ],
)
def test_edges(origin: Point, direction: Point, is_one: bool) -> None:
    shape = cone(*POINTED)
    ray = Ray(floats(origin), floats(direction), 1.0, 1.0, 0.0, 0.0)
    near, far = cone_crossing(shape, bundle_of(ray, 0.06))
    distance = cone_distance(shape, ray)
    assert near <= distance
    assert near < INF
    assert (far < INF) == is_one
    if is_one:
        assert far >= distance


def test_bundles_miss_what_is_beside_them() -> None:
    shape = cone(*POINTED)
    for origin, way in (((-3, 1.2, 6), ACROSS), ((-3, 0, 3.8), ACROSS), ((0, 2.2, 0), UP)):
        ray = Ray(floats(origin), floats(way), 1.0, 1.0, 0.0, 0.0)
        assert cone_crossing(shape, bundle_of(ray, 0.06)).near == INF


def test_no_ray_of_a_bundle_is_met_before_or_after_its_bounds() -> None:
    random = np.random.default_rng(2)
    for k, (origin, way) in enumerate(random_rays(120 if JIT else 25)):
        radii = random.uniform(0, 1, 2) * (random.uniform(size=2) < 0.7)
        shape = cone((0, 0, -0.8), tuple(random.uniform(-1, 1, 3)), *radii)
        width, growth = 0.02, (0.0, 0.01, -0.001)[k % 3]
        start = Ray(origin, way, 1.0, 0.0, 0.0, 0.0)
        bundle = Bundle(origin, way, width, growth, 1.0, None, None, 0.0, 0.0, True)
        near, far = cone_crossing(shape, bundle)
        one = np.cross(way, np.eye(3)[np.argmin(np.abs(way))])
        one /= np.linalg.norm(one)
        for angle in np.linspace(0, 6, 7):
            e = np.cos(angle) * one + np.sin(angle) * np.cross(way, one)
            begin = floats(tuple(np.array(origin) + width * e))
            along = np.array(way) + growth * e
            length = float(np.linalg.norm(along))
            ray = start._replace(origin=begin, direction=floats(tuple(along / length)))
            distance = cone_distance(shape, ray) / length
            assert distance >= near - 1e-9
            assert distance <= far + 1e-9


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_boxes(dtype: type) -> None:
    random = np.random.default_rng(1)
    count = 40 if JIT else 8
    start, end = random.normal(size=(2, count, 3)).astype(dtype)
    end[1::5, 1:] = start[1::5, 1:]  # along an axis
    radius, radius_end = random.uniform(0, 2, (2, count)).astype(dtype)
    boxes = np.empty((6, count), np.float64)
    GivenCones(start, end, radius, radius_end).bound(0, count, boxes)
    for k in range(count):
        way = (end[k] - start[k]).astype(float)
        one = np.cross(way, np.eye(3)[np.argmin(np.abs(way))])
        two = np.cross(way, one)
        one, two = one / np.linalg.norm(one), two / np.linalg.norm(two)
        angle = np.linspace(0, 2 * np.pi, 1000)[:, None]
        rim = np.cos(angle) * one + np.sin(angle) * two
        points = np.concatenate([start[k] + radius[k] * rim, end[k] + radius_end[k] * rim])
        low, high = boxes[:3, k] - boxes[3:, k], boxes[:3, k] + boxes[3:, k]
        np.testing.assert_allclose(low, points.min(axis=0), atol=1e-4)
        np.testing.assert_allclose(high, points.max(axis=0), atol=1e-4)
