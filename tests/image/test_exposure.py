"""From light to pixels."""

import math
import re
from typing import Any

import numpy as np
import pytest
from pictures import hand_made

import vtray
from vtray.base.errors import RenderError
from vtray.image.exposure import BRIGHTEST, check_brightness, develop


def nobody_asks() -> np.ndarray:
    raise AssertionError("on black, alpha is not needed")


def exposed(values: list[float], white: float) -> list[int]:
    linear = np.array(values, float).reshape(1, -1, 3)
    pixels = develop(linear, white, "black", nobody_asks, threads=2)
    assert (pixels.dtype, pixels.shape) == (np.uint8, linear.shape)
    return pixels.ravel().tolist()


def test_brightest_channel_becomes_255() -> None:
    assert exposed([0, 1, 2, 3, 3.999, 4], 4) == [0, 63, 127, 191, 254, 255]


def test_black_stays_black() -> None:
    assert exposed([0, 0, 0], 0) == [0, 0, 0]


def test_brightest_channel_is_255_whatever_the_rounding() -> None:
    for peak in np.random.default_rng(1).uniform(0, 300, 200):
        assert exposed([peak, 0, peak / 2], peak)[::2] == [255, 127]


@pytest.mark.parametrize("peak", [5e-324, 1e-310, 1e300])
def test_peaks_at_the_ends_of_the_range(peak: float) -> None:
    assert exposed([peak, 0, 0], peak) == [255, 0, 0]


def test_light_out_of_range_is_clipped() -> None:
    assert exposed([-1, -1e300, 4.5, 1e308, -0.0, 3.9999], 4) == [0, 0, 255, 255, 0, 254]


def test_more_rows_than_a_task_and_any_number_of_threads() -> None:
    linear = np.random.default_rng(2).uniform(0, 7, (200, 3, 3))
    expected = np.floor(255 * linear / 8).astype(np.uint8)
    for threads in (1, 2, 9):
        pixels = develop(linear, 8.0, "black", nobody_asks, threads)
        np.testing.assert_array_equal(pixels, expected)


# Light, cover, and what becomes of it: before the color (90, 60, 30), and alone. White is 2.
COVERED = [
    ((0, 0, 0), 0.0, (90, 60, 30), (0, 0, 0, 0)),
    ((2, 1, 0), 1.0, (255, 127, 0), (255, 127, 0, 255)),
    ((1, 0.5, 0), 0.5, (172, 93, 15), (255, 127, 0, 128)),  # 127.5 + 45, 63.75 + 30, 15
    ((0, 0, 0), 0.25, (67, 45, 22), (0, 0, 0, 64)),
    ((9, 9, 9), 1.0, (255, 255, 255), (255, 255, 255, 255)),
    ((-0.1, 0, 0), -0.01, (77, 60, 30), (0, 0, 0, 0)),  # filters with negative sides
    ((2.1, 1, 0), 1.02, (255, 127, 0), (255, 127, 0, 255)),
]


@pytest.mark.parametrize(("light", "cover", "before", "alone"), COVERED)
def test_background(light: tuple, cover: float, before: tuple, alone: tuple) -> None:
    linear, alpha = np.array([[light]], float), np.array([[cover]])
    color = vtray.Color(90, 60, 30)
    assert develop(linear, 2.0, color, lambda: alpha).tolist() == [[list(before)]]
    assert develop(linear, 2.0, "transparent", lambda: alpha).tolist() == [[list(alone)]]


def test_background_where_all_is_black() -> None:
    linear, alpha = np.zeros((1, 2, 3)), np.array([[0.0, 1.0]])
    color = vtray.Color(1, 2, 3)
    assert develop(linear, 0.0, color, lambda: alpha).tolist() == [[[1, 2, 3], [0, 0, 0]]]
    alone = develop(linear, 0.0, "transparent", lambda: alpha)
    assert alone.tolist() == [[[0, 0, 0, 0], [0, 0, 0, 255]]]


@pytest.mark.parametrize("background", ["black", "transparent", vtray.Color(90, 60, 30)])
@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize(
    ("white", "light", "share"),
    [
        (255 / 1e308, 1000.0, 1),  # an exposure of 1e308
        (5e-324, 1.0, 1),
        (1e304, 1e304, 1),  # the brightest there can be
        (1e304, 5e303, 0.5),
        (1e304, 1e303, 0.1),
        (math.inf, 1e303, 0),  # an exposure of 5e-324
    ],
)
def test_exposures_at_the_ends_of_the_range(
    white: float, light: float, share: float, bits: int, background: object
) -> None:
    image = hand_made(1, 1, background=background)
    image.linear, image.white = np.full((1, 1, 3), light), white
    image._alpha = np.ones((1, 1))
    pixels = vtray.Image.develop(image, bits)[..., :3]
    assert pixels.tolist() == [[[math.floor(share * (2**bits - 1))] * 3]]


def test_lights_too_bright_for_a_double() -> None:
    check_brightness([vtray.Light((0, 0, 0), BRIGHTEST)])
    with pytest.raises(RenderError, match=r"^lights: the intensities add up to inf, expected at"):
        check_brightness([vtray.Light((0, 0, 0), 1.7e308)] * 2)


@pytest.mark.parametrize("bits", [12, 32, 0, -8, True, 16.5, 8.0, math.nan, "16", None, [8]])
def test_bits_are_8_or_16(bits: Any) -> None:
    image = hand_made()
    problem = re.escape(f"bits: expected 8 or 16, got {bits!r}")
    with pytest.raises(RenderError, match=f"^{problem}$"):
        vtray.Image.develop(image, bits)
    assert vtray.Image.develop(image, np.int64(16)).dtype == np.uint16
