"""Legends, axes and labels on figures: vector text, at the right places, within the figure."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import once
from vtray.figures.annotations import Annotations
from vtray.figures.figure import make_figure
from vtray.figures.ink import DARK, LIGHT
from vtray.figures.sheet import FigureError

pytest.importorskip("matplotlib", reason="needs the extra vtray[figure]")
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

ELEMENTS = {"O": "red", "H": "white", "Fe": "orange"}
USUAL: dict[str, Any] = {"flat": False, "width": None, "dpi": None, "fontsize": None, "ax": None}


def figure(wanted: dict[str, Any], color: int = 0, **arguments: Any) -> Any:
    """Return a figure of a plain picture, taken along -z by parallel rays; a pixel is 0.1 wide."""
    scene = vtray.Scene()
    scene.add_spheres([(0, 0, 0)], radius=0, color=[1.0], cmap="viridis", clim=(-2, 3))
    scene.camera = vtray.Camera.orthographic((0, 0, 9), (0, 0, 0), 20, size=(320, 200))
    pixels = np.full((200, 320, 3), color, np.uint8)
    image: Any = SimpleNamespace(
        scene=scene,
        pixels=pixels,
        linear=np.zeros((200, 320, 3)),
        brightness_scales=(),
        flat=lambda: pixels,
    )
    made = make_figure(image, Annotations(**wanted), **(USUAL | arguments))
    made.canvas.draw()
    return made


def text(made: Any, words: str) -> Any:
    """Return the text of a figure that says something."""
    (found,) = made.findobj(lambda part: getattr(part, "get_text", str)() == words)
    return found


def legend(made: Any) -> Any:
    (found,) = made.findobj(lambda part: part.get_gid() == "legend")
    return found


@once
@pytest.mark.parametrize("arguments", [{}, {"width": 4.5, "fontsize": 9}])
def test_long_names_of_a_legend_are_broken(arguments: Any) -> None:
    names = {"a": "red", "a rather long name of a phase, with $x_1 > 2$ at all its ends": "gold"}
    made = figure({"legend": names}, **arguments)
    texts = legend(made).get_texts()
    assert [part.get_text().replace("\n", " ") for part in texts] == list(names)
    assert texts[1].get_text().count("\n") >= 1
    assert texts[0].get_fontsize() == texts[1].get_fontsize()
    box = legend(made).get_window_extent()
    assert box.width <= 0.42 * made.bbox.width
    assert box.x1 <= made.bbox.x1
    assert box.y0 >= 0


@once
@pytest.mark.parametrize(
    "arguments", [{}, {"width": 3.5, "fontsize": 7}, {"width": 3.5, "fontsize": 7, "dpi": 300}]
)
@pytest.mark.parametrize("flat", [False, True])
def test_legend_is_beside_the_picture_and_within_the_figure(arguments: Any, flat: bool) -> None:
    made = figure({"legend": ELEMENTS, "colorbar": "energy"}, flat=flat, **arguments)
    picture, bar = made.axes
    box = legend(made).get_window_extent()
    assert box.x0 > bar.get_tightbbox().x1
    assert box.x1 <= made.bbox.x1
    assert box.y1 == pytest.approx(picture.get_window_extent().y1)
    assert [part.get_text() for part in legend(made).get_texts()] == list(ELEMENTS)
    assert {part.get_fontsize() for part in legend(made).get_texts()} == {
        arguments.get("fontsize", 10)
    }
    if "width" in arguments:
        assert made.get_size_inches()[0] == pytest.approx(3.5, abs=0.01)


def test_long_legends_have_columns() -> None:
    names = {f"Type {k}": (0, 10 * k, 255) for k in range(25)}
    made = figure({"legend": names})
    box = legend(made).get_window_extent()
    assert box.x1 <= made.bbox.x1
    assert box.y0 >= 0
    assert box.height <= made.axes[0].get_window_extent().height + 1
    assert len({round(part.get_window_extent().x0) for part in legend(made).get_texts()}) > 1


@pytest.mark.parametrize(("color", "ink"), [(0, LIGHT), (255, DARK)])
@pytest.mark.parametrize("arguments", [{}, {"width": 3.5, "fontsize": 7}])
def test_labels_are_at_their_points_and_within_the_picture(
    color: int, ink: Any, arguments: Any
) -> None:
    labels = {"here": (5, 3, 0), "at the edge": (15.9, 9.9, 0), "gone": (17, 0, 0)}
    made = figure({"labels": labels, "colorbar": False}, color, **arguments)
    area = made.axes[0].get_window_extent()
    pixel = area.width / 320
    box = text(made, "here").get_window_extent()
    place = area.x0 + (160 + 50 + 0.5) * pixel, area.y1 - (100 - 30 + 0.5) * pixel
    middle = (box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2
    assert middle == pytest.approx(place, abs=1)
    assert to_hex(text(made, "here").get_color()) == "#{:02x}{:02x}{:02x}".format(*ink)
    shown = np.asarray(made.canvas.buffer_rgba())[..., :3].astype(int)
    outside = np.ones(shown.shape[:2], bool)
    top = len(shown) - round(area.y1)
    outside[top : top + round(area.height), round(area.x0) : round(area.x0) + round(area.width)] = (
        False
    )
    assert (shown[outside] == 255).all(), "nothing is written beside the picture"
    assert not made.findobj(lambda part: getattr(part, "get_text", str)() == "gone")


def test_triad_stands_in_the_corner() -> None:
    made = figure({"axes": {"x": (1, 0, 0), "y": (0, 1, 0)}, "colorbar": False})
    area = made.axes[0].get_window_extent()
    assert len(made.axes[0].findobj(Polygon)) == 8, "shafts and heads, with halos"
    boxes = [text(made, name).get_window_extent() for name in "xy"]
    for box in boxes:
        assert area.x0 < box.x0 < box.x1 < area.x0 + 0.4 * area.width
        assert area.y0 < box.y0 < box.y1 < area.y0 + 0.4 * area.height
    assert boxes[0].x0 > boxes[1].x1, "x points to the right"
    assert boxes[1].y0 > boxes[0].y1, "y points up"


def test_caption_stands_below_the_title() -> None:
    made = figure({"title": "Water", "time": "12.5 ps", "frame": 3})
    assert text(made, "Water\nt = 12.5 ps, frame 3").get_window_extent().y1 <= made.bbox.y1
    assert text(figure({"frame": 3}), "frame 3")


def test_what_was_drawn_in_the_same_axes_is_replaced() -> None:
    left, right = Figure(layout="constrained").subplots(1, 2)
    wanted = {"legend": ELEMENTS, "axes": True, "labels": {"here": (0, 0, 0)}}
    for _ in range(2):
        made = figure(wanted, ax=left)
    box = legend(made).get_window_extent()
    assert box.x1 < right.get_window_extent().x0
    assert text(made, "here")
    plain = figure({"colorbar": False}, ax=left)
    assert not plain.findobj(lambda part: part.get_gid() == "legend")
    assert not left.findobj(Polygon)


@pytest.mark.parametrize("wanted", [{"title": "$$"}, {"legend": {"a $x^$": "red"}}])
def test_formulas_that_are_none_are_told(wanted: dict[str, Any]) -> None:
    with pytest.raises(FigureError, match=r"^expected a formula of Matplotlib between dollars, or"):
        figure(wanted)
