"""The pictures of patterns: from files and arrays to scenes, and back."""

import copy
import json
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import vtray
from vtray.scene.fingerprint import scene_hash

PIXELS = np.random.default_rng(1).integers(0, 256, (4, 6, 3)).astype(np.uint8)


def scene_with(image: Any) -> vtray.Scene:
    """Return a scene in which a picture is in all places where one may be."""
    pattern = vtray.ImagePattern(image)
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 0), 1, material=vtray.Lambert(pattern=pattern))
    scene.add_spheres([(0, 0, 0), (1, 1, 1)], 1, material=vtray.Plastic(pattern=pattern))
    materials = ["mirror", vtray.Blend("metal", "lambert", pattern=pattern)]
    scene.add_spheres([(0, 0, 0), (1, 1, 1)], 1, material=materials, material_index=[0, 1])
    part = vtray.Sphere((0, 0, 0), 1, (1, 2, 3), material=vtray.Metal(pattern=pattern))
    scene.add_copies(part, [(1, 2, 3)])
    scene.add_light((1, 2, 3))
    scene.camera = vtray.Camera.fit(scene, size=(8, 8))
    return scene


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    """Return the file of a scene, beside a.png."""
    Image.fromarray(PIXELS).save(tmp_path / "a.png")
    scene_with(tmp_path / "a.png").save(tmp_path / "scene.json")
    return tmp_path / "scene.json"


def test_files_and_arrays_are_one(saved: Path) -> None:
    scene = scene_with(PIXELS)
    assert scene_with(saved.with_name("a.png")).objects == scene.objects
    for again in (vtray.load(saved), vtray.load_dict(scene.to_dict()), copy.deepcopy(scene)):
        assert again.objects == scene.objects
        assert scene_hash(again) == scene_hash(scene)
    assert pickle.loads(pickle.dumps(scene)).objects == scene.objects
    other = scene_with(PIXELS[::-1])
    assert other.objects != scene.objects
    assert scene_hash(other) != scene_hash(scene)


def test_a_picture_is_saved_once_and_again(saved: Path) -> None:
    vtray.load(saved).save(saved)
    named = re.findall('"image": "(.*)"', saved.read_text())
    assert len(named) == 4
    assert len(set(named)) == 1
    foreign = saved.with_name("other.npz")
    foreign.write_bytes(b"not of this scene")
    with pytest.raises(vtray.OutputError, match="does not belong to other.json"):
        vtray.load(saved).save(saved.with_name("other.json"))


def test_relative_paths_start_at_the_scene_file(saved: Path) -> None:
    text = saved.read_text()
    name = text.partition('"image": "')[2].partition('"')[0]
    saved.write_text(text.replace(name, "a.png"))
    assert vtray.load(saved).objects == scene_with(PIXELS).objects


def test_named_materials_have_pictures(saved: Path) -> None:
    pattern = {"type": "image", "image": "a.png"}
    found = json.loads(saved.read_text())
    found["materials"] = {"map": {"type": "lambert", "pattern": pattern}}
    found["objects"][0]["material"] = "map"
    saved.write_text(json.dumps(found))
    assert vtray.load(saved).objects[0] == scene_with(PIXELS).objects[0]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"a.png"', '"b.png"', "b.png: no such file; expected a picture"),
        ('"a.png"', "5", "expected the path of a picture, got 5"),
        ('"a.png"', '"scene.json"', "scene.json: holds no picture that can be read"),
        ('"a.png"', '"cut.png"', r"cut.png: is damaged or cut short \("),
        ('"a.png"', '"grey.npy"', "grey.npy: expected a uint8 array of shape"),
        ('"a.png"', '"."', ".: is a directory; expected a picture"),
        ('"image": "a.png"', '"size": 2', "missing; expected the path of a picture"),
    ],
)
def test_wrong_files_are_named(saved: Path, old: str, new: str, message: str) -> None:
    text = saved.read_text()
    name = text.partition('"image": "')[2].partition('"')[0]
    whole = saved.with_name("a.png").read_bytes()
    saved.with_name("cut.png").write_bytes(whole[:60])
    np.save(saved.with_name("grey.npy"), PIXELS[..., 0])
    saved.write_text(text.replace(name, "a.png").replace(old, new, 1))
    place = r"objects\[0\]\.material\.pattern\.image: "
    with pytest.raises(vtray.SceneError, match=place + message):
        vtray.load(saved)


