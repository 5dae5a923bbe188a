"""Matplotlib figures that show themselves in notebooks; only imported where there is Matplotlib."""

import io

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure


class ShownFigure(Figure):
    """A figure that is none of pyplot's, and still shows itself in a notebook."""

    @classmethod
    def new(cls, width: float, height: float, dpi: float) -> "ShownFigure":
        """Return an empty white figure of a size in inches."""
        figure = cls(figsize=(width, height), dpi=dpi, facecolor="white")
        FigureCanvasAgg(figure)
        return figure

    def _repr_png_(self) -> bytes:
        """Return the figure as a PNG, by which notebooks show it, pixel for pixel."""
        buffer = io.BytesIO()
        self.savefig(buffer, format="png", dpi="figure")
        return buffer.getvalue()
