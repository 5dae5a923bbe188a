"""Pictures as figures: nothing resampled, colour bars and scale bars right."""

import io
import subprocess
import sys
from collections.abc import Sequence
from typing import Any

import msgspec
import numpy as np
import oracle
import pytest
from PIL import Image as PillowImage

import vtray
from conftest import JIT, once
from vtray.figures.oklab import srgb_to_oklab
from vtray.figures.scale_bar import (
    depth_along_view,
    length_text,
    pixel_width,
    round_length,
    with_unit,
)
from vtray.figures.sheet import FigureError, picture_zoom

matplotlib = pytest.importorskip("matplotlib", reason="needs the extra vtray[figure]")
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.transforms import Bbox  # noqa: E402

Array = np.ndarray

SIZE = (330, 240) if JIT else (33, 24)
ZOOM = picture_zoom(SIZE[0])


def helix(cmap: str = "viridis", size: tuple[int, int] = SIZE, **camera: Any) -> vtray.Scene:
    """Return spheres above a floor, coloured by the values from -2 to 3.5."""
    t = np.linspace(0, 1, 40)
    center = np.stack([2 * np.cos(15 * t), 4 * t - 2, 7 + 2 * np.sin(15 * t)], axis=1)
    scene = vtray.Scene()
    scene.add_spheres(center, radius=0.4, color=5.5 * t - 2, cmap=cmap)
    scene.add_plane(point=(0, 3, 0), normal=(0, -1, 0), color=(230, 230, 235))
    scene.add_light((-5, -9, -3))
    pixel = 5.0 / size[0]
    scene.camera = vtray.Camera((0, -0.5, 0), (0.1, 0.1, 1), 5, size, (pixel, pixel), **camera)
    return scene


def view(scene: vtray.Scene) -> tuple[Array, Array, Array, Array]:
    """Return the axes and the eye of a scene's camera."""
    normal, center = (
        np.array(msgspec.structs.astuple(vector))
        for vector in (scene.camera.normal, scene.camera.center)
    )
    axes = oracle.axes(normal)
    return *axes, center - scene.camera.focus * axes[2]


def table(name: str) -> Array:
    """Return Matplotlib's colours of a map as nearest bytes."""
    cmap = matplotlib.colormaps[name]
    return np.floor(cmap(np.arange(cmap.N))[:, :3] * 255 + 0.5).astype(np.uint8)


@pytest.fixture(scope="module")
def image() -> vtray.Image:
    return vtray.render(helix())


def canvas(figure: Any) -> Array:
    """Return the pixels of a figure, (height, width, 3)."""
    figure.canvas.draw()
    return np.asarray(figure.canvas.buffer_rgba())[..., :3]


def area(figure: Any, axes: Any) -> Array:
    """Return the pixels of a figure that axes take."""
    pixels, box = canvas(figure), axes.get_window_extent()
    left, right = round(box.x0), round(box.x1)
    top, bottom = (round(len(pixels) - y) for y in (box.y1, box.y0))
    return pixels[top:bottom, left:right]


def scale_ends(figure: Any) -> Array:
    """Return where the scale bar begins and ends, in pixels from the left."""
    (line,) = figure.findobj(lambda artist: artist.get_gid() == "scale bar")
    return line.get_transform().transform(line.get_xydata())[:, 0]


def scale_label(figure: Any) -> Any:
    """Return what stands beside the scale bar."""
    (label,) = figure.findobj(lambda artist: artist.get_gid() == "scale bar label")
    return label


def scale_text(figure: Any) -> str:
    """Return the text of that."""
    return str(scale_label(figure).get_text())


ABOUT = r"${\approx}$ "
"""What stands before lengths that are right at one distance only."""


def shown_texts(figure: Any) -> list[Any]:
    """Return all that is written in a figure."""
    figure.canvas.draw()
    texts = list(figure.texts)
    for axes in figure.axes:
        texts += [*axes.texts, axes.title, axes._left_title]
        for axis in (axes.xaxis, axes.yaxis) if axes.axison else ():
            low, high = sorted(axis.get_view_interval())
            marks = zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=True)
            texts += [axis.label, *(text for place, text in marks if low <= place <= high)]
    return [text for text in texts if text.get_text()]


