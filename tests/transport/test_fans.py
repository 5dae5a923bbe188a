"""Fans of points in a light: nets, those of neighbours too, and their own for each light."""

import itertools
from typing import Any

import numpy as np
import pytest
import sample_places
from hypothesis import given
from hypothesis import strategies as st
from machine_code import instructions_in

from conftest import JIT, compiled_only, once, x86_only
from vtray.base.compiler.compiled import Kernel, kernel, uncompiled
from vtray.base.compiler.object_code import compile_object
from vtray.transport.sampling.fans import (
    COARSE,
    NO_OFFSET,
    RUN,
    Fans,
    Noise,
    block_offsets,
    fan_keys,
    fan_of,
    fan_point,
    fan_points,
    fans_of_middles,
    fans_of_samples,
    fans_of_share,
    halvings_for,
    place_of,
    shared_keys,
)
from vtray.transport.sampling.pixel_order import (
    order_offset,
    order_offsets,
    place_in_order,
)
from vtray.transport.sampling.sobol import (
    IMAGE_PLACE,
    pixel_keys,
    scrambled,
    shuffled,
    sobol_points,
)

WORDS = st.sampled_from([0, 1, 2**16, 2**31, 2**32 - 1]) | st.integers(0, 2**32 - 1)
KEYS = st.tuples(WORDS, WORDS)
FANS = [8, 16, 32, 64, 128, 256]
SIDE = 64 if JIT else 24
NOISE = Noise(0.01, by_light=True)


def points_of(fan: int, blocks: int) -> np.ndarray:
    """Return the points of so many blocks of fans, one after the other, unscrambled."""
    points, offsets = fan_points(fan), block_offsets(fan, blocks)
    return (points[:, None, :] ^ offsets[:, :, None]).reshape(2, -1)


def places(points: np.ndarray, keys: tuple[int, int]) -> np.ndarray:
    """Return points of fans, (count, 2)."""
    return np.array([fan_point(points, k, NO_OFFSET, keys) for k in range(points.shape[1])])


def cells_of(found: np.ndarray, columns: int, rows: int) -> np.ndarray:
    """Return the cell of each point, (..., 2)."""
    return np.floor(found * (columns, rows)).astype(int)


def grid_of(fan: int) -> tuple[int, int]:
    """Return how many columns and rows of cells there are for a fan: as many, or twice."""
    rows = 1
    while 4 * rows * rows * RUN <= fan:
        rows *= 2
    return fan // RUN // rows, rows


