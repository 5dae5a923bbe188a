"""Cylinders against values worked out by hand, and their boxes."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from conftest import JIT
from vtray.geometry.bundle import Bundle, image_plane_range
from vtray.geometry.ray import Footprint, Ray, Segment
from vtray.geometry.shapes.columns import Columns, Place
from vtray.geometry.shapes.cylinder import (
    CylinderShape,
    cylinder_crossing,
    cylinder_distance,
    cylinder_hides,
    cylinder_pole,
    is_second_half,
    load_cylinder,
)
from vtray.geometry.shapes.cylinder_columns import GivenCylinders
from vtray.geometry.vector import magnitude

Point = tuple[float, float, float]

INF = math.inf
HERE = Place((0.0, 0.0, 0.0), 1.0, (0.0, 0.0, 0.0))


def cylinder(start: Point, end: Point, radius: float) -> CylinderShape:
    data = np.array([*start, *end, radius], float)
    return load_cylinder(Columns(data, np.zeros(1, np.int32)), 0, HERE)


UPRIGHT = (0, 0, 4), (0, 0, 8), 1
"""From a height of 4 to one of 8, one wide to each side."""

IN, OUT, ACROSS, UP = (-1, 0, 0), (1, 0, 0), (1, 0, 0), (0, 0, 1)
SLANTED = (0, 0.6, 0.8)


def test_loading_brings_it_into_the_kernels_space() -> None:
    data = np.array([9, 9, 9, 9, 9, 9, 9, 1, 2, 3, 4, 6, 3, 0.5], float)
    place = Place((1.0, 0.0, 0.0), 2.0, (0.0, 1.0, 2.0))
    shape = load_cylinder(Columns(data, np.zeros(2, np.int32)), 1, place)
    assert shape.start == (4, 3, 4)
    assert shape.axis == (0.6, 0.8, 0)
    assert (shape.length, shape.side_radius) == (10, 1)
    assert shape.center == (7, 7, 4)
    assert shape.radius == math.sqrt(26)
    assert shape.error_scale == 11 + 10 + 1


@pytest.mark.parametrize(
    ("origin", "direction", "plane_depth", "expected"),
    [
        ((0, 0, 0), UP, 1, 4),  # along the axis
        ((0, 0.5, 0), UP, 1, 4),
        ((0, 1, 0), UP, 1, INF),  # along the side: a touch
        ((0, 1.5, 0), UP, 1, INF),
        ((0, 0, 9), (0, 0, -1), 1, 1),
        ((0, 0, 9), UP, 1, INF),  # away from it
        ((-3, 0, 6), ACROSS, 1, 2),
        ((-3, 0.6, 6), ACROSS, 1, 2.2),
        ((-3, 1, 6), ACROSS, 1, INF),  # a touch
        ((-3, 1 - 1e-12, 6), ACROSS, 1, 3),
        ((-3, 0, 4), ACROSS, 1, INF),  # a cap seen edge-on
        ((-3, 0, 4 + 1e-12), ACROSS, 1, 2),
        ((-3, 0, 8), ACROSS, 1, INF),
        ((-3, 0, 3), ACROSS, 1, INF),
        ((0, -2, 2), SLANTED, 1, 2.5),  # through a cap, out of the side
        ((0, -3, 3), SLANTED, 1, 10 / 3),  # through the side
        ((0, -4, 0), SLANTED, 1, 5),  # through a cap to the side at once: nearly at an edge
        ((0, -4.1, 0), SLANTED, 1, 3.1 / 0.6),
        ((0, -9, 0), SLANTED, 1, INF),  # beyond the far end
        ((0, 0, 0), UP, -3, 4),  # from behind the image plane
        ((0, 0, 0), UP, -6, 8),  # which cuts it: only the rest exists
        ((0, 0, 0), UP, -4, 8),  # what lies in the plane does not
        ((0, 0, 0), UP, -8, INF),
        ((-3, 0, 6), ACROSS, -3, 4),
        ((-3, 0, 6), ACROSS, -4, INF),
        ((0, 0, 5), UP, 0, 3),  # from within
        ((0, 0, 5), ACROSS, 0, 1),
        ((0, 0, 5), SLANTED, 0, 1 / 0.6),
    ],
)
def test_distance(origin: Point, direction: Point, plane_depth: float, expected: float) -> None:
    ray = Ray(
        tuple(map(float, origin)), tuple(map(float, direction)), float(plane_depth), 1.0, 0.0, 0.0
    )
    assert cylinder_distance(cylinder(*UPRIGHT), ray) == pytest.approx(expected, abs=2e-6)


@pytest.mark.parametrize(
    ("origin", "direction", "expected"),
    [
        ((0, 0, 4), UP, 4),  # from a cap through the inside
        ((0, 0, 4), (0, 0, -1), INF),  # outwards
        ((0, 0, 4), (0, 0.6, -0.8), INF),
        ((0, 0, 4 + 1e-15), (0, 0, -1), INF),  # rounding moved it inwards
        ((0, 0, 4 - 1e-15), UP, 4),
        ((0, 0, 4), ACROSS, INF),  # along it
        ((1, 0, 6), OUT, INF),
        ((1, 0, 6), IN, 2),
        ((1 - 1e-15, 0, 6), OUT, INF),
        ((1 + 1e-15, 0, 6), IN, 2),
        ((1, 0, 6), UP, INF),
        ((1, 0, 4), (0.6, 0, -0.8), INF),  # from an edge
        ((1, 0, 4), (-0.6, 0, 0.8), 10 / 3),
        ((1, 0, 4), (0.6, 0, 0.8), INF),
        ((2, 0, 6), IN, 1),  # from elsewhere
        ((0, 0, 6), UP, 2),
        ((0, 0, 9), UP, INF),
    ],
)
def test_distance_from_its_own_surface(origin: Point, direction: Point, expected: float) -> None:
    way = tuple(map(float, direction))
    ray = Ray(tuple(map(float, origin)), way, 1.0, 0.0, 0.0, 1e-13)
    assert cylinder_distance(cylinder(*UPRIGHT), ray) == pytest.approx(expected)


LYING = (-1, 0, 0), (1, 0, 0), 1


@pytest.mark.parametrize(
    ("start", "end", "hides"),
    [
        ((-3, 0, 0), (3, 0, 0), True),  # through both caps
        ((-3, 0, 0), (-2, 0, 0), False),  # it lies beyond the light
        ((-3, 0, 0), (-9, 0, 0), False),  # it lies behind the point
        ((-3, 1, 0), (3, 1, 0), False),  # along the side: a touch
        ((-3, 0.9, 0), (3, 0.9, 0), True),
        ((0, -3, 0.9), (0, 3, 0.9), True),  # through the side
        ((0, -3, 1), (0, 3, 1), False),
        ((1, -3, 0), (1, 3, 0), False),  # along a cap
        ((0.9, -3, 0), (0.9, 3, 0), True),
        ((-3, -0.5, 0), (0, -3, 0), False),  # past an edge
        ((-2, 0, 0), (0, 1.5, 0), True),  # through a cap, out of the side
        ((-3, 0, 0), (0.5, 0, 0), True),  # the light is inside
        ((0.5, 0, 0), (3, 0, 0), True),  # the point is inside
        ((0.5, 0, 0), (0, 0.5, 0), False),  # both are
        ((0, 1, 0), (0, 3, 0), False),  # from the side outwards
        ((0, 1, 0), (5, 1.01, 0), False),
        ((0, 1, 0), (0, -3, 0), True),  # from the side through the inside
        ((0, 1, 0), (3, 0, 0), True),
        ((0, 1, 0), (0, -0.5, 0), False),  # from the side to a light inside
        ((1, 0, 0), (3, 0, 0), False),  # from a cap outwards
        ((1, 0.5, 0), (1.01, -8, 0), False),
        ((1, 0, 0), (-3, 0, 0), True),
        ((1, 0, 0), (-0.5, 0, 0), False),
        ((1, 1, 0), (3, 3, 0), False),  # from an edge
        ((1, 1, 0), (3, 1, 0), False),
        ((1, 1, 0), (-3, -3, 0), True),
        ((0, 1 + 1e-15, 0), (3, 2, 0), False),  # rounding off the surface
        ((0, 1 - 1e-15, 0), (3, 2, 0), False),
        ((1 - 1e-15, 0.5, 0), (3, 2, 0), False),
        ((0, 1 + 1e-15, 0), (0, -0.5, 0), False),
        ((0.5, 0, 0), (1 + 1e-15, 0, 0), False),
        ((0.5, 0, 0), (0, 1 + 1e-15, 0), False),
        ((-3, 0, 0), (-1, 0, 0), False),  # a light on the near cap
        ((-3, 0, 0), (1, 0, 0), True),  # on the far cap
        ((0, -3, 0), (0, -1, 0), False),  # on the near side
        ((0, -3, 0), (0, 1, 0), True),  # on the far side
        ((-3, 0, 0), (-3, 0, 0), False),  # the light is at the point
        ((0, 0, 0), (0, 0, 0), False),
    ],
)
def test_hides(start: Point, end: Point, hides: bool) -> None:
    segment = Segment(tuple(map(float, start)), tuple(map(float, end)), 1.0, 1.0, 2.0, 2.0)
    for ends in (LYING, (LYING[1], LYING[0], 1)):
        assert bool(cylinder_hides(cylinder(*ends), segment)) is hides


@pytest.mark.parametrize(
    ("start", "end", "end_plane_depth", "hides"),
    [
        ((-3, 0, 0), (9, 0, 0), -1, True),  # the half that exists ends at x = 3
        ((-3, 0, 0), (9, 0, 0), -11, False),  # and here at -2
        ((-3, 0, 0), (9, 0, 0), -5, False),  # at its surface
        ((-3, 0, 0), (9, 0, 0), -3, True),  # within
        ((0, 0, 0), (9, 0, 0), -17, False),
        ((0, 0, 0), (9, 0, 0), -1, True),
        ((0, 1, 0), (0, -3, 0), -1, False),
        ((0, 1, 0), (0, -7, 0), -1, True),
    ],
)
def test_hides_nothing_behind_the_image_plane(
    start: Point, end: Point, end_plane_depth: float, hides: bool
) -> None:
    ends = tuple(map(float, start)), tuple(map(float, end))
    segment = Segment(*ends, 1.0, float(end_plane_depth), 2.0, 2.0)
    assert bool(cylinder_hides(cylinder(*LYING), segment)) is hides


@pytest.mark.skipif(JIT, reason="replaces what compiled code has taken in")
@settings(max_examples=300)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 3.0, 1e6]))
def test_what_passes_by_hides_nothing(seed: int, away: float) -> None:
    rng = np.random.default_rng(seed)
    first, axis, way = rng.normal(size=(3, 3))
    first += away * rng.normal(size=3)
    shape = cylinder(tuple(first), tuple(first + axis), abs(rng.normal()))
    # They pass the axis between the caps, at about the radius: off by rounding, or by more.
    beside = np.cross(axis, way)
    beside *= shape.side_radius / math.sqrt(beside @ beside)
    beside *= 1.0 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-17, 0)
    passed = first + rng.random() * axis + beside
    ends = [tuple(map(float, passed + to * way)) for to in (-rng.random(), rng.random())]
    scales = [magnitude(end) for end in ends]
    segment = Segment(*ends, 1.0, 1.0, *scales)
    quick = cylinder_hides(shape, segment)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("vtray.geometry.shapes.cylinder.passes_by", lambda *_: False)
        assert quick == cylinder_hides(shape, segment)


def test_a_light_far_away_does_not_blur_where_it_passes_the_image_plane() -> None:
    # It does so within, a thousandth beyond the near cap.
    share = 2.001 / (1e12 + 3)
    segment = Segment((-3.0, 0.0, 0.0), (1e12, 0.0, 0.0), 1.0, 1 - 1 / share, 2.0, 1e12)
    assert cylinder_hides(cylinder(*LYING), segment)


def test_what_is_met_at_a_small_angle_is_in_the_image_plane_sooner() -> None:
    # A thousandth off the axis, the error of the distance is a thousand times that of the place.
    rise = 1e-3
    way = 0.0, rise, math.sqrt(1 - rise * rise)
    for plane_depth, expected in ((1e-6, 1.0), (1e-9, 1 + 2 / rise)):
        origin = 0.0, -1 - rise, 5 - way[2]
        ray = Ray(origin, way, plane_depth - 1.0, 1.0, 0.0, 0.0)
        shape = cylinder((0, 0, 4), (0, 0, 9e3), 1)
        assert cylinder_distance(shape, ray) == pytest.approx(expected)


@pytest.mark.parametrize(
    "ends",
    [
        ((0, 0, 4), (0, 0, 8), 0),
        ((0, 0, 6), (0, 0, 6), 1),
        ((0, 0, 6), (0, 0, 6), 0),
        ((0, 0, 6), (0, 0, 6 + 1e-200), 1),
    ],
)
@pytest.mark.parametrize("direction", [UP, ACROSS, (0, 0.6, 0.8), (0.6, -0.8, 0)])
def test_without_length_or_radius_it_is_nothing(
    ends: tuple[Point, Point, float], direction: Point
) -> None:
    shape = cylinder(*ends)
    way = tuple(map(float, direction))
    for far in (5.0, 1e-9, 0.0):
        from_middle = tuple(float(m - far * w) for m, w in zip((0, 0, 6), way, strict=True))
        for bound in (0.0, 1e-13):
            ray = Ray(from_middle, way, 1.0, 1.0, 0.0, bound)
            assert cylinder_distance(shape, ray) == INF
        beyond = tuple(float(m + w) for m, w in zip((0, 0, 6), way, strict=True))
        assert not cylinder_hides(shape, Segment(from_middle, beyond, 1.0, 1.0, 2.0, 2.0))


@pytest.mark.parametrize(
    ("point", "pole", "is_round", "is_second"),
    [
        ((1, 0, 5), (0, 0, 5), True, False),
        ((0, -1, 7), (0, 0, 7), True, True),
        ((0, -1, 6), (0, 0, 6), True, False),
        ((0, -1, 6 + 1e-15), (0, 0, 6), True, False),  # no farther than rounding explains
        ((0.5, 0.5, 4), (0, 0, -1), False, False),
        ((0.5, 0.5, 8 + 1e-15), (0, 0, 1), False, True),
        ((1 + 1e-15, 0, 4.001), (0, 0, 4.001), True, False),  # near an edge
    ],
)
def test_surface(point: Point, pole: Point, is_round: bool, is_second: bool) -> None:
    shape, place = cylinder(*UPRIGHT), tuple(map(float, point))
    found, found_round = cylinder_pole(shape, place)
    assert found == pytest.approx(pole)
    assert bool(found_round) is is_round
    assert bool(is_second_half(shape, place, 1.0)) is is_second


@pytest.mark.parametrize(
    ("origin", "direction", "plane_depth", "expected"),
    [
        ((-3, 0, 5), ACROSS, 1, INF),  # one of its halves
        ((-3, 0, 6.05), ACROSS, 1, 2),  # and both
        ((-3, 0.95, 5), ACROSS, 1, 3 - math.sqrt(1 - 0.95**2)),  # outlines: hit
        ((-3, 1.05, 5), ACROSS, 1, 3 - math.sqrt(1.1**2 - 1.05**2)),  # and just missed
        ((-3, 1.15, 5), ACROSS, 1, INF),
        ((-3, 0, 4.05), ACROSS, 1, 2),
        ((-3, 0, 3.95), ACROSS, 1, 1.9),
        ((-3, 0, 3.85), ACROSS, 1, INF),
        ((0, 0, 0), UP, 1, INF),  # the middle of a cap
        ((0, 0.95, 0), UP, 1, 4),
        ((0, 1.05, 0), UP, 1, 4),
        ((0, 1.15, 0), UP, 1, INF),
        ((0, -4, 0), SLANTED, 1, 5),  # the edge between cap and side
        ((0, -3.8, 0), SLANTED, 1, INF),
        ((0, -4.2, 0), SLANTED, 1, INF),
        ((0, 5, 12), (0, -0.6, -0.8), 1, INF),
        ((0, -4, 0), SLANTED, -6, INF),  # which is behind the image plane
        ((0, -2.8, 3), SLANTED, 1, INF),  # the far edge
        ((0, -2.8, 3), SLANTED, -3.5, 6.2),  # seen from within
        ((-3, 0, 5), ACROSS, -9, INF),  # all of it is behind the image plane
    ],
)
def test_edges(origin: Point, direction: Point, plane_depth: float, expected: float) -> None:
    ray = Ray(
        tuple(map(float, origin)), tuple(map(float, direction)), float(plane_depth), 1.0, 0.0, 0.0
    )
    first, last = image_plane_range(ray, Footprint(0.1, 0.0))
    bundle = Bundle(ray.origin, ray.direction, 0.1, 0.0, 1.0, None, None, first, last, True)
    near, far = cylinder_crossing(cylinder(*UPRIGHT), bundle)
    if expected < INF:
        assert far == INF
        assert near <= expected + 0.03
        assert near > expected - 0.6
    else:
        assert near == INF or far < near + 0.7


def test_bundles_grow() -> None:
    # The axis is nearest at 5, and 1.5 away; but nearest in widths of the bundle at 5.8.
    shape = cylinder((1.5, 0, -5), (1.5, 0, 15), 0.5)
    start, way = (0.0, -3.0, 1.0), (0.0, 0.6, 0.8)
    for growth, is_met in ((0.16, False), (0.188, True)):
        bundle = Bundle(start, way, 0.0, growth, 1.0, None, None, 0.0, 0.0, True)
        assert (cylinder_crossing(shape, bundle).near < INF) == is_met


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_boxes(dtype: type) -> None:
    random = np.random.default_rng(1)
    count = 50 if JIT else 10
    start, end = random.normal(size=(2, count, 3)).astype(dtype)
    end[::5] = start[::5]
    end[1::5, 1:] = start[1::5, 1:]  # along an axis
    radius = random.uniform(0, 2, count).astype(dtype)
    given = GivenCylinders(start, end, radius)
    boxes = np.empty((6, count), np.float64)
    given.bound(0, count, boxes)
    for k in range(count):
        way = (end[k] - start[k]).astype(float)
        if not way.any():
            way = np.ones(3)
        one = np.cross(way, np.eye(3)[np.argmin(np.abs(way))])
        two = np.cross(way, one)
        one, two = one / np.linalg.norm(one), two / np.linalg.norm(two)
        angle = np.linspace(0, 2 * np.pi, 1000)[:, None]
        rim = radius[k] * (np.cos(angle) * one + np.sin(angle) * two)
        points = np.concatenate([start[k] + rim, end[k] + rim])
        low, high = boxes[:3, k] - boxes[3:, k], boxes[:3, k] + boxes[3:, k]
        if way.all() and (way == 1).all():
            assert (low <= start[k] + 1e-6).all()
            assert (high >= start[k] - 1e-6).all()
        else:
            np.testing.assert_allclose(low, points.min(axis=0), atol=1e-4)
            np.testing.assert_allclose(high, points.max(axis=0), atol=1e-4)


def test_boxes_as_large_as_doubles() -> None:
    most = np.finfo(float).max
    points = np.array([[-most, 0, most]])
    given = GivenCylinders(points, -points, np.ones(1))
    boxes = np.empty((6, 1))
    given.bound(0, 1, boxes)
    np.testing.assert_allclose(boxes[:, 0], [0, 0, 0, most, 1, most], atol=1)