def assert_legible(figure: Any) -> None:
    """See that nothing written is cut, lies on a picture, or on something else that is written."""
    texts = shown_texts(figure)
    boxes = [text.get_window_extent() for text in texts]
    for k, box in enumerate(boxes):
        name = texts[k].get_text()
        assert -0.1 <= box.x0 < box.x1 <= figure.bbox.x1 + 0.1, name
        assert -0.1 <= box.y0 < box.y1 <= figure.bbox.y1 + 0.1, name
        for other in (*boxes[:k], *(axes.get_window_extent() for axes in figure.axes)):
            assert not Bbox.intersection(box.padded(-1), other.padded(-1)), name


@once
@pytest.mark.parametrize("dpi", [None, 72, 100, 137.7, 300])
@pytest.mark.parametrize("flat", [False, True])
def test_no_pixel_is_changed(image: vtray.Image, dpi: float | None, flat: bool) -> None:
    figure = image.figure(dpi=dpi, flat=flat, title="A helix", colorbar="energy")
    expected = image.flat() if flat else image.pixels
    expected = expected.repeat(ZOOM, axis=0).repeat(ZOOM, axis=1)
    np.testing.assert_array_equal(area(figure, figure.axes[0]), expected)


@once
@pytest.mark.parametrize(("size", "zoom"), [((3, 2), 100), ((299, 3), 2), ((301, 2), 1)])
def test_small_pictures_have_squares_for_pixels(size: tuple[int, int], zoom: int) -> None:
    image = vtray.render(helix(size=size))
    figure = image.figure(colorbar=False, scalebar=False)
    shown = area(figure, figure.axes[0])
    expected = image.pixels.repeat(zoom, axis=0).repeat(zoom, axis=1)
    np.testing.assert_array_equal(shown, expected)


def test_saved_file_and_notebook_have_the_pixels_too(image: vtray.Image, tmp_path: Any) -> None:
    figure = image.figure()
    with PillowImage.open(io.BytesIO(figure._repr_png_())) as read:
        np.testing.assert_array_equal(np.asarray(read.convert("RGB")), canvas(figure))
    figure.savefig(tmp_path / "a.png")
    with PillowImage.open(tmp_path / "a.png") as read:
        np.testing.assert_array_equal(np.asarray(read.convert("RGB")), canvas(figure))


@once
@pytest.mark.parametrize("name", ["viridis", "coolwarm", "tab10"])
def test_colour_bar_has_the_colours_of_matplotlib(name: str) -> None:
    image = vtray.render(helix(name))
    figure = image.figure(colorbar="energy (eV)")
    bar = figure.axes[1]
    assert bar.get_ylabel() == "energy (eV)"
    assert bar.get_ylim() == (-2, 3.5)
    (shown,) = bar.get_images()
    assert shown.get_extent() == [0, 1, -2, 3.5]
    pixels = area(figure, bar)
    norm, cmap = matplotlib.colors.Normalize(-2, 3.5), matplotlib.colormaps[name]
    middle = pixels.shape[1] // 2
    for row in range(3, len(pixels) - 3):
        value = 3.5 - (row + 0.5) / len(pixels) * 5.5
        nearby = cmap(norm(value + np.linspace(-0.03, 0.03, 25)), bytes=True)[:, :3]
        near = np.abs(nearby.astype(int) - pixels[row, middle]).max(axis=1)
        assert near.min() <= 1


@once
def test_colour_bar_of_a_flat_figure_shows_each_colour_in_all_light() -> None:
    image = vtray.render(helix())
    figure = image.figure(flat=True)
    bar = figure.axes[1]
    (shown,) = bar.get_images()
    colors = np.asarray(shown.get_array())
    own = srgb_to_oklab(table("viridis"))
    lab = srgb_to_oklab(colors)
    assert np.abs(lab[..., 1:] - own[:, None, 1:]).max() < 0.0025
    assert (np.diff(lab[..., 0], axis=1) > -0.004).all()
    assert [text.get_text() for text in bar.get_xticklabels()] == ["shadow", "light"]


