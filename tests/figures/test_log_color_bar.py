"""Colour bars of logarithmic scales."""

import pytest

from vtray.figures.color_bar import _ticks
from vtray.scene.colors.color_scale import ColorScale


@pytest.mark.parametrize(
    ("low", "high", "places", "texts"),
    [
        (0.5, 2000.0, [0, 1, 2, 3], ["1", "10", "100", "1000"]),
        (2.0, 5.0, [0.30103, 0.69897], ["2", "5"]),
    ],
)
def test_marks_are_at_powers_of_ten(
    low: float, high: float, places: list[float], texts: list[str]
) -> None:
    found, words = _ticks(ColorScale("viridis", low, high, norm="log"), 6)
    assert found == pytest.approx(places)
    assert words == texts
