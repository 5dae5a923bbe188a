"""Other lights and colours are those of a new render, to the last bit."""

import gc
import json
import pickle
import weakref
from typing import Any

import numpy as np
import pytest
from clouds import cloud
from examples import light, one_sphere, plane, scene, sphere
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import colors, may_be_dark, scenes

import vtray
from conftest import JIT, once
from vtray.scene.settings import FILTERS

SETTINGS = st.fixed_dictionaries(
    {"samples": st.sampled_from([1, 1, 2, 5, 16])},
    optional={
        "filter": st.sampled_from(FILTERS),
        "seed": st.integers(0, 2**32 - 1),
        "exposure": st.sampled_from(["max", 0.5, 3.0]),
        "background": st.sampled_from(["black", "transparent", (10, 200, 30)]),
        "size": st.tuples(st.integers(1, 7), st.integers(1, 7)),
    },
)


def load(document: dict) -> vtray.Scene:
    return vtray.loads(json.dumps(document))


def assert_same(image: vtray.Image, expected: vtray.Image) -> None:
    """Compare all of two pictures."""
    np.testing.assert_array_equal(image.linear, expected.linear)
    np.testing.assert_array_equal(image.pixels, expected.pixels)
    np.testing.assert_array_equal(image.develop(16), expected.develop(16))
    np.testing.assert_array_equal(image.alpha, expected.alpha)
    np.testing.assert_array_equal(image.depth, expected.depth)
    np.testing.assert_array_equal(image.normals, expected.normals)
    np.testing.assert_array_equal(image.ids, expected.ids)
    assert image.white == expected.white
    assert image.scene == expected.scene
    assert image.settings == expected.settings
    assert image.locked == expected.locked


@once
@may_be_dark
@settings(max_examples=80)
@given(scenes(), SETTINGS, st.data())
def test_equals_a_new_render(document: dict, how: dict, data: st.DataObject) -> None:
    if how["samples"] > 2:
        document["camera"]["size"] = [min(9, n) for n in document["camera"]["size"]]
    world = load(document)
    # Not an argument, which excludes a lock.
    world.render = vtray.RenderSettings(exposure=how.pop("exposure", "max"))
    image = vtray.render(world, threads=2, keep_lights=True, **how)
    assert_same(image, vtray.render(world, threads=1, **how))

    strengths = [0.0, 0.25, 1.0, 7.0]
    intensities = [data.draw(st.sampled_from(strengths)) for _ in world.lights]
    lights = [
        vtray.Light(one.location, strength)
        for one, strength in zip(world.lights, intensities, strict=True)
    ]
    relit = vtray.Scene(world.camera, lights, world.objects, world.render)
    fresh = vtray.render(relit, threads=1, **how)
    assert_same(image.relight(intensities), fresh)
    assert_same(image.relight(intensities, lock=image), vtray.render(relit, lock=image, **how))
    assert_same(image.relight([one.intensity for one in world.lights]), image)
    if not world.objects:
        return
    index = data.draw(st.integers(-len(world.objects), len(world.objects) - 1))
    color = vtray.Color(**data.draw(colors()))
    item = world.objects[index]
    place = item.center
    changed = (
        vtray.Sphere(place, item.radius, color, item.lambert)
        if isinstance(item, vtray.Sphere)
        else vtray.Plane(place, item.normal, color, item.lambert)
    )
    objects = list(world.objects)
    objects[index] = changed
    recolored = vtray.Scene(world.camera, lights, objects, world.render)
    fresh = vtray.render(recolored, threads=1, **how)
    assert_same(image.relight(intensities).recolor(index, color), fresh)
    assert_same(image.recolor(index, color).relight(intensities), fresh)


def many(samples: int) -> tuple[vtray.Scene, dict]:
    """Return a scene of arrays of spheres, single ones and a plane, and how to render it."""
    count, size = (300, (40, 30)) if JIT else (12, (6, 5))
    spheres = cloud("uniform", count, 1)
    camera = vtray.Camera.orthographic((0, 0, 9), (0, 0, 0), 2.5, size=size)
    lights = [vtray.Light((3, 4, 9), 0.7), vtray.Light((-9, 1, 2), 0.3)]
    ball, wall = (
        vtray.Sphere((0.5, 0.5, 0.9), 0.3, (9, 99, 200), 1),
        vtray.Plane((0, 0, -1), (0, 0, 1), (200, 150, 90), 1),
    )
    return vtray.Scene(camera, lights, [wall, spheres, ball]), {"samples": samples}