def test_values_are_read_back_from_a_flat_picture(image: vtray.Image) -> None:
    flat, ids = image.flat(), image.ids
    own = srgb_to_oklab(table("viridis"))
    spheres = ids[..., 0] == 0
    assert spheres.sum() > 0.01 * spheres.size
    lab = srgb_to_oklab(flat[spheres])
    apart = np.linalg.norm(lab[:, None, 1:] - own[None, :, 1:], axis=2)
    value = (apart.argmin(axis=1) + 0.5) / 256 * 5.5 - 2
    truth = 5.5 * np.linspace(0, 1, 40)[ids[spheres][:, 1]] - 2
    assert np.abs(value - truth).max() < 3 * 5.5 / 256
    floor = flat[ids[..., 0] == 1]
    assert len(np.unique(floor)) > 5, "light is still seen"
    assert (flat[ids[..., 0] < 0] == 0).all()


def test_each_scale_has_a_bar(image: vtray.Image) -> None:
    scene = helix()
    scene.add_spheres([(0, 0, 9)], radius=0.1, color=[2], cmap="magma", clim=(0, 4))
    scene.add_spheres([(0, 0, 9)], radius=0.1, color=[2], cmap="viridis", clim=(-2, 3.5))
    scene.add_spheres([(0, 0, 9)], radius=0.1, color=[2], cmap="magma", clim=(2, 2))
    figure = vtray.render(scene).figure(colorbar=["energy", "charge", "constant"])
    labels = [axes.get_ylabel() for axes in figure.axes[1:]]
    assert labels == ["energy", "charge", "constant"]
    assert [text.get_text() for text in figure.axes[3].get_yticklabels()] == ["2"]
    assert (figure.axes[3].images[0].get_array() == table("magma")[128]).all()
    assert len(image.figure(colorbar=False).axes) == 1
    assert len(image.figure(colorbar=True).axes) == 2


@once
def test_scales_of_copies_have_bars_once() -> None:
    scene = helix()
    heat = {"color": [1.0, 3.0], "cmap": "magma"}
    bonds = vtray.Scene().add_cylinders(np.zeros((2, 3)), np.ones((2, 3)), 0.1, **heat)
    (spheres, _) = scene.objects
    ball = vtray.Sphere((0, 0, 0), 1)
    scene.objects[0] = vtray.Copies([ball, bonds, spheres, bonds], [(0, 0, 0), (0, 0, 9)])
    scene.objects.append(spheres)
    labels = ["energy", "charge"]
    figure = vtray.render(scene).figure(colorbar=labels)
    assert [axes.get_ylabel() for axes in figure.axes[1:]] == labels
    assert [axes.get_ylim() for axes in figure.axes[1:]] == [(1, 3), (-2, 3.5)]


@once
@pytest.mark.parametrize("limits", [(0, 1), (-1e-9, 3e-9), (0, 1e7), (99.99, 100.01), (-5, 250)])
def test_marks_of_colour_bars_are_true_and_fit(limits: tuple[float, float]) -> None:
    scene = helix()
    scene.objects.clear()
    scene.add_spheres([(0, 0, 9)], radius=1, color=[limits[0]], cmap="plasma", clim=limits)
    figure = vtray.render(scene).figure(colorbar="energy")
    bar = figure.axes[1]
    figure.canvas.draw()
    for tick, text in zip(bar.get_yticks(), bar.get_yticklabels(), strict=True):
        number = float(text.get_text().replace("\N{MINUS SIGN}", "-"))
        assert number == pytest.approx(tick, abs=1e-6 * (limits[1] - limits[0]))
    box = bar.get_tightbbox()
    assert box.x1 <= figure.bbox.x1
    assert len(bar.get_yticks()) >= 3


def project(scene: vtray.Scene, point: Array) -> Array:
    """Return where a point is in the image, in pixels, by the rules of the format."""
    camera = scene.camera
    right, down, forward, eye = view(scene)
    way = point - eye
    if camera.projection == "perspective":
        way = way * camera.focus / (way @ forward)
    place = np.array([way @ right, way @ down]) / camera.resolution
    return place + np.array(camera.size) / 2


