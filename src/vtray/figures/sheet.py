"""A figure whose parts are placed to the pixel."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from vtray.base.errors import VtrayError
from vtray.base.number import number_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from vtray.figures.shown_figure import ShownFigure

LARGEST = 10_000
"""What no size of a figure, in any unit, is larger than."""

LEAST_WIDTH = 300
"""Pictures narrower than this are shown with each pixel as a square of pixels."""

USUAL_INCHES = 6.5
"""How wide a picture is in print, unless its resolution would be below `LEAST_DPI`."""

LEAST_DPI = 100.0
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

    figure: "ShownFigure"
    width: int
    height: int

    @classmethod
    def of(cls, width: int, height: int, dpi: float) -> "Sheet":
        """Return an empty white sheet."""
        from matplotlib import rcParams

        from vtray.figures.shown_figure import ShownFigure

        color = rcParams["figure.facecolor"]
        sheet = cls(ShownFigure.new(1, 1, dpi, color), width, height)
        sheet.resize(width, height, dpi)
        return sheet

    def resize(self, width: int, height: int, dpi: float, inches: float = 0.0) -> None:
        """Give the sheet another size in pixels, and at least `inches` of width."""
        self.width, self.height = width, height
        self.figure.resize(max(_inches(width, dpi), inches), _inches(height, dpi), dpi)

    def place(self, left: float, bottom: float) -> tuple[float, float]:
        """Return a place given in pixels in parts of the figure."""
        return left / self.figure.bbox.width, bottom / self.figure.bbox.height

    def parts(
        self, left: float, bottom: float, width: float, height: float
    ) -> tuple[float, float, float, float]:
        """Return a rectangle given in pixels in parts of the figure."""
        return *self.place(left, bottom), *self.place(width, height)

    def axes(self, left: float, bottom: float, width: float, height: float) -> "Axes":
        """Add axes at a place given in pixels."""
        return self.figure.add_axes(self.parts(left, bottom, width, height))

    def picture(self, pixels: NDArray[Any], left: int, bottom: int, zoom: int) -> "Axes":
        """Add a picture, each of its pixels a square of zoom x zoom pixels."""
        from vtray.figures.shown_picture import ShownPicture

        height, width = pixels.shape[:2]
        axes = self.axes(*whole_pixels(left, bottom, width * zoom, height * zoom))
        ShownPicture.on(axes, pixels)
        return axes


def whole_pixels(
    left: float, bottom: float, width: float, height: float
) -> tuple[float, float, float, float]:
    """Return the rectangle of whole pixels that is nearest to one.

    It is a hair smaller: for one that is larger, Matplotlib may take a pixel more, and stretch the
    picture to that.
    """
    least = 1e-9
    width, height = max(round(width), 1), max(round(height), 1)
    return round(left) + least, round(bottom) + least, width - 2 * least, height - 2 * least


def picture_zoom(width: int) -> int:
    """Return how many pixels of a figure show one of a picture, across and down."""
    return max(1, math.ceil(LEAST_WIDTH / width))


def usual_dpi(width: int) -> float:
    """Return the dots per inch with which a picture of this width has a usual size."""
    return max(LEAST_DPI, round(width / USUAL_INCHES))


def check_number(name: str, value: float, least: float | None = None) -> float:
    """Return a number that must be at least `least`, or above 0, and no more than `LARGEST`.

    Raises
    ------
    FigureError
        It is not.
    """
    number = number_of(value)
    if not (math.isfinite(number) and (number > 0 if least is None else number >= least)):
        wanted = "> 0" if least is None else f"≥ {least:g}"
        message = f"{name}: expected a number {wanted}, or None, got {value!r}"
        raise FigureError(message)
    if number > LARGEST:
        message = f"{name}: expected at most {LARGEST}, got {value!r}"
        raise FigureError(message)
    return number


def check_dpi(dpi: float) -> float:
    """Return dots per inch that are possible."""
    return check_number("dpi", dpi, 1)


def _inches(pixels: int, dpi: float) -> float:
    """Return the length of so many pixels: of all that are, one that is not rounded down."""
    inches = pixels / dpi
    while int(inches * dpi) < pixels:
        inches = math.nextafter(inches, math.inf)
    return inches
