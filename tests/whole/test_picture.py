"""The picture equals that of an independent renderer to the last bit, however it is made."""

import json
from itertools import product
from typing import Any

import numpy as np
import oracle
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plain import NOTHING, trace_pixel
from strategies import crowd, may_be_dark, scenes

import vtray
from conftest import CONFORMANCE, JIT, compiled_only, once
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack


def load(scene: dict) -> vtray.Scene:
    return vtray.loads(json.dumps(scene))


def read_png(path: object) -> np.ndarray:
    from PIL import Image

    with Image.open(path) as image:
        return np.asarray(image.convert("RGB")).astype(int)


@once
@may_be_dark
@given(scenes())
def test_equals_oracle(scene: dict) -> None:
    image = vtray.render(load(scene), threads=1)
    linear = oracle.render(scene)
    np.testing.assert_array_equal(image.linear, linear)
    np.testing.assert_array_equal(image.pixels, oracle.develop(linear))


@compiled_only
@pytest.mark.parametrize("seed", range(30))
def test_equals_oracle_with_hundreds_of_objects(seed: int) -> None:
    scene = crowd(seed)
    linear = vtray.render(load(scene), threads=1).linear
    np.testing.assert_array_equal(linear, oracle.render(scene))


@once
@pytest.mark.parametrize("seed", range(3))
def test_equals_the_plain_path(seed: int) -> None:
    scene = load(crowd(seed, spheres=60 if JIT else 5))
    linear = vtray.render(scene, threads=1).linear
    arrays = pack(scene, accelerate(scene)).arrays
    cosines, blockers = np.zeros(len(scene.lights)), np.zeros(len(scene.lights), np.int64)
    for row, column in product(range(35), range(51) if JIT else range(0, 51, 10)):
        traced = trace_pixel(arrays, column, row, cosines, blockers)
        assert tuple(linear[row, column]) == traced.value
        assert (traced.primitive == NOTHING) == np.isinf(traced.distance)


@compiled_only
@pytest.mark.parametrize(
    ("threads", "tile"), [(1, 64), (2, 64), (7, 16), (3, 5), (200, 1), (2, 9999)]
)
def test_is_the_same_for_any_threads_and_tiles(threads: int, tile: int) -> None:
    scene = load(crowd(1))
    expected = vtray.render(scene, threads=1)
    image = vtray.render(scene, threads=threads, tile=tile)
    np.testing.assert_array_equal(image.linear, expected.linear)
    np.testing.assert_array_equal(image.pixels, expected.pixels)
    assert image.stats["rays"] == expected.stats["rays"]


EXTREMES = st.sampled_from(
    [0.0, -0.0, 5e-324, 1e-308, -1e-200, 1e-9, 1.0, 255.0, -1e9, 1e17, 1e200, -1e300, 1.7e308]
)


def numbers(document: object) -> list[tuple[Any, Any]]:
    """Return where the numbers of a document are, but for the size of its image."""
    found = []
    items = document.items() if isinstance(document, dict) else enumerate(document)
    for key, value in items:
        if isinstance(value, (dict, list)):
            found += numbers(value) if key != "size" else []
        elif not isinstance(value, str):
            found.append((document, key))
    return found


@once
@may_be_dark
@given(scenes(), st.data())
def test_any_number_gives_an_image_or_an_error(scene: dict, data: st.DataObject) -> None:
    places = numbers(scene)
    for _ in range(data.draw(st.integers(1, 4))):
        parent, key = data.draw(st.sampled_from(places))
        parent[key] = data.draw(EXTREMES)
    try:
        image = vtray.render(load(scene), threads=1)
    except vtray.VtrayError:
        return
    assert np.isfinite(image.linear).all()
    assert image.linear.min() >= 0
    assert image.pixels.max() == (255 if image.linear.max() > 0 else 0)


@pytest.mark.skipif(not CONFORMANCE.is_dir(), reason="the reference images are not here")
@compiled_only
def test_equals_reference_image_of_a_sphere() -> None:
    image = vtray.render(vtray.load(CONFORMANCE / "scene0.json"))
    np.testing.assert_array_equal(image.pixels, read_png(CONFORMANCE / "scene0.png"))


@pytest.mark.skipif(not CONFORMANCE.is_dir(), reason="the reference images are not here")
@compiled_only
def test_equals_reference_image_of_a_floor_but_for_its_speckle() -> None:
    image = vtray.render(vtray.load(CONFORMANCE / "scene1.json"))
    difference = np.abs(image.pixels - read_png(CONFORMANCE / "scene1.png")).max(axis=2)
    rows, _ = np.nonzero(difference)
    assert len(rows) <= 400
    assert rows.min() >= 510
    assert rows.max() <= 540
