"""Pictures of copies: to the last bit those of the scene in which all of them are written out."""

import math
from typing import Any

import numpy as np
import pytest
from cylinder_pictures import load
from hypothesis import given, settings
from hypothesis import strategies as st
from plain import NOTHING
from plain import trace_pixel as trace_plainly
from strategies import cylinder_scenes, may_be_dark
from written_out import write_out

import vtray
from conftest import JIT, compiled_only, once
from vtray.geometry.packets.layer_notes import new_walk
from vtray.geometry.packets.stack import new_stack
from vtray.geometry.world import NO_TREE
from vtray.rendering import hierarchy
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.numbering import find, number_objects
from vtray.rendering.pack import pack
from vtray.transport.integrators import reference

ALWAYS, NEVER = 0, 10**9
"""For ``hierarchy.LEAF``: what is copied always has a hierarchy, or never."""


def render(scene: vtray.Scene, few: int | None = None, **options: Any) -> vtray.Image:
    """Render a scene with nothing kept."""
    fresh = vtray.Scene(scene.camera, scene.lights, scene.objects)
    with pytest.MonkeyPatch.context() as patch:
        if few is not None:
            patch.setattr(hierarchy, "FEW", few)
            patch.setattr(hierarchy, "LEAF", few)
        return vtray.render(fresh, **{"threads": 1, **options})


def assert_as_written_out(scene: vtray.Scene, image: vtray.Image, **options: Any) -> None:
    """Compare all of the picture of a scene with that of its copies written out."""
    written, origins = write_out(scene)
    other = render(written, **options)
    for name in ("linear", "pixels", "alpha", "depth", "normals", "halves"):
        np.testing.assert_array_equal(getattr(image, name), getattr(other, name))
    assert image.stats["rays"] == other.stats["rays"]
    assert_same_ids(scene, image, other, origins)


def assert_same_ids(
    scene: vtray.Scene, image: vtray.Image, other: vtray.Image, origins: list[Any]
) -> None:
    """Compare what is seen in a picture with what is where copies are written out."""
    seen = zip(image.ids.reshape(-1, 2), image.copies.flat, other.ids.reshape(-1, 2), strict=True)
    for (place, index), copy, (other_place, other_index) in {tuple(map(tuple_of, s)) for s in seen}:
        if other_place < 0:
            assert (place, index, copy) == (-1, -1, -1)
            continue
        origin, item = origins[other_place], scene.objects[place]
        assert place == origin.place
        if isinstance(item, vtray.Copies):
            assert copy == origin.copy
            assert item.locate(index) == (origin.part, other_index)
        else:
            assert (copy, index) == (-1, other_index)


def tuple_of(value: Any) -> Any:
    """Return a row of integers as a tuple, and a number as an integer."""
    return int(value) if np.ndim(value) == 0 else tuple(map(int, value))


@st.composite
def copied_scenes(draw: st.DrawFn) -> vtray.Scene:
    """Scenes in which runs of objects are copied, often to places at which they touch."""
    scene = load(draw(cylinder_scenes()))
    size = max(map(abs, (1e-30, *(getattr(light.location, "x") for light in scene.lights))))  # noqa: B009
    steps = st.tuples(*[st.integers(-2, 2)] * 3).map(lambda step: [k * size / 4 for k in step])
    objects: list[Any] = []
    waiting = list(scene.objects)
    while waiting:
        count = draw(st.integers(1, 3))
        run, waiting = waiting[:count], waiting[count:]
        bounded = [item for item in run if not isinstance(item, vtray.Plane)]
        if bounded and draw(st.booleans()):
            places = np.array(draw(st.lists(steps, max_size=12))).reshape(-1, 3)
            objects.append(vtray.Copies(bounded, places.astype(draw(st.sampled_from("fd")))))
            run = [item for item in run if isinstance(item, vtray.Plane)]
        objects += run
    return vtray.Scene(scene.camera, scene.lights, objects)


@once
@may_be_dark
@settings(max_examples=100 if JIT else 10)
@given(copied_scenes(), st.sampled_from([None, ALWAYS, NEVER]))
def test_as_written_out(scene: vtray.Scene, few: int | None) -> None:
    if not JIT:
        scene.camera = scene.camera.replace(size=(5, 4))
    assert_as_written_out(scene, render(scene, few))


