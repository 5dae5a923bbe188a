"""Two pictures side by side."""

import json
import math
import re
from base64 import b64decode
from io import BytesIO
from pathlib import Path

import numpy as np
import png
import pytest
from examples import one_sphere
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image as PillowImage

import vtray
from conftest import once
from vtray.base import memory
from vtray.figures.comparison import DiffError, read_picture

Pixels = np.ndarray


def noise(seed: int, height: int = 9, width: int = 13, channels: int = 3) -> Pixels:
    return np.random.default_rng(seed).integers(0, 256, (height, width, channels), np.uint8)


@once
@given(st.integers(0, 1000), st.integers(1, 9), st.integers(1, 9), st.sampled_from([2, 9, 255]))
def test_figures_are_those_of_plain_numpy(seed: int, height: int, width: int, steps: int) -> None:
    a = noise(seed, height, width)
    change = np.random.default_rng(seed + 1).integers(-steps, steps + 1, a.shape)
    b = np.clip(a + change * (noise(seed + 2, height, width, 1) < 60), 0, 255).astype(np.uint8)
    found = vtray.compare(a, b)
    error = np.abs(a.astype(float) - b.astype(float))
    assert found.largest == error.max()
    assert found.mean == pytest.approx(error.mean())
    assert found.rmse == pytest.approx(math.sqrt((error**2).mean()))
    assert found.differing == (error.max(axis=2) > 0).sum()
    assert found.share == found.differing / (height * width)
    if found.box is None:
        assert (a == b).all()
        assert found.psnr == math.inf
    else:
        assert found.psnr == pytest.approx(10 * math.log10(255**2 / (error**2).mean()))
        left, top, right, bottom = found.box
        outside = error.copy()
        outside[top:bottom, left:right] = 0
        assert outside.max() == 0
        inside = error[top:bottom, left:right].max(axis=2)
        assert all(edge.max() > 0 for edge in (*inside[[0, -1]], *inside.T[[0, -1]]))


def test_difference_picture() -> None:
    a = np.full((2, 3, 3), 100, np.uint8)
    b = a.copy()
    b[0, 0], b[1, 2] = (101, 100, 90), (100, 0, 100)
    found = vtray.compare(a, b)
    assert found.difference[0, 0].tolist() == [65, 0, 83]
    assert found.difference[1, 2].tolist() == [0, 255, 0]
    assert found.difference.sum() == 65 + 83 + 255
    assert not vtray.compare(a, a).difference.any()


def test_text() -> None:
    a = np.zeros((4, 5, 3), np.uint8)
    b = a.copy()
    b[1:3, 2] = (0, 3, 0)
    assert str(vtray.compare(a, a)) == "all 20 pixels are equal (5 x 4)"
    lines = str(vtray.compare(a, b)).splitlines()
    assert lines[:3] == [
        "differing    2 of 20 pixels (10 %)",
        "where        columns 2 to 2, rows 1 to 2 of 5 x 4",
        "largest      3 of 255",
    ]
    assert [line.split()[0] for line in lines[3:]] == ["mean", "RMSE", "PSNR"]


def test_images_arrays_and_files(tmp_path: Path) -> None:
    image = vtray.render(vtray.loads(json.dumps(one_sphere())), threads=1)
    path = tmp_path / "a.png"
    image.save(path)
    for other in (image, image.pixels, path, str(path)):
        assert vtray.compare(image, other).box is None
    changed = image.pixels.copy()
    changed[5, 6] ^= 1
    found = vtray.compare(path, changed)
    assert (found.names, found.box) == ((str(path), "b"), (6, 5, 7, 6))


def test_transparent_pixels_lie_on_black_as_in_files(tmp_path: Path) -> None:
    pixels = noise(1, 40, 40, 4)
    PillowImage.fromarray(pixels).save(tmp_path / "a.png")
    assert vtray.compare(pixels, tmp_path / "a.png").box is None
    assert vtray.compare(pixels, pixels[..., :3]).box is not None


def deep(seed: int, channels: int = 3) -> Pixels:
    """Return pixels of 16 bits."""
    return np.random.default_rng(seed).integers(0, 65536, (9, 13, channels), np.uint16)


def test_16_bits_are_compared_as_such() -> None:
    a = np.zeros((4, 5, 3), np.uint16)
    b = a.copy()
    b[1, 2] = (0, 100, 0)
    found = vtray.compare(a, b)
    assert (found.largest, found.differing, found.maximum) == (100, 1, 65535)
    assert found.mean == pytest.approx(100 / 60)
    assert found.psnr == pytest.approx(20 * math.log10(65535 / (100 / math.sqrt(60))))
    assert "largest      100 of 65535" in str(found)
    assert found.difference[1, 2].tolist() == [0, 255, 0]
    assert found.difference.dtype == np.uint8
    assert found._repr_html_().count("data:image/png") == 3
    assert vtray.compare(deep(1), deep(1)).box is None


@pytest.mark.parametrize("channels", [3, 4])
@pytest.mark.parametrize("is_interlaced", [False, True])
def test_png_of_16_bits_is_read_with_all_of_them(
    channels: int, is_interlaced: bool, tmp_path: Path
) -> None:
    pixels, path = deep(2, channels), tmp_path / "a.png"
    form = {"greyscale": False, "alpha": channels == 4, "bitdepth": 16, "interlace": is_interlaced}
    with path.open("wb") as file:
        png.Writer(13, 9, **form).write(file, pixels.reshape(9, -1).tolist())
    np.testing.assert_array_equal(read_picture(path), pixels)


