"""Pictures of skies: given as arrays and as files, refused with words, saved and hashed."""

import copy
import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio  # noqa: N813
import pytest
from scene_text import changed

import vtray
from vtray import Gradient, Scene, SceneError, Sky
from vtray.base import memory
from vtray.base.errors import OutputError
from vtray.base.extras import ExtraError
from vtray.scene.fingerprint import scene_hash
from vtray.scene.pictures.sky_image import SkyImage

LIGHT = np.arange(4 * 8 * 3, dtype=np.float32).reshape(4, 8, 3) / 16


def written(path: Path, pixels: np.ndarray, names: str = "RGB") -> Path:
    """Write a picture by OpenImageIO."""
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, str(pixels.dtype))
    spec.channelnames = tuple(names)
    spec.attribute("oiio:UnassociatedAlpha", 1)
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), spec)
    assert out.write_image(np.ascontiguousarray(pixels))
    out.close()
    return path


def scene_with(sky: object) -> dict[str, Any]:
    """Return what a scene file says, with one light."""
    return changed({"lights": [sky]})


def load(folder: Path, **sky: object) -> Scene:
    """Load a scene file in a folder."""
    (folder / "scene.json").write_text(json.dumps(scene_with({"type": "sky", **sky})))
    return vtray.load(folder / "scene.json")


def pixels_of(scene: Scene) -> np.ndarray:
    (sky,) = scene.lights
    assert isinstance(sky, Sky)
    assert sky.image is not None
    return sky.image.pixels


@pytest.mark.parametrize("dtype", ["float16", "float32", "float64"])
def test_an_array_is_copied(dtype: str) -> None:
    given = LIGHT.astype(dtype)
    sky = Sky(2, image=given)
    given[:] = 0
    assert isinstance(sky.image, SkyImage)
    assert sky.image.pixels.dtype == np.float32
    np.testing.assert_array_equal(sky.image.pixels, LIGHT)
    assert not sky.image.pixels.flags.writeable
    assert sky == Sky(2, image=LIGHT.tolist()) == sky.replace(radiance=2) == copy.copy(sky)
    assert sky == pickle.loads(pickle.dumps(sky))
    assert sky != Sky(2, image=LIGHT * 2)
    assert Scene().add_sky(2, image=LIGHT) == sky
    assert repr(sky.image) == "SkyImage(<float32 (4, 8, 3)>)"


def test_files_of_all_kinds(tmp_path: Path) -> None:
    written(tmp_path / "a.exr", LIGHT)
    written(tmp_path / "gray.exr", LIGHT[..., :1], "Y")
    written(tmp_path / "alpha.exr", np.concatenate([LIGHT, LIGHT[..., :1] * 0], axis=2), "RGBA")
    written(tmp_path / "a.hdr", LIGHT)
    np.save(tmp_path / "a.npy", LIGHT)
    np.savez(tmp_path / "a.npz", image=LIGHT.astype(np.float64))
    for name in ("a.exr", "alpha.exr", "a.npy", "a.npz"):
        np.testing.assert_array_equal(pixels_of(load(tmp_path, image=name)), LIGHT)
        assert Sky(image=tmp_path / name) == Sky(image=str(tmp_path / name)) == Sky(image=LIGHT)
    gray = np.repeat(LIGHT[..., :1], 3, axis=2)
    np.testing.assert_array_equal(pixels_of(load(tmp_path, image="gray.exr")), gray)
    # Radiance's .hdr has 8 bits beside a common exponent.
    found = pixels_of(load(tmp_path, image="a.hdr"))
    np.testing.assert_allclose(found, LIGHT, atol=float(LIGHT.max()) / 100)


@pytest.mark.parametrize(("dtype", "most"), [("uint8", 255), ("uint16", 65535)])
def test_whole_numbers_are_parts_of_the_largest(tmp_path: Path, dtype: str, most: int) -> None:
    whole = np.random.default_rng(1).integers(0, most + 1, (4, 8, 4)).astype(dtype)
    written(tmp_path / "a.png", whole, "RGBA")
    expected = (whole[..., :3] / most).astype(np.float32)
    np.testing.assert_array_equal(pixels_of(load(tmp_path, image="a.png")), expected)
    if dtype == "uint8":
        level = np.full((16, 16, 3), 51, np.uint8)
        written(tmp_path / "a.jpg", level)
        assert pixels_of(load(tmp_path, image="a.jpg")) == pytest.approx(0.2)


