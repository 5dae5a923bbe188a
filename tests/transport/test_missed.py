"""Pictures with samples against ones with thousands of rays in each pixel: nothing is missed."""

import json

import numpy as np
import pytest
from dense import dense_picture
from missed import SCENES, mixture

import vtray
from conftest import compiled_only

pytestmark = compiled_only

MOST_OFF = 8
"""Of 255: noise of 256 samples in pixels that are finer than all that is in them."""


def off(document: dict, filter_name: str, fine: int = 48) -> np.ndarray:
    """Return how far the pixels of a picture with 256 samples are off, (height, width)."""
    expected = dense_picture(document, filter_name, fine)
    scene = vtray.loads(json.dumps(document))
    found = vtray.render(scene, samples=256, filter=filter_name).linear
    return np.abs(found - expected).max(axis=2) * 255 / expected.max()


@pytest.mark.parametrize("filter_name", ["box", "blackman-harris"])
@pytest.mark.parametrize("name", SCENES)
def test_what_is_smaller_than_a_pixel_is_seen(name: str, filter_name: str) -> None:
    assert off(SCENES[name](), filter_name).max() <= MOST_OFF


@pytest.mark.parametrize("filter_name", ["box", "blackman-harris", "mitchell"])
@pytest.mark.parametrize("seed", range(6))
def test_random_scenes(seed: int, filter_name: str) -> None:
    assert off(mixture(seed), filter_name, 24).max() <= MOST_OFF
