"""Figures of a size, with a font, and in axes: for papers."""

import io
import re
from typing import Any

import numpy as np
import pytest
from PIL import Image as PillowImage
from test_figure import SIZE, area, assert_legible, canvas, helix, scale_ends, shown_texts

import vtray
from conftest import once

matplotlib = pytest.importorskip("matplotlib", reason="needs the extra vtray[figure]")
from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

Array = np.ndarray

LONG = "Particles on a helix above a floor, in the light of a lamp far away on the left. " * 3
TITLES = {
    "long": LONG,
    "without spaces": LONG.replace(" ", "_"),
    "formulas": r"Of $\sum_{i=0}^{n} \frac{a_i b_i}{2}$ and " * 5,
    "one formula": "$" + "a + b + " * 40 + "c$",
    "money": r"It costs 5$, or 6$ or 7\$, " * 7,
    "lines": "First\n\nthird",
}
LABEL = "potential energy of each particle in the field of all others (eV)"


@pytest.fixture(scope="module")
def image() -> vtray.Image:
    return vtray.render(helix(), background="white")


def blank(width: float, height: float, **options: Any) -> Any:
    """Return an empty figure of a size in inches that can be drawn."""
    figure = Figure(figsize=(width, height), dpi=100, **options)
    FigureCanvasAgg(figure)
    return figure