def test_paths_are_relative_to_the_scene_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "in").mkdir()
    np.save(tmp_path / "in" / "a:b.npy", LIGHT)
    assert load(tmp_path, image="in/a:b.npy").lights == [Sky(image=LIGHT)]
    monkeypatch.chdir(tmp_path / "in")
    data = scene_with({"type": "sky", "image": "a:b.npy", "radiance": 3})
    assert vtray.load_dict(data).lights == [Sky(3, image=LIGHT)]
    escaped = json.dumps(data).replace("a:b", "a\\u003ab")
    assert vtray.loads(escaped).lights == [Sky(3, image=LIGHT)]


WORDS = "expected an array of floats of shape (height, width, 3), or the path of a picture, got"


def spoiled(value: float, dtype: str = "float64") -> np.ndarray:
    pixels = LIGHT.astype(dtype)
    pixels[3, 5, 1] = value
    return pixels


@pytest.mark.parametrize(
    ("image", "message"),
    [
        (7, f"{WORDS} 7"),
        ([[1.0], [1.0, 2.0]], f"{WORDS} [[1.0], [1.0, 2.0]]"),
        (LIGHT[..., 0], f"{WORDS} an array of dtype float32 and shape (4, 8)"),
        (
            LIGHT.astype(np.uint8),
            f"{WORDS} an array of dtype uint8 and shape (4, 8, 3); divide whole numbers by the one "
            "that stands for 1, such as 255",
        ),
        (LIGHT[:0], "expected at least one pixel, got shape (0, 8, 3)"),
        (
            spoiled(-0.5),
            "row 3, column 5, green: expected a finite number ≥ 0, got -0.5; clip it, as by "
            "numpy.maximum(image, 0)",
        ),
        (
            spoiled(np.nan),
            "row 3, column 5, green: expected a finite number ≥ 0, got nan; mend it in the program "
            "that made the picture",
        ),
        (
            spoiled(np.inf),
            "row 3, column 5, green: expected a number up to 3.4e38, got inf; clip it, as by "
            "numpy.minimum(image, 1e6)",
        ),
        (
            spoiled(1e39),
            "row 3, column 5, green: expected a number up to 3.4e38, got 1e+39; clip it, as by "
            "numpy.minimum(image, 1e6)",
        ),
        (
            LIGHT * 0,
            "expected some light, got a picture that is black; leave out the sky if it shall give "
            "no light",
        ),
    ],
)
def test_what_is_refused(tmp_path: Path, image: Any, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        Sky(image=image)
    assert str(caught.value) == f"Sky.image: {message}"
    with pytest.raises(SceneError) as caught:
        Scene().add_sky(image=image)
    assert str(caught.value) == f"add_sky: image: {message}"
    if isinstance(image, np.ndarray):
        with pytest.raises(SceneError) as caught:
            vtray.load_dict(scene_with({"type": "sky", "image": image}), "room")
        assert str(caught.value) == f"room: lights[0].image: {message}"
        np.save(tmp_path / "a.npy", image)
        with pytest.raises(SceneError) as caught:
            load(tmp_path, image="a.npy")
        end = message if image.size and image.ndim == 3 and image.dtype != np.uint8 else ""
        assert f"scene.json: lights[0].image: a.npy: {end}" in str(caught.value)


def test_a_picture_beside_a_gradient() -> None:
    words = "expected no picture beside a gradient; leave out one of them"
    with pytest.raises(SceneError, match=rf"^Sky\.image: {words}"):
        Sky(gradient=Gradient(), image=LIGHT)
    both: dict[str, Any] = {"type": "sky", "gradient": {}, "image": "a.exr"}
    with pytest.raises(SceneError, match=rf"^<dict>: lights\[0\]\.image: {words}"):
        vtray.load_dict(scene_with(both))
    with pytest.raises(SceneError, match=rf"^<dict>: lights\[0\]\.image: {words}"):
        vtray.load_dict(scene_with({**both, "image": LIGHT}))


def test_files_that_cannot_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def message(name: str) -> str:
        with pytest.raises(SceneError) as caught:
            load(tmp_path, image=name)
        start = f"{tmp_path / 'scene.json'}: lights[0].image: "
        assert str(caught.value).startswith(start)
        return str(caught.value).removeprefix(start)

    words = "expected the path of an .exr, .hdr, .png, .jpg, .npy or .npz file"
    assert message("sky.tga") == f'{words}, got "sky.tga"'
    assert message("sky.exr") == "sky.exr: no such file; expected a .exr file"
    (tmp_path / "dir.exr").mkdir()
    assert message("dir.exr") == "dir.exr: is a directory; expected a .exr file"
    (tmp_path / "empty.hdr").write_bytes(b"")
    assert message("empty.hdr") == "empty.hdr: is empty; expected a .hdr file"
    (tmp_path / "other.png").write_text("no picture")
    assert message("other.png") == "other.png: holds something else; expected a .png file"
    for ending in ("exr", "hdr", "png", "jpg"):
        noise = np.random.default_rng(2).integers(0, 255, (64, 128, 3)).astype(np.uint8)
        pixels = noise if ending in ("png", "jpg") else noise.astype(np.float32)
        whole = written(tmp_path / f"cut.{ending}", pixels).read_bytes()
        for part in (len(whole) // 2, 40):
            (tmp_path / f"cut.{ending}").write_bytes(whole[:part])
            assert message(f"cut.{ending}").startswith(f"cut.{ending}: is damaged or cut short (")
    written(tmp_path / "z.exr", LIGHT[..., :1], "Z")
    assert message("z.exr") == "z.exr: has the channels Z; expected R, G and B, or Y alone"
    np.savez(tmp_path / "a.npz", sky=LIGHT)
    assert message("a.npz") == "a.npz: expected an array image, got sky"
    written(tmp_path / "a.exr", LIGHT)
    monkeypatch.setattr(memory, "_limits", lambda: [memory._Limit(2, 1000, "1 kB are left")])
    found = message("a.exr")
    assert found.startswith("a.exr: 8 x 4 pixels are too large to hold in memory: they need ")


def test_without_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(tmp_path / "a.exr", LIGHT)
    monkeypatch.setitem(__import__("sys").modules, "OpenImageIO", None)
    with pytest.raises(ExtraError, match=r"a\.exr: reading it needs OpenImageIO, .* install"):
        Sky(image=path)


def test_saved_and_loaded(tmp_path: Path) -> None:
    scene = load(tmp_path, image=str(written(tmp_path / "sky.exr", LIGHT)), rotation=30, radiance=2)
    scene.add_spheres([(0, 0, 5)], 1, "red")
    scene.save(tmp_path / "new.json")
    text = json.loads((tmp_path / "new.json").read_text())
    assert text["lights"] == [
        {"type": "sky", "radiance": 2.0, "image": "new-2.npz", "rotation": 30.0}
    ]
    again = vtray.load(tmp_path / "new.json")
    assert again.lights == scene.lights
    assert vtray.load_dict(scene.to_dict()).lights == scene.lights
    assert scene.to_dict()["lights"][0]["image"] is pixels_of(scene)
    hashes = {scene_hash(one) for one in (scene, again, vtray.load_dict(scene.to_dict()))}
    assert len(hashes) == 1
    scene.lights = [Sky(2, image=LIGHT * 2, rotation=30)]
    assert scene_hash(scene) not in hashes
    again.save(tmp_path / "new.json")  # its own files are replaced
    assert vtray.load(tmp_path / "new.json").lights == again.lights


def test_files_of_others_are_not_replaced(tmp_path: Path) -> None:
    scene = Scene(vtray.Camera.fit([(0, 0, 0), (1, 0, 0)]), [Sky(image=LIGHT)])
    np.savez(tmp_path / "new.npz", data=LIGHT)
    with pytest.raises(OutputError, match=r"new\.npz: is there already and does not belong to"):
        scene.save(tmp_path / "new.json")
    np.savez(tmp_path / "sky.npz", image=LIGHT)
    lit = load(tmp_path, image="sky.npz")
    lit.camera = lit.camera.replace(size=(2, 2))
    with pytest.raises(OutputError, match="holds arrays of the scene itself"):
        vtray.render(lit).save(tmp_path / "sky.npz")
