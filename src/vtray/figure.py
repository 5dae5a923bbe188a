"""A picture as a figure to publish: with colour bars and a scale bar, not a pixel of it changed."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.errors import VtrayError
from vtray.extras import need
from vtray.flat import lit_colors
from vtray.scale_bar import (
    depth_along_view,
    is_orthographic,
    length_text,
    pixel_width,
    round_length,
)
from vtray.scene import Plane

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from vtray.image import Image

Pixels = NDArray[np.uint8]

LEAST_WIDTH = 300
"""Pictures narrower than this are shown with each pixel as a square of pixels."""

USUAL_INCHES = 6.5
"""How wide a picture is in print, unless its resolution would be below `LEAST_DPI`."""

LEAST_DPI = 100.0
SHADES = 64
"""How many steps of light a colour bar of a flat figure shows."""

BAR_SHARE = 0.25
"""The share of the picture's width that a scale bar takes at most."""

INCH = 72.0


class FigureError(VtrayError, ValueError):
    """A figure cannot be made as asked for."""


@dataclass
class Sheet:
    """A figure whose parts are placed in pixels, from the lower left.

    Attributes
    ----------
    figure
        The figure.
    width, height
        Its size in pixels.
    """

    figure: "Figure"
    width: int
    height: int

    @classmethod
    def of(cls, width: int, height: int, dpi: float) -> "Sheet":
        """Return an empty white sheet."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        # A hair more, so that Agg does not round a pixel away.
        size = ((width + 0.01) / dpi, (height + 0.01) / dpi)
        figure = Figure(figsize=size, dpi=dpi, facecolor="white")
        FigureCanvasAgg(figure)
        return cls(figure, width, height)

    def axes(self, left: float, bottom: float, width: float, height: float) -> "Axes":
        """Add axes at a place given in pixels."""
        across, up = self.figure.bbox.width, self.figure.bbox.height
        return self.figure.add_axes((left / across, bottom / up, width / across, height / up))

    def picture(self, pixels: NDArray[Any], left: int, bottom: int, zoom: int) -> "Axes":
        """Add a picture, each of its pixels a square of zoom x zoom pixels."""
        height, width = pixels.shape[:2]
        axes = self.axes(left, bottom, width * zoom, height * zoom)
        axes.imshow(pixels, interpolation="none", aspect="auto")
        axes.set_axis_off()
        return axes


def picture_zoom(width: int) -> int:
    """Return how many pixels of a figure show one of a picture, across and down."""
    return max(1, math.ceil(LEAST_WIDTH / width))


def usual_dpi(width: int) -> float:
    """Return the dots per inch with which a picture of this width has a usual size."""
    return max(LEAST_DPI, round(width / USUAL_INCHES))


def make_figure(
    image: "Image",
    *,
    colorbar: bool | str | Sequence[str],
    scalebar: bool | str,
    title: str | None,
    flat: bool,
    dpi: float | None,
    at: "ArrayLike | None",
) -> "Figure":
    """Return an image as a figure; see `vtray.Image.figure`."""
    need("matplotlib", "figure", "Image.figure")
    scales = _scales(image) if colorbar else []
    labels = _labels(colorbar, len(scales))
    bar = _scale_bar(image, scalebar, at)
    pixels = image.flat() if flat else image.pixels
    height, width = (side * picture_zoom(image.pixels.shape[1]) for side in pixels.shape[:2])
    dpi = usual_dpi(width) if dpi is None else _check_dpi(dpi)
    point = dpi / INCH
    pad = round(10 * point)
    top = pad if title is None else pad + round(24 * point)
    bottom = pad if bar is None else pad + round(30 * point)
    between = round(14 * point)
    thick = round((28 if flat else 12) * point)
    room = [_room(scale, label, point) for scale, label in zip(scales, labels, strict=True)]
    right = sum(between + thick + text for text in room) + pad
    sheet = Sheet.of(pad + width + right, top + height + bottom, dpi)
    sheet.picture(pixels, pad, bottom, picture_zoom(image.pixels.shape[1]))
    if title is not None:
        place = (pad / sheet.width, (bottom + height + 0.4 * top) / sheet.height)
        sheet.figure.text(*place, title, fontsize=11, va="center")
    left = pad + width
    for scale, label, text in zip(scales, labels, room, strict=True):
        left += between
        _draw_color_bar(sheet.axes(left, bottom, thick, height), scale, label, flat=flat)
        left += thick + text
    if bar is not None:
        _draw_scale_bar(sheet, bar, pad, bottom, width / image.pixels.shape[1])
    return sheet.figure


def _check_dpi(dpi: float) -> float:
    """Return dots per inch that are possible."""
    if not (isinstance(dpi, (int, float, np.number)) and math.isfinite(dpi) and dpi >= 1):
        message = f"dpi: expected a number ≥ 1, or None, got {dpi!r}"
        raise FigureError(message)
    return float(dpi)


def _scales(image: "Image") -> list[Any]:
    """Return the different colour scales of the objects, in their order."""
    scales: list[Any] = []
    for item in image.scene.objects:
        scale = getattr(item, "color_scale", None)
        if scale is not None and scale not in scales:
            scales.append(scale)
    return scales


def _labels(colorbar: bool | str | Sequence[str], count: int) -> list[str]:
    """Return the text beside each colour bar."""
    if isinstance(colorbar, (bool, np.bool_)):
        return [""] * count
    labels = [colorbar] if isinstance(colorbar, str) else list(colorbar)
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
    formatter.axis.set_view_interval(low, high)
    formatter.axis.set_data_interval(low, high)
    texts = formatter.format_ticks(values)
    offset = formatter.get_offset()
    if offset:  # such as 1e-9: write it out at each mark
        texts = [f"{value:.6g}" for value in values]
    return values, texts


def _room(scale: Any, label: str, point: float) -> int:  # noqa: ANN401
    """Return the width of what is written beside a colour bar, in pixels."""
    longest = max(map(len, _ticks(scale)[1]), default=0)
    return round((8 + 6.5 * longest + (16 if label else 0)) * point)


def _draw_color_bar(axes: "Axes", scale: Any, label: str, *, flat: bool) -> None:  # noqa: ANN401
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


@dataclass(frozen=True)
class ScaleBar:
    """A scale bar.

    Attributes
    ----------
    length
        In scene units.
    pixels
        In pixels of the picture.
    text
        What is written beside it.
    """

    length: float
    pixels: float
    text: str


def _scale_bar(image: "Image", scalebar: bool | str, at: "ArrayLike | None") -> ScaleBar | None:
    """Return the scale bar of an image, None if it should have none."""
    depth = _depth_of(image, at)
    if scalebar is False:
        return None
    camera = image.scene.camera
    note = ""
    if depth is None and is_orthographic(camera):
        depth = 0.0
    elif depth is None:
        seen, note = _what_counts(image)
        if not seen.any():
            return None
        depth = float(np.median(depth_along_view(camera, image.depth)[seen]))
    columns = image.pixels.shape[1]
    unit = pixel_width(camera, depth) * camera.size[0] / columns
    length = round_length(BAR_SHARE * columns * unit)
    text = length_text(length)
    if isinstance(scalebar, str):
        text += f" {scalebar}"
    if not is_orthographic(camera):
        text += f"  at distance {depth:.4g}{note}"
    if camera.resolution[0] != camera.resolution[1]:
        text += "  (horizontally)"
    return ScaleBar(length, length / unit, text)


def _what_counts(image: "Image") -> tuple[NDArray[np.bool_], str]:
    """Return the pixels whose median distance counts, and words for that: planes have no end."""
    places = image.ids[..., 0]
    planes = [k for k, item in enumerate(image.scene.objects) if isinstance(item, Plane)]
    spheres = (places >= 0) & ~np.isin(places, planes)
    if spheres.any():
        return spheres, ", the median of the spheres"
    return places >= 0, ", the median"


def _depth_of(image: "Image", at: "ArrayLike | None") -> float | None:
    """Return how far from the eye along z' a point lies."""
    if at is None:
        return None
    camera = image.scene.camera
    try:
        point = np.asarray(at, np.float64)
    except (TypeError, ValueError):
        point = np.zeros(0)
    if point.shape != (3,) or not np.isfinite(point).all():
        message = f"at: expected a point of three finite numbers, or None, got {at!r}"
        raise FigureError(message)
    normal = np.array([camera.normal.x, camera.normal.y, camera.normal.z])
    normal /= np.abs(normal).max()
    normal /= np.linalg.norm(normal)
    center = np.array([camera.center.x, camera.center.y, camera.center.z])
    depth = float((point - center) @ normal) + camera.focus
    if not depth > 0:
        message = f"at: expected a point in front of the eye, got {at!r}"
        raise FigureError(message)
    return depth


def _draw_scale_bar(sheet: Sheet, bar: ScaleBar, left: int, bottom: int, zoom: float) -> None:
    """Draw a scale bar below the picture, where it hides nothing."""
    from matplotlib.lines import Line2D

    length = bar.pixels * zoom
    height = bottom * 0.68
    cap = 0.09 * bottom
    x, y = sheet.figure.bbox.width, sheet.figure.bbox.height
    style = {"color": "black", "solid_capstyle": "butt", "gid": "scale bar"}
    ends = [left / x, (left + length) / x]
    sheet.figure.add_artist(Line2D(ends, [height / y] * 2, lw=1.6, **style))
    for end in ends:
        rise = [(height - cap) / y, (height + cap) / y]
        sheet.figure.add_artist(Line2D([end] * 2, rise, lw=1.0, color="black"))
    place = (left + length) / x + 6 * sheet.figure.dpi / INCH / x
    sheet.figure.text(place, height / y, bar.text, fontsize=9, va="center")
