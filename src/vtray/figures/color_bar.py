"""Colour bars: what values the colours of a figure stand for."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.figures.bar_marks import marks_of, share_of
from vtray.figures.brightness_scale import LABEL, BrightnessScale
from vtray.figures.flat import lit_colors
from vtray.figures.lettering import write
from vtray.figures.sheet import INCH, FigureError
from vtray.scene.copies import Copies
from vtray.scene.objects import Object

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.backend_bases import RendererBase

Pixels = NDArray[np.uint8]

SHADES = 64
"""How many steps of light a colour bar of a flat figure shows."""

MOST_MARKS = 6
"""About how many marks a colour bar has at most; short ones have less."""

LEAST_LINE = 6.0
"""How long the lines of a label may be beside a short bar, in sizes of its font."""


def color_scales(objects: Sequence[Object]) -> list[Any]:
    """Return the different colour scales of objects, in their order, and of what is copied."""
    scales: list[Any] = []
    for item in objects:
        inner = color_scales(item.objects) if isinstance(item, Copies) else []
        own = getattr(item, "color_scale", None)
        for scale in inner if own is None else [own]:
            if scale not in scales:
                scales.append(scale)
    return scales


def is_asked_for(colorbar: object) -> bool:
    """Tell whether colour bars are asked for, rightly or not."""
    return not isinstance(colorbar, (bool, np.bool_)) or bool(colorbar)


def bar_labels(colorbar: bool | str | Sequence[str], scales: Sequence[Any]) -> list[str]:
    """Return the text beside the colour bar of each scale.

    Those of brightness, which come last, have one of their own unless it is said.
    """
    usual = [LABEL if isinstance(scale, BrightnessScale) else "" for scale in scales]
    if isinstance(colorbar, (bool, np.bool_)):
        return usual
    labels: list[Any] = [colorbar]
    if isinstance(colorbar, (list, tuple)):
        labels = list(colorbar)
    count, of_colors = len(scales), usual.count("")
    if len(labels) == max(of_colors, 1) and count:
        labels += usual[len(labels) :]
    if len(labels) != count or not all(isinstance(label, str) for label in labels):
        bars = "a label" if count == 1 else f"a list of {count} labels"
        expected = f"True, False or {bars}" if count else "True or False, as no object has a cmap"
        message = f"colorbar: expected {expected}, got {colorbar!r}"
        raise FigureError(message)
    return labels


def _ticks(scale: Any, most: int) -> tuple[list[float], list[str]]:  # noqa: ANN401
    """Return where a colour bar has marks, and what is written there."""
    marks = marks_of(scale, most)
    values = [value for value, _ in marks]
    if isinstance(scale, BrightnessScale):
        values = [share_of(scale, value) for value in values]
    elif scale.norm == "log" and scale.low < scale.high:
        values = [math.log10(value) for value in values]
    return values, [text for _, text in marks]


@dataclass
class ColorBar:
    """A colour bar on axes of its own.

    Attributes
    ----------
    axes
        Where it is drawn.
    scale
        The colour scale that it shows.
    label
        What stands beside it.
    mark_size, label_size
        The sizes of its fonts in points.
    """

    axes: "Axes"
    scale: Any
    label: str
    mark_size: float
    label_size: float

    @classmethod
    def draw(cls, axes: "Axes", scale: Any, label: str, *, flat: bool) -> "ColorBar":  # noqa: ANN401
        """Draw the colours of a scale; in a flat figure each in shadow on the left to lit."""
        from matplotlib import rcParams

        table: Pixels = scale.table
        low, high = (0.0, 1.0) if scale.low == scale.high else (scale.low, scale.high)
        if isinstance(scale, BrightnessScale):
            low, high = 0.0, 1.0
        elif scale.norm == "log" and scale.low < scale.high:
            low, high = math.log10(low), math.log10(high)
        if scale.low == scale.high:
            table = scale.colors([scale.low])
        shades = SHADES if flat else 1
        colors = np.repeat(table[:, None], shades, axis=1)
        if flat:
            light = np.tile(np.linspace(0.0, 1.0, shades), len(table))
            colors = lit_colors(colors.reshape(-1, 3), light).reshape(colors.shape)
        axes.imshow(
            colors, origin="lower", aspect="auto", extent=(0, 1, low, high), interpolation="nearest"
        )
        axes.grid(visible=False)
        axes.yaxis.set_ticks_position("right")
        axes.yaxis.set_label_position("right")
        axes.set_xticks([0, 1] if flat else [], ["shadow", "light"] if flat else [])
        axes.tick_params(axis="x", which="both", length=0)
        axes.set_ylabel(label, labelpad=0.4 * rcParams["font.size"])
        mark_size = float(axes.yaxis.get_major_ticks(1)[0].label2.get_fontsize())
        return cls(axes, scale, label, mark_size, float(axes.yaxis.label.get_fontsize()))

    def beside(self, height: float, renderer: "RendererBase | None" = None) -> float:
        """Write marks and the label for a height; return the width of that.

        All lengths are in points, as what `overhang`, `below` and `least_width` return.
        """
        most = int(min(max(height / (2 * self.mark_size), 1), MOST_MARKS))
        values, texts = _ticks(self.scale, most)
        self.axes.set_yticks([0.5] if self.scale.low == self.scale.high else values, texts)
        room = max(height, LEAST_LINE * self.label_size) * self._point
        write(self.axes.yaxis.label, self.label, self.label_size, room, renderer)
        box = self.axes.yaxis.get_tightbbox(renderer)
        return 0.0 if box is None else (box.x1 - self.axes.bbox.x1) / self._point

    def overhang(self, height: float, renderer: "RendererBase | None" = None) -> float:
        """Return by how much the label is longer than the bar, above and below."""
        length = self.axes.yaxis.label.get_window_extent(renderer).height / self._point
        return max(0.0, length - height) / 2

    def below(self, renderer: "RendererBase | None" = None) -> float:
        """Return the height of what is written below the bar."""
        box = self.axes.xaxis.get_tightbbox(renderer)
        return 0.0 if box is None else max(0.0, self.axes.bbox.y0 - box.y0) / self._point

    def least_width(self) -> float:
        """Return how wide it must be for what is written below it."""
        boxes = [text.get_window_extent() for text in self.axes.get_xticklabels()]
        space = 0.6 * self.mark_size
        return sum(box.width / 2 for box in boxes) / self._point + space if boxes else 0.0

    @property
    def _point(self) -> float:
        """How many pixels a point is."""
        return self.axes.figure.dpi / INCH
