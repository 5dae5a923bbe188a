"""How rectangles are seen from a point: their solid angles, and directions that fill them."""

import math
from itertools import product

import numpy as np
import pytest

from conftest import once
from vtray.base.compiler.compiled import uncompiled
from vtray.geometry.vector import dot
from vtray.transport.lights.spherical_rectangle import (
    SphericalRectangle,
    rectangle_direction,
    spherical_rectangle,
    square_integral,
)

Long = np.longdouble
AXES = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def corner_angle(x: float, y: float, z: float) -> np.longdouble:
    """Return the solid angle of a rectangle from below a corner to (x, y), with a sign."""
    wide, high, far = Long(x), Long(y), Long(z)
    return np.arctan(wide * high / (far * np.sqrt(wide**2 + high**2 + far**2)))


def true_angle(left: float, right: float, bottom: float, top: float, z: float) -> np.longdouble:
    """Return the solid angle of a rectangle."""
    one, other = (corner_angle(x, top, z) - corner_angle(x, bottom, z) for x in (left, right))
    return other - one


def some_rectangles() -> list[tuple[tuple[float, float, float], tuple[float, float]]]:
    """Return middles and half edges of rectangles, none seen under a tiny angle."""
    random = np.random.default_rng(4)
    found = []
    for _ in range(200):
        half = 10 ** random.uniform(-1.5, 1.5, 2)
        x, y = random.uniform(-3, 3, 2) * half
        found.append(((float(x), float(y), 10 ** random.uniform(-1, 1)), tuple(map(float, half))))
    return found


def edges(seen: SphericalRectangle) -> tuple[float, float, float, float]:
    """Return where the edges are, as they were rounded."""
    return seen.left, seen.right, seen.bottom, seen.top


@once
@pytest.mark.parametrize(("middle", "half"), some_rectangles())
def test_directions_fill_a_rectangle_evenly(
    middle: tuple[float, float, float], half: tuple[float, float]
) -> None:
    seen = spherical_rectangle(AXES, middle, half)
    left, right, bottom, top = edges(seen)
    height = middle[2]
    whole = true_angle(left, right, bottom, top, height)
    assert seen.solid_angle == pytest.approx(float(whole), rel=1e-11)
    for u, v in product((0.0, 0.01, 0.37, 0.5, 0.93, 1.0), repeat=2):
        x, y, z = rectangle_direction(u, v, seen)
        assert x * x + y * y + z * z == pytest.approx(1.0, abs=1e-15)
        x, y = x / z * height, y / z * height
        # A share of u of the solid angle is to the left, and of the line there a share of v below.
        assert float(true_angle(left, x, bottom, top, height) / whole) == pytest.approx(u, abs=1e-8)
        low, at, high = (place / math.hypot(x, place, height) for place in (bottom, y, top))
        assert (at - low) / (high - low) == pytest.approx(v, abs=1e-8)


@pytest.mark.parametrize("size", [1e-3, 1e-8, 1e-20, 1e-100, 1e-130])
@pytest.mark.parametrize("middle", [(0.0, 0.0, 1.0), (0.3, -0.9, 0.2), (-1.0, 0.0, 1e-4)])
def test_small_rectangles_keep_their_digits(
    middle: tuple[float, float, float], size: float
) -> None:
    half = (size * 0.5 * middle[2], 0.25 * size * middle[2])
    seen = spherical_rectangle(AXES, middle, half)
    distance = math.hypot(*middle)
    expected = 4 * half[0] * half[1] * middle[2] / distance**3
    assert seen.solid_angle == pytest.approx(expected, rel=size + 1e-14)
    for u, v in product((0.0, 0.25, 1.0), repeat=2):
        way = np.array(rectangle_direction(u, v, seen))
        to = np.array(
            [middle[0] + (2 * u - 1) * half[0], middle[1] + (2 * v - 1) * half[1], middle[2]]
        )
        np.testing.assert_allclose(way, to / np.linalg.norm(to), atol=size * size + 1e-15)


@pytest.mark.parametrize(
    ("middle", "half"),
    [
        ((0.0, 0.0, 1e-14), (0.5, 0.4)),
        ((0.5, 0.4, 1e-14), (0.5, 0.4)),
        ((0.9, 0.0, 1e-14), (1e-3, 0.1)),
        ((0.0, 0.9, 1e-14), (1e-3, 0.1)),
        ((0.9, 0.9, 1e-14), (1e-140, 0.1)),
        ((0.0, 0.0, 1e-14), (1e-140, 1e-140)),
        ((0.0, 0.0, 1.0), (1e-140, 1e-140)),
        ((0.0, 0.0, 0.1), (0.9, 1e-140)),
        ((0.6, -0.6, 1e-15), (0.6, 0.6)),
    ],
)
def test_odd_rectangles_give_directions(
    middle: tuple[float, float, float], half: tuple[float, float]
) -> None:
    seen = spherical_rectangle(AXES, middle, half)
    assert 0 <= seen.solid_angle <= 2 * math.pi * (1 + 1e-14)
    for u, v in product((0.0, 0.5, np.nextafter(1, 0)), repeat=2):
        x, y, z = rectangle_direction(u, v, seen)
        assert x * x + y * y + z * z == pytest.approx(1.0, abs=1e-14)
        assert z >= 0


def test_the_integral_straight_in_front() -> None:
    # Of all there is to see the integral is pi; of a small rectangle its solid angle.
    assert square_integral(1e-9, (1.0, 1.0)) == pytest.approx(math.pi, abs=1e-8)
    assert square_integral(1.0, (1e-8, 2e-8)) == pytest.approx(8e-16, rel=1e-12)
    # Midpoints of many small parts.
    x, y = (np.arange(400) + 0.5) / 400 * 2 - 1, (np.arange(400) + 0.5) / 400 - 0.5
    distance2 = x[:, None] ** 2 + y**2 + 0.7**2
    expected = (0.7**2 / distance2**2).sum() * (2 / 400) * (1 / 400)
    assert square_integral(0.7, (1.0, 0.5)) == pytest.approx(expected, rel=1e-5)


def test_frames_turn_directions() -> None:
    frame = (0.0, 0.6, 0.8), (-1.0, 0.0, 0.0), (0.0, -0.8, 0.6)
    plain = spherical_rectangle(AXES, (0.2, -0.1, 0.4), (0.3, 0.2))
    turned = spherical_rectangle(frame, (0.2, -0.1, 0.4), (0.3, 0.2))
    way, other = (rectangle_direction(0.3, 0.8, seen) for seen in (plain, turned))
    assert [dot(other, axis) for axis in frame] == pytest.approx(list(way), abs=1e-15)


def test_compiled_equals_plain_python() -> None:
    for middle, half in some_rectangles()[::20]:
        seen = spherical_rectangle(AXES, middle, half)
        assert seen == uncompiled(spherical_rectangle)(AXES, middle, half)
        for u, v in product((0.0, 0.1, 0.9), repeat=2):
            plain = uncompiled(rectangle_direction)(u, v, seen)
            assert rectangle_direction(u, v, seen) == plain
