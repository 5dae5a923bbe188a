"""Mirrors and glass beside formulas from books, written in other ways."""

import math

import numpy as np
import pytest

from vtray.base.compiler.compiled import uncompiled
from vtray.transport.materials.optics import mirrored, split_at

mirror, split = uncompiled(mirrored), uncompiled(split_at)

NORMAL = (0.0, 0.0, 1.0)


def towards(degrees: float) -> tuple[float, float, float]:
    """Return the direction of a ray that comes down at an angle to the normal."""
    angle = math.radians(degrees)
    return math.sin(angle), 0.0, -math.cos(angle)


def test_mirrored_rays_leave_at_the_angle_of_incidence() -> None:
    random = np.random.default_rng(4)
    for _ in range(100):
        normal, direction = random.normal(size=(2, 3))
        normal, direction = (v / np.linalg.norm(v) for v in (normal, direction))
        out = np.array(mirror(tuple(direction), tuple(normal)))
        assert np.dot(out, normal) == pytest.approx(-np.dot(direction, normal), abs=1e-14)
        # What lies in the surface stays.
        along = direction - np.dot(direction, normal) * normal
        assert out - np.dot(out, normal) * normal == pytest.approx(along, abs=1e-14)
        assert np.linalg.norm(out) == pytest.approx(1, abs=1e-15)


@pytest.mark.parametrize("ratio", [1.5, 1 / 1.5, 1.33, 2.4, 0.9])
@pytest.mark.parametrize("degrees", [0.0, 10.0, 30.0, 40.0, 60.0, 85.0])
def test_split_follows_snell_and_fresnel(ratio: float, degrees: float) -> None:
    found = split(towards(degrees), NORMAL, ratio)
    inner = math.radians(degrees)
    if math.sin(inner) >= ratio:
        assert found.reflected == 1.0
        return
    x, y, z = found.refracted
    assert y == 0.0
    assert z < 0.0
    assert x == pytest.approx(math.sin(inner) / ratio, abs=1e-14)
    outer = math.asin(math.sin(inner) / ratio)
    if degrees == 0.0:
        expected = ((ratio - 1) / (ratio + 1)) ** 2
    else:  # by sines and tangents of sums, as Fresnel wrote them
        across = math.sin(inner - outer) / math.sin(inner + outer)
        along = math.tan(inner - outer) / math.tan(inner + outer)
        expected = (across**2 + along**2) / 2
    assert found.reflected == pytest.approx(expected, abs=1e-13)


def test_all_is_mirrored_beyond_the_critical_angle_and_at_grazing() -> None:
    critical = math.degrees(math.asin(1 / 1.5))
    assert split(towards(critical + 1e-6), NORMAL, 1 / 1.5).reflected == 1.0
    assert split(towards(critical - 1e-6), NORMAL, 1 / 1.5).reflected < 1.0
    assert split(towards(90.0), NORMAL, 1.5).reflected == pytest.approx(1.0)


def test_nothing_happens_where_both_sides_are_alike() -> None:
    found = split(towards(35.0), NORMAL, 1.0)
    assert found.reflected == 0.0
    assert found.refracted == pytest.approx(towards(35.0), abs=1e-15)


def test_brewsters_angle_mirrors_half_of_what_lies_across() -> None:
    """There the light along the plane of incidence is not mirrored at all."""
    angle = math.atan(1.5)
    outer = math.asin(math.sin(angle) / 1.5)
    across = (math.sin(angle - outer) / math.sin(angle + outer)) ** 2
    found = split(towards(math.degrees(angle)), NORMAL, 1.5)
    assert found.reflected == pytest.approx(across / 2, abs=1e-14)
