"""A scene whose lights were never set looks as in a studio."""

import copy
import inspect
import pickle
import re
from pathlib import Path

import numpy as np
import pytest

import vtray
from conftest import JIT, once
from vtray import render
from vtray.scene.default_light import settings_of

SIZE = (32, 24) if JIT else (12, 9)
WHITE = [255, 255, 255]


def balls() -> vtray.Scene:
    scene = vtray.Scene()
    scene.add_spheres([(0, 0, 0), (1.5, 0, 0), (0, 1.4, 0.3)], 0.6, color="#3a6ea5")
    scene.camera = vtray.Camera.fit(scene, size=SIZE)
    return scene


def test_it_has_the_studio_its_own_colors_and_white_behind() -> None:
    scene = balls()
    image = render(scene)
    assert not scene.lights  # they follow the camera until they are set
    assert image.scene.lights == vtray.lights.studio(scene)
    assert image.settings.exposure == 1.0
    np.testing.assert_array_equal(image.pixels[0, 0], WHITE)
    seen = image.ids[..., 0] >= 0
    # The brightest show their own colour and a little more, and nothing is black.
    color = np.array([0x3A, 0x6E, 0xA5])
    assert image.linear[seen].max(axis=0) == pytest.approx(1.1 * color, rel=0.03)
    assert (image.linear[seen].min(axis=0) > 0.2 * color).all()


@once
def test_copies_and_pickles_have_it_too() -> None:
    scene = balls()
    render(scene)
    for copied in (copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert copied == scene
        assert not copied.lights
        assert render(copied).settings.exposure == 1.0
    scene.lights = []
    assert render(pickle.loads(pickle.dumps(scene)), warn=print).settings.exposure == "max"


def test_help_says_which_settings_are_others() -> None:
    usual, found = vtray.RenderSettings(), settings_of(balls())
    names = usual.__struct_fields__
    others = [name for name in names if getattr(found, name) != getattr(usual, name)]
    assert "background" in others
    parts = re.split(r"\n(?! )", inspect.getdoc(render) or "")
    told = {name: " ".join(part.split()) for part in parts for name in part.split("\n")[:1]}
    for name in others:
        assert "scenes whose lights were never set" in told[name], name


def test_what_is_asked_for_is_done() -> None:
    scene = balls()
    image = render(scene, exposure="max", background="black")
    assert image.pixels.max() == 255
    assert not image.pixels[0, 0].any()
    own = {"exposure": 0.5, "background": "transparent", "tolerance": 0.5, "edge_samples": 8}
    scene.render = vtray.RenderSettings(2, **own)
    assert render(scene).settings == scene.render
    locked = render(scene, lock=image)
    assert locked.white == image.white


def test_set_lights_are_used_as_ever() -> None:
    scene = balls()
    scene.lights = vtray.lights.none()
    with pytest.warns(UserWarning, match="there are none"):
        image = render(scene)
    assert not image.linear.any()
    assert image.settings.background == "black"
    scene = balls()
    scene.add_light((0, 0, 9))
    image = render(scene)
    assert image.scene.lights == scene.lights
    assert image.settings == vtray.RenderSettings()


def test_planes_alone_are_lit_evenly_and_nothing_not_at_all() -> None:
    scene = vtray.Scene(vtray.Camera((0, 0, 5), (0, 0, -1), 1.0, (8, 6), (0.1, 0.1)))
    assert not render(scene).linear.any()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color="#804020")
    np.testing.assert_array_equal(render(scene).pixels[3, 4], [0x80, 0x40, 0x20])


@once
def test_files_keep_the_light_that_was_seen(tmp_path: Path) -> None:
    scene = balls()
    image = render(scene)
    scene.save(tmp_path / "scene.json")
    loaded = vtray.load(tmp_path / "scene.json")
    assert loaded.lights == vtray.lights.studio(scene)
    assert vtray.load_dict(scene.to_dict()).lights == loaded.lights
    assert loaded.render == image.settings
    again = render(loaded)
    np.testing.assert_array_equal(again.pixels, image.pixels)
    assert again.scene_hash == image.scene_hash
    assert not scene.lights


@once
def test_it_goes_with_the_camera() -> None:
    scene = balls()
    first = render(scene).scene.lights
    scene.camera = vtray.Camera.fit(scene, direction=(1, 0, 0), size=SIZE)
    assert render(scene).scene.lights != first


@once
def test_single_rays_see_the_same() -> None:
    scene = balls()
    image = render(scene)
    assert vtray.trace_pixel(scene, SIZE[0] // 2, SIZE[1] // 2).scene.lights == image.scene.lights


@once
@pytest.mark.parametrize("opacity", [None, 0.5])
def test_objects_that_hold_nothing_need_no_light(opacity: float | None) -> None:
    scene = vtray.Scene(camera=balls().camera)
    scene.add_particles(np.zeros((0, 3)), bonds=[], opacity=opacity)
    assert len(scene.objects) > 0
    said: list[str] = []
    image = render(scene, warn=said.append)
    assert (image.pixels == WHITE).all()
    assert said == []
    scene.add_plane((0, 0, -1), (0, 0, 1))
    assert render(scene).scene.lights == [vtray.Ambient()]
