"""Colour bars of logarithmic scales."""

import pytest

from vtray.figures.bar_marks import marks_of, share_of
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


@pytest.mark.parametrize("norm", ["linear", "log"])
@pytest.mark.parametrize(("low", "high"), [(2e-6, 3e-5), (-2.0, 3.5), (0.5, 2000.0), (1.0, 1e12)])
def test_figures_say_what_is_painted(low: float, high: float, norm: str) -> None:
    if norm == "log" and low < 0:
        return
    scale = ColorScale("viridis", low, high, norm=norm)
    assert _ticks(scale, 6)[1] == [text for _, text in marks_of(scale, 6)]


@pytest.mark.parametrize(
    ("low", "high", "texts"),
    [
        (0.5, 2000.0, ["1", "10", "100", "1000"]),
        (2.0, 5.0, ["2", "5"]),
        (1.0, 1e12, ["1", "100", "10000", "1e6", "1e8", "1e10", "1e12"]),
        (3.1, 3.9, ["3.2", "3.4", "3.6", "3.8"]),
    ],
)
def test_painted_marks_stand_where_their_colours_are(
    low: float, high: float, texts: list[str]
) -> None:
    scale = ColorScale("viridis", low, high, norm="log")
    found = marks_of(scale, 6)
    assert [text for _, text in found] == texts
    for value, _ in found:
        row = min(int(share_of(scale, value) * len(scale.table) + 1e-9), len(scale.table) - 1)
        assert abs(scale.table[row].astype(int) - scale.colors([value])[0]).max() <= 3
