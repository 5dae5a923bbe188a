"""Each ray to soft lights is that of the oracle, and arrives where the oracle says so."""

from typing import Any

import numpy as np
import pytest
from cylinder_pictures import load
from soft_pictures import Compared, compare_fans
from soft_scenes import KINDS, soft_scene

import vtray
from conftest import once

PIXELS = 3
SEEDS = range(2)

VIEWS = [
    pytest.param({}, id="at the origin"),
    pytest.param({"by": 1e6}, id="far from the origin"),
    pytest.param({"projection": "orthographic"}, id="orthographic"),
]


def compare(document: dict[str, Any], seed: int) -> Compared:
    """Compare some pixels of a scene."""
    random = np.random.default_rng(seed)
    image = vtray.render(load(document), seed=seed, threads=1, tolerance=1e6)
    hits = np.argwhere(image.ids[..., 0] >= 0)
    rows = random.permutation(len(hits))[:PIXELS]
    pixels = [(int(column), int(row)) for row, column in hits[rows]]
    return compare_fans(document, pixels, seed, image)


@once
@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("kind", KINDS)
def test_rays_are_those_of_the_oracle(kind: str, view: dict[str, Any]) -> None:
    found = [compare(soft_scene(seed, kind, **view), seed) for seed in SEEDS]
    rays, arrive, doubtful = map(sum, zip(*found, strict=True))
    assert 0 < arrive < rays
    assert doubtful <= rays / 1000
