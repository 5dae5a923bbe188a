"""What is seen where nothing is, the share that is covered, and exposures that are given."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import oracle
import pytest
from examples import light, plane, scene, sphere
from filter_formulas import FORMULAS
from hypothesis import given, settings
from hypothesis import strategies as st
from pictures import read_exr
from strategies import may_be_dark, scenes

import vtray
from conftest import JIT, once

BALLS = [sphere((0, 0, 5), 1), sphere((0.9, 0.4, 4), 0.5, lambert=0.5)]
SIZE = [40, 30] if JIT else [10, 8]
VIEW = {"size": SIZE, "resolution": [3 / SIZE[0], 2.4 / SIZE[1]]}


def load(document: dict) -> vtray.Scene:
    return vtray.loads(json.dumps(document))


def render(document: dict, **options: Any) -> vtray.Image:
    return vtray.render(load(document), **{"threads": 1, **options})


def balls(*more: dict) -> dict:
    """Return a scene of two balls."""
    return scene([*BALLS, *more], [light(5, -5, 0), light(-3, -4, -2, intensity=0.5)], **VIEW)


def covered_share(document: dict, filter_name: str, grid: int) -> np.ndarray:
    """Return the share of each pixel that is covered, by many rays weighted by the filter."""
    formula, radius = FORMULAS[filter_name]
    width, height = document["camera"]["size"]
    rows, columns = np.mgrid[0:height, 0:width]
    offsets = radius * (2 * np.arange(grid) + 1 - grid) / grid
    weights = np.array([formula(x) for x in offsets])
    weights /= weights.sum()
    share = np.zeros((height, width))
    below = rows + offsets[:, None, None]
    for across, weight in zip(offsets, weights, strict=True):
        covered = oracle.look(document, columns + across, below).ids >= 0
        share += weight * (weights[:, None, None] * covered).sum(axis=0)
    return share


@once
@pytest.mark.parametrize("filter_name", FORMULAS)
def test_alpha_is_the_share_that_is_covered(filter_name: str) -> None:
    document = balls()
    samples = 1024 if JIT else 64
    alpha = render(document, samples=samples, filter=filter_name).alpha
    share = covered_share(document, filter_name, 48 if JIT else 16)
    assert (alpha[share == 0] == 0).all()
    assert (alpha[share == 1] == 1).all()
    assert ((share > 0.1) & (share < 0.9)).sum() > 10
    assert np.abs(alpha - share.clip(0, 1)).max() < (0.02 if JIT else 0.15)


def test_alpha_is_from_0_to_1_with_filters_that_have_negative_sides(tmp_path: Path) -> None:
    image = render(balls(), samples=16, filter="mitchell", background="transparent")
    assert image.alpha.min() == 0
    assert image.alpha.max() == 1
    image.save(tmp_path / "a.exr")
    _, channels = read_exr((tmp_path / "a.exr").read_bytes())
    np.testing.assert_array_equal(channels["A"], image.alpha.astype(np.float32))
    light = np.dstack([channels[name] for name in "RGB"])
    seen = image.alpha > 0
    np.testing.assert_array_equal(light[seen], (image.linear[seen] / 255).astype(np.float32))
    assert not light[~seen].any()
    assert image.linear[~seen].any()


@pytest.mark.parametrize("samples", [1, 4])
def test_alpha_is_1_before_a_wall(samples: int) -> None:
    image = render(balls(plane((0, 0, 9), (0, 0, -1))), samples=samples)
    np.testing.assert_array_equal(image.alpha, 1)
    transparent = render(balls(plane((0, 0, 9), (0, 0, -1))), samples=1, background="transparent")
    assert (transparent.pixels[..., 3] == 255).all()


@once
@pytest.mark.parametrize("exposure", ["max", 0.7, 4])
@pytest.mark.parametrize("samples", [1, 5])
def test_empty_pixels_have_exactly_the_background(samples: int, exposure: object) -> None:
    document = balls()
    how = {"samples": samples, "exposure": exposure}
    black = render(document, **how)
    empty, full = black.alpha == 0, black.alpha == 1
    assert empty.any()
    assert full.any()
    for color in ((1, 2, 3), (255, 254, 0), (77, 77, 77)):
        image = render(document, background=vtray.Color(*color), **how)
        np.testing.assert_array_equal(image.linear, black.linear)
        assert (image.pixels[empty] == color).all()
        assert (image.develop(16)[empty] == np.array(color) * 257).all()
        np.testing.assert_array_equal(image.pixels[full], black.pixels[full])
        # At edges it is between.
        ends = np.maximum(black.pixels, color)
        assert (image.pixels <= ends.astype(int) + black.pixels).all()
    transparent = render(document, background="transparent", **how)
    assert transparent.pixels.shape == (*empty.shape, 4)
    assert (transparent.pixels[empty] == 0).all()
    assert (transparent.pixels[full][:, 3] == 255).all()
    np.testing.assert_array_equal(transparent.pixels[full][:, :3], black.pixels[full])


@once
@may_be_dark
@settings(max_examples=60 if JIT else 15)
@given(
    scenes(),
    st.sampled_from([1, 2, 7]),
    st.sampled_from(["box", "gaussian", "blackman-harris"]),
    st.sampled_from([8, 16]),
)
def test_transparent_over_black_is_the_picture_on_black(
    document: dict, samples: int, filter_name: str, bits: int
) -> None:
    how = {"samples": samples, "filter": filter_name}
    black = render(document, **how).develop(bits).astype(float)
    straight = render(document, background="transparent", **how).develop(bits).astype(float)
    maximum = 2**bits - 1
    over = straight[..., :3] * straight[..., 3:] / maximum
    # What is brighter than white stays at white where less of it is covered.
    clipped = (straight[..., :3] == maximum) & (straight[..., 3:] < maximum)
    assert (np.abs(over - black) <= 1.5)[~clipped].all()
    assert (over <= black + 1.5).all()


def test_exposure_of_1_shows_the_color_of_what_is_lit_squarely() -> None:
    wall = plane((0, 0, 5), (0, 0, -1), color={"r": 200, "g": 100, "b": 7})
    document = scene([wall], [light(0, 0, -1e90)], size=[3, 2])
    assert (render(document, exposure=1).pixels == (200, 100, 7)).all()
    assert (render(document, exposure=0.5).pixels == (100, 50, 3)).all()
    assert (render(document, exposure=2).pixels == (255, 200, 14)).all()
    assert (render(document, exposure=1).develop(16) == np.array((200, 100, 7)) * 257).all()


@once
@may_be_dark
@settings(max_examples=60 if JIT else 15)
@given(scenes(), st.floats(1e-3, 1e3))
def test_exposure_is_a_factor(document: dict, exposure: float) -> None:
    image = render(document, exposure=exposure)
    expected = np.floor(255 * image.linear / (255 / exposure)).clip(0, 255)
    expected[image.linear == 255 / exposure] = 255
    np.testing.assert_array_equal(image.pixels, expected)
    later = render(document).expose(exposure)
    np.testing.assert_array_equal(later.pixels, image.pixels)
    assert later.settings == image.settings
    assert later.white == image.white == 255 / exposure
    np.testing.assert_array_equal(image.expose().pixels, oracle.develop(image.linear))


def test_lock() -> None:
    bright, document = balls(), balls()
    for lamp in document["lights"]:
        lamp["intensity"] *= 0.25
    first = render(bright)
    second = render(document, lock=first)
    assert (first.locked, second.locked) == (False, True)
    assert second.white == first.white
    np.testing.assert_allclose(second.linear, first.linear / 4, rtol=1e-15)
    np.testing.assert_array_equal(second.pixels, np.floor(255 * second.linear / first.white))
    np.testing.assert_array_equal(render(document).expose(lock=first).pixels, second.pixels)
    # The other way round, light beyond white stays at white.
    third = render(bright, lock=render(document))
    assert (third.pixels == 255).any()
    np.testing.assert_array_equal(
        third.pixels, np.floor(255 * third.linear / third.white).clip(0, 255)
    )
    # Which of two exposures is meant, nobody knows.
    words = "^lock and exposure {}: expected one of them; leave out the other$"
    with pytest.raises(vtray.RenderError, match=words.format(3)):
        render(bright, lock=first, exposure=3)
    with pytest.raises(vtray.RenderError, match=words.format("'max'")):
        first.expose("max", lock=second)
    black = render(scene([], [], size=[3, 2]))
    assert not render(bright, lock=black).pixels.any()
