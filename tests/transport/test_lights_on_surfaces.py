"""A light on a surface, as near as rounding can tell: what is in front of the surface sees it."""

import json
from typing import Any

import numpy as np
import oracle
import pytest
from examples import light, plane, scene, sphere, xyz
from hierarchies import ALWAYS, NEVER, render
from hypothesis import given, settings
from hypothesis import strategies as st

import vtray
from conftest import compiled_only

pytestmark = compiled_only

RADII = [k / 10 for k in range(1, 21)]
PLACES = [(0.1, 0.2, 4.3), (0.7, -0.3, 5.1), (1 / 3, 0.0, 6.7)]
WORLDS = [(0.0, 0.0, 0.0), (1e6 / 3, -12345.6, 7e5)]


def moved(place: tuple[float, ...], by: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(p + b for p, b in zip(place, by, strict=True))


def room(
    center: tuple[float, ...], radius: float, lamp: tuple[float, ...], world: tuple[float, ...]
) -> dict[str, Any]:
    """Return a ball between floor and ceiling, and a lamp at a direction from its centre."""
    x, y, z = moved(center, world)
    place = [c + radius * a for c, a in zip((x, y, z), lamp, strict=True)]
    floor, ceiling = (moved((0, side, 0), world) for side in (3, -3))
    objects = [sphere((x, y, z), radius), plane(ceiling, (0, 1, 0)), plane(floor, (0, -1, 0))]
    view = {"center": xyz(*world), "focus": 2, "size": [20, 20], "resolution": [0.2, 0.2]}
    return scene(objects, [light(*place)], **view)


@pytest.mark.parametrize("few", [ALWAYS, NEVER])
@pytest.mark.parametrize("world", WORLDS)
@pytest.mark.parametrize("center", PLACES)
def test_a_lamp_at_the_top_of_a_ball_lights_the_ceiling_only(
    center: tuple[float, ...], world: tuple[float, ...], few: int
) -> None:
    for radius in RADII:
        document = room(center, radius, (0, -1, 0), world)
        image = render(vtray.loads(json.dumps(document)), few)
        lit, seen = image.linear[..., 0] > 0, image.ids[..., 0]
        assert {1, 2} <= set(seen.flat)
        assert lit[seen == 1].all(), radius
        assert not lit[seen == 2].any(), radius
        assert not lit[seen == 0].any(), radius


@pytest.mark.parametrize("world", WORLDS)
def test_a_lamp_on_a_ball_lights_the_ball_inside(world: tuple[float, ...]) -> None:
    for radius in RADII:
        document = room((0.1, 0.2, 0.3), 3 + radius, (0, -1, 0), world)
        del document["objects"][1:]
        assert (render(vtray.loads(json.dumps(document)), NEVER).linear > 0).all(), radius


def test_a_lamp_in_the_image_plane_is_on_the_ball_all_the_same() -> None:
    # Rounding puts the lamp in front of the image plane, in it, or behind it.
    for radius in RADII:
        for by in (-1e-17, 0.0, 1e-17):
            document = room((0.1, 0.2, 0.0), radius, (0, -1, by / radius), (0, 0, 0))
            image = render(vtray.loads(json.dumps(document)), NEVER)
            lit, seen = image.linear[..., 0] > 0, image.ids[..., 0]
            assert lit[seen == 1].all(), radius
            assert not lit[seen == 2].any(), radius


UNIT = st.floats(-1, 1).filter(lambda x: abs(x) > 1e-3)


@settings(max_examples=60)
@given(
    center=st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(3, 9)),
    radius=st.floats(0.05, 2),
    way=st.tuples(UNIT, UNIT, UNIT),
    far=st.sampled_from([0.0, 1e3, 1e7]),
)
def test_what_lies_before_the_tangent_plane_sees_the_lamp(
    center: tuple[float, ...], radius: float, way: tuple[float, ...], far: float
) -> None:
    way = tuple(np.array(way) / np.sqrt(np.square(way).sum()))
    document = room(center, radius, way, (far, -far / 3, far / 7))
    document["camera"]["size"], document["camera"]["resolution"] = [6, 6], [0.7, 0.7]
    image = render(vtray.loads(json.dumps(document)), NEVER)
    np.testing.assert_array_equal(image.linear, oracle.render(document))
    seen = oracle.look(document)
    distance = np.where(seen.ids >= 0, seen.depth, 0.0)[..., None]
    points = distance * oracle.directions(document, *np.mgrid[0:6, 0:6][::-1]) - (0, 0, 2)
    # Walls see the lamp exactly if they are on the other side of the plane that touches the ball
    # there, and the ball sees none of it.
    above = (points - (np.array(center) + radius * np.array(way))) @ np.array(way)
    walls = (seen.ids > 0) & (np.abs(above) > 1e-6)
    lamp = np.array(list(document["lights"][0]["location"].values())) - (far, -far / 3, far / 7)
    towards = (lamp[1] - points[..., 1]) * np.where(seen.ids == 1, 1, -1) > 1e-6
    lit = image.linear[..., 0] > 0
    np.testing.assert_array_equal(lit[walls], ((above > 0) & towards)[walls])
    assert not lit[seen.ids == 0].any()
