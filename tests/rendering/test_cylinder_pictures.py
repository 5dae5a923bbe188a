"""Pictures of cylinders: those of the oracle, however they are made, and without speckle."""

import json
import math
from typing import Any

import numpy as np
import oracle
import pytest
from cylinder_pictures import assert_near_oracle, load
from examples import cylinder, light, scene, xyz
from hierarchies import ALWAYS, NEVER, render
from hypothesis import given, settings
from plain import NOTHING
from plain import trace_pixel as trace_plainly
from strategies import cylinder_scenes, may_be_dark, thicket

import vtray
from conftest import JIT, compiled_only, once
from vtray.geometry.packets.layer_notes import new_walk
from vtray.geometry.packets.stack import new_stack
from vtray.rendering import hierarchy
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.transport.integrators import reference
from vtray.transport.sampling.filters import FILTERS

Scene = dict[str, Any]

BLUE = {"r": 1, "g": 2, "b": 3}
ORTHOGRAPHIC = {"projection": "orthographic"}


def assert_same(one: vtray.Image, other: vtray.Image) -> None:
    """Compare all of two pictures to the last bit."""
    np.testing.assert_array_equal(one.linear, other.linear)
    np.testing.assert_array_equal(one.alpha, other.alpha)
    np.testing.assert_array_equal(one.depth, other.depth)
    np.testing.assert_array_equal(one.normals, other.normals)
    np.testing.assert_array_equal(one.ids, other.ids)
    assert one.stats["rays"] == other.stats["rays"]


@once
@may_be_dark
@settings(max_examples=50 if JIT else 10)
@given(cylinder_scenes())
def test_is_near_the_oracle(document: Scene) -> None:
    if not JIT:
        document["camera"]["size"] = [min(5, n) for n in document["camera"]["size"]]
    image = render(load(document), NEVER)
    assert_near_oracle(document, image)
    assert_same(render(load(document), ALWAYS), image)


@once
@pytest.mark.parametrize("view", [{}, ORTHOGRAPHIC])
@pytest.mark.parametrize("by", [0.0, 1e6])
@pytest.mark.parametrize("seed", range(2 if JIT else 1))
def test_is_near_the_oracle_among_many_things(seed: int, by: float, view: Scene) -> None:
    document = thicket(seed, 20 if JIT else 4, by, **view)
    if not JIT:
        document["camera"].update(size=[6, 5], resolution=[0.5, 0.5])
    image = render(load(document), NEVER)
    assert assert_near_oracle(document, image) < 1e-3
    assert np.unique(image.ids[..., 0]).size > (9 if JIT else 0)
    assert_same(render(load(document), ALWAYS), image)


@once
@pytest.mark.parametrize("view", [{}, ORTHOGRAPHIC])
@pytest.mark.parametrize("by", [0.0, 1e6, -12345.678])
@pytest.mark.parametrize("way", [(0, 1, 0), (0.6, 0.8, 0), (0.3, -0.5, 0.7), (0, 0.01, 1)])
def test_a_convex_thing_alone_has_no_shadow(way: tuple[float, ...], by: float, view: Scene) -> None:
    start, lamp = np.array((-0.5, -1.0, 5.0)) + by, np.array((5.0, -5.0, 0.0)) + by
    end = start + 2 * np.array(way)
    document = scene(
        [cylinder(tuple(start.tolist()), tuple(end.tolist()), 1.0)],
        [light(*lamp.tolist())],
        center=xyz(by, by, by),
        **(view if JIT else {**view, "size": [10, 8], "resolution": [0.6, 0.6]}),
    )
    image = vtray.render(load(document))
    hit = image.ids[..., 0] >= 0
    assert hit.sum() > (100 if JIT else 3)
    ids = np.argwhere(hit)
    render = oracle._Render(document, np.float64)
    starts, rays = render.rays(ids[:, 1].astype(float), ids[:, 0].astype(float))
    points = starts + image.depth[hit][:, None] * rays + by
    to_light = lamp - points
    to_light /= np.sqrt(oracle.dot(to_light, to_light))[:, None]
    cosine = oracle.dot(image.normals[hit], to_light).clip(0)
    # What faces the light is lit, as Lambert says.
    np.testing.assert_allclose(image.linear[hit][:, 0], 255 * cosine, atol=1e-5)
    # A normal is square to the axis, or along it.
    axis = np.array(way) / np.sqrt(np.dot(way, way))
    along = np.abs(oracle.dot(image.normals[hit], axis))
    assert (np.minimum(along, np.abs(along - 1)) < 1e-9).all()
    assert (oracle.dot(image.normals[hit], rays) < 0).all()


