"""A picture as a figure to publish: with colour bars and a scale bar, not a pixel of it changed."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from vtray.base.extras import need
from vtray.figures.color_bar import bar_labels, color_scales
from vtray.figures.lettering import write
from vtray.figures.panel import LEAST_SHARE, Panel, Rooms
from vtray.figures.scale_bar import (
    ScaleBar,
    depth_along_view,
    is_orthographic,
    length_text,
    pixel_width,
    round_length,
)
from vtray.figures.sheet import (
    INCH,
    LEAST_DPI,
    FigureError,
    Sheet,
    check_dpi,
    check_number,
    picture_zoom,
    usual_dpi,
)
from vtray.figures.subject import Pixels, Subject
from vtray.scene.scene import Plane

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

BAR_SHARE = 0.25
"""The share of the picture's width that a scale bar takes at most."""

FONT_SIZES = ("font.size", "axes.titlesize", "axes.labelsize", "xtick.labelsize", "ytick.labelsize")
"""Matplotlib's settings for the sizes of all text in a figure."""


def make_figure(
    image: Subject,
    *,
    colorbar: bool | str | Sequence[str],
    scalebar: object,
    title: object,
    flat: bool,
    width: float | None,
    dpi: float | None,
    fontsize: float | None,
    at: "ArrayLike | None",
    ax: "Axes | None",
) -> "Figure":
    """Return an image as a figure; see `vtray.Image.figure`."""
    matplotlib = need("matplotlib", "figure", "Image.figure")
    if not isinstance(title, (str, type(None))):
        message = f"title: expected a text or None, got {title!r}"
        raise FigureError(message)
    width = None if width is None else check_number("width", width)
    dpi = None if dpi is None else check_dpi(dpi)
    sizes = (
        {} if fontsize is None else dict.fromkeys(FONT_SIZES, check_number("fontsize", fontsize))
    )
    scales = color_scales(image.scene.objects) if colorbar else []
    labels = bar_labels(colorbar, len(scales))
    bar = _scale_bar(image, scalebar, at)
    if ax is not None:
        _check_axes(ax, width, dpi)
    pixels = image.flat() if flat else image.pixels
    with matplotlib.rc_context(sizes):
        if ax is not None:
            Panel(ax, pixels, scales, labels, bar, title or "", flat=flat).settle()
            return ax.figure.figure
        sheet = Sheet.of(600, 400, LEAST_DPI)
        axes = sheet.axes(0, 0, 1, 1)
        panel = Panel(axes, pixels, scales, labels, bar, title or "", flat=flat)
    if width is None:
        _lay_out(sheet, panel, dpi)
    else:
        _lay_out_in_width(sheet, panel, width, dpi)
    return sheet.figure


def _check_axes(ax: object, width: float | None, dpi: float | None) -> None:
    """Raise FigureError if a picture cannot be drawn there."""
    from matplotlib.axes import Axes

    if not isinstance(ax, Axes) or ax.name != "rectilinear" or ax.figure is None:
        message = f"ax: expected rectangular Axes of a Matplotlib figure, or None, got {ax!r}"
        raise FigureError(message)
    for name, value in (("width", width), ("dpi", dpi)):
        if value is not None:
            message = f"{name}: expected None with ax, whose figure has a size of its own"
            raise FigureError(f"{message}, got {value:g}")


def _lay_out(sheet: Sheet, panel: Panel, dpi: float | None) -> None:
    """Make a sheet as large as its panel, each pixel of the picture one of the sheet, or more."""
    zoom = picture_zoom(panel.columns)
    width, height = panel.columns * zoom, panel.rows * zoom
    dpi = usual_dpi(width) if dpi is None else dpi
    sheet.figure.set_dpi(dpi)
    rooms = panel.rooms(width * INCH / dpi, height * INCH / dpi)
    across = width + _pixels(_margin(panel, rooms), dpi)
    _finish(sheet, panel, rooms, (across, width, height), dpi)


def _lay_out_in_width(sheet: Sheet, panel: Panel, width: float, dpi: float | None) -> None:
    """Make a sheet of a width in inches, and as high as its panel then is.

    Without dots per inch, they are those with which each pixel of the picture is one of the sheet,
    or more.
    """
    sheet.figure.set_dpi(dpi or 300)
    points = INCH * width
    _, rooms = panel.fit(points - 2 * panel.em, math.inf)
    margin = _margin(panel, rooms)
    if margin > (1 - LEAST_SHARE) * points:
        least = margin / (1 - LEAST_SHARE) / INCH
        message = f"width: expected at least {least:.3g} inches with this text, got {width:g}"
        raise FigureError(f"{message}; or give a smaller fontsize")
    if dpi is not None:
        across = math.floor(width * dpi + 1e-6)
        shown = across - _pixels(margin, dpi)
        high = max(1, round(shown * panel.rows / panel.columns))
    else:
        zoom = max(1, math.ceil(LEAST_DPI * (points - margin) / INCH / panel.columns))
        shown, high = zoom * panel.columns, zoom * panel.rows
        # The more pixels, the more of them are margin, one at a time: some number is right.
        across = math.floor(shown / (1 - margin / points)) - 2
        while across - _pixels(margin, across / width) < shown:
            across += 1
        dpi = across / width
    _finish(sheet, panel, rooms, (across, shown, high), dpi, width)


