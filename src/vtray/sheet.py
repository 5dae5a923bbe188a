"""A figure whose parts are placed to the pixel."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.errors import VtrayError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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

    figure: "Figure"
    width: int
    height: int

    @classmethod
    def of(cls, width: int, height: int, dpi: float) -> "Sheet":
        """Return an empty white sheet."""
        from vtray.shown_figure import ShownFigure

        # A hair more, so that Agg does not round a pixel away.
        figure = ShownFigure.new((width + 0.01) / dpi, (height + 0.01) / dpi, dpi)
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


def check_dpi(dpi: float) -> float:
    """Return dots per inch that are possible."""
    if not (isinstance(dpi, (int, float, np.number)) and math.isfinite(dpi) and dpi >= 1):
        message = f"dpi: expected a number ≥ 1, or None, got {dpi!r}"
        raise FigureError(message)
    return float(dpi)
