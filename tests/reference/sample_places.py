"""Where the samples of a pixel lie, written on its own in plain Python and NumPy.

From the papers that ``sampler`` and ``filters`` of vtray name, and only from these; but the table
of a filter is vtray's.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from vtray.transport.sampling.filters import filter_places

WORD = 2**32
MITCHELL_ZERO = 8 / 7


class Places(NamedTuple):
    """Places in the image and what a sample there weighs, all (..., samples)."""

    columns: np.ndarray
    rows: np.ndarray
    weights: np.ndarray


def sample_places(
    columns: np.ndarray, rows: np.ndarray, samples: int, filter_name: str, seed: int = 0
) -> Places:
    """Return the places of the samples of some pixels, given as two arrays of the same shape."""
    pixels = zip(columns.flat, rows.flat, strict=True)
    keys = np.array([pixel_keys(int(x), int(y), 0, seed) for x, y in pixels], np.uint64)
    keys = keys.reshape(-1, 2)
    shares = owen(np.array(sobol(samples), np.uint64), keys[..., None])
    shares = shares.reshape(*columns.shape, 2, samples)
    table = filter_places(filter_name)
    steps = len(table) - 2
    # Between two entries, in the order of operations of vtray.
    at = shares * steps
    step = at.astype(int)
    x = table[step] + (at - step) * (table[step + 1] - table[step])
    across, below = x[..., 0, :], x[..., 1, :]
    weights = np.ones(across.shape)
    if filter_name == "mitchell":
        weights = np.where(
            (np.abs(across) > MITCHELL_ZERO) == (np.abs(below) > MITCHELL_ZERO), 1, -1
        )
        # Where they would nearly cancel, all count the same.
        weights = np.where(weights.sum(axis=-1, keepdims=True) < samples / 2, 1.0, weights)
    return Places(across + columns[..., None], below + rows[..., None], weights)


def lens_places(
    columns: np.ndarray, rows: np.ndarray, samples: int, blades: int = 0, seed: int = 0
) -> np.ndarray:
    """Return where samples go through a lens of radius 1, to the right and down, (..., samples, 2).

    The opening is a disc, or a polygon of so many sides.
    """
    digits = (samples - 1).bit_length()
    points = np.array(sobol(1 << digits), np.uint64)
    found = np.zeros((columns.size, samples, 2))
    for k, (x, y) in enumerate(zip(columns.flat, rows.flat, strict=True)):
        deal, _ = pixel_keys(int(x), int(y), 2, seed)
        # Owen's scrambling of the digits of the sample's number.
        numbers = np.arange(samples, dtype=np.uint64) << np.uint64(32 - digits)
        order = (owen(numbers, np.uint64(deal)) * 2**digits).astype(int) if digits else [0]
        keys = np.array(pixel_keys(int(x), int(y), 1, seed), np.uint64)
        found[k] = opening(*owen(points, keys[:, None])[:, order], blades)
    return found.reshape(*columns.shape, samples, 2)


def opening(u: np.ndarray, v: np.ndarray, blades: int = 0) -> np.ndarray:
    """Return places in a disc or a polygon of radius 1 for points of the square, (..., 2)."""
    if blades:
        turns = 2 * np.pi * np.arange(blades + 1) / blades
        corners = np.stack([np.sin(turns), -np.cos(turns)], axis=-1)
        side = np.minimum((v * blades).astype(int), blades - 1)
        along = (v * blades - side)[..., None]
        return np.sqrt(u)[..., None] * ((1 - along) * corners[side] + along * corners[side + 1])
    a, b = 2 * u - 1, 2 * v - 1
    is_wide = np.abs(a) > np.abs(b)
    radius = np.where(is_wide, a, b)
    with np.errstate(invalid="ignore"):
        ratio = np.nan_to_num(np.where(is_wide, b, a) / radius)
    turn = np.where(is_wide, np.pi / 4 * ratio, np.pi / 2 - np.pi / 4 * ratio)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=-1)


def mean(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return weighted means of samples, (..., samples, 3), added up one after the other."""
    light, total = np.zeros((*values.shape[:-2], 3)), np.zeros(values.shape[:-2])
    for k in range(values.shape[-2]):
        light = light + weights[..., k, None] * values[..., k, :]
        total = total + weights[..., k]
    return light / total[..., None]


def sobol(count: int, begin: int = 0) -> list[list[int]]:
    """Return two coordinates of Sobol's points, from Pascal's triangle, as 32 binary digits each.

    The first digit after the point is the highest. So many points follow that of number `begin`.
    """
    digits = np.arange(begin, begin + count)[:, None] >> np.arange(32) & 1
    pascal = np.array([[math.comb(i, j) % 2 for j in range(32)] for i in range(32)])
    return [
        [from_digits(point) for point in axis.tolist()] for axis in (digits, digits @ pascal % 2)
    ]


def place_in_order(column: int, row: int, digits: int, key: int) -> int:
    """Return the place of a pixel among ``2**digits`` that form a square, neighbours together."""
    interleaved = 0
    for k in range(digits // 2):
        interleaved += (column >> k & 1) << 2 * k | (row >> k & 1) << 2 * k + 1
    return int(owen(interleaved << 32 - digits, key) * 2**digits)


def from_digits(digits: list[int]) -> int:
    """Return an integer from 32 binary digits, the highest first."""
    return int("".join(map(str, digits)), 2)


def reversed_bits(number: Any) -> Any:
    """Return integers of 32 bits with their order reversed."""
    return sum((number >> k & 1) << (31 - k) for k in range(32))


def owen(point: Any, key: Any) -> Any:
    """Return a coordinate after Owen's scrambling, by the hash of Laine, Karras and Vegdahl."""
    bits = reversed_bits(point)
    bits = bits ^ bits * 0x3D20ADEA % WORD
    bits = (bits + key) % WORD
    bits = bits * (key >> 16 | 1) % WORD
    bits = bits ^ bits * 0x05526C56 % WORD
    bits = bits ^ bits * 0x53A22864 % WORD
    return reversed_bits(bits) / WORD


def pixel_keys(*numbers: int) -> tuple[int, int]:
    """Return two keys of 32 bits for column, row, purpose and seed."""
    # The lowest bits of the hash, which become the first digits of the points, are its worst.
    x, y, _, _ = pcg4d(*numbers)
    return x ^ x >> 16, y ^ y >> 16


def pcg4d(*numbers: int) -> list[int]:
    """Return four numbers of 32 bits from four."""
    x, y, z, w = ((n * 1664525 + 1013904223) % WORD for n in numbers)

    def stir() -> None:
        nonlocal x, y, z, w
        x = (x + y * w) % WORD
        y = (y + z * x) % WORD
        z = (z + x * y) % WORD
        w = (w + y * z) % WORD

    stir()
    x, y, z, w = (n ^ n >> 16 for n in (x, y, z, w))
    stir()
    return [x, y, z, w]