def _margin(panel: Panel, rooms: Rooms) -> float:
    """Return how much wider a sheet is than the picture, in points."""
    return rooms.right + 2 * panel.em


def _pixels(points: float, dpi: float) -> int:
    """Return a length in points in whole pixels."""
    return round(points * dpi / INCH)


def _finish(
    sheet: Sheet,
    panel: Panel,
    rooms: Rooms,
    size: tuple[int, int, int],
    dpi: float,
    inches: float = 0.0,
) -> None:
    """Put a panel on a sheet, given the width of the sheet, and width and height of the picture."""
    from matplotlib.transforms import Bbox

    across, width, height = size
    bottom = _pixels(rooms.below + panel.em, dpi)
    sheet.resize(across, bottom + height + _pixels(rooms.above + panel.em, dpi), dpi, inches)
    box = Bbox.from_bounds(_pixels(panel.em, dpi), bottom, width, height)
    for axes, place in zip(panel.all_axes(), panel.place(box, rooms, whole=True), strict=True):
        axes.set_position(sheet.parts(*place.bounds))


def compare_figure(
    pictures: Sequence[Pixels], captions: Sequence[str], text: str, dpi: float | None
) -> "Figure":
    """Return pictures of the same size side by side, captions above them and a text below."""
    matplotlib = need("matplotlib", "figure", "Comparison.figure")
    columns = pictures[0].shape[1]
    zoom = picture_zoom(columns)
    height, width = (side * zoom for side in pictures[0].shape[:2])
    dpi = max(LEAST_DPI, usual_dpi(2 * width)) if dpi is None else check_dpi(dpi)
    point = dpi / INCH
    em = float(matplotlib.rcParams["font.size"])
    pad, between = round(em * point), round(0.6 * em * point)
    step = width + pad
    sheet = Sheet.of(pad + step * len(pictures), height, dpi)
    figure = sheet.figure
    names = [figure.text(0, 0, "", va="bottom") for _ in captions]
    for name, caption in zip(names, captions, strict=True):
        write(name, caption, em, width)
    below = figure.text(0, 0, text, fontsize=0.85 * em, va="top", family="monospace")
    top, bottom = (
        math.ceil(max(part.get_window_extent().height for part in parts)) + between + pad // 2
        for parts in (names, [below])
    )
    sheet.resize(sheet.width, bottom + height + top, dpi)
    for k, (picture, name) in enumerate(zip(pictures, names, strict=True)):
        sheet.picture(picture, pad + k * step, bottom, zoom)
        name.set_position(sheet.place(pad + k * step, bottom + height + between))
    below.set_position(sheet.place(pad, bottom - between))
    return figure


def _scale_bar(image: Subject, scalebar: object, at: "ArrayLike | None") -> ScaleBar | None:
    """Return the scale bar of an image, None if it should have none."""
    if not isinstance(scalebar, (bool, str)):
        message = f'scalebar: expected True, False or a unit such as "nm", got {scalebar!r}'
        raise FigureError(message)
    depth = _depth_of(image, at)
    if scalebar is False:
        return None
    camera = image.scene.camera
    pattern = _pattern(image, scalebar)
    if depth is None and (not is_orthographic(camera) or "{distance}" in pattern):
        depth = _median_depth(image)
        if depth is None:
            return None
    unit = pixel_width(camera, depth or 0.0)
    length = round_length(BAR_SHARE * camera.size[0] * unit)
    text = pattern.replace("{length}", length_text(length))
    if depth is not None:
        text = text.replace("{distance}", f"{depth:.4g}")
    return ScaleBar(length, length / unit, text)


def _pattern(image: Subject, scalebar: bool | str) -> str:
    """Return what is written beside a scale bar, with the names of numbers in braces."""
    if isinstance(scalebar, str) and "{length}" in scalebar:
        return scalebar
    pattern = "{length}" if scalebar is True else f"{{length}} {scalebar}"
    camera = image.scene.camera
    if not is_orthographic(camera):  # right at one distance only
        pattern = r"${\approx}$ " + pattern
    if camera.resolution[0] != camera.resolution[1]:
        pattern += " (horizontally)"
    return pattern


def _median_depth(image: Subject) -> float | None:
    """Return the median distance of what is seen, along the view; None if nothing is.

    Planes, which have no end, only count where there is nothing else.
    """
    places = image.ids[..., 0]
    planes = [k for k, item in enumerate(image.scene.objects) if isinstance(item, Plane)]
    seen = (places >= 0) & ~np.isin(places, planes)
    if not seen.any():
        seen = places >= 0
    if not seen.any():
        return None
    return float(np.median(depth_along_view(image.scene.camera, image.depth)[seen]))


def _depth_of(image: Subject, at: "ArrayLike | None") -> float | None:
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