def many(
    seed: int, shapes: int, copies: int, by: float = 0.0, projection: str = "perspective"
) -> vtray.Scene:
    """Return a scene with two kinds of copies among other things, which touch and overlap."""
    numbers = np.random.default_rng(seed)
    near = numbers.uniform(-0.3, 0.3, (3, shapes, 3))
    scene = vtray.Scene()
    scene.add_plane((by, 3 + by, by), (0, 1, 0), "gray")
    scene.add_spheres(numbers.uniform(-1, 1, (5, 3)) + by, 0.2, "red")
    scene.add_copies(
        [
            vtray.Spheres(near[0], numbers.uniform(0.02, 0.1, shapes), list_of_colors(shapes)),
            vtray.Cylinder((0, 0, 0), (0, 0.5, 0), 0.1, (0, 255, 0), 0.5),
            vtray.Cylinders(near[1], near[2], 0.02, color=(0, 0, 255), color_end=(255, 0, 0)),
            vtray.Sphere((0, 0.2, 0), 0.1, (0, 255, 0), 0.5),
        ],
        numbers.uniform(-2, 2, (copies, 3)) + by,
    )
    scene.add_spheres(numbers.uniform(-1, 1, (5, 3)) + by, 0.2, "blue")
    scene.add_cylinder((-2 + by, -2 + by, by), (2 + by, 2 + by, by), 0.05)
    ball = vtray.Sphere((0, 0, 0), 0.1, (255, 255, 0), 0.5)
    scene.add_copies(ball, np.round(numbers.uniform(-2, 2, (copies, 3)), 1) + by)
    size, pixel = ((60, 40), 0.1) if JIT else ((9, 7), 0.5)
    center = (by, -1.0 + by, -3.0 + by)
    scene.camera = vtray.Camera(center, (0, 1, 3), 6.0, size, (pixel, pixel), projection=projection)
    scene.add_light((5 + by, -9 + by, -6 + by))
    scene.add_light((by, by, 0.1 + by), 0.5)  # among the copies
    return scene


def list_of_colors(count: int) -> np.ndarray[Any, Any]:
    """Return as many colours, each another."""
    return np.stack([np.arange(count) % 256, np.full(count, 9), np.full(count, 200)], axis=1)


@once
@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("by", [0.0, 1e6, -12345.678])
@pytest.mark.parametrize(("shapes", "copies"), [(1, 1), (4, 40), (300, 30)] if JIT else [(2, 6)])
def test_many_as_written_out(shapes: int, copies: int, by: float, projection: str) -> None:
    scene = many(1, shapes, copies, by, projection)
    image = render(scene)
    assert np.unique(image.copies).size > (min(copies, 3) if JIT else 1)
    assert_as_written_out(scene, image)


@compiled_only
@pytest.mark.parametrize("seed", range(4))
def test_boxes_hold_what_rounding_moves_far_from_the_origin(seed: int) -> None:
    by = 2.0**47  # where doubles are 1/32 apart
    scene = vtray.Scene()
    centers = np.random.default_rng(seed).uniform(-1, 1, (300, 3))
    scene.add_copies(vtray.Spheres(centers, 0.05), [(by, by, by)])
    scene.add_light((by, by - 9, by - 9))
    scene.camera = vtray.Camera((by, by, by - 8), (0, 0, 1), 6.0, (300, 300), (0.01, 0.01))
    assert_as_written_out(scene, render(scene))


@compiled_only
@pytest.mark.parametrize("options", [{"samples": 4}, {"threads": 3, "tile": 7}])
def test_however_it_is_made(options: dict[str, Any]) -> None:
    scene = many(2, 30, 25)
    assert_as_written_out(scene, render(scene, **options), **options)


@compiled_only
@pytest.mark.parametrize("samples", [1, 4])
def test_other_lights_and_colors(samples: int) -> None:
    scene = many(3, 20, 10)
    options: dict[str, Any] = {"samples": samples, "keep_lights": True}
    image = render(scene, **options)
    dimmed = image.relight([0.5, 2.0])
    np.testing.assert_array_equal(dimmed.linear, render(dimmed.scene, **options).linear)
    colored = image.recolor(2, "purple")
    assert not np.array_equal(colored.linear, image.linear)
    np.testing.assert_array_equal(colored.linear, render(colored.scene, **options).linear)


@compiled_only
def test_rays_one_by_one_meet_the_same_as_all_shapes_tested() -> None:
    scene = many(4, 30, 20)
    arrays = pack(scene, accelerate(scene)).arrays
    cosines, blockers = np.zeros(2), np.full(2, NOTHING)
    image = render(scene)
    for y in range(0, 40, 3):
        for x in range(0, 60, 3):
            found = trace_plainly(arrays, x, y, cosines, blockers)
            plain = cosines.copy(), blockers.copy()
            traced = reference.trace_pixel(
                arrays, x, y, new_stack(), cosines, blockers, new_walk(0)
            )
            assert traced == found
            np.testing.assert_array_equal(plain, (cosines, blockers))
            if traced.primitive != NOTHING:
                numbering = number_objects(scene.objects)
                place, copy, inner = find(scene.objects, numbering, traced.primitive)
                assert (place, inner) == tuple(image.ids[y, x])
                assert copy == image.copies[y, x]