@once
@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("at", [(0.3, -0.2, 6), (4, 5, 20)])
def test_scale_bar_is_as_long_as_what_it_says(projection: str, at: Sequence[float]) -> None:
    scene = helix(projection=projection)
    right = view(scene)[0]
    image = vtray.render(scene)
    figure = image.figure(at=at, scalebar="nm")
    text = scale_text(figure)
    assert text.startswith(ABOUT) == (projection == "perspective")
    number, unit = text.removeprefix(ABOUT).split()
    length = float(number)
    here, there = project(scene, np.array(at)), project(scene, at + length * right)
    x = scale_ends(figure)
    assert (x[1] - x[0]) / ZOOM == pytest.approx(there[0] - here[0], rel=1e-9)
    assert 0.1 * SIZE[0] * ZOOM <= x[1] - x[0] <= 0.25 * SIZE[0] * ZOOM
    assert unit == "nm"


def test_scale_bar_without_a_point_is_for_the_median_of_the_spheres(image: vtray.Image) -> None:
    scene, spheres = image.scene, image.ids[..., 0] == 0
    center = scene.objects[0].center
    _, _, forward, eye = view(scene)
    surface = depth_along_view(scene.camera, image.depth)[spheres]
    near = (center - eye) @ forward
    assert near.min() - 0.4 <= surface.min() <= surface.max() <= near.max() + 0.4
    depth = near[image.ids[spheres, 1]]
    text = scale_text(image.figure(scalebar="{length} nm at a distance of {distance} nm"))
    assert text == f"2 nm at a distance of {np.median(depth):.4g} nm"
    assert scale_text(image.figure()) == f"{ABOUT}2"


@once
@pytest.mark.parametrize("width", [30, 310])
def test_text_of_the_scale_bar_fits(width: int) -> None:
    figure = vtray.render(helix(size=(width, 9))).figure(scalebar="micrometres", colorbar=False)
    figure.canvas.draw()
    assert scale_label(figure).get_window_extent().x1 < figure.bbox.x1


def test_depth_is_measured_along_the_view() -> None:
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 4, (6, 8), (1, 0.5))
    distance = np.full((8, 6), np.sqrt(9 + 4 + 16))  # of the corner of the image plane
    assert depth_along_view(camera, distance)[0, 0] == pytest.approx(4)
    assert pixel_width(camera, 12) == 3


@once
def test_background_and_more_samples() -> None:
    scene = helix()
    scene.render = vtray.RenderSettings(samples=8, background="orange")
    image = vtray.render(scene)
    empty = image.ids[..., 0] < 0
    assert (image.flat()[empty] == (255, 165, 0)).all()
    clear = vtray.render(scene, background="transparent", samples=1)
    figure = clear.figure()
    shown = area(figure, figure.axes[0])[::ZOOM, ::ZOOM]
    assert (shown[empty] == 255).all(), "white paper"
    np.testing.assert_array_equal(shown[~empty], clear.pixels[~empty][:, :3])


@once
def test_pictures_of_another_size() -> None:
    image, large = (vtray.render(helix(), size=size) for size in (SIZE, (2 * SIZE[0], SIZE[1] * 2)))
    lengths = []
    for picture in (image, large):
        figure = picture.figure(at=(0, 0, 8))
        x = scale_ends(figure)
        zoom = picture_zoom(picture.pixels.shape[1])
        lengths.append((x[1] - x[0]) / zoom / float(scale_text(figure).removeprefix(ABOUT)))
    assert lengths[1] == pytest.approx(2 * lengths[0])


def test_nothing_is_seen() -> None:
    scene = helix()
    scene.objects.clear()
    image = vtray.render(scene)
    figure = image.figure(title="Nothing")
    assert [text.get_text() for text in shown_texts(figure)] == ["Nothing"]
    assert len(figure.axes) == 1
    assert scale_text(image.figure(at=(0, 0, 5))).startswith(ABOUT)
    assert not image.flat().any()


@pytest.mark.parametrize(
    ("limit", "length"),
    [(1, 1), (0.99, 0.5), (4.9, 2), (5, 5), (9999, 5000), (1e-9, 1e-9), (0.3, 0.2), (1e300, 1e300)],
)
def test_round_lengths(limit: float, length: float) -> None:
    assert round_length(limit) == length


def test_lengths_in_words() -> None:
    texts = [length_text(length) for length in (0.5, 20.0, 5e-9, 2e8, 0.001, 10000.0)]
    assert texts == ["0.5", "20", "5e-09", "2e+08", "0.001", "10000"]


