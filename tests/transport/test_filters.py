"""Reconstruction filters: samples lie where the papers' formulas say, and weigh what they say."""

import math

import numpy as np
import pytest
from filter_formulas import FORMULAS, Formula

from conftest import once
from vtray.transport.sampling.filters import FILTERS, filter_places, place_in_filter
from vtray.transport.sampling.sobol import scrambled, sobol_points

NODES, WEIGHTS = np.polynomial.legendre.leggauss(5)


def integral(function: Formula, low: float, high: float, pieces: int = 64) -> float:
    """Return an integral by Gauss' rule on pieces."""
    edges = np.linspace(low, high, pieces + 1)
    half = (high - low) / pieces / 2
    places = ((edges[:-1] + edges[1:]) / 2)[:, None] + half * NODES
    values = np.vectorize(function, otypes=[float])(places)
    return float((values * WEIGHTS).sum() * half)


def test_all_filters_are_here() -> None:
    assert FORMULAS.keys() == FILTERS.keys()


@pytest.mark.parametrize("name", FORMULAS)
def test_each_share_of_the_magnitude_lies_where_it_should(name: str) -> None:
    formula, radius = FORMULAS[name]

    def magnitude(x: float) -> float:
        return abs(formula(x))

    whole = integral(magnitude, -radius, radius, 512)
    table = filter_places(name)
    steps = len(table) - 2
    assert table[0] == -radius
    assert table[-1] == table[-2] == radius
    assert (np.diff(table[:-1]) > 0).all()
    np.testing.assert_array_equal(table[:-1], -table[-2::-1])
    for k in range(0, steps, 37):
        share = integral(magnitude, -radius, table[k], 512) / whole
        assert share == pytest.approx(k / steps, abs=2e-6)


@pytest.mark.parametrize("name", FORMULAS)
def test_places_between_those_of_the_table(name: str) -> None:
    radius = FORMULAS[name][1]
    table = filter_places(name)
    steps = len(table) - 2
    places = [place_in_filter(table, k / (8 * steps)) for k in range(8 * steps)]
    assert (np.diff(places) > 0).all()
    assert places[::8] == table[:-2].tolist()
    assert places[4 * steps] == 0
    last = place_in_filter(table, 1 - 2.0**-32)
    assert places[-1] < last <= radius


@pytest.mark.parametrize("name", FORMULAS)
def test_the_sign_changes_where_the_filter_does(name: str) -> None:
    formula, radius = FORMULAS[name]
    for x in np.linspace(0, radius, 1001)[:-1]:
        assert formula(x) >= 0 if x <= FILTERS[name].positive else formula(x) < 0


@once
@pytest.mark.parametrize("frequency", [0.0, 0.25, 0.5, 1.0, 1.75])
@pytest.mark.parametrize("name", FORMULAS)
def test_samples_measure_what_the_filter_does(name: str, frequency: float) -> None:
    # The mean of a wave, weighted by signs: the filter's response to it.
    formula, radius = FORMULAS[name]

    def wave(x: float) -> float:
        return math.cos(2 * math.pi * frequency * x)

    whole = integral(formula, -radius, radius, 256)
    response = integral(lambda x: formula(x) * wave(x), -radius, radius, 256) / whole
    table = filter_places(name)
    count = 2048
    places = [place_in_filter(table, scrambled(n, 12345)) for n in sobol_points(count)[0].tolist()]
    signs = [1.0 if abs(x) <= FILTERS[name].positive else -1.0 for x in places]
    total = sum(sign * wave(x) for sign, x in zip(signs, places, strict=True))
    assert total / sum(signs) == pytest.approx(response, abs=5e-3)
