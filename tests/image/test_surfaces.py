"""Depth, normals and ids of a picture are those of an independent renderer, to the last bit."""

import json
from typing import Any

import numpy as np
import oracle
import pytest
from examples import light, plane, scene, sphere, xyz
from hierarchies import ALWAYS, NEVER, render
from hypothesis import given
from strategies import crowd, may_be_dark, scenes

import vtray
from conftest import JIT, compiled_only, once

SLANTED = {"up": xyz(0.3, -1, 0.2), "projection": "orthographic"}


def load(document: dict) -> vtray.Scene:
    return vtray.loads(json.dumps(document))


def assert_seen(image: vtray.Image, seen: oracle.Seen) -> None:
    """Check all of a picture whose objects are single spheres and planes."""
    np.testing.assert_array_equal(image.linear, seen.linear)
    np.testing.assert_array_equal(image.depth, seen.depth)
    np.testing.assert_array_equal(image.normals, seen.normals)
    np.testing.assert_array_equal(image.ids[..., 0], seen.ids)
    np.testing.assert_array_equal(image.ids[..., 1], np.where(seen.ids < 0, -1, 0))
    np.testing.assert_array_equal(image.alpha, seen.ids >= 0)


@once
@may_be_dark
@given(scenes())
def test_equals_oracle(document: dict) -> None:
    seen = oracle.look(document)
    assert_seen(render(load(document), NEVER), seen)
    assert_seen(render(load(document), ALWAYS), seen)


@compiled_only
@pytest.mark.parametrize("few", [ALWAYS, NEVER])
@pytest.mark.parametrize("view", [{}, SLANTED])
@pytest.mark.parametrize("seed", range(12))
def test_equals_oracle_with_hundreds_of_objects(seed: int, view: dict, few: int) -> None:
    document = crowd(seed, **view)
    assert_seen(render(load(document), few, threads=2), oracle.look(document))


@compiled_only
@pytest.mark.parametrize("pixel", [1e-9, 1e-3, 0.02, 0.3, 50.0])
@pytest.mark.parametrize("seed", range(4))
def test_equals_oracle_for_orthographic_pixels_of_any_size(seed: int, pixel: float) -> None:
    document = crowd(seed, **SLANTED)
    scale = document["camera"]["resolution"][0] / 0.02
    document["camera"]["resolution"] = [pixel * scale, 1.7 * pixel * scale]
    document["camera"]["focus"] = scale * [1e-6, 0.1, 3.0, 1e6][seed]
    assert_seen(render(load(document), ALWAYS), oracle.look(document))


@once
@pytest.mark.parametrize("few", [ALWAYS, NEVER])
@pytest.mark.parametrize("view", [{}, SLANTED])
def test_ids_count_the_spheres_of_each_object(view: dict, few: int) -> None:
    document = crowd(14, 150 if JIT else 60, **view)
    pixel = document["camera"]["resolution"][0]
    if not JIT:
        document["camera"].update(size=[12, 8], resolution=[5 * pixel, 7 * pixel])
    world = load(document)
    spheres = [item for item in world.objects if isinstance(item, vtray.Sphere)]
    planes = [item for item in world.objects if isinstance(item, vtray.Plane)]
    third = len(spheres) // 3
    parts = spheres[:third], spheres[third : 2 * third], spheres[2 * third :]
    several = [together(parts[0]), together([]), *planes, *parts[1], together(parts[2])]
    world.objects = several
    image = render(world, few)
    seen = oracle.look(document)
    first = 2 + len(planes)
    table = [(0, k) for k in range(third)]
    table += [(first + k, 0) for k in range(third)]
    table += [(first + third, k) for k in range(len(parts[2]))]
    table += [(2 + k, 0) for k in range(len(planes))]
    expected = np.array([*table, (-1, -1)])[seen.ids]
    assert len(np.unique(expected[..., 0])) > 2
    assert image.ids.dtype == np.int32
    np.testing.assert_array_equal(image.ids, expected)
    np.testing.assert_array_equal(image.depth, seen.depth)


def together(spheres: list[vtray.Sphere]) -> vtray.Spheres:
    """Return single spheres as arrays."""

    def columns(name: str, keys: str) -> np.ndarray:
        rows = [[getattr(getattr(item, name), key) for key in keys] for item in spheres]
        return np.array(rows, float).reshape(-1, 3)

    radius = np.array([item.radius for item in spheres])
    lambert = np.array([item.lambert for item in spheres])
    color = columns("color", "rgb").astype(np.uint8)
    return vtray.Spheres(columns("center", "xyz"), radius, color, lambert)


def test_by_hand() -> None:
    # Looking along z, 3 x 1 pixels of size 1: the middle of the picture is at column 1.5.
    camera = {"focus": 2, "size": [3, 1], "resolution": [1, 1], "projection": "orthographic"}
    ball, wall = sphere((0.5, -0.5, 6), 1), plane((0, 0, 9), (0, 0.6, 0.8))
    image = render(load(scene([wall, ball], [light(0.5, -0.5, -4)], **camera)), ALWAYS)
    assert image.ids[0].tolist() == [[0, 0], [0, 0], [1, 0]]
    # From the plane through the eye, at z = -2, to z = 5, or to z = 9 + 0.75 * 0.5.
    assert image.depth[0] == pytest.approx([11.375, 11.375, 7])
    np.testing.assert_allclose(image.normals[0, 1:], [[0, -0.6, -0.8], [0, 0, -1]], atol=1e-15)
    assert image.linear[0, 2] == pytest.approx([255] * 3)


def test_nothing() -> None:
    image = render(load(scene([], [], size=[3, 2])), ALWAYS)
    assert np.isinf(image.depth).all()
    assert not image.normals.any()
    assert (image.ids == -1).all()
    assert not image.alpha.any()


def test_traced_when_asked_and_only_once(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []
    looked = vtray.rendering.surfaces.Look.__call__

    def look(self: Any) -> Any:
        calls.append(1)
        return looked(self)

    monkeypatch.setattr("vtray.rendering.surfaces.Look.__call__", look)
    image = render(load(scene([sphere((0, 0, 5), 1)], [light(0, 0, 0)], size=[9, 7])), ALWAYS)
    assert calls == []
    assert image.pixels.any()
    assert calls == []
    assert image.depth[3, 4] < np.inf
    assert image.normals[3, 4].any()
    assert image.ids[3, 4].tolist() == [0, 0]
    assert image.expose(2.0).ids is image.ids
    assert calls == [1]


def test_looks_at_the_scene_as_it_was() -> None:
    world = load(scene([sphere((0, 0, 5), 1)], [light(0, 0, 0)], size=[9, 7]))
    image = vtray.render(world)
    expected = vtray.render(
        load(scene([sphere((0, 0, 5), 1)], [light(9, 9, 9)], size=[9, 7]))
    ).depth
    world.objects.clear()
    world.camera = vtray.Camera((0, 0, 0), (1, 0, 0), 1, (2, 2), (1, 1))
    np.testing.assert_array_equal(image.depth, expected)