@pytest.mark.parametrize("background", ["black", "transparent"])
@pytest.mark.parametrize("ending", [".png", ".tif"])
def test_images_are_compared_with_files_of_16_bits(
    ending: str, background: str, tmp_path: Path
) -> None:
    if ending == ".tif":
        pytest.importorskip("tifffile", reason="needs the extra vtray[formats]")
    scene = vtray.loads(json.dumps(one_sphere()))
    image = vtray.render(scene, threads=1, background=background)
    path, coarse = tmp_path / f"a{ending}", tmp_path / "b.png"
    image.save(path, bits=16)
    image.save(coarse)
    np.testing.assert_array_equal(read_picture(path), image.develop(16))
    assert vtray.compare(image, path).box is None
    found = vtray.compare(path, coarse)
    assert 0 < found.largest < 257
    assert found.maximum == 65535


def test_files_of_16_bits_that_are_not_read(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    with path.open("wb") as file:
        form = {"greyscale": True, "alpha": True, "bitdepth": 16}
        png.Writer(13, 9, **form).write(file, deep(3, 2).reshape(9, -1).tolist())
    problem = "expected an image of 8 bits per channel, got one of kind RGBA with 16, gray or of"
    with pytest.raises(DiffError, match=f"{path}: {problem}"):
        vtray.compare(path, path)
    with path.open("wb") as file:
        form = {"greyscale": False, "transparent": (1, 2, 3), "bitdepth": 16}
        png.Writer(13, 9, **form).write(file, deep(3).reshape(9, -1).tolist())
    with pytest.raises(DiffError, match="got one of kind RGB with 16"):
        vtray.compare(path, path)


@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_what_is_empty_is_not_black(kind: type) -> None:
    maximum = np.iinfo(kind).max
    empty = np.zeros((4, 5, 4), kind)
    black = empty.copy()
    black[..., 3] = maximum
    for other in (black, black[..., :3]):
        found = vtray.compare(empty, other)
        assert (found.largest, found.differing) == (maximum, 20)
        assert (found.difference == 255).all()
    red = empty.copy()
    red[..., 0] = 200  # of what is empty, nobody sees the colour
    assert vtray.compare(empty, red).box is None
    half = black.copy()
    half[0, 0, 3] = maximum // 3
    assert vtray.compare(half, black).largest == maximum - maximum // 3


def test_flip_of_what_is_empty_is_that_on_white() -> None:
    pytest.importorskip("flip_evaluator", reason="needs the extra vtray[diff]")
    empty, black = np.zeros((4, 5, 4), np.uint8), np.zeros((4, 5, 3), np.uint8)
    assert vtray.compare(empty, black).flip == vtray.compare(black + 255, black).flip
    seen = np.full((4, 5, 4), 255, np.uint8)
    assert vtray.compare(empty, seen).flip == vtray.compare(black, black + 255).flip


def test_flip_of_16_bits_is_that_of_8() -> None:
    pytest.importorskip("flip_evaluator", reason="needs the extra vtray[diff]")
    a, b = noise(1), noise(2)
    fine = vtray.compare(a.astype(np.uint16) * 257, b)
    assert fine.flip == pytest.approx(vtray.compare(a, b).flip, rel=1e-5)


@pytest.mark.parametrize(
    ("a", "b", "message"),
    [
        (noise(1), noise(1, 9, 12), "b: expected an image of 13 x 9 pixels, as a is, got 12 x 9"),
        (noise(1) / 255, noise(1), r"a: expected an Image, a path, .* got float64 \(9, 13, 3\)"),
        (noise(1), noise(1)[..., 0], r"b: expected .* got uint8 \(9, 13\)"),
        (noise(1), None, "b: expected .* got NoneType"),
        (noise(1), "none.png", "none.png: cannot be read: no such file"),
    ],
)
def test_what_cannot_be_compared(a: object, b: object, message: str) -> None:
    with pytest.raises(DiffError, match=message):
        vtray.compare(a, b)


def test_flip_is_that_of_the_command() -> None:
    pytest.importorskip("flip_evaluator", reason="needs the extra vtray[diff]")
    from vtray.commands import diff

    a, b = noise(1), noise(2)
    assert vtray.compare(a, b).flip == diff.compare(a, b).flip


def test_notebook_shows_both_and_the_difference() -> None:
    found = vtray.compare(noise(1), noise(2))
    html = found._repr_html_()
    sources = re.findall(r'src="data:image/png;base64,([^"]+)"', html)
    shown = [np.asarray(PillowImage.open(BytesIO(b64decode(source)))) for source in sources]
    for picture, expected in zip(shown, (found.a, found.b, found.difference), strict=True):
        np.testing.assert_array_equal(picture, expected)
    assert str(found) in html
    object.__setattr__(found, "names", ("<a>", "b"))
    assert "<a>" not in found._repr_html_()


def test_figure_shows_all_three_as_they_are() -> None:
    pytest.importorskip("matplotlib", reason="needs the extra vtray[figure]")
    found = vtray.compare(noise(1, 70, 301), noise(2, 70, 301))
    figure = found.figure()
    figure.canvas.draw()
    canvas = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    for axes, expected in zip(figure.axes, (found.a, found.b, found.difference), strict=True):
        box = axes.get_window_extent()
        left, top = round(box.x0), round(len(canvas) - box.y1)
        np.testing.assert_array_equal(canvas[top : top + 70, left : left + 301], expected)
    assert [text.get_text() for text in figure.texts][:2] == ["a", "b"]


def test_picture_too_large_for_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.png"
    PillowImage.new("RGB", (100, 100)).save(path)
    assert vtray.compare(path, path).pixels == 10_000
    monkeypatch.setattr(memory, "_limits", lambda: [memory._Limit(2, 10**5, "")])
    problem = "a picture of 100 x 100 pixels needs .* of memory, 0 MB is available"
    with pytest.raises(vtray.VtrayError, match=f"{path}: {problem}"):
        vtray.compare(path, path)
