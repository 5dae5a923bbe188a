"""Pictures of cones: those of the oracle, with a hierarchy and without, alone and among others."""

from random import Random
from typing import Any

import numpy as np
import pytest
from cylinder_pictures import assert_near_oracle, load
from examples import cone, cylinder, light, plane, scene, sphere
from hierarchies import ALWAYS, NEVER, render

import vtray
from conftest import JIT, compiled_only, once

Scene = dict[str, Any]

SIZE: Scene = {"size": [24, 18], "resolution": [0.2, 0.2]}
SMALL: Scene = {"size": [6, 5], "resolution": [0.6, 0.6]}


def copse(seed: int, count: int, **camera: Any) -> Scene:
    """Return a scene of cones of all tapers before a wall, some of which have a ball at a tip."""
    random = Random(seed)
    objects = [plane((0, 0, 9), (0.2, 0.1, -1))]
    for _ in range(count):
        start = [random.uniform(-2, 2), random.uniform(-1.6, 1.6), random.uniform(2, 7)]
        length = random.choice([0.02, 0.6, 1.5, 4.0])
        end = [p + length * random.uniform(-1, 1) for p in start]
        widest = random.choice([0.01, 0.2, 0.6])
        radii = [widest, widest * random.choice([0.0, 0.0, 0.3, 1.0])]
        random.shuffle(radii)
        color = {c: random.randrange(60, 256) for c in "rgb"}
        objects.append(cone(tuple(start), tuple(end), *radii, color=color))
        if random.random() < 0.2:
            objects.append(sphere(tuple(end), 0.1))
    return scene(objects, [light(5, -5, 0), light(-3, 1, 3, intensity=0.4)], **camera)


@once
@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_is_near_the_oracle(projection: str) -> None:
    document = copse(1, 10 if JIT else 3, projection=projection, **(SIZE if JIT else SMALL))
    image = render(load(document), NEVER)
    assert assert_near_oracle(document, image) < 2e-3
    assert np.unique(image.ids[..., 0]).size > (6 if JIT else 1)
    other = render(load(document), ALWAYS)
    for name in ("linear", "depth", "normals", "ids"):
        np.testing.assert_array_equal(getattr(image, name), getattr(other, name))


@once
@pytest.mark.parametrize(
    "item",
    [
        cone((0, 0, 9), (0, 0, 2), 2),  # the tip towards the eye
        cone((0, 0, 2), (0, 0, 9), 2),
        cone((0.01, 0, 3), (0, 0.02, 3.001), 2, 0.1),  # a disc
        cone((-3, -2, 4), (3, 2, 5), 1e-3),  # a needle
        cone((0, 0, -2), (0.3, 0.2, 6), 3, 0.5),  # cut open by the image plane
        cone((0, 0, -2), (0, 0, 12), 3, 4),  # from within
        cone((-1, 0, 5), (1, 0, 5), 1, 1 + 1e-12),
    ],
)
def test_unusual_cones_are_near_the_oracle(item: Scene) -> None:
    document = scene([item], [light(5, -5, 0), light(0.1, 0.2, 4)], **(SIZE if JIT else SMALL))
    assert assert_near_oracle(document, vtray.render(load(document), warn=str)) < 0.02


@compiled_only
def test_pixels_on_edges_have_samples_and_others_have_not() -> None:
    view = {"size": [40, 30], "resolution": [0.05, 0.05]}
    # With a cylinder, out of sight: kernels for both are compiled for other tests as well.
    solids = [cone((-1, 1, 5), (1.2, -1, 6), 1, 0.2), cylinder((9, 9, 5), (9, 9, 6), 0.1)]
    document = scene(solids, [light(5, -5, -9)], **view)
    few, many = (
        render(load(document), which, samples=2, keep_lights=True) for which in (NEVER, ALWAYS)
    )
    np.testing.assert_array_equal(few.linear, many.linear)
    marks = few._relighting._passes[1].first >= 0
    flat = render(load(document), NEVER).ids[..., 0]
    edge = np.zeros(flat.shape, bool)
    for axis in (0, 1):
        changes = np.diff(flat, axis=axis) != 0
        inner = [slice(None), slice(None)]
        inner[axis] = slice(1, None)
        edge[tuple(inner)] |= changes
    assert edge.any()
    assert marks[edge].mean() > 0.9
    hit = flat >= 0
    assert 0.05 < marks[hit].mean() < 0.75


def row_of(size: tuple[int, int], *objects: Any) -> vtray.Scene:
    """Return a scene that is 5 wide and 2 high, seen along z and lit from there."""
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 5, size, (5 / size[0], 2 / size[1]))
    camera = camera.replace(projection="orthographic")
    return vtray.Scene(camera, [vtray.Light((0, 0, -99))], list(objects))


def test_halves_and_ids() -> None:
    size = (20, 8) if JIT else (6, 4)
    ends = [(0, 9, 3), (0, -2, 3)], [(1, 9, 3), (0, 2, 3)]
    cones = vtray.Cones(*ends, 0.6, 0.2, (255, 0, 0), 1, (0, 0, 255))
    scene = row_of(size, vtray.Sphere((0, 0, 99), 1), cones)
    image = render(scene, ALWAYS)
    column, rows = size[0] // 2, (0, size[1] - 1)
    for row, (red, blue) in zip(rows, ((True, False), (False, True)), strict=True):
        assert image.ids[row, column].tolist() == [1, 1]
        assert (image.linear[row, column, ::2] > 0).tolist() == [red, blue]
    hit = vtray.trace_pixel(scene, column, 0).hit
    assert hit is not None
    assert str(hit.surface) == "objects[1], cone 1"
    assert (hit.surface.radius, hit.surface.radius_end) == (0.6, 0.2)


@pytest.mark.skipif(JIT, reason="would compile kernels for one small picture")
def test_copies_are_found() -> None:
    scene = row_of((5, 2))
    parts = [vtray.Sphere((0, 0, 99), 1), vtray.Cones([(0, -2, 3)], [(0, 2, 3)], 0.6, 0.2)]
    copies = scene.add_copies(parts, at=[(-1.5, 0, 0), (1.5, 0, 0)])
    image = render(scene, ALWAYS)
    for column, copy in ((1, 0), (4, 1)):
        assert image.ids[1, column].tolist() == [0, 1]
        assert image.copies[1, column] == copy
    assert copies.locate(1) == (1, 0)
