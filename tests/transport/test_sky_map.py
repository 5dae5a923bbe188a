"""The maps of skies: angles and back, tables, and the density of what is chosen by brightness."""

import math
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT
from vtray.geometry.circle import cosine_sine_of_turn
from vtray.rendering.pack_brightness import pack_brightness
from vtray.rendering.pack_skies import pack_skies
from vtray.transport.lights.sky import Skies, light_at
from vtray.transport.sampling.sky_brightness import bright_density, bright_direction
from vtray.transport.sampling.sky_map import direction_at, map_place
from vtray.transport.sampling.sky_map import eighths_of_turn as eighths
from vtray.transport.sampling.table import find_part, linear_point

COUNT = 4000 if JIT else 300
UP = (0.36, -0.48, 0.8)


def sky_of(pixels: np.ndarray, **options: Any) -> Skies:
    skies = pack_skies([vtray.Sky(image=pixels, **options)], UP)
    assert skies is not None
    return skies


def random_ways(seed: int) -> np.ndarray:
    ways = np.random.default_rng(seed).normal(size=(COUNT, 3))
    return ways / np.sqrt((ways**2).sum(axis=1, keepdims=True))


def test_angles_are_those_of_the_arctangent() -> None:
    for x, y, _ in random_ways(1):
        expected = math.atan2(y, x) / math.pi * 4 % 8
        assert eighths(float(y), float(x)) == pytest.approx(expected, abs=1e-9)
    exact = [(0, 0, 0), (0, 1, 0), (1, 0, 2), (0, -1, 4), (-1, 0, 6), (0.0, 5e-324, 0)]
    for y, x, expected in exact:
        assert eighths(float(y), float(x)) == expected
    for y, x, expected in [(1, 1, 1), (1, -1, 3), (-1, -1, 5), (-1, 1, 7), (1e-300, 1e300, 0)]:
        assert eighths(float(y), float(x)) == pytest.approx(expected, abs=1e-9)


def test_cosines_and_sines_all_around() -> None:
    for turn in np.linspace(0, 8, 161):
        cosine, sine = cosine_sine_of_turn(float(turn))
        angle = math.pi / 4 * turn
        assert (cosine, sine) == pytest.approx((math.cos(angle), math.sin(angle)), abs=1e-15)


def test_places_of_directions_and_back() -> None:
    skies = sky_of(np.ones((7, 20, 3)), rotation=33)
    for way in random_ways(2):
        place = map_place(skies, 0, tuple(way.tolist()))
        assert 0 <= place.across < 20
        assert 0.5 <= place.down <= 7.5
        assert direction_at(skies, 0, place.across, place.down) == pytest.approx(way, abs=1e-8)
    above, below = (map_place(skies, 0, tuple(s * part for part in UP)) for s in (1, -1))
    assert (above.down, below.down) == pytest.approx((0.5, 7.5))


def test_light_is_that_of_pixels_in_their_middles() -> None:
    pixels = np.random.default_rng(3).random((5, 8, 3)).astype(np.float32)
    skies = sky_of(pixels)
    for row in range(5):
        for column in range(8):
            assert light_at(skies, 0, float(column), row + 1.0) == pytest.approx(
                pixels[row, column]
            )
    # Between the last column and the first, and over the poles.
    mean = (pixels[2, 7] / 2 + pixels[2, 0] / 2).tolist()
    assert light_at(skies, 0, 7.5, 3.0) == pytest.approx(mean, rel=1e-6)
    assert light_at(skies, 0, 3.0, 0.5) == pytest.approx(pixels[0, 3])
    assert light_at(skies, 0, 3.0, 5.5) == pytest.approx(pixels[4, 3])


def test_parts_of_sums() -> None:
    sums = np.array([9.0, 0.0, 0.0, 1.0, 1.0, 4.0, 9.0])
    for target, part in [(0.0, 2), (0.5, 2), (1.0, 4), (3.999, 4), (4.0, 5)]:
        assert find_part(sums, 1, 6, target) == part
    assert find_part(sums, 1, 3, 0.5) == 2


@pytest.mark.parametrize(("first", "last"), [(1, 1), (0, 2), (3, 0), (1, 4), (0, 0), (1e-30, 1e30)])
def test_points_as_often_as_a_line_says(first: float, last: float) -> None:
    u = np.linspace(0, 1, 41)
    points = np.array([linear_point(float(k), float(first), float(last)) for k in u])
    assert ((points >= 0) & (points <= 1)).all()
    both = (first + last) or 1
    below = points * first + points**2 * (last - first) / 2 if both != 1 or first else points / 2
    np.testing.assert_allclose(below / both * 2, u, atol=1e-12)


@pytest.mark.parametrize("shape", [(6, 12), (1, 5), (9, 1)])
def test_directions_are_as_often_as_their_density(shape: tuple[int, int]) -> None:
    pixels = np.random.default_rng(5).random((*shape, 3))
    pixels[0, 0] = 100
    skies = sky_of(pixels)
    bright = skies.bright
    ways = random_ways(6)
    density = [
        bright_density(skies, bright, 0, map_place(skies, 0, tuple(w.tolist()))) for w in ways
    ]
    # Over all directions, 4 pi, it is pi: the mean over even directions is a quarter.
    error = np.std(density) / math.sqrt(COUNT)
    assert np.mean(density) == pytest.approx(0.25, abs=4 * error)
    # By importance: the mean of anything over the density comes to its integral.
    u, v = np.random.default_rng(7).random((2, COUNT))
    chosen = [
        bright_direction(float(a), float(b), skies, bright, 0) for a, b in zip(u, v, strict=True)
    ]
    lengths = np.sqrt((np.array(chosen) ** 2).sum(axis=1))
    np.testing.assert_allclose(lengths, 1, atol=1e-12)
    found = [bright_density(skies, bright, 0, map_place(skies, 0, way)) for way in chosen]
    assert min(found) > 0
    for k in range(3):
        values, expected = np.array(chosen)[:, k], 4 * np.array(density) * ways[:, k]
        error = math.hypot(np.std(values), np.std(expected)) / math.sqrt(COUNT)
        assert values.mean() == pytest.approx(expected.mean(), abs=4 * error)


def test_smooth_skies_have_no_table() -> None:
    level, peaked = np.ones((6, 6, 3), np.float32), np.ones((6, 6, 3), np.float32)
    peaked[3, 2] = 50
    assert pack_brightness([]).share.tolist() == []
    assert pack_brightness([level, level]).share.tolist() == [0, 0]
    bright = pack_brightness([level, peaked, level])
    assert bright.share.tolist() == [0, 0.5, 0]
    assert bright.first_row.tolist() == [0, 1, 7]
