"""Spheres and planes against values worked out by hand."""

import math

import pytest

from vtray.geometry.shapes.plane import intersect_plane, plane_blocks
from vtray.geometry.shapes.sphere import intersect_sphere, sphere_blocks

AHEAD = (0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("eye_from_center", "radius", "expected"),
    [
        ((0.0, 0.0, -5.0), 1.0, (4.0, 6.0)),
        ((0.0, 0.6, -5.0), 1.0, (4.2, 5.8)),
        ((0.0, 0.0, 0.0), 1.0, (-1.0, 1.0)),  # from the inside
        ((0.0, 0.0, 5.0), 1.0, (-6.0, -4.0)),  # behind
        ((0.0, 1.0, -5.0), 1.0, (math.inf, math.inf)),  # a touch is a miss
        ((2.0, 0.0, -5.0), 1.0, (math.inf, math.inf)),
        ((0.0, 0.0, -5.0), 0.0, (math.inf, math.inf)),  # radius 0 is never hit
        ((0.0, 0.0, -1e9), 1e-3, (1e9 - 1e-3, 1e9 + 1e-3)),
    ],
)
def test_intersect_sphere(
    eye_from_center: tuple[float, float, float], radius: float, expected: tuple[float, float]
) -> None:
    assert intersect_sphere(eye_from_center, AHEAD, radius) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("start", "end", "blocks"),
    [
        ((-3.0, 0.0, 0.0), (3.0, 0.0, 0.0), True),  # through the middle
        ((-3.0, 0.0, 0.0), (-2.0, 0.0, 0.0), False),  # the sphere lies beyond the light
        ((-3.0, 0.0, 0.0), (-9.0, 0.0, 0.0), False),  # the sphere lies behind the point
        ((-3.0, 1.0, 0.0), (3.0, 1.0, 0.0), False),  # a touch
        ((-3.0, 0.9, 0.0), (3.0, 0.9, 0.0), True),
        ((-3.0, 0.0, 0.0), (0.5, 0.0, 0.0), True),  # the light is inside
        ((0.5, 0.0, 0.0), (3.0, 0.0, 0.0), True),  # the point is inside
        ((0.5, 0.0, 0.0), (0.0, 0.5, 0.0), False),  # both are
        ((1.0, 0.0, 0.0), (3.0, 0.0, 0.0), False),  # from the surface outwards
        ((1.0, 0.0, 0.0), (-3.0, 0.0, 0.0), True),  # from the surface through the inside
        ((1.0, 0.0, 0.0), (-0.5, 0.0, 0.0), False),  # from the surface to a light inside
        ((1.0 + 1e-15, 0.0, 0.0), (3.0, 1.0, 0.0), False),  # rounding off the surface
        ((1.0 - 1e-15, 0.0, 0.0), (3.0, 1.0, 0.0), False),
        ((-3.0, 0.0, 0.0), (-1.0, 0.0, 0.0), False),  # a light on the near surface
        ((-3.0, 0.0, 0.0), (1.0, 0.0, 0.0), True),  # a light on the far surface
    ],
)
def test_sphere_blocks(
    start: tuple[float, float, float], end: tuple[float, float, float], blocks: bool
) -> None:
    to_end = (end[0] - start[0], end[1] - start[1], end[2] - start[2])
    assert bool(sphere_blocks(start, to_end, end, 1.0, 1e-14, 1e-14)) is blocks


@pytest.mark.parametrize(
    ("height", "descent", "expected"),
    [(2.0, 0.5, 4.0), (-2.0, -0.5, 4.0), (2.0, -0.5, -4.0), (2.0, 0.0, math.inf)],
)
def test_intersect_plane(height: float, descent: float, expected: float) -> None:
    assert intersect_plane(height, descent) == expected


@pytest.mark.parametrize(
    ("start", "end", "start_plane_depth", "end_plane_depth", "blocks"),
    [
        (1.0, -1.0, 1.0, 1.0, True),
        (-1.0, 1.0, 1.0, 1.0, True),
        (1.0, 2.0, 1.0, 1.0, False),  # both on one side
        (1e-15, -1.0, 1.0, 1.0, False),  # the point is on the plane
        (1.0, 0.0, 1.0, 1.0, False),  # the light is on the plane
        (1.0, -1.0, 1.0, -0.9, True),  # crosses just in front of the image plane
        (1.0, -1.0, 1.0, -1.0, False),  # in it
        (1.0, -1.0, 1.0, -1.1, False),  # behind it
        (1.0, -3.0, 1.0, -2.0, True),
        (3.0, -1.0, 1.0, -2.0, False),
    ],
)
def test_plane_blocks(
    start: float, end: float, start_plane_depth: float, end_plane_depth: float, blocks: bool
) -> None:
    assert bool(plane_blocks(start, end, start_plane_depth, end_plane_depth, 1e-14)) is blocks