def saved(figure: Any, kind: str, **options: Any) -> bytes:
    """Return a figure as a file."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format=kind, **options)
    return buffer.getvalue()


def read(data: bytes) -> Array:
    with PillowImage.open(io.BytesIO(data)) as picture:
        return np.asarray(picture.convert("RGB"))


@once
def test_figure_for_a_paper_in_one_call(image: vtray.Image) -> None:
    figure = image.figure(
        width=3.5, dpi=300, fontsize=7, colorbar="energy (eV)", scalebar="nm", title="A helix"
    )
    assert figure.get_size_inches()[0] == 3.5
    assert {text.get_fontsize() for text in shown_texts(figure)} == {7}
    assert_legible(figure)
    for style in ({}, {"savefig.dpi": 77, "savefig.bbox": "tight"}):
        with matplotlib.rc_context(style):
            assert read(saved(figure, "png")).shape[1] == 1050
            assert b"/MediaBox [ 0 0 252 " in saved(figure, "pdf")
    assert read(saved(figure, "png", dpi=100)).shape[1] == 350


@once
@pytest.mark.parametrize("width", [3.3, 3.5, 7.1])
def test_width_alone_keeps_each_pixel(image: vtray.Image, width: float) -> None:
    figure = image.figure(width=width, flat=True, colorbar="energy", title="A helix")
    assert figure.get_size_inches()[0] == pytest.approx(width, rel=1e-12)
    shown = area(figure, figure.axes[0])
    zoom = shown.shape[1] // SIZE[0]
    np.testing.assert_array_equal(shown, image.flat().repeat(zoom, axis=0).repeat(zoom, axis=1))
    np.testing.assert_array_equal(read(saved(figure, "png")), canvas(figure))


@once
@pytest.mark.parametrize(("width", "dpi"), [(3.3, 300), (3.37, 200), (2.345, 123.4)])
def test_width_and_resolution_are_kept(image: vtray.Image, width: float, dpi: float) -> None:
    figure = image.figure(width=width, dpi=dpi)
    assert figure.get_size_inches()[0] == pytest.approx(width, rel=1e-12)
    assert canvas(figure).shape[1] == int(width * dpi + 1e-9)
    box = figure.axes[0].get_window_extent()
    assert box.height == pytest.approx(box.width * SIZE[1] / SIZE[0], abs=0.5)


@once
def test_pixels_are_mixed_where_they_do_not_agree(image: vtray.Image) -> None:
    figure = image.figure(width=3.5, dpi=300)
    shown = area(figure, figure.axes[0])
    # Taking the nearest pixel makes no colours that were not there.
    own = np.unique(image.pixels.reshape(-1, 3), axis=0)
    assert len(np.unique(shown.reshape(-1, 3), axis=0)) > (1.2 * len(own) if SIZE[0] > 99 else 0)
    # And PDF holds the picture itself.
    assert re.search(rb"/Width %d\b" % SIZE[0], saved(figure, "pdf"))


@once
@pytest.mark.parametrize("title", TITLES.values(), ids=TITLES)
def test_all_text_fits(image: vtray.Image, title: str) -> None:
    figures = [
        image.figure(title=title, colorbar=LABEL, scalebar="micrometres of the real thing"),
        image.figure(title=title, colorbar=LABEL, width=3.5, dpi=150, fontsize=7, flat=True),
    ]
    with matplotlib.rc_context({"font.family": "serif", "font.size": 15}):
        figures.append(image.figure(title=title, colorbar="energy (eV)", width=5, dpi=90))
    with matplotlib.rc_context({"font.size": 7}):
        paper = blank(3.5, 3.5, layout="constrained")
        for ax in paper.subplots(2, 1):
            image.figure(ax=ax, title=title[:120], colorbar="energy (eV)", scalebar="nm")
        figures.append(paper)
    for figure in figures:
        assert_legible(figure)
    words = "".join(title.replace("\\$", "$").split())
    (written,) = (text for text in shown_texts(figures[0]) if text.get_position() == (0.0, 1.0))
    assert "".join(written.get_text().replace("\\$", "$").split()) == words


def test_scale_bar_does_not_widen_the_figure(image: vtray.Image) -> None:
    widths = {image.figure(scalebar=bar).bbox.width for bar in (False, "nm", LONG, "{length} m")}
    assert len(widths) == 1


def test_matplotlibs_settings_at_the_call_count(image: vtray.Image) -> None:
    style = {
        "font.size": 13,
        "font.family": ["monospace"],
        "axes.titlesize": 17,
        "text.color": "red",
        "figure.facecolor": "navy",
        "figure.constrained_layout.use": True,
        "axes.grid": True,
        "image.origin": "lower",
    }
    with matplotlib.rc_context(style):
        figure = image.figure(title="A helix", colorbar="energy")
        compared = vtray.compare(image, image).figure()
    texts = shown_texts(figure)
    assert {text.get_fontsize() for text in texts} == {13, 17}
    assert {family for text in texts for family in text.get_fontfamily()} == {"monospace"}
    assert {text.get_fontsize() for text in compared.texts} == {13, 0.85 * 13}
    assert tuple(canvas(figure)[0, 0]) == (0, 0, 128)
    assert_legible(figure)
    zoom = area(figure, figure.axes[0]).shape[1] // SIZE[0]
    expected = image.pixels.repeat(zoom, axis=0).repeat(zoom, axis=1)
    np.testing.assert_array_equal(area(figure, figure.axes[0]), expected)


@pytest.mark.parametrize("layout", [None, "constrained", "tight"])
def test_pictures_in_axes_stay_in_their_place(image: vtray.Image, layout: str | None) -> None:
    paper = blank(7, 3, layout=layout)
    first, second = paper.subplots(1, 2)
    paper.sca(first)
    second.plot([1, 2])
    assert image.figure(ax=first, title="(a)", colorbar="energy", scalebar="nm") is paper
    assert paper.gca() is first
    assert_legible(paper)
    place = first.get_position(original=True)
    bar = paper.axes[2]
    for box in (first.get_position(), bar.get_position()):
        assert place.x0 - 0.01 <= box.x0 < box.x1 <= place.x1 + 0.01
        assert place.y0 - 0.01 <= box.y0 < box.y1 <= place.y1 + 0.01
    assert bar.get_position().height == pytest.approx(first.get_position().height, abs=0.01)
    assert bar.get_tightbbox().x1 <= second.get_tightbbox().x0
    shown = first.get_window_extent()
    assert shown.width / shown.height == pytest.approx(SIZE[0] / SIZE[1], rel=0.02)
    assert b"/MediaBox [ 0 0 504 216 ]" in saved(paper, "pdf")


def test_picture_in_the_same_axes_replaces_the_one_before(image: vtray.Image) -> None:
    paper = blank(4, 3)
    ax = paper.subplots()
    place = ax.get_position()
    image.figure(ax=ax, title="before", scalebar="nm")
    image.figure(ax=ax, title="after")
    assert ax.get_title("left") == "after"
    assert (len(ax.images), len(paper.axes)) == (1, 2)
    ax.clear()
    ax.plot([1, 2])
    paper.canvas.draw()
    assert not paper.axes[1].get_visible()
    assert ax.get_position().bounds == place.bounds
    image.figure(ax=ax)
    assert_legible(paper)
    ax.remove()
    paper.canvas.draw()


def test_axes_within_axes_and_figures(image: vtray.Image) -> None:
    paper = blank(6, 3)
    left, right = paper.subfigures(1, 2)
    ax = right.subplots()
    assert image.figure(ax=ax) is paper
    inset = left.subplots().inset_axes((0.5, 0.5, 0.4, 0.4))
    assert image.figure(ax=inset, colorbar=False, scalebar=False) is paper
    paper.canvas.draw()
    assert 300 < ax.get_window_extent().x0 < right.axes[1].get_window_extent().x1 < 600
    box = inset.get_window_extent()
    assert box.width / box.height == pytest.approx(SIZE[0] / SIZE[1], rel=0.05)


def test_picture_in_axes_of_its_size_keeps_each_pixel(image: vtray.Image) -> None:
    width, height = SIZE
    paper = blank((width + 10) / 100, (height + 6) / 100)
    ax = paper.add_axes(
        (5 / (width + 10), 3 / (height + 6), width / (width + 10), height / (height + 6))
    )
    image.figure(ax=ax, colorbar=False, scalebar=False)
    np.testing.assert_array_equal(canvas(paper)[3:-3, 5:-5], image.pixels)


def test_scale_bar_in_axes_is_as_long_as_it_says(image: vtray.Image) -> None:
    lone = image.figure(colorbar=False)
    paper = blank(4, 3)
    ax = paper.subplots()
    image.figure(ax=ax, colorbar=False)
    paper.canvas.draw()
    parts = [
        np.ptp(scale_ends(figure)) / figure.axes[0].get_window_extent().width
        for figure in (lone, paper)
    ]
    assert parts[0] == pytest.approx(parts[1], rel=1e-9)
