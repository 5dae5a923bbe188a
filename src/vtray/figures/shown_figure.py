"""Matplotlib figures that show themselves in notebooks; only imported where there is Matplotlib."""

import io
from typing import Any

from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure


class ShownFigure(Figure):
    """A figure that is none of pyplot's, and still shows itself in a notebook."""

    @classmethod
    def new(cls, width: float, height: float, dpi: float, color: Any = "white") -> "ShownFigure":  # noqa: ANN401
        """Return an empty figure of a size in inches, whose parts stay where they are put."""
        figure = cls(facecolor=color)
        figure.set_layout_engine("none")
        figure.resize(width, height, dpi)
        FigureCanvasAgg(figure)
        return figure

    def resize(self, width: float, height: float, dpi: float) -> None:
        """Give the figure another size in inches, and other dots per inch."""
        self.set_dpi(dpi)
        self.set_size_inches(width, height)
        # Matplotlib saves and pickles figures with those that they began with.
        self._original_dpi = dpi

    def savefig(self, fname: Any, **options: Any) -> None:  # noqa: ANN401
        """Save the figure as large as it is, unless `options` say otherwise.

        Matplotlib's own settings for files, ``savefig.dpi`` and ``savefig.bbox``, would change the
        size that the figure was made for.
        """
        with rc_context({"savefig.dpi": "figure", "savefig.bbox": "standard"}):
            super().savefig(fname, **options)

    def _repr_png_(self) -> bytes:
        """Return the figure as a PNG, by which notebooks show it, pixel for pixel."""
        buffer = io.BytesIO()
        self.savefig(buffer, format="png")
        return buffer.getvalue()