def test_the_closed_form_of_a_post() -> None:
    # Seen from the side, each column shows one line of it; the light comes from straight left.
    size = [40, 12] if JIT else [10, 3]
    document = scene(
        [cylinder((0, -9, 9), (0, 9, 9), 1.5)],
        [light(-1e9, 0, 9)],
        size=size,
        resolution=[4 / size[0], 0.3],
        **ORTHOGRAPHIC,
    )
    image = vtray.render(load(document))
    x = (np.arange(size[0]) - size[0] / 2) * 4 / size[0]
    sine = np.where(np.abs(x) < 1.5, x / 1.5, 2)
    light_of = np.where(sine < 0, -255 * sine, 0) * (np.abs(sine) < 1)
    np.testing.assert_allclose(image.linear[..., 0], [light_of] * size[1], atol=1e-5)
    depth = np.where(np.abs(sine) < 1, 19 - np.sqrt(np.maximum(2.25 - x * x, 0)), np.inf)
    np.testing.assert_allclose(image.depth, [depth] * size[1])


STRAIGHT: dict[str, tuple[tuple[float, ...], float, float, float, Scene]] = {
    "outlines": ((0.6, 0.8, 0), -20, 20, 1, ORTHOGRAPHIC),
    "slanted outlines": ((0.36, 0.48, 0.8), -20, 20, 1, ORTHOGRAPHIC),
    "outlines from the eye": ((0.6, 0.8, 0), -20, 20, 15 * math.sin(math.atan(0.1)), {}),
    "a cap": ((0.6, 0.8, 0), 0, 4, 2, {}),
    "a cap along parallel rays": ((0.6, 0.8, 0), 0, 4, 2, ORTHOGRAPHIC),
    "halves": ((0.6, 0.8, 0), -4, 4, 2, {}),
    "halves along parallel rays": ((0.6, 0.8, 0), -4, 4, 2, ORTHOGRAPHIC),
}
"""Along which axis cylinders lie, from where to where, their radii, and how they are seen."""


