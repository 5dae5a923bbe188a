"""Colour bars: what values the colours of a figure stand for."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.flat import lit_colors
from vtray.sheet import FigureError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from vtray.image import Image

Pixels = NDArray[np.uint8]

SHADES = 64
"""How many steps of light a colour bar of a flat figure shows."""


def color_scales(image: "Image") -> list[Any]:
    """Return the different colour scales of the objects, in their order."""
    scales: list[Any] = []
    for item in image.scene.objects:
        scale = getattr(item, "color_scale", None)
        if scale is not None and scale not in scales:
            scales.append(scale)
    return scales


def bar_labels(colorbar: bool | str | Sequence[str], count: int) -> list[str]:
    """Return the text beside each colour bar."""
    if isinstance(colorbar, (bool, np.bool_)):
        return [""] * count
    labels: list[Any] = [colorbar]
    if isinstance(colorbar, (list, tuple)):
        labels = list(colorbar)
    if len(labels) != count or not all(isinstance(label, str) for label in labels):
        bars = "a label" if count == 1 else f"a list of {count} labels"
        expected = f"True, False or {bars}" if count else "True or False, as no object has a cmap"
        message = f"colorbar: expected {expected}, got {colorbar!r}"
        raise FigureError(message)
    return labels


def _ticks(scale: Any) -> tuple[list[float], list[str]]:  # noqa: ANN401
    """Return where a colour bar has marks, and what is written there."""
    from matplotlib.ticker import MaxNLocator, ScalarFormatter

    low, high = scale.low, scale.high
    if low == high:
        return [low], [f"{low:g}"]
    slack = 1e-9 * (high - low)
    values = [
        float(value)
        for value in MaxNLocator(nbins=6, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
        if low - slack <= value <= high + slack
    ]
    formatter = ScalarFormatter(useOffset=False)
    formatter.create_dummy_axis()
    axis: Any = formatter.axis
    axis.set_view_interval(low, high)
    axis.set_data_interval(low, high)
    texts = formatter.format_ticks(values)
    offset = formatter.get_offset()
    if offset:  # such as 1e-9: write it out at each mark
        texts = [f"{value:.6g}" for value in values]
    return values, texts


def text_room(scale: Any, label: str, point: float) -> int:  # noqa: ANN401
    """Return the width of what is written beside a colour bar, in pixels."""
    longest = max(map(len, _ticks(scale)[1]), default=0)
    return round((8 + 6.5 * longest + (16 if label else 0)) * point)


def draw_color_bar(axes: "Axes", scale: Any, label: str, *, flat: bool) -> None:  # noqa: ANN401
    """Draw the colours of a scale; in a flat figure each in shadow on the left to lit."""
    table: Pixels = scale.table
    low, high = (0.0, 1.0) if scale.low == scale.high else (scale.low, scale.high)
    if scale.low == scale.high:
        table = table[:1]
    shades = SHADES if flat else 1
    colors = np.repeat(table[:, None], shades, axis=1)
    if flat:
        light = np.tile(np.linspace(0.0, 1.0, shades), len(table))
        colors = lit_colors(colors.reshape(-1, 3), light).reshape(colors.shape)
    axes.imshow(
        colors, origin="lower", aspect="auto", extent=(0, 1, low, high), interpolation="nearest"
    )
    values, texts = _ticks(scale)
    axes.set_yticks([0.5] if scale.low == scale.high else values, texts)
    axes.yaxis.set_ticks_position("right")
    axes.yaxis.set_label_position("right")
    axes.tick_params(axis="y", labelsize=9, width=0.8, length=3)
    axes.set_ylabel(label, fontsize=10, labelpad=5)
    axes.set_xticks([0, 1] if flat else [], ["shadow", "light"] if flat else [])
    axes.tick_params(axis="x", labelsize=7.5, length=0, pad=3)
    for spine in axes.spines.values():
        spine.set_linewidth(0.8)
