"""Morton's codes, and the order of keys."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from conftest import once
from vtray.geometry.bvh import key_sort
from vtray.geometry.bvh.key_sort import sort_few, sort_keys
from vtray.geometry.bvh.morton import Grid, in_one_cell, key_number, make_grid
from vtray.geometry.bvh.morton import make_key as make_any_key

UNIT = make_grid((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), 10)


def make_key(point: tuple[float, float, float], number: int, grid: Grid) -> np.uint64:
    return np.uint64(make_any_key(point, number, grid))


def code(key: np.uint64, grid: Grid) -> int:
    return int(key) >> grid.number_bits


@pytest.mark.parametrize(
    ("number_bits", "axis_bits"), [(1, 21), (2, 20), (10, 18), (16, 16), (17, 15), (27, 12)]
)
def test_keys_have_room_for_codes_and_numbers(number_bits: int, axis_bits: int) -> None:
    grid = make_grid((0.0, 0.0, 0.0), (1.0, 4.0, 2.0), number_bits)
    assert grid == ((0.0, 0.0, 0.0), 2.0**axis_bits / 4, axis_bits, number_bits)
    last = (1 << number_bits) - 1
    key = make_key((9.0, 9.0, 9.0), last, grid)
    assert int(key) == (1 << 3 * axis_bits + number_bits) - 1
    assert key_number(key, grid) == last


def test_codes_worked_out_by_hand() -> None:
    grid = make_grid((-1.0, 0.0, 2.0), (7.0, 8.0, 10.0), 58)  # two bits for each coordinate
    assert grid.axis_bits == 2
    cells = {
        (-1.0, 0.0, 2.0): 0b000_000,
        (1.0, 0.0, 2.0): 0b000_100,
        (-1.0, 2.0, 2.0): 0b000_010,
        (-1.0, 0.0, 4.0): 0b000_001,
        (3.0, 0.0, 2.0): 0b100_000,
        (5.5, 3.9, 6.0): 0b101_110,
        (7.0, 8.0, 10.0): 0b111_111,
        (-9.0, 99.0, 1.9): 0b010_010,  # outside of the grid: the nearest cell
    }
    for place, expected in cells.items():
        assert code(make_key(place, 5, grid), grid) == expected


@pytest.mark.parametrize("size", [0.0, 5e-324, 1e-310, 1e-300, 1e-9])
def test_grids_of_the_smallest_boxes(size: float) -> None:
    grid = make_grid((0.0, -size, 0.0), (size, 0.0, 0.0), 20)
    assert np.isfinite(grid.cells)
    assert (grid.cells > 0) == (size > 0)
    keys = [make_key(place, 3, grid) for place in ((0.0, -size, 0.0), (size, 0.0, 0.0))]
    assert [key_number(key, grid) for key in keys] == [3, 3]
    assert keys[0] <= keys[1]
    assert in_one_cell(*keys, grid) == (size < 1e-305)


FRACTIONS = st.floats(0, 1)
POINTS = st.tuples(FRACTIONS, FRACTIONS, FRACTIONS)


@given(POINTS, st.integers(0, 1023), POINTS, st.integers(0, 1023))
def test_keys_sort_as_codes_and_then_as_numbers(one: tuple, i: int, two: tuple, j: int) -> None:
    first, second = make_key(one, i, UNIT), make_key(two, j, UNIT)
    assert (key_number(first, UNIT), key_number(second, UNIT)) == (i, j)
    assert (first < second) == ((code(first, UNIT), i) < (code(second, UNIT), j))
    assert in_one_cell(first, second, UNIT) == (code(first, UNIT) == code(second, UNIT))
    # The bits of the three coordinates take turns, from the highest on.
    cells = [min(int(part * 2**18), 2**18 - 1) for part in one]
    turns = [str(cell >> bit & 1) for bit in range(17, -1, -1) for cell in cells]
    assert code(first, UNIT) == int("".join(turns), 2)


SHAPES: dict[str, Callable[[np.random.Generator, int], np.ndarray]] = {
    "random": lambda random, n: random.integers(0, 2**64, n, np.uint64),
    "sorted": lambda random, n: np.arange(n, dtype=np.uint64),
    "reversed": lambda random, n: np.arange(n, dtype=np.uint64)[::-1].copy(),
    "equal": lambda random, n: np.full(n, 2**64 - 1, np.uint64),
    "few values": lambda random, n: random.integers(0, 3, n, np.uint64),
    "nearly all in front": lambda random, n: np.uint64(2) ** random.integers(0, 9, n, np.uint64),
    "one far away": lambda random, n: np.where(
        np.arange(n) == n // 3, np.uint64(2**63), np.uint64(7)
    ),
}


@once
@pytest.mark.parametrize("threads", [1, 2, 3, 7, 64])
@pytest.mark.parametrize("shape", SHAPES)
def test_keys_are_sorted(shape: str, threads: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(key_sort, "SMALL", 4)
    random = np.random.default_rng(threads)
    for count in (0, 1, 3, 4, 5, 63, 64, 1000, 20_000):
        keys = SHAPES[shape](random, count)
        expected = np.sort(keys)
        np.testing.assert_array_equal(sort_keys(keys, threads), expected)


@pytest.mark.parametrize("shape", SHAPES)
def test_low_bits_that_are_in_order_stay_so(shape: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(key_sort, "SMALL", 20)
    monkeypatch.setattr(key_sort, "CHUNK", 7)
    count = 1500
    high = SHAPES[shape](np.random.default_rng(3), count) >> np.uint64(11)
    keys = high << np.uint64(11) | np.arange(count, dtype=np.uint64)
    expected = np.sort(keys)
    for threads in (1, 2, 5):
        np.testing.assert_array_equal(sort_keys(keys.copy(), threads, 11), expected)


@pytest.mark.parametrize("shape", SHAPES)
def test_few_keys_are_sorted_in_place(shape: str) -> None:
    random = np.random.default_rng(5)
    for count in (0, 1, 2, 3, 8, 9, 100, 257):
        keys = SHAPES[shape](random, count + 7)
        expected = keys.copy()
        expected[3 : 3 + count].sort()
        sort_few(keys, 3, 3 + count)
        np.testing.assert_array_equal(keys, expected)