@pytest.mark.parametrize(
    ("shift", "size", "radius"),
    [
        pytest.param(1e100, 1.0, 0.25, id="beyond the space of the boxes of what is copied"),
        pytest.param(1.79e308, 5e305, 1e307, id="at the end of the doubles"),
        pytest.param(1.0, 1e-100, 2e-101, id="tiny"),
    ],
)
def test_far_and_tiny_copies_are_found_without_their_hierarchies(
    shift: float, size: float, radius: float
) -> None:
    scene = vtray.Scene()
    centers = np.linspace(-1, 1, 12)[:, np.newaxis] * (size, size, 0)
    scene.add_copies(
        [vtray.Spheres(centers, radius)],
        [(0, 0, 4 * size), (shift, shift, shift), (-shift, shift, -shift)],
    )
    scene.add_light((0, -size, 0))
    scene.camera = vtray.Camera.look_at((0, 0, 0), (0, 0, size), size=(40, 30) if JIT else (12, 9))
    image = render(scene)
    assert (image.copies == 0).any()
    assert_as_written_out(scene, image)


def test_copies_stand_among_the_others_where_they_do_in_the_scene() -> None:
    scene = vtray.Scene()
    ball: Any = {"center": (0, 0, 5), "radius": 1}
    for first, second in (("red", "blue"), ("blue", "red")):
        scene.objects = []
        scene.add_sphere(**ball, color=first)
        scene.add_copies(vtray.Sphere((0, 0, 4), 1, vtray.Color(0, 255, 0), 1.0), [(0, 0, 1)] * 3)
        scene.add_sphere(**ball, color=second)
        scene.lights, scene.camera = (
            [vtray.Light((0, 0, 0))],
            vtray.Camera.look_at((0, 0, 0), (0, 0, 1), size=(3, 3)),
        )
        assert render(scene).ids[1, 1].tolist() == [0, 0]
        scene.objects = scene.objects[1:]
        image = render(scene)
        assert image.ids[1, 1].tolist() == [0, 0]
        assert image.copies[1, 1] == 0


@pytest.mark.parametrize("places", [np.zeros((0, 3)), [(0, 0, 5), (0, 0, 6)]])
def test_copies_of_nothing_are_not_seen(places: Any) -> None:
    scene = vtray.Scene()
    scene.add_copies(vtray.Spheres(np.zeros((0, 3)), 1.0), places)
    scene.add_copies(vtray.Sphere((0, 0, 0), 1.0, vtray.Color(255, 0, 0), 1.0), np.zeros((0, 3)))
    scene.add_light((0, 0, 0))
    scene.camera = vtray.Camera.look_at((0, 0, 0), (0, 0, 1), size=(4, 3))
    image = render(scene)
    assert (image.ids == -1).all()
    assert (image.copies == -1).all()
    assert math.isinf(image.depth.min())
    assert accelerate(scene).placed is None


def test_a_copy_that_moves_is_built_anew() -> None:
    at = np.array([(0.0, 0.0, 5.0), (3.0, 0.0, 5.0)])
    radius = np.array([0.5, 0.5])
    scene = vtray.Scene()
    scene.add_copies(vtray.Spheres([(0, 0, 0), (1, 0, 0)], radius), at)
    scene.add_light((0, 0, 0))
    scene.camera = vtray.Camera.look_at((0, 0, 0), (0, 0, 1), size=(8, 6))
    kept = accelerate(scene)
    assert accelerate(scene) is kept
    for array in (at, radius):
        array[0] *= 1.5
        again = accelerate(scene)
        assert again is not kept
        kept = again
        np.testing.assert_array_equal(vtray.render(scene, threads=1).linear, render(scene).linear)


@compiled_only
def test_memory_is_that_of_what_is_copied() -> None:
    numbers = np.random.default_rng(1)
    spheres = vtray.Spheres(numbers.uniform(-0.5, 0.5, (10**5, 3)), 0.01)
    lattice = np.stack(np.meshgrid(*[np.arange(10.0)] * 3), axis=-1).reshape(-1, 3)
    scene = vtray.Scene(objects=[vtray.Copies(spheres, lattice)])
    kept = accelerate(scene, 2)
    assert kept.count == 10**8
    alone = accelerate(vtray.Scene(objects=[spheres]), 2).memory
    assert kept.memory <= alone + 120 * 10**3


def test_more_than_can_be_numbered(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = vtray.Scene()
    scene.add_copies(vtray.Spheres([(0, 0, 0), (1, 0, 0)], 1.0), np.zeros((5, 3)))
    monkeypatch.setattr(hierarchy, "MAX_NUMBERS", 9)
    words = "^objects: expected at most 9 spheres, cylinders and cones, copies counted, got 10$"
    with pytest.raises(vtray.RenderError, match=words):
        accelerate(scene)
    monkeypatch.setattr(hierarchy, "MAX_NUMBERS", 10)
    monkeypatch.setattr(hierarchy, "MAX_SPHERES", 4)
    words = "^objects: expected at most 4 places of copies, got 5$"
    with pytest.raises(vtray.RenderError, match=words):
        accelerate(scene)
    monkeypatch.setattr(hierarchy, "MAX_SPHERES", 5)
    assert accelerate(scene).placed is not None
    assert accelerate(scene).shapes[0].root == NO_TREE