@pytest.mark.parametrize("index", [0, 1])
def test_wrong_arrays_of_dictionaries_are_named(index: int) -> None:
    found = scene_with(PIXELS).to_dict()
    found["objects"][index]["material"]["pattern"]["image"] = PIXELS / 255
    place = rf"<dict>: objects\[{index}\]\.material\.pattern\.image: expected a uint8 array"
    with pytest.raises(vtray.SceneError, match=place):
        vtray.load_dict(found)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (PIXELS / 255, r"got an array of dtype float64 .*; turn it into numbers up to 255, as by"),
        (PIXELS[..., 0], r"got an array of dtype uint8 and shape \(4, 6\)"),
        (PIXELS[:0], r"expected at least one pixel, got shape \(0, 6, 3\)"),
        ([[1, 2], [3]], "or the path of a picture, got"),
        (5, "or the path of a picture, got 5"),
        ("none.png", "none.png: no such file; expected a picture"),
    ],
)
def test_wrong_values_are_named(given: Any, message: str) -> None:
    with pytest.raises(vtray.SceneError, match=r"ImagePattern\.image: .*" + message):
        vtray.ImagePattern(given)


def test_what_becomes_no_array_is_told() -> None:
    class Tensor:
        def __array__(self, *_: Any, **__: Any) -> Any:
            raise RuntimeError("Can't call numpy() on Tensor that requires grad.")

    with pytest.raises(vtray.SceneError, match=r"^ImagePattern\.image: expected a uint8 array"):
        vtray.ImagePattern(Tensor())
    with pytest.raises(vtray.SceneError, match=r"^Sky\.image: expected an array of floats"):
        vtray.Sky(image=Tensor())


def test_unknown_keys_are_told(saved: Path) -> None:
    text = saved.read_text()
    saved.write_text(text.replace('"image": "', '"blur": 1, "image": "', 1))
    told: list[str] = []
    vtray.load(saved, warn=told.append)
    assert len(told) == 1
    assert "objects[0].material.pattern.blur: unknown key" in told[0]


def test_a_picture_does_not_change() -> None:
    given = PIXELS.copy()
    pattern = vtray.ImagePattern(given)
    given[:] = 0
    assert (pattern.image.pixels[..., :3] == PIXELS).all()
    with pytest.raises(ValueError, match="read-only"):
        pattern.image.pixels[:] = 0


@pytest.mark.parametrize("mode", ["L", "P", "RGBA", "I;16", "1", "LA", "CMYK"])
def test_all_modes_of_pillow_are_read(tmp_path: Path, mode: str) -> None:
    grey = np.array([[0, 255], [255, 0]], np.uint8)
    picture = Image.fromarray(grey.astype(np.uint16) * 257 if mode == "I;16" else grey)
    path = tmp_path / ("a.tif" if mode == "CMYK" else "a.png")
    (picture if mode == "I;16" else picture.convert(mode)).save(path)
    assert (vtray.ImagePattern(path).image.pixels[..., :3] == grey[..., None]).all()


def test_photographs_are_turned_as_the_camera_was_held(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.fromarray(PIXELS).save(tmp_path / "a.png", exif=exif)
    turned = vtray.ImagePattern(tmp_path / "a.png").image.pixels
    assert (turned[..., :3] == np.rot90(PIXELS, -1)).all()


def test_a_picture_of_the_scene_is_not_written_over(saved: Path) -> None:
    text = saved.read_text()
    name = text.partition('"image": "')[2].partition('"')[0]
    saved.write_text(text.replace(name, "a.png"))
    with pytest.raises(vtray.OutputError, match="holds arrays of the scene itself"):
        vtray.render(vtray.load(saved), warn=[].append).save(saved.with_name("a.png"))
    assert (np.asarray(Image.open(saved.with_name("a.png"))) == PIXELS).all()
