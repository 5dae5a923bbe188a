"""Colour bars that tell how bright points shine."""

from typing import Any

import numpy as np
import pytest

import vtray
from conftest import once
from vtray.figures.annotations import Annotations, find_marks
from vtray.figures.bar_marks import marks_of, share_of
from vtray.figures.brightness_scale import BrightnessScale
from vtray.figures.color_bar import _ticks
from vtray.figures.sheet import FigureError
from vtray.scene.particles.particles import Particles

CAMERA = vtray.Camera.orthographic((0, 0, 10), (0, 0, 0), 30, size=(40, 30))
STEPS = np.linspace(0.05, 1.2, 9)
MIDDLE = 0.75**2
"""What the pixel of a point in its middle has of its light."""


def picture(stretch: Any = "asinh", peak: float | None = 7.0, **options: Any) -> vtray.Image:
    """Return a picture of points in the middles of pixels, of which the last is beyond the peak."""
    scene = vtray.Scene(CAMERA)
    places = np.stack([4.0 * np.arange(9) - 16, np.zeros(9), np.zeros(9)], axis=1)
    points = Particles(places, {"light": 7.0 * STEPS / MIDDLE, "age": np.arange(9.0)})
    drawn = {name: options.pop(name) for name in ("color", "cmap") if name in options}
    scene.add_particles(points, emission="light", stretch=stretch, peak=peak, **drawn)
    return vtray.render(scene, **options)


def bars(image: vtray.Image, colorbar: Any = True, *, flat: bool = False) -> Any:
    marks = find_marks(image, Annotations(colorbar=colorbar), flat=flat)
    return list(zip(marks.scales, marks.bar_labels, strict=True))


@once
@pytest.mark.parametrize("stretch", ["linear", "asinh", "log"])
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"color": "orange"},
        {"tonemap": "agx", "exposure": 0.5},
        {"background": (0, 0, 90)},
        {"tonemap": "filmic", "background": (0, 0, 90)},
    ],
)
def test_shades_are_those_of_the_picture(stretch: Any, options: dict[str, Any]) -> None:
    image = picture(stretch, **options)
    ((scale, label),) = bars(image)
    assert label == "emission per pixel"
    assert (scale.low, scale.high) == (0, 7)
    for step, pixel in zip(STEPS, image.pixels[15, 4::4].astype(int), strict=False):
        row = share_of(scale, 7.0 * min(step, 1.0)) * (len(scale.table) - 1)
        assert np.abs(scale.table[round(row)] - pixel).max() <= 2
    assert (image.pixels[15, 20] > image.pixels[0, 0]).any()


def test_the_peak_is_that_of_the_picture() -> None:
    image = picture(peak=None)
    ((scale, _),) = bars(image)
    light = 7.0 * STEPS[-1]
    assert scale.high == pytest.approx(light)
    hiding = vtray.Scene(CAMERA, image.scene.lights, [*image.scene.objects])
    hiding.add_sphere((16, 0, 5), 1.5)
    hiding.add_light((0, 0, 90))
    ((hidden, _),) = bars(vtray.render(hiding))
    assert hidden.high == pytest.approx(7.0 * STEPS[-2])
    nothing = vtray.Scene(CAMERA)
    nothing.add_particles([(100, 0, 0)], emission=1.0)
    assert bars(vtray.render(nothing)) == []


@pytest.mark.parametrize(
    ("stretch", "softening", "high", "texts"),
    [
        ("asinh", 0.1, 50.0, ["0", "5", "10", "20", "50"]),
        ("log", 0.001, 50.0, ["0", "0.2", "1", "10", "50"]),
        ("linear", 1.0, 50.0, ["0", "10", "20", "30", "40", "50"]),
        ("asinh", 0.1, 2e9, ["0", "2e8", "5e8", "1e9", "2e9"]),
        ("asinh", 1e-9, 1e300, None),
    ],
)
def test_marks(stretch: Any, softening: float, high: float, texts: list[str] | None) -> None:
    scale = BrightnessScale(high, stretch, softening, np.zeros((2, 3), np.uint8))
    found = marks_of(scale, 6)
    assert texts is None or [text for _, text in found] == texts
    places = [share_of(scale, value) for value, _ in found]
    assert 3 <= len(found) <= 7
    assert np.diff(places).min() > 0.15
    x = np.array([value for value, _ in found]) / high
    expected = {
        "linear": x,
        "asinh": np.arcsinh(x / softening) / np.arcsinh(1 / softening),
        "log": np.log1p(x / softening) / np.log1p(1 / softening),
    }
    assert np.allclose(places, expected[stretch])
    assert _ticks(scale, 6) == (places, [text for _, text in found])


def test_colours_have_a_bar_beside_that_of_brightness() -> None:
    image = picture(color="age", cmap="viridis")
    for given, labels in (
        (True, ["", "emission per pixel"]),
        ("age", ["age", "emission per pixel"]),
        (["age", "mass per pixel"], ["age", "mass per pixel"]),
    ):
        (colors, _), (brightness, _) = found = bars(image, given)
        assert [label for _, label in found] == labels
    assert (colors.low, colors.high) == (0, 8)
    assert brightness.table[-1].tolist() == [255, 255, 255]
    assert len(bars(image, flat=True)) == 1
    assert bars(picture(), "mass")[0][1] == "mass"
    with pytest.raises(FigureError, match="colorbar: expected True, False or a list of 2 labels"):
        bars(image, ["a", "b", "c"])


def test_without_room_for_both_colours_have_a_bar() -> None:
    image = picture(color="age", cmap="viridis", size=(120, 90))
    colors, alone = (image.annotated(colorbar=label).pixels for label in ("age", True))
    assert (colors != image.pixels).any()
    assert (alone != image.pixels).any()
    with pytest.raises(FigureError, match="annotations: there is no room in a picture of 120"):
        image.annotated(colorbar=["age", "mass"])


def test_points_alike_share_a_bar() -> None:
    scene = vtray.Scene(CAMERA)
    for x, peak in ((0, 2.0), (4, 2.0), (8, 3.0)):
        scene.add_particles([(x, 0, 0)], emission=1.0, peak=peak)
    assert [scale.high for scale, _ in bars(vtray.render(scene))] == [2, 3]


@once
def test_on_the_picture_and_in_figures() -> None:
    image = picture(size=(400, 300), color="orange")
    pixels = image.annotated(colorbar="mass").pixels
    ((scale, _),) = bars(image)
    column = next(k for k in range(399, 0, -1) if (pixels[:, k] == scale.table[-1]).all(1).any())
    shades = pixels[:, column - 1]
    where = np.flatnonzero((shades == scale.table[-1]).all(axis=1))
    inside = shades[where[0] : where[0] + 100]
    assert (np.diff(inside[:, 0].astype(int)) <= 0).all()
    figure = image.figure(colorbar="mass", scalebar=False)
    bar = figure.axes[1]
    assert bar.get_ylim() == (0, 1)
    assert bar.get_ylabel() == "mass"
    texts = [label.get_text() for label in bar.get_yticklabels()]
    assert texts == [text for _, text in marks_of(scale, 6)]
