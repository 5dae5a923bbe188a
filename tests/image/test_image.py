"""The picture as an object."""

import io
import json
from pathlib import Path

import numpy as np
import pytest
from examples import one_sphere, scene
from PIL import Image as PillowImage

import vtray
from vtray.base.tiles import split_into_tiles


@pytest.fixture(scope="module")
def image() -> vtray.Image:
    document = one_sphere()
    document["camera"].update(size=[24, 18], resolution=[0.2, 0.2])
    return vtray.render(vtray.loads(json.dumps(document)), threads=2)


def test_arrays(image: vtray.Image) -> None:
    assert image.linear.shape == image.pixels.shape == (18, 24, 3)
    assert (image.linear.dtype, image.pixels.dtype) == (np.float64, np.uint8)
    assert image.pixels.max() == 255
    assert image.linear[..., 1:].max() == 0
    assert image.stats["rays"] > 18 * 24
    assert {"pack", "compile", "trace", "develop"} <= image.stats.keys()


@pytest.mark.parametrize("name", ["a.png", "b.PNG", "c"])
def test_save(image: vtray.Image, name: str, tmp_path: Path) -> None:
    image.save(tmp_path / name)
    image.save(str(tmp_path / name))
    with PillowImage.open(tmp_path / name) as read:
        assert (read.format, read.mode, read.size) == ("PNG", "RGB", (24, 18))
        np.testing.assert_array_equal(np.asarray(read), image.pixels)


@pytest.mark.parametrize("name", ["a.gif", "a.png.txt"])
def test_save_to_an_unknown_format(image: vtray.Image, name: str, tmp_path: Path) -> None:
    with pytest.raises(vtray.OutputError, match=r"the formats are \.png"):
        image.save(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_16_bits(image: vtray.Image) -> None:
    pixels = image.develop(16)
    assert (pixels.dtype, pixels.shape, pixels.max()) == (np.uint16, (18, 24, 3), 65535)
    expected = np.floor(65535 * image.linear / image.white)
    expected[image.linear == image.white] = 65535
    np.testing.assert_array_equal(pixels, expected)
    np.testing.assert_array_equal(image.develop(8), image.pixels)


def test_notebook(image: vtray.Image) -> None:
    with PillowImage.open(io.BytesIO(image._repr_png_())) as read:
        np.testing.assert_array_equal(np.asarray(read), image.pixels)


def test_empty_scene_is_black() -> None:
    image = vtray.render(vtray.loads(json.dumps(scene([], [], size=[3, 2]))))
    assert image.pixels.tolist() == [[[0, 0, 0]] * 3] * 2
    assert image.stats["rays"] == 6


@pytest.mark.parametrize("bad", [0, -1, 1.0, True, "2"])
def test_threads_and_tiles_are_checked(bad: object) -> None:
    document = vtray.loads(json.dumps(scene([], [])))
    with pytest.raises(ValueError, match="threads: expected an integer ≥ 1, got"):
        vtray.render(document, threads=bad)
    with pytest.raises(ValueError, match="tile: expected an integer ≥ 1, got"):
        vtray.render(document, tile=bad)


def test_scene_changed_in_code_is_checked() -> None:
    document = vtray.loads(json.dumps(one_sphere()))
    document.objects.append("cube")
    kinds = "Sphere, Cylinder, Cone, Plane, Spheres, Cylinders, Cones, Copies or Stars"
    with pytest.raises(vtray.SceneError, match=rf"Scene.objects\[1\]: expected {kinds}"):
        vtray.render(document)


@pytest.mark.parametrize(
    ("width", "height", "side"), [(1, 1, 64), (64, 64, 64), (130, 65, 64), (5, 4, 2)]
)
def test_tiles_cover_the_image_once(width: int, height: int, side: int) -> None:
    covered = np.zeros((height, width), int)
    for left, top, right, bottom in split_into_tiles(width, height, side):
        assert 0 < right - left <= side
        covered[top:bottom, left:right] += 1
    assert (covered == 1).all()