@pytest.mark.parametrize(
    ("length", "unit", "text"),
    [
        (2e-9, "m", "2 nm"),
        (5e-10, "m", "0.5 nm"),
        (2e-7, "m", "0.2 µm"),
        (0.05, "m", "50 mm"),
        (0.5, "m", "0.5 m"),
        (2000.0, "m", "2000 m"),
        (2e-17, "m", "0.02 fm"),
        (1.2345e-8, "m", "12.3 nm"),
        (2e-9, "nm", "2e-09 nm"),
        (0.02, "Å", "0.02 Å"),
        (2e-9, "", "2e-09"),
    ],
)
def test_lengths_with_units(length: float, unit: str, text: str) -> None:
    assert with_unit(length, unit) == text


BAD = [
    ({"dpi": 0}, "dpi: expected a number ≥ 1, or None, got 0"),
    ({"dpi": float("nan")}, "dpi: expected a number ≥ 1, or None, got nan"),
    ({"dpi": "300"}, "dpi: expected a number ≥ 1, or None, got '300'"),
    ({"at": (0, 1)}, r"at: expected a point of three finite numbers, or None, got \(0, 1\)"),
    ({"at": (0, 0, np.inf)}, "at: expected a point of three finite numbers"),
    ({"at": (0, 0, 10**400)}, "at: expected a point of three finite numbers"),
    ({"at": np.ma.masked_array([0, 0, 1], [0, 0, 1])}, "at: expected a point of three finite num"),
    ({"at": "here"}, "at: expected a point of three finite numbers"),
    ({"at": (0, 0, -50)}, r"at: expected a point in front of the eye, got \(0, 0, -50\)"),
    ({"colorbar": ["a", "b"]}, r"colorbar: expected True, False or a label, got \['a', 'b'\]"),
    ({"colorbar": [3]}, r"colorbar: expected True, False or a label, got \[3\]"),
    ({"colorbar": 3}, "colorbar: expected True, False or a label, got 3"),
    ({"colorbar": {}}, "colorbar: expected True, False or a label, got {}"),
    ({"dpi": 1e9}, "dpi: expected at most 10000, got 1000000000.0"),
    ({"width": 1e5}, "width: expected at most 10000, got 100000.0"),
    ({"fontsize": 1e6}, "fontsize: expected at most 10000, got 1000000.0"),
    ({"scalebar": 3}, 'scalebar: expected True, False or a unit such as "nm", got 3'),
    ({"title": 3}, "title: expected a text or None, got 3"),
    ({"width": -3.5}, r"width: expected a number > 0, or None, got -3\.5"),
    ({"width": True}, "width: expected a number > 0, or None, got True"),
    ({"fontsize": "small"}, "fontsize: expected a number > 0, or None, got 'small'"),
    (
        {"width": 0.3},
        r"width: expected at least \d\.\d+ inches with this text, got 0\.3; or give a ",
    ),
    ({"ax": 3}, "ax: expected rectangular Axes of a Matplotlib figure, or None, got 3"),
    ({"ax": Figure().subplots(subplot_kw={"polar": True})}, "ax: expected rectangular Axes"),
    ({"ax": Figure().subplots(), "width": 3}, "width: expected None with ax, .* got 3"),
    ({"ax": Figure().subplots(), "dpi": 300}, "dpi: expected None with ax, whose figure has"),
]


@pytest.mark.parametrize(("arguments", "message"), BAD)
def test_bad_arguments(image: vtray.Image, arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(FigureError, match=message):
        image.figure(**arguments)


def test_label_without_a_colour_map() -> None:
    scene = helix()
    scene.objects.pop(0)
    with pytest.raises(FigureError, match="colorbar: expected True or False, as no object has"):
        vtray.render(scene).figure(colorbar="energy")


def test_missing_matplotlib_is_named(image: vtray.Image, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(vtray.VtrayError, match=r"Image.figure needs .*-m pip install matplotlib"):
        image.figure()


def test_matplotlib_is_loaded_for_figures_only_and_pyplot_never() -> None:
    code = (
        "import sys, vtray.image.image, vtray.figures.comparison, vtray.rendering.pixel_rays;"
        "assert 'matplotlib' not in sys.modules;"
        "import vtray.figures.figure, numpy as np;"
        "vtray.compare(*np.zeros((2, 9, 9, 3), np.uint8)).figure();"
        "assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
