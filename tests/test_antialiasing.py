"""Pictures with samples: each pixel is the mean of an independent renderer's rays."""

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import oracle
import vtray
from conftest import JIT, compiled_only
from examples import xyz
from sample_places import mean, sample_places
from strategies import crowd, scenes
from vtray.settings import FILTERS

COUNTS = [2, 3, 4, 5, 7, 16, 17, 100, 256] if JIT else [2, 3, 17]


def load(document: dict) -> vtray.Scene:
    return vtray.loads(json.dumps(document))


def render(document: dict, **options: Any) -> vtray.Image:
    return vtray.render(load(document), **{"threads": 1, **options})


def marks_of(document: dict, samples: int = 2, **options: Any) -> np.ndarray:
    """Return which pixels have samples."""
    image = render(document, samples=samples, keep_lights=True, **options)
    return image._relighting._passes[1].first >= 0


def sampled(
    document: dict, marks: np.ndarray, samples: int, filter_name: str, seed: int = 0
) -> tuple[np.ndarray, np.ndarray]:
    """Return the light and the cover of the pixels that are marked, by the oracle."""
    rows, columns = np.nonzero(marks)
    places = sample_places(columns, rows, samples, filter_name, seed)
    seen = oracle.look(document, places.columns, places.rows)
    covered = np.where(seen.ids[..., None] >= 0, 1.0, 0.0)
    return mean(seen.linear, places.weights), mean(covered, places.weights)[..., 0]


def assert_sampled(
    document: dict, samples: int, filter_name: str, seed: int = 0, **options: Any
) -> np.ndarray:
    """Check all pixels of a picture; return which have samples."""
    how = {"samples": samples, "filter": filter_name, "seed": seed}
    image = render(document, **how, **options)
    middle = render(document)
    marks = marks_of(document, **how)
    expected, cover = sampled(document, marks, samples, filter_name, seed)
    np.testing.assert_array_equal(image.linear[~marks], middle.linear[~marks])
    np.testing.assert_array_equal(image.alpha[~marks], middle.alpha[~marks])
    np.testing.assert_array_equal(image.linear[marks], expected)
    np.testing.assert_array_equal(image.alpha[marks], cover)
    assert image.white == max(image.linear.max(), 0)
    return marks


@settings(max_examples=100 if JIT else 15)
@given(
    scenes(),
    st.sampled_from(COUNTS),
    st.sampled_from(FILTERS),
    st.sampled_from([0, 1, 2**32 - 1]),
)
def test_each_pixel_is_the_mean_of_its_samples(
    document: dict, samples: int, filter_name: str, seed: int
) -> None:
    if samples > 17 or not JIT:
        document["camera"]["size"] = [min(5, n) for n in document["camera"]["size"]]
    assert_sampled(document, samples, filter_name, seed)


@compiled_only
@pytest.mark.parametrize("view", [{}, {"projection": "orthographic", "up": xyz(0.1, 1, 0.3)}])
@pytest.mark.parametrize("samples", [3, 16, 200])
@pytest.mark.parametrize("seed", range(3))
def test_hundreds_of_spheres(seed: int, samples: int, view: dict) -> None:
    document = crowd(seed + 20, **view)
    document["camera"]["size"] = [23, 18]
    marks = assert_sampled(document, samples, FILTERS[(seed + samples) % 5], seed, threads=2)
    assert marks.any()


@compiled_only
@pytest.mark.parametrize("samples", [257, 300, 512, 1000])
def test_more_samples_than_go_into_a_packet(samples: int) -> None:
    document = crowd(3)
    document["camera"]["size"] = [6, 5]
    document["camera"]["resolution"] = [5 * n for n in document["camera"]["resolution"]]
    assert assert_sampled(document, samples, "gaussian").any()
