"""Glossy surfaces by themselves: light goes both ways alike, directions are as dense as said."""

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from conftest import once
from vtray.base.compiler.compiled import uncompiled
from vtray.rendering.pack_looks import made_of, pack_looks, rows_of_ranges
from vtray.scene.materials import Glass, Material, Metal, Plastic
from vtray.scene.scene import Scene
from vtray.transport.materials import facets, frosted, gloss
from vtray.transport.materials.look import Look, Looks

UP = (0.0, 0.0, 1.0)
COLOR = (0.9, 0.5, 0.2)


@cache
def looks_of(material: Material) -> Looks:
    """Return how one material looks."""
    scene = Scene()
    scene.render = scene.render.replace(integrator="path")
    first = np.zeros(1, np.int64)
    made = [made_of([material])]
    looks = pack_looks(made, rows_of_ranges(made, first, first), 1.0, scene)
    assert looks is not None
    return looks


def surface(material: Material, out: Any) -> tuple[Looks, Any]:
    """Return a surface as it is seen from somewhere."""
    looks = looks_of(material)
    towards = -out[0], -out[1], -out[2]
    look = Look(int(looks.kind[0]), 0)
    seen = uncompiled(gloss.gloss_of)(looks, looks.albedos, look, COLOR, 0.8, towards, UP)
    return looks, seen


def direction(cosine: float, turn: float) -> tuple[float, float, float]:
    """Return a unit vector."""
    aside = math.sqrt(1 - cosine * cosine)
    return aside * math.cos(turn), aside * math.sin(turn), cosine


MATERIALS = [
    Plastic(1.5, 0.45),
    Plastic(0.6, 0.9),
    Plastic(1.5),
    Metal(roughness=0.45),
    Metal("gold", roughness=0.6),
    Metal(roughness=1),
]


@once
@pytest.mark.parametrize("material", MATERIALS)
@given(st.floats(0.02, 1), st.floats(0.02, 1), st.floats(0, 7))
def test_light_goes_both_ways_alike(
    material: Material, one: float, other: float, turn: float
) -> None:
    into, out = direction(one, 0.3), direction(other, turn)
    forth, back = (
        np.array(uncompiled(gloss.seen_light)(looks, looks.albedos, seen, way).share) / way[2]
        for (looks, seen), way in ((surface(material, out), into), (surface(material, into), out))
    )
    assert forth == pytest.approx(back, rel=1e-6)
    assert (forth >= 0).all()


def cells(ways: Any) -> Any:
    """Return the cell of each direction: 8 by height, times 8 around."""
    height = np.minimum((8 * ways[:, 2]).astype(int), 7)
    around = np.arctan2(ways[:, 1], ways[:, 0]) / (2 * math.pi) % 1
    return 8 * height + np.minimum((8 * around).astype(int), 7)


@once
@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("cosine", [0.15, 0.6, 1.0])
def test_directions_are_as_dense_as_said(material: Material, cosine: float) -> None:
    """Chi-square, in cells of equal solid angle, with the integral of the density over each."""
    looks, seen = surface(material, direction(cosine, 0.4))
    rng, count = np.random.default_rng(1), 6000
    drawn = [
        uncompiled(gloss.scatter_gloss)(looks, looks.albedos, seen, *rng.random(3))
        for _ in range(count)
    ]
    kept = [one for one in drawn if one.density > 0]
    found = np.bincount(cells(np.array([one.way for one in kept])), minlength=64)
    fine = 96
    ways = [
        direction((k + 0.5) / fine, 2 * math.pi * (j + 0.5) / fine)
        for k in range(fine)
        for j in range(fine)
    ]
    densities = [
        uncompiled(gloss.seen_light)(looks, looks.albedos, seen, way).density for way in ways
    ]
    each = count * 2 * math.pi / fine**2 * np.array(densities)
    expected = np.bincount(cells(np.array(ways)), each, minlength=64)
    is_many = expected > 20
    off = found[is_many] - expected[is_many]
    # What is left of the error of the integral, where the density is sharp, is some percent.
    bound = np.sqrt(expected[is_many]) + 0.03 * expected[is_many]
    assert float(np.sum((off / bound) ** 2)) < is_many.sum() + 5 * math.sqrt(2 * is_many.sum())
    for one in kept[:50]:
        again = uncompiled(gloss.seen_light)(looks, looks.albedos, seen, one.way)
        assert again.density == one.density
        assert np.multiply(one.share, one.density) == pytest.approx(again.share)


@given(st.floats(0.01, 1), st.floats(1e-4, 1))
def test_facets_fill_the_surface(cosine: float, spread: float) -> None:
    """Those seen from anywhere fill what is seen; their mean turns towards the viewer."""
    rng = np.random.default_rng(2)
    out = direction(cosine, 1.0)
    for _ in range(20):
        facet = uncompiled(facets.seen_facet)(spread, out, UP, *rng.random(2))
        assert np.dot(facet, facet) == pytest.approx(1)
        assert np.dot(facet, out) > -1e-9
        assert facet[2] > 0


@once
@pytest.mark.parametrize("glass", [Glass(1.5, roughness=0.4), Glass(0.7, roughness=0.8)])
@pytest.mark.parametrize("is_inner", [False, True])
@pytest.mark.parametrize("cosine", [0.05, 0.3, 0.8])
def test_rough_glass_loses_nothing(glass: Glass, is_inner: bool, cosine: float) -> None:
    looks, rng = looks_of(glass), np.random.default_rng(3)
    ratio = 1 / glass.ior if is_inner else glass.ior
    out = direction(cosine, 2.0)
    way, total = (-out[0], -out[1], -out[2]), []
    for _ in range(4000):
        went = uncompiled(frosted.pass_facet)(
            looks.albedos, int(is_inner), glass.roughness**2, ratio, way, UP, *rng.random(3)
        )
        side = 1 if went.is_mirrored else -1
        assert went.share == 0 or side * went.way[2] > 0
        total.append(went.share)
    assert np.mean(total) == pytest.approx(1, abs=0.02)


@once
@given(st.floats(0.001, 0.02))
def test_glass_that_is_hardly_rough_goes_where_smooth_glass_does(roughness: float) -> None:
    looks = looks_of(Glass(1.5, roughness=0.02))
    way = direction(-0.7, 0.0)
    went = uncompiled(frosted.pass_facet)(
        looks.albedos, 0, roughness**2 + 1e-5, 1.5, way, UP, 0.5, 0.5, 0.9
    )
    sine = math.sqrt(1 - 0.49) / 1.5
    assert went.way == pytest.approx((sine, 0, -math.sqrt(1 - sine * sine)), abs=0.02)


@once
def test_roughness_below_a_hundredth_is_smooth() -> None:
    assert looks_of(Metal(roughness=0.009)).albedos is None
    assert looks_of(Metal(roughness=0.011)).albedos is not None
