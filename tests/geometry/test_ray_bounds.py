"""What culling leaves out is never met, and it does leave out what is far away."""

import math
from random import Random

import numpy as np
import pytest

from conftest import once
from vtray.geometry.packets.shaft import outside_shaft

Vec = tuple[float, float, float]


def random_point(random: Random, size: float) -> Vec:
    return random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)


def nearest_approach(center: Vec, light: Vec, box_center: Vec, box_half: Vec) -> float:
    """Return the least distance from a sphere's centre to segments from the box to the light."""
    random = np.random.default_rng(3)
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    spots = np.concatenate([corners, random.uniform(-1, 1, (400, 3))])
    points = np.array(box_center) + spots * np.array(box_half)
    way = np.array(light) - points
    arm = np.array(center) - points
    length2 = np.maximum((way * way).sum(axis=1), 1e-300)
    part = np.clip((arm * way).sum(axis=1) / length2, 0, 1)
    return float(np.sqrt(((arm - part[:, None] * way) ** 2).sum(axis=1)).min())


@once
@pytest.mark.parametrize("seed", range(200))
def test_sphere_outside_the_shaft_is_met_by_no_shadow_ray(seed: int) -> None:
    random = Random(seed)
    light, box_center, center = (random_point(random, 2.0) for _ in range(3))
    box_half = tuple(abs(part) for part in random_point(random, random.choice([0.01, 0.5])))
    near = nearest_approach(center, light, box_center, box_half)
    # A sphere that reaches a shadow ray by a hair is kept ...
    assert not outside_shaft(center, near * 1.0001 + 1e-9, light, box_center, box_half)
    # ... and one much smaller is not, unless the box is wide and the bound loose.
    if max(box_half) < 0.01:
        assert near < 0.05 or outside_shaft(center, near * 0.7, light, box_center, box_half)


def test_shaft_without_length_keeps_what_is_there() -> None:
    here, nothing = (1.0, 2.0, 3.0), (0.0, 0.0, 0.0)
    assert not outside_shaft((1.5, 2.0, 3.0), 1.0, here, here, nothing)
    assert outside_shaft((3.0, 2.0, 3.0), 1.0, here, here, nothing)
    assert not outside_shaft((math.nan, 2.0, 3.0), 1.0, here, here, nothing)