@once
@pytest.mark.parametrize("by", [0.0, 1e3])
@pytest.mark.parametrize("name", STRAIGHT)
def test_no_speckle_along_straight_edges(name: str, by: float) -> None:
    # They fall on the middles of a row or a column of pixels: the camera is turned with them.
    axis, begin, end, radius, view = STRAIGHT[name]
    ends = (
        tuple((np.array((0, 0, 5)) + along * np.array(axis) + by).tolist())
        for along in (begin, end)
    )
    document = scene(
        [cylinder(*ends, radius, color_end=BLUE)],
        [light(by, by, by - 9)],
        center=xyz(by, by, by),
        up=xyz(axis[0], axis[1], 0),
        **(view if JIT else {**view, "size": [24, 8]}),
    )
    image = vtray.render(load(document))
    is_first = image.linear[..., 0] > image.linear[..., 2] / 2
    shown = (image.ids[..., 0] >= 0) + 2 * is_first
    height, width = shown.shape
    rows = shown[:, width // 2 - 5 : width // 2 + 5]
    assert (rows == rows[:, :1]).all() or "slanted" in name
    if "outlines" in name:
        # A column changes once at the most: from half to half.
        columns = shown[height // 3 : height - height // 3]
        assert (np.count_nonzero(np.diff(columns, axis=0), axis=0) <= 1).all()


@once
@pytest.mark.parametrize("exponent", [-980, -600, -60, 60, 600, 980])
def test_is_the_same_at_any_size(exponent: int) -> None:
    document = thicket(2, 20 if JIT else 3)
    if not JIT:
        document["camera"].update(size=[6, 5], resolution=[0.5, 0.5])
    expected = render(load(document), NEVER)
    factor = 2.0**exponent
    text = json.dumps(document)
    document = json.loads(text)
    for item in [document["camera"], *document["objects"], *document["lights"]]:
        for key in {"focus", "radius"} & item.keys():
            item[key] *= factor
        for key in {"center", "location", "start", "end"} & item.keys():
            item[key] = {axis: value * factor for axis, value in item[key].items()}
    camera = document["camera"]
    camera["resolution"] = [length * factor for length in camera["resolution"]]
    for few in (NEVER, ALWAYS):
        image = render(load(document), few)
        np.testing.assert_array_equal(image.linear, expected.linear)
        np.testing.assert_array_equal(image.ids, expected.ids)


@compiled_only
@pytest.mark.parametrize("samples", [1, 5])
@pytest.mark.parametrize(("threads", "tile"), [(2, 64), (3, 5), (7, 16)])
def test_is_the_same_for_any_threads_and_tiles(threads: int, tile: int, samples: int) -> None:
    document = thicket(1, 200)
    expected = render(load(document), NEVER, samples=samples)
    image = render(load(document), ALWAYS, samples=samples, threads=threads, tile=tile)
    assert_same(image, expected)


@pytest.mark.parametrize("view", [{}, ORTHOGRAPHIC])
def test_equals_the_plain_path(view: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hierarchy, "FEW", ALWAYS)
    document = thicket(5, 60 if JIT else 3, size=[23, 18] if JIT else [3, 2], **view)
    loaded = load(document)
    image = vtray.render(loaded, threads=1)
    arrays = pack(loaded, accelerate(loaded)).arrays
    cosines, blockers = np.zeros(len(loaded.lights)), np.zeros(len(loaded.lights), np.int64)
    for row, column in np.ndindex(*image.linear.shape[:2]):
        traced = trace_plainly(arrays, column, row, cosines, blockers)
        assert tuple(image.linear[row, column]) == traced.value
        assert (traced.primitive == NOTHING) == np.isinf(traced.distance)
        stack, kept = new_stack(), (cosines.copy(), blockers.copy())
        assert (
            reference.trace_pixel(arrays, column, row, stack, cosines, blockers, new_walk(0))
            == traced
        )
        np.testing.assert_array_equal((cosines, blockers), kept)


@compiled_only
@pytest.mark.parametrize("few", [ALWAYS, NEVER])
@pytest.mark.parametrize("samples", [1, 4])
def test_other_lights_and_colors_are_those_of_a_new_render(samples: int, few: int) -> None:
    world = load(thicket(3, 12))
    world.add_cylinders([(-1, 0, 4), (0, -1, 6)], [(1, 1, 4), (1, 1, 5)], 0.5, ["red", "blue"])
    index = len(world.objects) - 1
    image = render(world, few, samples=samples, keep_lights=True)
    for colors in (
        {"color": "green"},
        {"color": ["red", "white"], "color_end": "yellow"},
        {"color": [0.1, 0.9], "color_end": [0.5, 0.3], "cmap": "viridis"},
    ):
        changed = image.recolor(index, **colors)
        np.testing.assert_array_equal(
            changed.linear, render(changed.scene, few, samples=samples).linear
        )
        assert not np.array_equal(changed.linear, image.linear)
    dimmed = image.relight([0.5] * len(world.lights))
    expected = render(dimmed.scene, few, samples=samples)
    np.testing.assert_array_equal(dimmed.linear, expected.linear)
    single = next(k for k, o in enumerate(world.objects) if isinstance(o, vtray.Cylinder))
    changed = image.recolor(single, "purple")
    np.testing.assert_array_equal(
        changed.linear, render(changed.scene, few, samples=samples).linear
    )


VIEWS: dict[str, Scene] = {
    "side": scene([cylinder((-2, -1, 5), (2, 1.5, 7), 0.7)], []),
    "cap": scene([cylinder((0, 0, 5), (0.4, 0.3, 7), 2)], []),
    "to the horizon": scene(
        [cylinder((-2, 1, 1), (3, 0, 400), 0.3), cylinder((2, 1, 1), (-3, 2, 300), 0.05)], []
    ),
    "thin": scene([cylinder((-4, -3, 5), (4, 3.3, 7), 0.002)], []),
    "thin, far away": scene([cylinder((-1, -1, 0.1), (0.1, 0.3, 900), 0.004)], []),
    "from within": scene([cylinder((0.3, 0.1, -3), (0.4, 0.3, 12), 3)], []),
    "discs": scene(
        [cylinder((0, 0, 5), (0, 0.001, 5.002), 2), cylinder((2, 0, 5), (2, 0.03, 5), 2)], []
    ),
    "cut open": scene(
        [cylinder((0, 0, -1), (1.5, 0.5, 2), 1), cylinder((-3, -2, -0.5), (-2, 1, 1), 0.7)], []
    ),
    "square to the rays": scene([cylinder((-3, 0.1, 5), (4, 0.1, 5), 2)], []),
}


@compiled_only
@may_be_dark
@pytest.mark.parametrize("filter_name", ["box", "mitchell"])
@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("name", VIEWS)
def test_pixels_on_edges_have_samples(name: str, projection: str, filter_name: str) -> None:
    """Outlines, edges of caps, and middle lines; and few others have."""
    document = json.loads(json.dumps(VIEWS[name]))
    width, height = 40, 30
    document["camera"].update(
        size=[width, height], resolution=[10 / width, 7.5 / height], projection=projection
    )
    radius = FILTERS[filter_name].radius
    rows, columns = np.mgrid[0:height, 0:width]

    def shown(across: Any, below: Any) -> np.ndarray:
        seen = oracle.look(document, columns + across, rows + below)
        # Face and half, where something is seen.
        return np.where(
            seen.ids >= 0, 10 * seen.ids + (seen.parts % 3 > 0) + seen.parts // 3 * 2, -1
        )

    places = np.random.default_rng(1).uniform(-radius, radius, (64, 2))
    across, below = places.T[..., None, None]
    several = (shown(across, below) != shown(0, 0)).any(axis=0)
    assert several.any()
    for few in (ALWAYS, NEVER):
        image = render(load(document), few, samples=2, keep_lights=True, filter=filter_name)
        marks = image._relighting._passes[1].first >= 0
        assert not (several & ~marks).any()
        if filter_name == "box":
            assert marks.sum() <= 9 * several.sum() + 40


def test_halves_meet_in_the_middle() -> None:
    size = [16, 10] if JIT else [8, 4]
    document = scene(
        [cylinder((-2, 0, 5), (2, 0, 5), 1, color_end={"r": 0, "g": 0, "b": 255})],
        [light(0, 0, -1e9)],
        size=size,
        resolution=[0.25, 0.25],
        **ORTHOGRAPHIC,
    )
    image = vtray.render(load(document))
    hit = image.ids[..., 0] >= 0
    red = image.linear[..., 0] > 0
    columns = np.broadcast_to(np.arange(size[0]), hit.shape)
    # The middle itself belongs to the first half.
    np.testing.assert_array_equal(red[hit], (columns <= size[0] // 2)[hit])
    assert (image.linear[..., 2][hit] > 0).all()


@once
def test_ids_tell_object_and_index() -> None:
    size = (30, 12) if JIT else (6, 3)
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 5, size, (6 / size[0], 2 / size[1]))
    camera = camera.replace(projection="orthographic")
    wall = vtray.Plane((0, 0, 9), (0, 0, -1), (9, 9, 9), 1)
    posts = vtray.Cylinders(
        [(x, -9, 3) for x in (-2, -1, 0)], [(x, 9, 3) for x in (-2, -1, 0)], 0.4
    )
    one = vtray.Cylinder((1, -9, 3), (1, 9, 3), 0.4)
    ball = vtray.Sphere((2, 0, 3), 0.4)
    for objects in ([wall, posts, one, ball], [one, ball, wall, posts], [posts, ball, one, wall]):
        for few in (ALWAYS, NEVER):
            ids = render(vtray.Scene(camera, [vtray.Light((0, 0, -9))], objects), few).ids
            row = ids[size[1] // 2]
            for x in range(-2, 3):
                found = tuple(row[size[0] // 2 + x * size[0] // 6].tolist())
                item = posts if x < 1 else (one, ball)[x - 1]
                assert found == (objects.index(item), x + 2 if x < 1 else 0)
            assert tuple(row[0].tolist()) == (objects.index(wall), 0)


@once
@pytest.mark.parametrize("few", [ALWAYS, NEVER])
def test_at_the_same_distance_kinds_have_an_order(few: int) -> None:
    """Spheres, then cylinders, then planes, and within a kind the order of the scene."""
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 2, (1, 1), (1, 1))
    # The ray through the pixel at (-0.5, -0.5) in the image plane goes straight ahead.
    camera = camera.replace(projection="orthographic")
    place = -0.5, -0.5

    def seen(*objects: object) -> tuple[int, int]:
        image = render(vtray.Scene(camera, [vtray.Light((0, 0, -9))], list(objects)), few)
        assert image.depth[0, 0] == 2 + 4
        return tuple(image.ids[0, 0].tolist())

    wall = vtray.Plane((0, 0, 4), (0, 0, -1), (9, 9, 9), 1)
    post = vtray.Cylinder((*place, 4), (*place, 8), 1)
    posts = vtray.Cylinders([(*place, 4)] * 2, [(*place, 9)] * 2, 2)
    ball = vtray.Sphere((*place, 5), 1)
    assert seen(wall, post, ball) == (2, 0)
    assert seen(ball, wall, post) == (0, 0)
    assert seen(wall, post) == (1, 0)
    assert seen(wall, posts, post) == (1, 0)
    assert seen(wall, post, posts) == (1, 0)
    assert seen(posts, ball) == (1, 0)


def test_what_stands_between_is_told_in_that_order() -> None:
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 2, (1, 1), (1, 1))
    camera = camera.replace(projection="orthographic")
    # From the wall at (-0.5, -0.5, 8) to the light, past (2.5, -0.5, 5).
    lamp, wall = vtray.Light((5.5, -0.5, 2)), vtray.Plane((0, 0, 8), (0, 0, -1))
    curtain = vtray.Plane((2.5, 0, 0), (1, 0, 0))
    post = vtray.Cylinder((2.5, -2, 5), (2.5, 2, 5), 0.5)
    posts = vtray.Cylinders([(2.5, 9, 5), (2.5, -3, 5)], [(2.5, 8, 5), (2.5, 3, 5)], 0.5)
    ball = vtray.Sphere((2.5, -0.5, 5), 0.5)
    objects = [wall, curtain, posts, post, ball]
    for item, index in ((ball, None), (posts, 1), (post, None), (curtain, None)):
        tree = vtray.trace_pixel(vtray.Scene(camera, [lamp], objects), 0, 0)
        blocker = tree.lights[0].blocker
        assert objects[blocker.object] is item
        assert blocker.index == index
        objects.remove(item)
    assert vtray.trace_pixel(vtray.Scene(camera, [lamp], objects), 0, 0).lights[0].blocker is None