@once
@pytest.mark.parametrize("samples", [1, 3])
def test_values_become_colors_as_in_a_new_scene(samples: int) -> None:
    world, how = many(samples)
    image = vtray.render(world, keep_lights=True, **how)
    spheres = world.objects[1]
    values = np.linspace(-1, 2, len(spheres))
    values[3] = np.nan
    words: dict[str, Any] = {"cmap": "magma", "clim": (0, 1), "nan_color": "lime"}
    other = vtray.Scene(world.camera, world.lights, [world.objects[0]])
    other.add_spheres(spheres.center, spheres.radius, values, lambert=spheres.lambert, **words)
    other.objects.append(world.objects[2])
    recolored = image.recolor(1, values, **words)
    fresh = vtray.render(other, **how)
    np.testing.assert_array_equal(recolored.linear, fresh.linear)
    np.testing.assert_array_equal(recolored.pixels, fresh.pixels)
    assert not np.array_equal(recolored.linear, image.linear)
    # One color for all, and each its own.
    own = np.random.default_rng(3).integers(0, 256, (len(spheres), 3), dtype=np.uint8)
    for color in ("teal", own):
        other.objects[1] = (
            vtray.Spheres(
                spheres.center, spheres.radius, vtray.colors.to_rgb(color), spheres.lambert
            )
            if isinstance(color, str)
            else vtray.Spheres(spheres.center, spheres.radius, color, spheres.lambert)
        )
        np.testing.assert_array_equal(
            recolored.recolor(1, color).linear, vtray.render(other, **how).linear
        )


def test_pictures_do_not_change_each_other_or_the_scene() -> None:
    world, how = many(2)
    image = vtray.render(world, keep_lights=True, **how)
    linear, pixels = image.linear.copy(), image.pixels.copy()
    one, two = image.relight([0, 1]), image.recolor(0, "black")
    three = image.relight([0, 1])
    np.testing.assert_array_equal(one.linear, three.linear)
    np.testing.assert_array_equal(image.linear, linear)
    np.testing.assert_array_equal(image.pixels, pixels)
    assert [light.intensity for light in world.lights] == [0.7, 0.3]
    assert world.objects[0].color == vtray.Color(200, 150, 90)
    assert two.scene.objects[0].color == vtray.Color(0, 0, 0)
    world.objects.clear()
    world.lights.clear()
    np.testing.assert_array_equal(image.relight([0, 1]).linear, one.linear)


def test_lights_add_up() -> None:
    world, how = many(4)
    image = vtray.render(world, keep_lights=True, **how)
    parts = [image.relight(only).linear for only in ([0.7, 0], [0, 0.3])]
    np.testing.assert_allclose(sum(parts), image.linear, rtol=1e-12)
    np.testing.assert_allclose(image.relight([1.4, 0.6]).linear, 2 * image.linear, rtol=1e-12)
    dark = image.relight([0, 0])
    assert not dark.linear.any()
    assert not dark.pixels.any()
    assert dark.white == 0


WRONG = [
    (
        lambda image: image.relight([1]),
        "relight: intensities: expected 2 numbers, one for each light, got 1",
    ),
    (
        lambda image: image.relight([1, 2, 3]),
        "relight: intensities: expected 2 numbers, one for each light, got 3",
    ),
    (
        lambda image: image.relight([]),
        "relight: intensities: expected 2 numbers, one for each light, got 0",
    ),
    (
        lambda image: image.relight(3),
        "relight: intensities: expected 2 numbers, one for each light, got 3",
    ),
    (
        lambda image: image.relight({0.5: "key", 0.25: "fill"}),
        "relight: intensities: expected 2 numbers, one for each light, in their order, got a dict$",
    ),
    (
        lambda image: image.relight({0.5, 0.25}),
        "relight: intensities: expected 2 numbers, one for each light, in their order, got a set$",
    ),
    (
        lambda image: image.relight(np.array(1.0)),
        "relight: intensities: expected 2 numbers, one for each light, got array",
    ),
    (lambda image: image.relight([1, 1], lock=2.5), "lock: expected a picture.*, got 2.5"),
    (lambda image: image.expose(lock=np.zeros(9)), "lock: expected a picture.*, got array"),
    (lambda image: vtray.render(image.scene, lock="a.png"), "lock: expected .*'a.png'"),
    (lambda image: image.relight([1, -1]), r"relight: intensities\[1\]: .*≥ 0.*-1"),
    (lambda image: image.relight([1, float("nan")]), r"relight: intensities\[1\]: .*nan"),
    (lambda image: image.relight([1, float("inf")]), r"relight: intensities\[1\]: .*inf"),
    (lambda image: image.relight(["1", 1]), r"relight: intensities\[0\]: expected a number.*'1'"),
    (lambda image: image.relight([1, None]), r"relight: intensities\[1\]: expected a number.*None"),
    (lambda image: image.relight([1e308, 1e308]), "lights: the intensities add up to inf"),
    (lambda image: image.recolor(2, "red"), "recolor: index: expected a place from 0 to 1, got 2"),
    (lambda image: image.recolor(-3, "red"), "recolor: index: expected a place.*, got -3"),
    (lambda image: image.recolor(0, "rde"), "recolor: color: .*'rde'"),
    (lambda image: image.recolor(0, (1, 2)), "recolor: color: "),
    (lambda image: image.recolor(0, [(1, 2, 3), (1, 2, 3)]), "recolor: color: "),
    (lambda image: image.recolor(0, (1, 2, 256)), "recolor: color: .*256"),
    (lambda image: image.recolor("0", "red"), "recolor: index: expected .*'0'"),
    (lambda image: image.recolor(0.0, "red"), "recolor: index: expected .*0.0"),
    (lambda image: image.recolor(np.arange(2), "red"), r"recolor: index: .*got array\(\[0, 1"),
    (lambda image: image.recolor(True, "red"), "recolor: index: expected .*True"),
]


