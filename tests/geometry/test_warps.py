"""The unit square turned into a disc and into directions: where to, how dense, and how fast."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from machine_code import instructions_in

from conftest import JIT, compiled_only, x86_only
from vtray.base.compiler.compiled import Kernel, kernel, uncompiled
from vtray.base.compiler.object_code import compile_object
from vtray.geometry.warps import (
    cone_direction,
    cosine_direction,
    disc_point,
    frame_around,
)

Vec = tuple[float, float, float]

BELOW_ONE = math.nextafter(1, 0)
ROUNDING = 1e-15
SIDE = 256 if JIT else 64
STEP = 1e-6
"""Of differences that stand for derivatives."""

SHARES = st.sampled_from([0.0, 0.25, 0.5, BELOW_ONE, 2.0**-32]) | st.floats(0, 1, exclude_max=True)
INNER_SHARES = st.floats(0.01, 0.99)
HEIGHTS = st.sampled_from([0.0, 1e-300, 1e-20, 1e-9, 1.0, 2.0]) | st.floats(0, 2)
NARROW_HEIGHTS = st.floats(1e-3, 2)
PARTS = st.sampled_from([0.0, -0.0, 1.0, -1.0, 1e-9, -1e-9, 1e-160]) | st.floats(-1, 1)


def unit_vector(parts: Vec) -> Vec:
    length = math.hypot(*parts)
    x, y, z = (part / length for part in parts)
    return x, y, z


UNIT_VECTORS = st.tuples(PARTS, PARTS, PARTS).filter(lambda v: math.hypot(*v) > 1e-9)
UNIT_VECTORS = UNIT_VECTORS.map(unit_vector)


def grid() -> Any:
    """Give the centres of fine cells of the unit square."""
    for row in range(SIDE):
        for column in range(SIDE):
            yield (column + 0.5) / SIDE, (row + 0.5) / SIDE


def scaling(warp: Callable[[float, float], Any], u: float, v: float) -> float:
    """Return how much larger a small area is than that of the square it is made from."""
    # The map has a kink on the diagonals, and no derivative in the middle.
    a, b = abs(2 * u - 1), abs(2 * v - 1)
    assume(abs(a - b) > 1e-3)
    across = np.subtract(warp(u + STEP, v), warp(u - STEP, v)) / (2 * STEP)
    down = np.subtract(warp(u, v + STEP), warp(u, v - STEP)) / (2 * STEP)
    if len(across) == 2:
        return abs(across[0] * down[1] - across[1] * down[0])
    return float(np.linalg.norm(np.cross(across, down)))


def test_known_points_of_the_disc() -> None:
    half = math.sqrt(0.5)
    for square, disc in {
        (0.5, 0.5): (0, 0),
        (0.0, 0.5): (-1, 0),
        (0.5, 0.0): (0, -1),
        (0.75, 0.5): (0.5, 0),
        (0.5, 0.75): (0, 0.5),
        (0.0, 0.0): (-half, -half),
        (0.25, 0.75): (-half / 2, half / 2),
    }.items():
        assert disc_point(*square) == pytest.approx(disc, abs=2e-16)


@given(SHARES, SHARES)
def test_disc_is_that_of_shirley_and_chiu(u: float, v: float) -> None:
    a, b = 2 * u - 1, 2 * v - 1
    if abs(a) > abs(b):
        radius, angle = a, math.pi / 4 * b / a
    else:
        radius, angle = b, math.pi / 2 - (math.pi / 4 * a / b if b else 0)
    expected = radius * math.cos(angle), radius * math.sin(angle)
    assert disc_point(u, v) == pytest.approx(expected, abs=4e-16)
    assert math.hypot(*disc_point(u, v)) <= 1 + ROUNDING


@given(INNER_SHARES, INNER_SHARES)
def test_disc_keeps_areas(u: float, v: float) -> None:
    assert scaling(disc_point, u, v) == pytest.approx(math.pi, rel=1e-6)


def test_disc_is_filled_evenly() -> None:
    x, y = np.array([disc_point(u, v) for u, v in grid()]).T
    cells = np.histogram2d(x, y, bins=8, range=[(-1, 1), (-1, 1)])[0]
    corners = np.linspace(-1, 1, 9) ** 2
    farthest = np.maximum(corners[1:], corners[:-1])
    inside = farthest[:, None] + farthest <= 1
    assert inside.sum() == 32
    expected = SIDE**2 / math.pi / 16
    assert cells[inside] == pytest.approx(expected, rel=0.03 if JIT else 0.1)


@given(UNIT_VECTORS)
def test_frame_is_orthonormal(axis: Vec) -> None:
    frame = np.array([*frame_around(axis), axis])
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), rtol=0, atol=ROUNDING)
    assert np.linalg.det(frame) > 0


@given(SHARES, SHARES, UNIT_VECTORS)
def test_cosine_directions_are_above_the_surface(u: float, v: float, normal: Vec) -> None:
    way = cosine_direction(u, v, normal)
    x, y = disc_point(u, v)
    height = math.sqrt(max(1 - x * x - y * y, 0))
    assert math.hypot(*way) == pytest.approx(1, abs=ROUNDING)
    # Near the horizon a root has half as many digits.
    assert np.dot(way, normal) == pytest.approx(height, abs=3e-8 if height < 1e-3 else 1e-12)
    assert np.dot(way, normal) >= -ROUNDING


@given(INNER_SHARES, INNER_SHARES, UNIT_VECTORS)
def test_density_of_cosine_directions(u: float, v: float, normal: Vec) -> None:
    cosine = np.dot(cosine_direction(u, v, normal), normal)
    assume(cosine > 0.1)
    area = scaling(lambda u, v: cosine_direction(u, v, normal), u, v)
    assert area == pytest.approx(math.pi / cosine, rel=1e-5)


def test_moments_of_cosine_directions() -> None:
    normal = unit_vector((1, -2, -0.5))
    ways = np.array([cosine_direction(u, v, normal) for u, v in grid()])
    # The height falls off like a root at the edge, where a grid is off by so much.
    expected = np.multiply(normal, 2 / 3)
    np.testing.assert_allclose(ways.mean(axis=0), expected, rtol=0, atol=SIDE**-1.5)
    # Half of them are more than 45 degrees from the normal.
    assert (ways @ normal < math.sqrt(0.5)).mean() == pytest.approx(0.5, abs=2 / SIDE)


@given(SHARES, SHARES, UNIT_VECTORS, HEIGHTS)
def test_cone_directions_are_in_the_cone(u: float, v: float, axis: Vec, height: float) -> None:
    way = cone_direction(u, v, axis, height)
    assert math.hypot(*way) == pytest.approx(1, abs=ROUNDING)
    assert np.dot(way, axis) >= 1 - height - ROUNDING
    if height < 1:  # told apart even where the cosine is 1
        aside = math.hypot(*np.cross(way, axis))
        assert aside <= math.sqrt(height * (2 - height)) * (1 + ROUNDING) + ROUNDING


def test_edge_of_the_disc_may_be_rounded_outwards() -> None:
    edge = [(0.0, k / 256) for k in range(256)]
    assert max(x * x + y * y for x, y in (disc_point(*place) for place in edge)) > 1
    axis = unit_vector((1, 2, 3))
    for place in edge:
        for way in (cosine_direction(*place, axis), cone_direction(*place, axis, 2.0)):
            assert math.hypot(*way) == pytest.approx(1, abs=ROUNDING)


@given(SHARES, SHARES, UNIT_VECTORS)
def test_cone_without_width_is_its_axis(u: float, v: float, axis: Vec) -> None:
    assert cone_direction(u, v, axis, 0.0) == axis


@given(UNIT_VECTORS, HEIGHTS)
def test_middle_of_a_cone_is_its_axis(axis: Vec, height: float) -> None:
    assert cone_direction(0.5, 0.5, axis, height) == axis


@given(INNER_SHARES, INNER_SHARES, UNIT_VECTORS, NARROW_HEIGHTS)
def test_cone_directions_are_uniform(u: float, v: float, axis: Vec, height: float) -> None:
    area = scaling(lambda u, v: cone_direction(u, v, axis, height), u, v)
    assert area == pytest.approx(2 * math.pi * height, rel=1e-5)


@pytest.mark.parametrize("height", [0.01, 0.5, 1.0, 2.0])
def test_mean_of_a_cone(height: float) -> None:
    axis = unit_vector((-1, 0.3, 2))
    ways = np.array([cone_direction(u, v, axis, height) for u, v in grid()])
    expected = np.multiply(axis, 1 - height / 2)
    np.testing.assert_allclose(ways.mean(axis=0), expected, rtol=0, atol=height / SIDE**2)


@given(SHARES, SHARES, UNIT_VECTORS, HEIGHTS)
def test_compiled_equals_plain_python(u: float, v: float, axis: Vec, height: float) -> None:
    assert disc_point(u, v) == uncompiled(disc_point)(u, v)
    assert frame_around(axis) == uncompiled(frame_around)(axis)
    assert cosine_direction(u, v, axis) == uncompiled(cosine_direction)(u, v, axis)
    in_cone = cone_direction(u, v, axis, height)
    assert in_cone == uncompiled(cone_direction)(u, v, axis, height)


LANES = 8


@kernel
def cosine_lanes(lanes: Any, count: int) -> None:
    """Turn points into directions around normals: rows u, v, normal, then the directions."""
    for k in range(count):
        normal = (lanes[2 * LANES + k], lanes[3 * LANES + k], lanes[4 * LANES + k])
        x, y, z = cosine_direction(lanes[k], lanes[LANES + k], normal)
        lanes[5 * LANES + k] = x
        lanes[6 * LANES + k] = y
        lanes[7 * LANES + k] = z


@kernel
def cone_lanes(lanes: Any, count: int) -> None:
    """Turn points into directions in hemispheres: rows u, v, axis, then the directions."""
    for k in range(count):
        axis = (lanes[2 * LANES + k], lanes[3 * LANES + k], lanes[4 * LANES + k])
        x, y, z = cone_direction(lanes[k], lanes[LANES + k], axis, 1.0)
        lanes[5 * LANES + k] = x
        lanes[6 * LANES + k] = y
        lanes[7 * LANES + k] = z


def in_hemisphere(u: float, v: float, axis: Vec) -> Vec:
    return uncompiled(cone_direction)(u, v, axis, 1.0)


WAYS = [(cosine_lanes, uncompiled(cosine_direction)), (cone_lanes, in_hemisphere)]


def some_lanes() -> np.ndarray:
    """Return eight points, the middle and a corner among them, and axes, (8, 8)."""
    draw = np.random.default_rng(3)
    lanes = np.zeros((8, LANES))
    lanes[:2] = draw.uniform(size=(2, LANES))
    lanes[:2, :2] = 0.5, 0.0
    axes = draw.normal(size=(3, LANES))
    lanes[2:5] = axes / np.sqrt((axes * axes).sum(axis=0))
    return lanes


@pytest.mark.parametrize(("do_lanes", "do_one"), WAYS)
def test_eight_lanes_equal_plain_python(do_lanes: Any, do_one: Any) -> None:
    lanes = some_lanes()
    expected = [do_one(u, v, (x, y, z)) for u, v, x, y, z in lanes[:5].T.tolist()]
    flat = lanes.reshape(-1)
    do_lanes(flat, LANES)
    assert flat.reshape(8, LANES)[5:].T.tolist() == [list(way) for way in expected]


@compiled_only
@x86_only
@pytest.mark.parametrize("do_lanes", [way[0] for way in WAYS])
def test_lanes_are_vectorised(do_lanes: Any) -> None:
    arguments = some_lanes().reshape(-1), LANES
    names = instructions_in(compile_object(do_lanes._function, arguments, Kernel._options).code)
    assert names & {"divpd", "vdivpd"}
    assert names & {"sqrtpd", "vsqrtpd"}
