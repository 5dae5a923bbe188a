"""A legend beside a picture on axes; only imported where there is Matplotlib."""

import math
from typing import Any, NamedTuple

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.image import BboxImage
from matplotlib.legend import Legend
from matplotlib.legend_handler import HandlerBase
from matplotlib.transforms import Bbox, ScaledTranslation, TransformedBbox

from vtray.figures.legend import Entry, ball
from vtray.figures.lettering import longest_word, write
from vtray.figures.sheet import INCH
from vtray.scene.colors.names import Rgb

SIDE = 1.1
"""The size of balls, in sizes of the font."""

PAD = 0.5
"""From a ball to its name, in sizes of the font."""

PIXELS = 96
"""The pixels of a ball, across and down: enough for letters of 10 points at 600 dots per inch."""


class _Ball(NamedTuple):
    """What a ball of the legend looks like."""

    color: Rgb
    flat: bool


class _Handler(HandlerBase):  # type: ignore[misc, unused-ignore]
    """Draws a ball in a line of a legend."""

    def create_artists(
        self,
        legend: Legend,  # noqa: ARG002
        orig_handle: Any,  # noqa: ANN401
        xdescent: float,
        ydescent: float,
        width: float,
        height: float,
        fontsize: float,
        trans: Any,  # noqa: ANN401
    ) -> list[Artist]:
        """Return the ball, as a picture."""
        side = SIDE * fontsize
        box = Bbox.from_bounds(
            -xdescent + (width - side) / 2, -ydescent + (height - side) / 2, side, side
        )
        picture = BboxImage(TransformedBbox(box, trans), interpolation="antialiased")
        picture.set_data(ball(orig_handle.color, PIXELS, flat=orig_handle.flat))
        return [picture]


class DrawnLegend:
    """A legend on the right of axes, from their upper edge down.

    Parameters
    ----------
    ax
        The axes.
    entries
        Its lines.
    flat
        Whether its balls are those of a flat picture.
    """

    def __init__(self, ax: Axes, entries: list[Entry], *, flat: bool) -> None:
        self.ax, self.entries = ax, entries
        self.handles: Any = [_Ball(entry.color, flat) for entry in entries]
        self.artist: Legend | None = None
        self.count, self.shift = 0, 0.0
        self._draw(1)

    def fit(
        self, height: float, room: float, renderer: RendererBase | None = None
    ) -> tuple[float, float]:
        """Set it in as many columns as a height needs; return its width and height, in points.

        Names that are longer than there is room for in a column are broken at spaces.
        """
        self._draw(1)
        self._write(room, renderer)
        line = self._size(renderer)[1] / len(self.entries)
        fits = max(1, math.floor(height / line + 0.1))
        self._draw(math.ceil(len(self.entries) / fits))
        self._write(room, renderer)
        return self._size(renderer)

    def _write(self, room: float, renderer: RendererBase | None) -> None:
        """Write its names in lines, given the width of a column in points."""
        assert self.artist is not None  # noqa: S101
        for text, entry in zip(self.artist.get_texts(), self.entries, strict=True):
            size = float(text.get_fontsize())
            beside = (room - (SIDE + PAD) * size) * self._point
            longest = longest_word(text, entry.name, renderer)
            write(text, entry.name, size, max(beside, longest), renderer)

    def move(self, shift: float) -> None:
        """Put it so many points to the right of the axes."""
        self.shift = shift
        assert self.artist is not None  # noqa: S101
        inches = self.ax.figure.dpi_scale_trans
        place = self.ax.transAxes + ScaledTranslation(shift / INCH, 0.0, inches)
        self.artist.set_bbox_to_anchor((1.0, 1.0), place)

    def remove(self) -> None:
        """Take it off the axes."""
        if self.artist is not None and self.artist.figure is not None:  # else axes were cleared
            self.artist.remove()
        self.artist = None

    def _draw(self, count: int) -> None:
        """Set it in so many columns."""
        if self.artist is not None and self.count == count:
            return
        self.remove()
        self.count = count
        self.artist = Legend(
            self.ax,
            self.handles,
            [entry.name for entry in self.entries],
            handler_map={_Ball: _Handler()},
            ncols=count,
            loc="upper left",
            frameon=False,
            borderpad=0.0,
            borderaxespad=0.0,
            handlelength=SIDE,
            handleheight=SIDE,
            handletextpad=PAD,
            labelspacing=0.4,
            columnspacing=1.2,
        )
        self.artist.set_gid("legend")
        self.ax.add_artist(self.artist)
        self.move(self.shift)

    def _size(self, renderer: RendererBase | None) -> tuple[float, float]:
        """Return its width and height in points."""
        assert self.artist is not None  # noqa: S101
        box = self.artist.get_window_extent(renderer)
        return float(box.width) / self._point, float(box.height) / self._point

    @property
    def _point(self) -> float:
        """How many pixels a point is."""
        return float(self.ax.figure.dpi) / INCH