def assert_net(found: np.ndarray) -> None:
    """Check that there is one point in each elementary cell of all shapes."""
    columns = 1
    while columns <= len(found):
        cells = cells_of(found, columns, len(found) // columns)
        assert len(set(map(tuple, cells.tolist()))) == len(found)
        columns *= 2


def test_cells_are_nearly_square() -> None:
    assert [grid_of(fan) for fan in FANS] == [(2, 2), (4, 2), (4, 4), (8, 4), (8, 8), (16, 8)]


@pytest.mark.parametrize("fan", FANS)
@pytest.mark.parametrize("samples", [1, 3, 4])
def test_fans_are_blocks_of_sobols_sequence(fan: int, samples: int) -> None:
    assert fan_points(fan).shape == (2, fan)
    assert fan_points(fan).dtype == np.int64
    assert fan_points(fan).flags.c_contiguous
    points = points_of(fan, samples)
    numbers = points[0].reshape(samples, fan)
    assert (np.sort(numbers) == np.arange(fan * samples).reshape(samples, fan)).all()
    np.testing.assert_array_equal(points, sobol_points(fan * samples)[:, points[0]])
    # One order for all blocks.
    np.testing.assert_array_equal(numbers % fan, numbers[:1].repeat(samples, axis=0))


@once
@pytest.mark.parametrize("fan", FANS)
@given(keys=KEYS)
def test_runs_share_a_cell(fan: int, keys: tuple[int, int]) -> None:
    found = places(points_of(fan, 3), keys)
    assert ((found >= 0) & (found < 1)).all()
    columns, rows = grid_of(fan)
    cells = cells_of(found, columns, rows).reshape(3, fan // RUN, RUN, 2)
    assert (cells == cells[:, :, :1]).all()
    for block in cells[:, :, 0]:
        assert len(set(map(tuple, block.tolist()))) == fan // RUN


@once
@pytest.mark.parametrize("fan", FANS)
@given(keys=KEYS)
def test_runs_that_follow_share_larger_cells(fan: int, keys: tuple[int, int]) -> None:
    columns, rows = grid_of(fan)
    cells = cells_of(places(points_of(fan, 2), keys)[::RUN], columns, rows)
    together = 2
    while together < fan // RUN:
        for group in cells.reshape(-1, together, 2):
            wide, high = (len(set(axis)) for axis in group.T.tolist())
            assert wide * high == together
            assert max(wide, high) <= 2 * min(wide, high)
            for axis, size in zip(group.T, (wide, high), strict=True):
                assert len(set((axis // size).tolist())) == 1
        together *= 2
    if fan // RUN >= 4:
        steps = np.diff(cells.reshape(-1, 4, 2), axis=1)
        assert (np.abs(steps).sum(axis=2) == 1).all()


@given(keys=KEYS)
def test_two_runs_of_64_points_share_a_quarter(keys: tuple[int, int]) -> None:
    quarters = cells_of(places(points_of(64, 2), keys), 2, 2).reshape(-1, 2 * RUN, 2)
    assert (quarters == quarters[:, :1]).all()


@pytest.mark.parametrize("fan", FANS)
def test_runs_that_follow_are_side_by_side(fan: int) -> None:
    points = fan_points(fan)
    unscrambled = np.array([[int(f"{n:032b}"[::-1], 2) for n in axis] for axis in points.tolist()])
    cells = cells_of(unscrambled.T[::RUN] / 2**32, *grid_of(fan))
    assert (np.abs(np.diff(cells, axis=0)).sum(axis=1) == 1).all()


@pytest.mark.parametrize("fan", [8, 32, 64])
@given(keys=KEYS)
def test_each_fan_and_all_together_are_nets(fan: int, keys: tuple[int, int]) -> None:
    found = places(points_of(fan, 4), keys)
    for block in found.reshape(4, fan, 2):
        assert_net(block)
    assert_net(found[: 2 * fan])
    assert_net(found)


def points_of_fan(
    fans: Fans, number: int, sample: int, x: int, y: int, count: int = 1
) -> np.ndarray:
    """Return the points of a fan of a pixel to light 3, with the seed 5, (rays, 2)."""
    own, first = fan_of(fans, number, count, sample, x, y, 3, 5), fans.first
    points = range(first, first + fans.rays)
    return np.array([fan_point(fans.points, k, *own) for k in points])


@pytest.mark.parametrize(("share", "rays"), [(0.5, 32), (0.3, 32), (0.2, 16), (0.01, 8)])
def test_fans_of_fewer_rays_are_nets_too(share: float, rays: int) -> None:
    fans = fans_of_share(fans_of_middles(NOISE), share)
    assert fans.rays == rays
    found = [points_of_fan(fans, number, 0, 7, 2) for number in range(8)]
    for one in found:
        assert_net(one)
    assert_net(np.concatenate(found[4:]))
    of_neighbours = [points_of_fan(fans, 0, 0, x, y) for x in (6, 7) for y in (2, 3)]
    assert_net(np.concatenate(of_neighbours))


@pytest.mark.parametrize("samples", [4, 16, 64])
def test_fans_of_samples_are_nets_together_and_each(samples: int) -> None:
    fans = fans_of_samples(samples, NOISE)
    places_of_all = range(1 << fans.levels)

    def fan(sample: int, number: int, count: int) -> np.ndarray:
        return points_of_fan(fans, number, sample, 7, 2, count)

    # The first fans of 2, 4 ... samples that follow each other.
    for several in (2, 4, samples):
        assert_net(np.concatenate([fan(sample, 0, 1) for sample in places_of_all[:several]]))
    # All fans of each where it has more, and those of all of them.
    for count in [count for count in (2, 4, 32) if count <= fans.fans]:
        found = [[fan(sample, k, count) for k in range(count)] for sample in places_of_all]
        for of_sample in found[:4]:
            assert_net(np.concatenate(of_sample))
        assert_net(np.concatenate([one for of_sample in found for one in of_sample]))


@pytest.mark.parametrize(("samples", "side"), [(1, 2), (1, 4), (2, 2), (4, 4)])
def test_first_fans_of_neighbours_are_nets_together(samples: int, side: int) -> None:
    fans = fans_of_samples(samples, NOISE) if samples > 1 else fans_of_middles(NOISE)
    pixels = [(8 + column, 1020 + row) for column in range(side) for row in range(side)]
    found = [points_of_fan(fans, 0, k, *pixel) for pixel in pixels for k in range(samples)]
    assert_net(np.concatenate(found))


@pytest.mark.parametrize(("samples", "levels"), [(2, 20), (256, 20), (257, 18), (65536, 12)])
def test_other_squares_and_other_lights_have_other_points(samples: int, levels: int) -> None:
    fans = fans_of_samples(samples, NOISE)
    assert fans.order_levels == levels
    side = 1 << levels // 2
    found = [points_of_fan(fans, 0, 0, *at)[0] for at in ((0, 0), (1, 0), (side, 0), (0, side))]
    found.append(np.array(fan_point(fans.points, 0, *fan_of(fans, 0, 1, 0, 0, 0, 4, 5))))
    assert len(np.unique(found, axis=0)) == 5


@given(st.integers(0, 2**16 - 1), st.integers(0, 2**16 - 1), st.sampled_from([2, 8, 20]), WORDS)
def test_order_of_pixels(column: int, row: int, levels: int, key: int) -> None:
    place = place_in_order(column, row, levels, key)
    assert place == sample_places.place_in_order(column, row, levels, key)
    assert 0 <= place < 2**levels
    beside = place_in_order(column ^ 1, row, levels, key)
    assert place // 4 == beside // 4
    assert place != beside
    offsets = order_offsets(64)
    numbers = sample_places.sobol(1, 64 * place)
    found = order_offset(offsets, 0, place)
    assert list(found) == [sample_places.reversed_bits(number) for (number,) in numbers]


@pytest.mark.parametrize(
    ("tolerance", "parts"),
    [(0.001, 1), (COARSE[0] / 1.01, 1), *zip(COARSE, (2, 4, 8), strict=True), (1.0, 8)],
)
def test_fans_of_samples_have_fewer_rays_where_much_noise_may_be(
    tolerance: float, parts: int
) -> None:
    noise = Noise(tolerance, by_light=True, halvings=halvings_for(tolerance))
    assert fans_of_middles(noise).rays == 64
    assert fans_of_samples(16, noise).rays == 16 // parts
    assert fans_of_samples(2, noise).rays == 64 // parts


def test_keys_of_lights_differ_from_all_others() -> None:
    lights = [fan_keys(5, 3, light, 1) for light in range(1000)]
    lights += [shared_keys(5, 3, sample, 1) for sample in range(1000)]
    others = [pixel_keys(5, 3, purpose, 1) for purpose in range(1000)]
    assert len(set(lights + others)) == 3000


def field(point: int, light: int) -> np.ndarray:
    """Return where a point of the fans of each pixel of a picture lies, (SIDE, SIDE, 2)."""
    points = points_of(64, point // 64 + 1)
    return np.array(
        [
            [fan_point(points, point, NO_OFFSET, fan_keys(x, y, light, 0)) for x in range(SIDE)]
            for y in range(SIDE)
        ]
    )


def image_places(sample: int) -> np.ndarray:
    """Return where a sample of each pixel of a picture lies, (SIDE, SIDE, 2)."""
    numbers = sobol_points(sample + 1)[:, sample].tolist()
    return np.array(
        [
            [
                [
                    scrambled(n, key)
                    for n, key in zip(numbers, pixel_keys(x, y, IMAGE_PLACE, 0), strict=True)
                ]
                for x in range(SIDE)
            ]
            for y in range(SIDE)
        ]
    )


@pytest.mark.parametrize("point", [0, 9, 64 * 3 + 17])
def test_lights_and_places_in_the_image_are_independent(point: int) -> None:
    fields = [field(point, light) for light in (0, 1, 2, 100)] + [image_places(point // 64)]
    axes = [one[..., axis].ravel() - 0.5 for one in fields for axis in (0, 1)]
    # Covariances in units of their standard deviation for points that are independent.
    pairs = itertools.combinations(axes, 2)
    related = np.array([(one * other).sum() * 12 / SIDE for one, other in pairs])
    assert np.abs(related).max() < 4
    assert (related * related).mean() < 2


@pytest.mark.parametrize("levels", [2, 4, 6])
def test_samples_of_two_lights_and_the_image_are_independent(levels: int) -> None:
    samples = 1 << levels
    points, numbers = points_of(16, samples), sobol_points(samples).T.tolist()
    pixels = [(x, y) for x in range(20) for y in range(20 if JIT else 5)]

    def fans(x: int, y: int, light: int) -> np.ndarray:
        keys = fan_keys(x, y, light, 0)
        order = [place_of(levels, k, x, y, light, 0) for k in range(samples)]
        return np.array([fan_point(points, 16 * k, NO_OFFSET, keys) for k in order])

    def image(x: int, y: int) -> np.ndarray:
        keys = pixel_keys(x, y, IMAGE_PLACE, 0)
        return np.array([[scrambled(*pair) for pair in zip(n, keys, strict=True)] for n in numbers])

    found = np.array([np.hstack([fans(x, y, 0), fans(x, y, 1), image(x, y)]) for x, y in pixels])
    # Within each pixel, as random numbers have it.
    related = np.array([np.corrcoef(of_pixel.T) for of_pixel in found])
    pairs = [(0, 2), (0, 3), (1, 2), (1, 3), (0, 4), (0, 5), (1, 4), (1, 5), (2, 4), (3, 5)]
    for pair in pairs:
        spread = np.sqrt(np.mean(related[:, *pair] ** 2))
        assert spread < 1.5 / np.sqrt(samples - 1)
        assert abs(related[:, *pair].mean()) < 5 * spread / np.sqrt(len(pixels))


@given(st.integers(1, 16), WORDS)
def test_shuffled_blocks_stay_blocks(levels: int, key: int) -> None:
    count = 1 << min(levels, 8)
    order = np.array([shuffled(k, levels, key) for k in range(count)])
    for size in (1, 2, 4, 8, 16, 32, 64, 128, 256):
        for block in order.reshape(-1, size) if size <= count else []:
            first = block.min()
            assert first % size == 0
            assert sorted(block.tolist()) == list(range(first, first + size))


@given(KEYS, st.integers(0, 64 * 3 - 1))
def test_compiled_equals_plain_python(keys: tuple[int, int], k: int) -> None:
    points = points_of(64, 3)
    found = fan_point(points, k, NO_OFFSET, keys)
    assert found == uncompiled(fan_point)(points, k, NO_OFFSET, keys)
    first, offsets = fan_points(64), block_offsets(64, 3)
    assert found == fan_point(first, k % 64, (offsets[0, k // 64], offsets[1, k // 64]), keys)
    reversed_points = [sample_places.reversed_bits(n) for n in points[:, k].tolist()]
    assert found == tuple(map(sample_places.owen, reversed_points, keys))


@kernel
def place_run(points: Any, first: int, count: int, keys: tuple[int, int], run: Any) -> None:
    """Set the points of a run, all columns and then all rows."""
    for k in range(count):
        u, v = fan_point(points, first + k, NO_OFFSET, keys)
        run[k] = u
        run[RUN + k] = v


def test_runs_in_kernels() -> None:
    points, run = points_of(32, 2), np.zeros(2 * RUN)
    place_run(points, 40, RUN, (3, 2**32 - 1), run)
    np.testing.assert_array_equal(
        run.reshape(2, RUN).T, places(points, (3, 2**32 - 1))[40 : 40 + RUN]
    )


@compiled_only
@x86_only
def test_runs_are_vectorised() -> None:
    arguments = points_of(32, 2), 40, RUN, (3, 5), np.zeros(2 * RUN)
    code = compile_object(place_run._function, arguments, Kernel._options).code
    # Several products of integers at once.
    assert instructions_in(code) & {"pmuludq", "vpmuludq", "vpmullq"}
