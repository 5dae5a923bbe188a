"""Annotations painted onto pixels: where they are, and that all else stays as it was."""

import io
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image as PillowImage

import vtray
from vtray.figures.annotations import Annotations, find_marks
from vtray.figures.ink import DARK, LIGHT, ink_on
from vtray.figures.painted.canvas import Canvas
from vtray.figures.painted.cover import Cover, polygon, rectangle
from vtray.figures.painted.layout import arranged
from vtray.figures.painted.letters import FONT, RANGES, check_letters, letters
from vtray.figures.painted.picture import annotated_pixels, share_beside
from vtray.figures.sheet import FigureError

Array = np.ndarray

ALL: dict[str, Any] = {
    "title": "Water",
    "time": "12.5 ps",
    "frame": 12,
    "legend": {"O": "red", "H": "white"},
    "colorbar": "height (Å)",
    "scalebar": "nm",
    "axes": True,
}
CORNERS = {"title": "Water", "legend": {"O": "red"}, "scalebar": "nm", "axes": True}


def subject(pixels: Array) -> Any:
    """Return a picture of some pixels, taken along z by parallel rays; a pixel is 0.1 wide."""
    height, width = pixels.shape[:2]
    scene = vtray.Scene()
    scene.add_spheres([(0, 0, 0)], radius=0, color=[1.0], cmap="viridis", clim=(-2, 3))
    scene.camera = vtray.Camera.orthographic(
        (0, 0, 9), (0, 0, 0), 0.1 * height, size=(width, height)
    )
    light = np.zeros((height, width, 3))
    return SimpleNamespace(scene=scene, pixels=pixels, linear=light, brightness_scales=())


def plain(width: int, height: int, color: Any = (0, 0, 0)) -> Any:
    return subject(np.full((height, width, len(color)), color, np.uint8))


def noise(width: int, height: int, channels: int = 3) -> Any:
    parts = np.random.default_rng(2).integers(0, 256, (height, width, channels))
    return subject(parts.astype(np.uint8))


def changed(image: Any, **wanted: Any) -> Array:
    """Return which pixels annotations change, (height, width)."""
    painted = annotated_pixels(image, Annotations(**wanted))
    assert painted.shape == image.pixels.shape
    return (painted != image.pixels).any(axis=2)


