"""Scrambled points of low discrepancy: nets, uniform, and their own for each pixel."""

import itertools

import numpy as np
import pytest
import sample_places
from hypothesis import given
from hypothesis import strategies as st

from conftest import JIT
from vtray.transport.sampling.sobol import IMAGE_PLACE, pixel_keys, scrambled, sobol_points

WORDS = st.sampled_from([0, 1, 2**16, 2**31, 2**32 - 1]) | st.integers(0, 2**32 - 1)
SIDE = 64 if JIT else 24


def points(count: int, key_x: int, key_y: int) -> np.ndarray:
    """Return the first points under two keys, (count, 2)."""
    keys = (key_x, key_y)
    return np.array(
        [
            [
                scrambled(int(axis[n]), key)
                for axis, key in zip(sobol_points(count), keys, strict=True)
            ]
            for n in range(count)
        ]
    )


@pytest.mark.parametrize("count", [1, 2, 3, 7, 300, 1025])
def test_sobol_points_are_those_of_pascals_triangle(count: int) -> None:
    expected = [list(map(sample_places.reversed_bits, axis)) for axis in sample_places.sobol(count)]
    np.testing.assert_array_equal(sobol_points(count), expected)


def test_most_points() -> None:
    numbers = sobol_points(2**16)
    assert len(np.unique(numbers[1])) == 2**16
    assert numbers.min() == 0
    assert numbers.max() == 2**16 - 1


@given(WORDS, WORDS)
def test_any_block_of_a_power_of_two_is_a_net(key_x: int, key_y: int) -> None:
    levels = 6
    found = points(2**levels, key_x, key_y)
    assert ((found >= 0) & (found < 1)).all()
    for level in range(levels + 1):
        for block in found.reshape(-1, 2**level, 2):
            for wide in range(level + 1):
                # One in each of the cells, which are 2**wide beside 2**(level - wide).
                cells = np.floor(block * (2.0**wide, 2.0 ** (level - wide))).astype(int)
                assert len(set(map(tuple, cells.tolist()))) == 2**level


@given(WORDS, WORDS)
def test_scrambling_equals_the_published_hash(point: int, key: int) -> None:
    expected = sample_places.owen(sample_places.reversed_bits(point), key)
    assert scrambled(point, key) == expected


@given(WORDS, st.integers(0, 31), st.integers(0, 2**32 - 1), WORDS)
def test_a_digit_depends_on_those_before_it_alone(
    point: int, same: int, rest: int, key: int
) -> None:
    # Bits are reversed: the first digits are the lowest.
    other = point & (1 << same) - 1 | (~point & 1 << same) | rest >> (same + 1) << (same + 1)
    one, two = (int(scrambled(p, key) * 2**32) for p in (point, other))
    assert one >> (32 - same) == two >> (32 - same)
    assert one >> (31 - same) != two >> (31 - same)


@given(WORDS, WORDS, st.integers(0, 3), WORDS)
def test_keys_equal_the_published_hash(column: int, row: int, purpose: int, seed: int) -> None:
    expected = sample_places.pixel_keys(column, row, purpose, seed)
    assert pixel_keys(column, row, purpose, seed) == expected


@given(WORDS, WORDS, st.integers(0, 3), WORDS)
def test_keys_differ_by_all_that_they_are_made_of(
    column: int, row: int, purpose: int, seed: int
) -> None:
    given = [column, row, purpose, seed]
    keys = {pixel_keys(*given)}
    for k in range(4):
        keys.add(pixel_keys(*given[:k], given[k] ^ 1, *given[k + 1 :]))
    assert len(keys) == 5
    assert len(set(itertools.chain(*keys))) == 10


def field(sample: int, purpose: int = IMAGE_PLACE, seed: int = 0) -> np.ndarray:
    """Return where a sample of each pixel of a picture lies, (SIDE, SIDE, 2)."""
    numbers = sobol_points(sample + 1)[:, sample].tolist()
    return np.array(
        [
            [
                [
                    scrambled(n, key)
                    for n, key in zip(numbers, pixel_keys(x, y, purpose, seed), strict=True)
                ]
                for x in range(SIDE)
            ]
            for y in range(SIDE)
        ]
    )


@pytest.mark.parametrize("sample", [0, 1, 5])
@pytest.mark.parametrize("seed", [0, 1, 2**32 - 1])
def test_samples_are_uniform_over_pixels(sample: int, seed: int) -> None:
    places = field(sample, seed=seed)
    cells = 4
    x, y = np.moveaxis((places * cells).astype(int), -1, 0)
    counts = np.bincount((x + cells * y).ravel(), minlength=cells**2)
    expected = SIDE**2 / cells**2
    chi_square = ((counts - expected) ** 2 / expected).sum()
    assert chi_square < 44  # of 15 degrees of freedom: once in 10,000


def test_samples_of_pixels_are_independent() -> None:
    places = field(0) - 0.5
    others = {
        "across against down": places[..., ::-1],
        "the pixel above": np.roll(places, 1, axis=0),
        "the pixel to the left": np.roll(places, 1, axis=1),
        "a diagonal": np.roll(places, (1, 1), axis=(0, 1)),
        "another": np.roll(places, (1, -2), axis=(0, 1)),
        "another purpose": field(0, purpose=IMAGE_PLACE + 1) - 0.5,
        "another seed": field(0, seed=1) - 0.5,
    }
    related = {name: (places * other).mean(axis=(0, 1)) * 12 for name, other in others.items()}
    assert all(np.abs(values).max() < 4 / SIDE for values in related.values()), related
    # But the first two points of a pixel are always in different halves.
    assert ((places < 0) != (field(1) < 0.5)).all()
