"""Light from what several caps have in common: sums of parts, known cases, and a plain integral."""

import math

import numpy as np
import pytest

from conftest import once
from vtray.base.compiler.compiled import kernel, uncompiled
from vtray.geometry.caps import MOST_CAPS, UNKNOWN, Caps, light_within, new_caps, set_cap

Cap = tuple[np.ndarray, float]
"""The unit vector in its middle, and its angle from there to the border, below pi."""

UP = np.array([0.0, 0.0, 1.0])
ABOVE = (UP, math.pi / 2)
"""What is above a horizon."""


@kernel
def light_of(caps: Caps, count: int, normal: tuple[float, float, float]) -> float:
    """Return the light within caps."""
    return light_within(caps, count, normal)


def light(*items: Cap, normal: np.ndarray = UP, is_plain: bool = False) -> float:
    """Return the light within caps."""
    caps = new_caps()
    for k, (axis, angle) in enumerate(items):
        way = tuple(float(x) for x in axis)
        uncompiled(set_cap)(caps, k, way, math.cos(angle), math.sin(angle))
    called = uncompiled(light_within) if is_plain else light_of
    return float(called(caps, len(items), tuple(float(x) for x in normal)))


def outside(cap: Cap) -> Cap:
    """Return the cap of all other directions."""
    return -cap[0], math.pi - cap[1]


def unit(way: np.ndarray) -> np.ndarray:
    """Return a vector of length 1."""
    return way / math.sqrt(way @ way)


def near(random: np.random.Generator, axis: np.ndarray, by: float) -> np.ndarray:
    """Return a direction about so far from another, in radians."""
    return unit(axis + by * random.normal(size=3))


def lamp_and_balls(random: np.random.Generator, balls: int) -> list[Cap]:
    """Return a lamp that a horizon cuts, and what some balls leave."""
    angle = 10 ** random.uniform(-2, -0.3)
    side = unit(np.append(random.normal(size=2), 0.0))
    rise = random.uniform(-0.9, 0.9) * angle
    axis = math.cos(rise) * side + math.sin(rise) * UP
    parts = [(axis, angle), ABOVE]
    for _ in range(balls):
        size = angle * 10 ** random.uniform(-0.7, 0.7)
        parts.append(outside((near(random, axis, 0.6 * (angle + size)), min(size, 1.4))))
    return parts


def integral(parts: list[Cap], rows: int = 1000) -> float:
    """Return the light within caps, summed over a grid in the first of them."""
    axis, angle = parts[0]
    square = (np.arange(rows) + 0.5) / rows
    height = 1 - (1 - math.cos(angle)) * square[:, None]
    turn = 2 * math.pi * square[None, :]
    radius = np.sqrt(1 - height * height)
    beside = unit(np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))]))
    other = np.cross(axis, beside)
    ways = (
        height[..., None] * axis
        + (radius * np.cos(turn))[..., None] * beside
        + (radius * np.sin(turn))[..., None] * other
    )
    is_within = np.ones(ways.shape[:2], bool)
    for middle, reach in parts[1:]:
        is_within &= ways @ middle >= math.cos(reach)
    return float((ways @ UP * is_within).mean()) * 2 * math.pi * (1 - math.cos(angle))


def test_all_of_a_cap_is_as_bright_as_its_middle() -> None:
    axis = unit(np.array([0.3, -0.4, 1.2]))
    for angle in (0.01, 0.2, 0.5):
        expected = math.pi * math.sin(angle) ** 2 * axis[2]
        assert light((axis, angle)) == pytest.approx(expected, rel=1e-13)
        assert light((axis, angle), ABOVE) == pytest.approx(expected, rel=1e-13)
    assert light(ABOVE) == pytest.approx(math.pi, rel=1e-13)


def test_nothing_in_common_is_dark() -> None:
    axis = unit(np.array([0.3, -0.4, 1.2]))
    assert light((axis, 0.2), (-axis, 0.3)) == 0.0
    assert light((axis, 0.2), outside((axis, 0.3))) == 0.0
    assert light((-axis, 0.2), ABOVE) == 0.0


def test_a_cap_within_another_is_left_out_as_a_whole() -> None:
    one, other = (UP, 0.5), (unit(np.array([0.1, 0.0, 1.0])), 0.2)
    expected = math.pi * (math.sin(0.5) ** 2 - math.sin(0.2) ** 2 * other[0][2])
    assert light(one, outside(other)) == pytest.approx(expected, rel=1e-13)


@once
@pytest.mark.parametrize("balls", [0, 1, 2, 3, 4])
def test_what_is_in_a_cap_and_what_is_not_is_all(balls: int) -> None:
    random, known = np.random.default_rng(balls), 0
    for _ in range(300):
        parts = lamp_and_balls(random, balls)
        angle = parts[0][1]
        cut = near(random, parts[0][0], angle), angle * random.uniform(0.2, 2)
        pieces = light(*parts, cut), light(*parts, outside(cut)), light(*parts)
        if UNKNOWN in pieces:
            continue
        known += 1
        # Rounding counts beside the length of the border.
        assert pieces[0] + pieces[1] == pytest.approx(pieces[2], abs=1e-12 * angle)
    assert known > 290


@once
@pytest.mark.parametrize("balls", [0, 1, 2, 3])
def test_against_an_integral(balls: int) -> None:
    random, found = np.random.default_rng(10 + balls), []
    for _ in range(20):
        parts = lamp_and_balls(random, balls)
        all_of_it = math.pi * math.sin(parts[0][1]) ** 2
        expected = integral(parts)
        found.append(expected / all_of_it)
        assert light(*parts) == pytest.approx(expected, abs=1e-3 * all_of_it * parts[0][1])
    assert max(found) > 1e-3


@once
def test_compiled_equals_plain_python() -> None:
    random = np.random.default_rng(3)
    for _ in range(50):
        parts = lamp_and_balls(random, 3)
        assert light(*parts) == light(*parts, is_plain=True)


def test_what_is_too_close_to_call_is_unknown() -> None:
    axis = unit(np.array([0.0, 1.0, 0.1]))
    lamp = axis, 0.3
    assert light(lamp, ABOVE, lamp) == UNKNOWN
    assert light((axis, 1e-4), ABOVE) == UNKNOWN
    touching = near(np.random.default_rng(1), axis, 0.0), 0.3 + 1e-12
    assert light(lamp, ABOVE, touching) == UNKNOWN


def test_there_is_room_for_a_lamp_a_horizon_and_what_is_around() -> None:
    random = np.random.default_rng(8)
    assert light(*lamp_and_balls(random, MOST_CAPS - 2)) >= 0.0
