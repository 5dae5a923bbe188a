"""A picture as a figure to publish: with what belongs around it, not a pixel of it resampled."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from vtray.base.extras import need
from vtray.figures.annotations import Annotations, find_marks
from vtray.figures.lettering import write
from vtray.figures.panel import LEAST_SHARE, Panel, Rooms
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

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_TENTHS = 1000
"""The widest figure that is thought of, in tenths of an inch."""

FONT_SIZES = (
    "font.size",
    "axes.titlesize",
    "axes.labelsize",
    "legend.fontsize",
    "xtick.labelsize",
    "ytick.labelsize",
)
"""Matplotlib's settings for the sizes of all text in a figure."""


def make_figure(
    image: Subject,
    wanted: Annotations,
    *,
    flat: bool,
    width: float | None,
    dpi: float | None,
    fontsize: float | None,
    ax: "Axes | None",
) -> "Figure":
    """Return an image as a figure; see `vtray.Image.figure`."""
    matplotlib = need("matplotlib", "figure", "Image.figure")
    if wanted.scalebar is True and image.scene.camera.projection == "panorama":
        wanted = replace(wanted, scalebar=False)  # it is the default, and no length is right there
    width = None if width is None else check_number("width", width)
    dpi = None if dpi is None else check_dpi(dpi)
    sizes = (
        {} if fontsize is None else dict.fromkeys(FONT_SIZES, check_number("fontsize", fontsize))
    )
    marks = find_marks(image, wanted, flat=flat)
    if ax is not None:
        _check_axes(ax, width, dpi)
    pixels = image.flat() if flat else image.pixels
    with matplotlib.rc_context(sizes):
        if ax is not None:
            Panel(ax, pixels, marks, flat=flat).settle()
            return ax.figure.figure
        sheet = Sheet.of(600, 400, LEAST_DPI)
        axes = sheet.axes(0, 0, 1, 1)
        panel = Panel(axes, pixels, marks, flat=flat)
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


def _least_width(panel: Panel, width: float) -> float:
    """Return about the least width in inches in which a panel has room.

    In a wider one a legend has more lines, and fewer columns.
    """
    tenths = math.ceil(10 * width)
    while tenths < MOST_TENTHS:
        points = INCH * tenths / 10
        if _margin(panel, _rooms_in(panel, points)) <= (1 - LEAST_SHARE) * points:
            break
        tenths = math.ceil(1.03 * tenths + 1e-9)
    return tenths / 10


def _lay_out_in_width(sheet: Sheet, panel: Panel, width: float, dpi: float | None) -> None:
    """Make a sheet of a width in inches, and as high as its panel then is.

    Without dots per inch, they are those with which each pixel of the picture is one of the sheet,
    or more.
    """
    sheet.figure.set_dpi(dpi or 300)
    points = INCH * width
    rooms = _rooms_in(panel, points)
    margin = _margin(panel, rooms)
    if margin > (1 - LEAST_SHARE) * points:
        least = _least_width(panel, width)
        message = f"width: expected at least {least:.1f} inches with this text, got {width:g}"
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


def _rooms_in(panel: Panel, points: float) -> Rooms:
    """Return the room around the picture of a panel in a sheet of a width in points."""
    _, rooms = panel.fit(points - 2 * panel.em, math.inf)
    return rooms


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