@pytest.mark.parametrize(
    "corners",
    [[(2, 3), (9.5, 3), (9.5, 8.25), (2, 8.25)], [(2.3, 9.1), (8, 1.7), (11.2, 12.6)]],
)
def test_polygon_covers_its_area(corners: Any) -> None:
    x, y = np.transpose(corners)
    area = (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2
    cover = polygon(corners)
    assert cover.parts.sum() / 255 == pytest.approx(area, rel=0.02)
    assert cover.parts[[0, -1]].max() == cover.parts[:, [0, -1]].max() == 0


def test_rectangle_of_whole_pixels_has_sharp_edges() -> None:
    cover = rectangle(3, 4, 5, 2)
    assert set(np.unique(cover.parts)) == {0, 255}
    rows, columns = np.nonzero(cover.parts)
    assert (rows.min() + cover.top, columns.min() + cover.left) == (4, 3)
    assert len(rows) == 10


def test_paint_is_mixed_by_what_it_covers() -> None:
    cover = Cover(-1, 0, np.array([[255, 0, 51, 255]], np.uint8))
    canvas = Canvas(np.full((1, 3, 3), 100, np.uint8), 10)
    canvas.blend(cover, (200, 0, 255))
    assert canvas.pixels.tolist() == [[[100] * 3, [120, 80, 131], [200, 0, 255]]]
    clear = Canvas(np.array([[(9, 9, 9, 0), (9, 9, 9, 0), (0, 0, 0, 255)]], np.uint8), 10)
    clear.blend(cover, (200, 0, 255))
    assert clear.pixels.tolist() == [[[9, 9, 9, 0], [200, 0, 255, 51], [200, 0, 255, 255]]]


@pytest.mark.parametrize(
    ("pixel", "color"),
    [((0, 0, 0), LIGHT), ((255, 255, 255), DARK), ((0, 0, 255), LIGHT), ((0, 0, 0, 0), DARK)],
)
def test_letters_are_dark_on_light_and_light_on_dark(pixel: Any, color: Any) -> None:
    assert ink_on(np.full((2, 3, len(pixel)), pixel, np.uint8)).color == color


@pytest.mark.parametrize("size", [(256, 256), (640, 200), (180, 400), (1000, 800)])
@pytest.mark.parametrize("channels", [3, 4])
def test_all_stands_within_the_margin(size: tuple[int, int], channels: int) -> None:
    image = noise(*size, channels)
    before = image.pixels.copy()
    rows, columns = np.nonzero(changed(image, **ALL))
    np.testing.assert_array_equal(image.pixels, before)
    width, height = size
    assert columns.min() >= 5
    assert rows.min() >= 5
    assert columns.max() < width - 5
    assert rows.max() < height - 5
    # As far from all four sides: letters of 11 pixels or more have a margin of 10 or more.
    edges = [columns.min(), rows.min(), width - 1 - columns.max(), height - 1 - rows.max()]
    assert max(edges) - min(edges) <= 5


def test_only_marks_change_pixels() -> None:
    image = noise(400, 300)
    em = 11
    placed = arranged(find_marks(image, Annotations(**ALL)), em, 400, 300)
    assert placed is not None
    free = np.ones((300, 400), bool)
    for block, left, top in placed:
        free[top - 4 : top + block.height + 4, left - 4 : left + block.width + 4] = False
    assert free.mean() > 0.6
    assert not changed(image, **ALL)[free].any()
    assert not changed(image).any()


def test_same_bytes_on_every_run() -> None:
    first, second = (annotated_pixels(noise(300, 200), Annotations(**ALL)) for _ in range(2))
    assert first.tobytes() == second.tobytes()


def test_larger_pictures_have_larger_letters() -> None:
    heights = []
    for scale in (1, 4):
        rows, _ = np.nonzero(changed(plain(400 * scale, 400 * scale), title="H"))
        heights.append(rows.max() - rows.min())
    assert heights[1] / heights[0] == pytest.approx(4, rel=0.25)
    rows, _ = np.nonzero(
        (annotated_pixels(plain(400, 400), Annotations(title="H"), 50) != 0).any(axis=2)
    )
    halo = 2 * Canvas(plain(1, 1).pixels, 50).halo
    assert rows.max() - rows.min() == pytest.approx(0.73 * 1.2 * 50 + halo, abs=2)


def test_scale_bar_is_as_long_as_it_says() -> None:
    image = plain(300, 200)
    bar = find_marks(image, Annotations(scalebar=True)).scale_bar
    assert bar is not None
    assert bar.length == 0.1 * bar.pixels == 5
    lines = (annotated_pixels(image, Annotations(scalebar=True)) == 255).all(axis=2)
    assert lines.sum(axis=1).max() == 50


def test_colour_bar_has_the_colours_of_its_scale() -> None:
    image = plain(300, 400)
    pixels = annotated_pixels(image, Annotations(colorbar=True))
    (scale,) = find_marks(image, Annotations(colorbar=True)).scales
    table = [tuple(color) for color in scale.table.tolist()]
    column = next(k for k in range(300) if (pixels[:, k + 2] == table[128]).all(axis=1).any())
    found = [table.index(p) for p in map(tuple, pixels[:, column + 2].tolist()) if p in table]
    assert found == sorted(found, reverse=True)
    assert found[0] > 253
    assert found[-1] < 2
    # Marks at whole numbers: -2 at the lower end, 3 at the upper one.
    (block, left, top), *_ = arranged(find_marks(image, Annotations(colorbar=True)), 11, 300, 400)
    assert [text for _, text in block.marks] == ["−2", "−1", "0", "1", "2", "3"]
    ticks = np.nonzero((pixels[:, left + block.thick + 1] == 255).all(axis=1))[0]
    places = np.linspace(ticks[0], ticks[-1], 6)
    np.testing.assert_allclose(ticks, places, atol=0.51)
    assert block.length - 4 <= ticks[-1] - ticks[0] <= block.length
    assert top < ticks[0] < ticks[-1] < top + block.height


def test_bar_of_one_value_has_the_colour_in_the_middle() -> None:
    image = plain(300, 200)
    image.scene.objects.clear()
    spheres = image.scene.add_spheres(np.zeros((2, 3)), radius=0, color=[3.0, 3.0], cmap="viridis")
    (scale,) = find_marks(image, Annotations(colorbar=True)).scales
    shown = annotated_pixels(image, Annotations(colorbar=True))
    assert spheres.color.tolist() == [scale.table[128].tolist()] * 2
    assert (shown == scale.table[128]).all(axis=2).sum() > 300


def test_legend_has_balls_of_its_colours_beside_names() -> None:
    image = plain(300, 300)
    names = {f"Type {k}": (250, 10 * k, 0) for k in range(20)}
    (block, left, top), *_ = arranged(find_marks(image, Annotations(legend=names)), 11, 300, 300)
    assert len(block.columns) == 2, "more lines than there is room for below each other"
    pixels = annotated_pixels(image, Annotations(legend=names))
    middle = block.ball // 2
    for start, column in zip(block.starts, block.columns, strict=True):
        for k, entry in enumerate(column):
            x, y = left + start + middle, top + k * block.pitch + middle
            ratio = pixels[y, x].astype(float) / np.maximum(entry.color, 1)
            assert 0.7 < ratio[0] <= 1
            assert pixels[y, x, 1] == pytest.approx(ratio[0] * entry.color[1], abs=1)
            assert (pixels[y - middle : y + middle, x + middle + 3 : x + 60] == 255).any()


def test_labels_that_overlap_are_left_out() -> None:
    image = plain(120, 60)
    near, far, beside = (0, 0, 1), (0.2, 0, 0), (0, 2, 0)
    alone = changed(image, labels=[("near", near)])
    both = changed(image, labels=[("far away", far), ("near", near)])
    assert np.array_equal(both, alone)
    first = changed(image, labels=[("one", far), ("two", far)])
    assert np.array_equal(first, changed(image, labels=[("one", far)]))
    apart = changed(image, labels=[("near", near), ("high", beside)])
    assert apart.sum() > alone.sum()


@pytest.mark.parametrize("at", [(11, -8, 0), (9, 6, 0), (-12, 8, 0), (-12, -8, 0)])
def test_labels_leave_other_marks_free(at: Any) -> None:
    image = plain(300, 200)
    marks = {"title": "Water", "colorbar": "eV", "scalebar": "nm", "axes": True}
    alone = changed(image, **marks)
    assert np.array_equal(changed(image, labels=[("over it", at)], **marks), alone)
    middle = changed(image, labels=[("over it", at), ("free", (0, 0, 0))], **marks)
    assert middle.sum() > alone.sum()


@pytest.mark.parametrize("at", [(0, 0, 0), (7.2, -3.1, 0), (9.9, 9.9, 0), (-9.9, -9.9, 0)])
def test_labels_stand_around_their_points(at: Any) -> None:
    image = plain(200, 200, (255, 255, 255))
    rows, columns = np.nonzero(changed(image, labels=[("HOH", at)]))
    middle = np.array([columns.min() + columns.max() + 1, rows.min() + rows.max() + 1]) / 2
    inside = np.clip([100.5 + 10 * at[0], 100.5 - 10 * at[1]], 9, 191)
    np.testing.assert_allclose(middle, inside, atol=12 if abs(at[0]) > 9 else 1.5)
    assert rows.min() > 0
    assert columns.min() > 0
    assert rows.max() < 199
    assert columns.max() < 199


def test_label_outside_of_the_picture_is_left_out() -> None:
    assert not changed(plain(60, 40), labels=[("gone", (4, 0, 0))]).any()


@pytest.mark.parametrize(
    ("size", "wanted", "fontsize", "message"),
    [
        ((60, 40), ALL, None, "annotations: there is no room .* 60 x 40 pixels; render it larger,"),
        ((300, 300), CORNERS, 90, "annotations: there is no room .*, or give a smaller fontsize"),
        ((30, 30), {"labels": {"a long label": (0, 0, 0)}}, None, "annotations: there is no room"),
        ((300, 300), CORNERS, 0, "fontsize: expected a number > 0, or None, got 0"),
        ((300, 300), {"title": "水"}, None, "title: expected letters of Latin and Greek, got '水'"),
        ((300, 300), {"scalebar": "\t"}, None, r"scalebar: expected letters of .*, got '\\t'"),
    ],
)
def test_no_room_and_no_letters(
    size: tuple[int, int], wanted: Any, fontsize: float | None, message: str
) -> None:
    with pytest.raises(FigureError, match=message) as error:
        annotated_pixels(plain(*size), Annotations(**wanted), fontsize)
    assert "\n" not in str(error.value)


def test_ends_of_lines_are_kept_or_become_spaces() -> None:
    image = plain(300, 300)
    one = annotated_pixels(image, Annotations(**(ALL | {"colorbar": "a b", "time": "1 s"})))
    two = annotated_pixels(image, Annotations(**(ALL | {"colorbar": "a\nb", "time": "1\ns"})))
    assert (one == two).all()
    assert changed(image, title="A\nB", labels={"C\nD": (0, 0, 0)}).any()


def test_long_legends_leave_room_for_what_is_shown() -> None:
    legend = Annotations(legend={f"kind {k}": "red" for k in range(40)})
    assert 0.2 < share_beside([], legend, (1024, 1024)) < 0.4
    wide = Annotations(legend={"poly(ethylene terephthalate)": "red"})
    assert 0.2 < share_beside([], wide, (1024, 1024)) < 0.4
    # Where letters would be tiny, a legend stands on what is shown.
    assert share_beside([], legend, (240, 240)) > 0.6
    assert share_beside([], wide, (1024, 1024), fontsize=80) > 0.6


def test_long_names_of_a_legend_are_broken() -> None:
    image = plain(360, 300)
    names = {"a": "red", "a rather long name of a phase": "gold"}
    (block, left, _), *_ = arranged(find_marks(image, Annotations(legend=names)), 11, 360, 300)
    assert [entry.name for entry in block.columns[0]] == ["a", "a rather long\nname of a phase"]
    assert left > 0.6 * 360
    assert 0.2 < share_beside([], Annotations(legend=names), (360, 300)) < 0.4
    rows, columns = np.nonzero(changed(image, legend=names))
    assert columns.min() > 0.6 * 360
    assert rows.max() - rows.min() > 3 * 11
    # Even in letters that somebody chose.
    assert 0.2 < share_beside([], Annotations(legend=names), (1024, 900), fontsize=30) < 0.4


@pytest.mark.parametrize("dark", [False, True])
def test_legends_on_what_is_shown_have_paper(dark: bool) -> None:
    image = noise(240, 240)
    image.pixels[...] = image.pixels // 2 + 128 * (not dark)
    names = {f"kind {k}": "red" for k in range(40)}
    painted = annotated_pixels(image, Annotations(legend=names))
    (block, left, top), *_ = arranged(find_marks(image, Annotations(legend=names)), 11, 240, 240)
    paper = painted[top + block.height // 2 :, left - 2 : left, :][:20]
    assert (paper < 70).all() if dark else (paper > 200).all()


def test_long_titles_are_broken_beside_the_legend() -> None:
    image = plain(300, 200)
    words = "A title of many words that is far longer than this picture is wide"
    placed = arranged(find_marks(image, Annotations(**(CORNERS | {"title": words}))), 11, 300, 200)
    assert placed is not None
    (title,) = [block for block, *_ in placed if "A title" in getattr(block, "lines", [""])[0]]
    assert len(title.lines) > 1
    assert " ".join(title.lines) == words


@pytest.mark.parametrize("space", [" ", "_"])
def test_titles_are_not_broken_into_letters_beside_a_wide_legend(space: str) -> None:
    name = "a rather long name of a category number".replace(" ", space)
    wanted = Annotations(title="Kinds", legend={f"{name} {k}": "red" for k in range(5)})
    marks = find_marks(plain(300, 240), wanted)
    found = [one for em in range(7, 12) if (one := arranged(marks, em, 300, 240))]
    assert len(found) > 2
    for title, _ in found:
        assert title.block.lines == ["Kinds"]  # type: ignore[attr-defined]
    title, legend = found[-1]
    assert title.top + title.block.height <= legend.top


def test_names_are_broken_in_columns_too() -> None:
    names = {
        f"a name {k} that is longer than all the picture is wide, by far": "red" for k in "abcde"
    }
    marks = find_marks(plain(300, 200), Annotations(legend=names))
    (legend, left, _), *_ = arranged(marks, 11, 300, 200)
    assert len(legend.columns) > 1
    assert all("\n" in entry.name for column in legend.columns for entry in column)
    assert left > 9


def test_all_characters_are_in_the_font() -> None:
    tools = pytest.importorskip("fontTools.ttLib")
    with tools.TTFont(FONT) as font:
        known = set(font.getBestCmap())
    assert known == {code for first, last in RANGES for code in range(first, last + 1)}


def test_letters_of_units_are_not_boxes() -> None:
    font = letters(20)
    box = font.cover("\N{CJK UNIFIED IDEOGRAPH-6C34}", 0, 0).parts
    for character in "Åµσ²⁻₂°±≈∞−άέήίόύώΐΏșțϵ":
        shown = font.cover(check_letters(character, "title"), 0, 0).parts
        assert shown.shape != box.shape or (shown != box).any()
    assert check_letters("A\N{COMBINING RING ABOVE}", "title") == "Å"


def test_picture_is_saved_with_how_it_was_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    scene = vtray.Scene()
    scene.add_spheres([(0, 0, 0)], radius=1)
    scene.add_light((5, -9, 9))
    scene.camera = vtray.Camera.fit(scene, size=(60, 40))
    image = vtray.render(scene)
    before = image.pixels.copy()
    annotated = image.annotated(title="A")
    np.testing.assert_array_equal(image.pixels, before)
    assert (annotated.pixels != before).any()
    assert repr(annotated) == "<AnnotatedPicture of 60 x 40 pixels>"
    annotated.save(tmp_path / "a.png")
    for file in (tmp_path / "a.png", io.BytesIO(annotated._repr_png_())):
        with PillowImage.open(file) as read:
            np.testing.assert_array_equal(np.asarray(read), annotated.pixels)
    assert vtray.read_provenance(tmp_path / "a.png").scene == image.scene_hash
    for name in ("a.npz", "a.exr", "a.gif"):
        with pytest.raises(vtray.OutputError):
            annotated.save(tmp_path / name)
