"""A picture as a figure to publish: with colour bars and a scale bar, not a pixel of it changed."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vtray.color_bar import bar_labels, color_scales, draw_color_bar, text_room
from vtray.extras import need
from vtray.scale_bar import (
    depth_along_view,
    is_orthographic,
    length_text,
    pixel_width,
    round_length,
)
from vtray.scene import Plane
from vtray.sheet import INCH, LEAST_DPI, FigureError, Sheet, check_dpi, picture_zoom, usual_dpi

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from vtray.image import Image

Pixels = NDArray[np.uint8]

BAR_SHARE = 0.25
"""The share of the picture's width that a scale bar takes at most."""


def make_figure(
    image: "Image",
    *,
    colorbar: bool | str | Sequence[str],
    scalebar: object,
    title: object,
    flat: bool,
    dpi: float | None,
    at: "ArrayLike | None",
) -> "Figure":
    """Return an image as a figure; see `vtray.Image.figure`."""
    need("matplotlib", "figure", "Image.figure")
    if not isinstance(title, (str, type(None))):
        message = f"title: expected a text or None, got {title!r}"
        raise FigureError(message)
    scales = color_scales(image) if colorbar else []
    labels = bar_labels(colorbar, len(scales))
    bar = _scale_bar(image, scalebar, at)
    pixels = image.flat() if flat else image.pixels
    height, width = (side * picture_zoom(image.pixels.shape[1]) for side in pixels.shape[:2])
    dpi = usual_dpi(width) if dpi is None else check_dpi(dpi)
    point = dpi / INCH
    pad = round(10 * point)
    top = pad if title is None else pad + round(24 * point)
    bottom = pad if bar is None else pad + round(26 * point)
    between = round(14 * point)
    thick = round((28 if flat else 12) * point)
    room = [text_room(scale, label, point) for scale, label in zip(scales, labels, strict=True)]
    right = sum(between + thick + text for text in room) + pad
    if bar is not None:  # room for its text also where the picture is narrow
        text = bar.pixels * width / pixels.shape[1] + (6 + 5.6 * len(bar.text)) * point
        right = max(right, round(text) + pad - width)
    sheet = Sheet.of(pad + width + right, top + height + bottom, dpi)
    sheet.picture(pixels, pad, bottom, picture_zoom(image.pixels.shape[1]))
    if title is not None:
        place = (pad / sheet.width, (bottom + height + 0.4 * top) / sheet.height)
        sheet.figure.text(*place, title, fontsize=11, va="center")
    left = pad + width
    for scale, label, text in zip(scales, labels, room, strict=True):
        left += between
        draw_color_bar(sheet.axes(left, bottom, thick, height), scale, label, flat=flat)
        left += thick + text
    if bar is not None:
        _draw_scale_bar(sheet, bar, pad, bottom, width / image.pixels.shape[1])
    return sheet.figure


def compare_figure(
    pictures: Sequence[Pixels], captions: Sequence[str], text: str, dpi: float | None
) -> "Figure":
    """Return pictures of the same size side by side, captions above them and a text below."""
    need("matplotlib", "figure", "Comparison.figure")
    columns = pictures[0].shape[1]
    zoom = picture_zoom(columns)
    height, width = (side * zoom for side in pictures[0].shape[:2])
    dpi = max(LEAST_DPI, usual_dpi(2 * width)) if dpi is None else check_dpi(dpi)
    point = dpi / INCH
    pad, top = round(10 * point), round(26 * point)
    bottom = pad + round(12.5 * point * (1 + text.count("\n")))
    step = width + pad
    sheet = Sheet.of(pad + step * len(pictures), top + height + bottom, dpi)
    for k, (picture, caption) in enumerate(zip(pictures, captions, strict=True)):
        sheet.picture(picture, pad + k * step, bottom, zoom)
        place = ((pad + k * step) / sheet.width, (bottom + height + 7 * point) / sheet.height)
        sheet.figure.text(*place, caption, fontsize=10, va="bottom")
    place = (pad / sheet.width, (bottom - 6 * point) / sheet.height)
    sheet.figure.text(*place, text, fontsize=8.5, va="top", family="monospace")
    return sheet.figure


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


def _scale_bar(image: "Image", scalebar: object, at: "ArrayLike | None") -> ScaleBar | None:
    """Return the scale bar of an image, None if it should have none."""
    if not isinstance(scalebar, (bool, str)):
        message = f'scalebar: expected True, False or a unit such as "nm", got {scalebar!r}'
        raise FigureError(message)
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
    unit = pixel_width(camera, depth)
    length = round_length(BAR_SHARE * camera.size[0] * unit)
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
    ends = [left / x, (left + length) / x]
    line = Line2D(ends, [height / y] * 2, lw=1.6, color="black", solid_capstyle="butt")
    line.set_gid("scale bar")
    sheet.figure.add_artist(line)
    for end in ends:
        rise = [(height - cap) / y, (height + cap) / y]
        sheet.figure.add_artist(Line2D([end] * 2, rise, lw=1.0, color="black"))
    place = (left + length) / x + 6 * sheet.figure.dpi / INCH / x
    sheet.figure.text(place, height / y, bar.text, fontsize=9, va="center")