@pytest.fixture(scope="module")
def kept() -> vtray.Image:
    lights = [light(5, -5, 0), light(0, -5, 0)]
    world = scene([sphere((0, 0, 5), 1), plane((0, 2, 0), (0, -1, 0))], lights, size=[4, 3])
    return vtray.render(load(world), keep_lights=True)


@pytest.mark.parametrize(("change", "message"), WRONG)
def test_wrong_arguments(kept: vtray.Image, change: Any, message: str) -> None:
    with pytest.raises(vtray.VtrayError, match=message) as error:
        change(kept)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("change", ["relight", "recolor"])
def test_without_kept_lights(change: str) -> None:
    image = vtray.render(load(scene([sphere((0, 0, 5), 1)], [light(0, 0, 0)], size=[4, 3])))
    remedy = "^image: its lights were not kept; render it with keep_lights=True$"
    with pytest.raises(vtray.RenderError, match=remedy):
        image.relight([2]) if change == "relight" else image.recolor(0, "red")


def test_lights_that_are_off() -> None:
    world = load(scene([sphere((0, 0, 5), 9)], [light(0, 0, 0, intensity=0)], size=[3, 2]))
    with pytest.warns(UserWarning, match="^lights: all have the intensity 0, so all that is seen"):
        assert not vtray.render(world).linear.any()
    assert vtray.render(world, keep_lights=True).relight([1]).linear.any()  # warns of nothing


@pytest.mark.parametrize(
    "light",
    [
        vtray.Sky(1.0, color=(0, 0, 0)),
        vtray.Sun((0, 0, -1), color=(0, 0, 0)),
    ],
)
def test_lights_without_light(light: vtray.Sky | vtray.Sun) -> None:
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 0), 1)
    scene.lights = [light]
    scene.camera = vtray.Camera.look_at((0, -6, 0), target=(0, 0, 0), up=(0, 0, 1), size=(9, 9))
    with pytest.warns(UserWarning, match="^lights: all are black, and so is all"):
        assert not vtray.render(scene).linear.any()
    scene.lights = [light.replace(color=(0, 0, 1))]
    assert vtray.render(scene).linear.any()


def test_without_lights_or_objects() -> None:
    how = {"keep_lights": True, "samples": 2}
    empty = vtray.render(load(scene([], [], size=[3, 2])), **how)
    with pytest.warns(
        UserWarning, match=r"^lights: there are none, so all that is seen is black"
    ) as caught:
        dark = vtray.render(load(scene([sphere((0, 0, 5), 9)], [], size=[3, 2])), **how)
    assert [warning.filename for warning in caught] == [__file__]
    for image in (empty, dark):
        assert not image.relight([]).linear.any()
    with pytest.raises(
        vtray.SceneError, match="recolor: index: expected nothing, as there are no objects, got 0"
    ):
        vtray.render(load(scene([], [])), keep_lights=True).recolor(0, "red")


@once
def test_pictures_of_the_same_rays_share_surfaces_and_hold_no_other_picture() -> None:
    image = vtray.render(vtray.loads(json.dumps(one_sphere())), size=(8, 6), keep_lights=True)
    other = image.relight([2.0]).expose(1.5)
    assert other.ids is image.ids
    gone = weakref.ref(image)
    del image
    gc.collect()
    assert gone() is None
    again = pickle.loads(pickle.dumps(other))
    assert (again.pixels == other.pixels).all()
    assert again.scene_hash == other.scene_hash
