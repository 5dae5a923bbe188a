"""Cameras as far away, as near, and with pixels as small or as large as a double can say."""

import itertools
import json
import math
from typing import Any

import numpy as np
import oracle
import pytest
from examples import light, plane, scene, sphere, xyz
from hierarchies import ALWAYS, NEVER, render

import vtray
from conftest import compiled_only

pytestmark = compiled_only

OBJECTS = [sphere((0, 0, 5), 1), sphere((0.7, -0.9, 3), 0.4), plane((0, 1, 0), (0.1, -1, 0.05))]
LIGHTS = [light(5, -5, 0), light(-2, -6, -3)]
VIEWS: list[dict[str, Any]] = [{}, {"normal": xyz(0.2, 0.3, 1), "center": xyz(0.1, -1, 0.3)}]


def load(document: dict[str, Any]) -> vtray.Scene:
    return vtray.loads(json.dumps(document))


@pytest.mark.parametrize("few", [ALWAYS, NEVER])
@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("focus", [1e10, 1e13, 1e15, 1e20, 1e80, 1e300])
def test_from_far_away_the_view_is_orthographic(
    focus: float, view: dict[str, Any], few: int
) -> None:
    document = scene(OBJECTS, LIGHTS, focus=focus, **view)
    image = render(load(document), few)
    if focus < 1e100:  # the oracle has no units in which squares do not overflow
        seen = oracle.look(document)
        np.testing.assert_array_equal(image.linear, seen.linear)
        np.testing.assert_array_equal(image.depth, seen.depth)
    parallel = scene(OBJECTS, LIGHTS, **view, projection="orthographic")
    expected = render(load(parallel), few)
    assert expected.pixels.max() == 255
    difference = np.abs(image.pixels.astype(int) - expected.pixels).max(axis=2)
    assert np.count_nonzero(difference > 1) <= 3
    sampled = render(load(document), few, samples=4).pixels.astype(int)
    difference = np.abs(sampled - render(load(parallel), few, samples=4).pixels).max(axis=2)
    assert np.count_nonzero(difference > 1) <= 6
    parallel["camera"]["focus"] = focus
    np.testing.assert_allclose(render(load(parallel), few).linear, expected.linear, atol=0.01)


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_depth_and_rays_from_far_away_begin_at_the_eye(projection: str) -> None:
    document = scene(OBJECTS, LIGHTS, focus=2.0**40, projection=projection)
    image = render(load(document), NEVER)
    tree = vtray.trace_pixel(image, 32, 24)
    assert tree.origin == (0, 0, -(2.0**40))
    assert tree.hit is not None
    np.testing.assert_allclose(tree.hit.point, (0, 0, 4), atol=1e-14)
    assert tree.hit.distance == image.depth[24, 32] == 2.0**40 + 4


def test_one_focus_and_the_next_give_the_same_picture() -> None:
    # From 2**30 times the view on, rays start nearby.
    wide = scene(OBJECTS, LIGHTS, focus=2.0**30 * 11.2)
    wider = scene(OBJECTS, LIGHTS, focus=math.nextafter(2.0**30 * 11.2, math.inf))
    one, two = (render(load(document), NEVER) for document in (wide, wider))
    assert not np.array_equal(one.linear, two.linear)
    np.testing.assert_array_equal(one.ids, two.ids)
    difference = np.abs(one.pixels.astype(int) - two.pixels)
    assert np.count_nonzero(difference > 1) <= 3


@pytest.mark.parametrize("samples", [1, 4])
def test_an_eye_in_the_image_plane_sees_straight_ahead(samples: int) -> None:
    for focus in (5e-324, 1e-300, 1e-200, 1e-100):
        image = render(load(scene(OBJECTS, LIGHTS, focus=focus)), NEVER, samples=samples)
        assert np.argwhere(image.ids[..., 0] >= 0).tolist() == [[24, 32]]
        if samples == 1:
            assert np.argwhere(image.linear[..., 0] > 0).tolist() == [[24, 32]]


def test_pixels_that_are_wide_and_not_high() -> None:
    # Of the columns, the one in the middle alone looks ahead: as it does where all are narrow.
    expected = render(load(scene(OBJECTS, LIGHTS)), NEVER).linear
    for width in (1e200, 1e300):
        image = render(load(scene(OBJECTS, LIGHTS, resolution=[width, 0.1])), NEVER)
        np.testing.assert_array_equal(image.linear[:, 32] > 0, expected[:, 32] > 0)
        assert not image.linear[:, :32].any()


ENDS = [5e-324, 1e-300, 1.0, 1e300, 1.7e308]


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("exposure", [5e-324, 1.7e308])
def test_nothing_is_out_of_range(projection: str, exposure: float) -> None:
    how = {"samples": 4, "filter": "mitchell", "exposure": exposure, "background": "transparent"}
    for k, (focus, size, width) in enumerate(itertools.product(ENDS, repeat=3)):
        height = ENDS[k // 7 % len(ENDS)]
        objects = [sphere((0, 0, size), size / 2), plane((0, size / 4, size), (0, -1, 1e-300))]
        camera = {"focus": focus, "size": [2, 3], "resolution": [width, height]}
        lights = [light(size, -size, 0)]
        world = load(scene(objects, lights, projection=projection, **camera))
        image = vtray.render(world, threads=1, **how)
        assert np.isfinite(image.linear).all()
        assert np.isfinite(image.normals).all()
        np.testing.assert_array_equal(np.isfinite(image.depth), image.ids[..., 0] >= 0)
        assert 0 <= image.alpha.min() <= image.alpha.max() <= 1
        assert image.develop(16).shape == (3, 2, 4)
        assert str(vtray.trace_pixel(image, 1, 1)).startswith("pixel ")


def test_a_sphere_smaller_than_rounding_has_a_normal() -> None:
    ball = sphere((0, 0, 1e300), 1e150)
    image = render(load(scene([ball], [light(0, 0, 0)], size=[2, 2])), NEVER)
    assert image.ids[1, 1, 0] == 0
    assert image.normals[1, 1].tolist() == [0, 0, -1]
    assert image.linear[1, 1].tolist() == [255] * 3
