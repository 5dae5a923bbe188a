"""From light to pixels."""

import numpy as np
import pytest

import vtray
from vtray.errors import RenderError
from vtray.exposure import BRIGHTEST, check_brightness, develop


def exposed(values: list[float], peak: float) -> list[int]:
    film = np.array(values, float).reshape(1, -1, 3)
    pixels = np.full(film.shape, 77, np.uint8)
    develop(film, peak, pixels)
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


def test_lights_too_bright_for_a_double() -> None:
    check_brightness([vtray.Light((0, 0, 0), BRIGHTEST)])
    with pytest.raises(RenderError, match=r"^lights: the intensities add up to inf, expected at"):
        check_brightness([vtray.Light((0, 0, 0), 1.7e308)] * 2)
