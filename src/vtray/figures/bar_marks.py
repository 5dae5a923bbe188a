"""Which values are written beside a colour bar, and where they stand."""

from functools import partial
from typing import Any

import numpy as np

from vtray.base.exact_math import logarithm
from vtray.figures.brightness_scale import BrightnessScale
from vtray.figures.round_marks import round_marks, spread_marks


def share_of(scale: Any, value: float) -> float:  # noqa: ANN401
    """Return how far up the bar of a scale a value stands, from 0 to 1."""
    if isinstance(scale, BrightnessScale):
        return scale.share(value)
    low, high = scale.low, scale.high
    if low == high:
        return 0.5
    if scale.norm == "log":
        below, at, above = logarithm(np.array([low, value, high], np.float64))
        return float((at - below) / (above - below))
    return float((value - low) / (high - low))


def marks_of(scale: Any, most: int) -> list[tuple[float, str]]:  # noqa: ANN401
    """Return at most so many round values for the bar of a scale, and how they are written."""
    if scale.norm == "linear" or scale.low == scale.high:
        return round_marks(scale.low, scale.high, most)
    return spread_marks(scale.low, scale.high, partial(share_of, scale), most)
