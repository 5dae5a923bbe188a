"""A picture on axes, with what belongs to it: a title, colour bars, a legend, a scale bar."""

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from numpy.typing import NDArray

from vtray.figures.annotations import Marks
from vtray.figures.color_bar import ColorBar
from vtray.figures.lettering import write
from vtray.figures.scale_bar import ScaleBar
from vtray.figures.sheet import INCH, whole_pixels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.backend_bases import RendererBase
    from matplotlib.gridspec import SubplotSpec
    from matplotlib.transforms import Bbox

LEAST_SHARE = 0.1
"""Of the width of all, the share that the picture has at least."""

TITLE_SHARE = 0.4
"""Of the height of axes, the share that a title has at most; it gets smaller to keep it."""


LEGEND_SHARE = 0.4
"""Of the width of all, the share that a legend should have at most: its names are broken for it."""

LEAST_SIZE = 3.0
"""The least size of a title, in points."""

ABOUT = r"${\approx}$ "
"""What stands before a length that is right at one distance only."""


class Rooms(NamedTuple):
    """How much room there must be around a picture, in points.

    Attributes
    ----------
    beside
        On the right of each colour bar, for its marks and label.
    right, below, above
        On these sides of the picture.
    """

    beside: tuple[float, ...]
    right: float
    below: float
    above: float


class Panel:
    """A picture on axes: colour bars and a legend on its right, a title above, a scale bar below.

    All sizes but that of the picture follow from the font. As the locator of axes, which Matplotlib
    calls whenever it draws them, it keeps all of it within the place that the axes had.

    Parameters
    ----------
    ax
        The axes of the picture; those of the bars are added to their figure.
    pixels
        The picture, uint8, (height, width, 3 or 4).
    marks
        What belongs to it; labels and the triad are drawn onto it.
    flat
        Whether the colour bars show each colour from shadow to light.
    """

    def __init__(
        self,
        ax: "Axes",
        pixels: NDArray[Any],
        marks: Marks,
        *,
        flat: bool,
    ) -> None:
        from matplotlib import rcParams

        from vtray.figures.drawn_legend import DrawnLegend
        from vtray.figures.drawn_marks import draw_labels, draw_triad
        from vtray.figures.shown_picture import ShownPicture

        self.ax, self.bar = ax, marks.scale_bar
        self.words = "\n".join(text for text in (marks.title, marks.caption) if text)
        self.rows, self.columns = pixels.shape[:2]
        self.em = float(rcParams["font.size"])
        self.fitted: tuple[object, tuple[float, Rooms]] = (None, (0.0, Rooms((), 0.0, 0.0, 0.0)))
        self.outer = ax.get_axes_locator()
        if isinstance(self.outer, Panel):  # what was drawn on these axes before
            self.outer.remove()
            self.outer = self.outer.outer
        self.shown = ShownPicture.on(ax, pixels)
        self.parts: list[Any] = [self.shown]
        self.bars: list[ColorBar] = []
        if marks.scales:
            figure = ax.figure
            current = figure.gca()
            for scale, label in zip(marks.scales, marks.bar_labels, strict=True):
                axes = figure.add_axes((0.9, 0.1, 0.05, 0.8))
                self.bars.append(ColorBar.draw(axes, scale, label, flat=flat))
            figure.sca(current)
        self.parts += [bar.axes for bar in self.bars]
        self.gap = 1.4 * self.em
        self.thick = max([1.2 * self.em, *(bar.least_width() for bar in self.bars)])
        self.title: Any = None
        if self.words:
            self.title = ax.set_title(
                self.words, loc="left", y=1.0, pad=0.35 * self.em, va="bottom"
            )
            self.title_size = float(self.title.get_fontsize())
        self.note: Any = None
        if self.bar is not None:
            self._draw_scale_bar(self.bar)
        self.legend = DrawnLegend(ax, marks.legend, flat=flat) if marks.legend else None
        self.parts += draw_labels(ax, pixels, marks.labels)
        if marks.triad:
            self.parts += draw_triad(ax, pixels, marks.triad)

    def _draw_scale_bar(self, bar: ScaleBar) -> None:
        """Draw a scale bar below the picture, where it hides nothing."""
        from matplotlib import rcParams
        from matplotlib.lines import Line2D
        from matplotlib.transforms import ScaledTranslation, blended_transform_factory

        ax, em = self.ax, self.em
        inches = ax.figure.dpi_scale_trans
        below = blended_transform_factory(ax.transData, ax.transAxes)
        self.note = ax.text(
            bar.pixels - 0.5,
            0.0,
            "",
            fontsize=rcParams["xtick.labelsize"],
            va="top",
            transform=below + ScaledTranslation(0.6 * em / INCH, -0.5 * em / INCH, inches),
        )
        self.note.set_gid("scale bar label")
        self.note_size = float(self.note.get_fontsize())
        self.note.set_text("0")
        drop = 0.5 * em + self.note.get_window_extent().height / self._point / 2
        color = rcParams["text.color"]
        ends = (-0.5, bar.pixels - 0.5)
        line = Line2D(ends, (0.0, 0.0), lw=0.16 * em, color=color, solid_capstyle="butt")
        line.set_gid("scale bar")
        caps = Line2D(
            ends, (0.0, 0.0), ls="none", marker="|", ms=0.64 * em, mew=0.1 * em, color=color
        )
        for part in (line, caps):
            part.set_transform(below + ScaledTranslation(0.0, -drop / INCH, inches))
            part.set_clip_on(False)
            ax.add_artist(part)
        self.parts += [self.note, line, caps]

    def remove(self) -> None:
        """Take all of it off the axes, which go back to their place."""
        for part in self.parts:
            if part.figure is not None:  # else the axes were cleared
                part.remove()
        if self.legend is not None:
            self.legend.remove()
        if self.title is not None:
            self.title.set_text("")
        self.ax.set_axes_locator(self.outer)

    def rooms(
        self,
        width: float,
        height: float,
        renderer: "RendererBase | None" = None,
        most_above: float = math.inf,
        most_beside: float | None = None,
    ) -> Rooms:
        """Write all text for a picture of this size; return the room that it takes.

        Parameters
        ----------
        width, height
            Of the picture, in points.
        most_above
            How much room there is for the title, in points.
        most_beside
            How wide a column of the legend should be at the most, in points; None for what goes
            with the picture.
        renderer
            What draws, None for that of the figure.
        """
        ax, point = self.ax, self._point
        beside = tuple(self._up(bar.beside(height, renderer)) for bar in self.bars)
        right = sum(self.gap + self.thick + text for text in beside)
        high = 0.0
        if self.legend is not None:
            most = (
                LEGEND_SHARE / (1.0 - LEGEND_SHARE) * width if most_beside is None else most_beside
            )
            wide, high = self.legend.fit(max(height, self.em), most, renderer)
            self.legend.move(right + self.gap)
            right += self.gap + self._up(wide)
        over = max((bar.overhang(height, renderer) for bar in self.bars), default=0.0)
        above = over
        if self.words:
            room = width if over else width + right  # not above labels that stick out
            above = max(over, self._write_title(room, most_above, renderer))
        marks = max((bar.below(renderer) for bar in self.bars), default=0.0)
        below = max(marks, over, high - height)
        if self.bar is not None:
            room = width + (0.0 if marks else right)
            room -= self.bar.pixels * width / self.columns + 0.6 * self.em
            text = ABOUT * bool(self.bar.note) + self.bar.text
            write(self.note, text, self.note_size, max(room, self.em) * point, renderer)
            bottom = self.note.get_window_extent(renderer).y0
            below = max(below, (ax.bbox.y0 - bottom) / point)
        return Rooms(beside, right, self._up(below), self._up(above))

    def _write_title(self, room: float, most: float, renderer: "RendererBase | None") -> float:
        """Write the title in lines of some length; return how high it is, all in points."""
        size = self.title_size
        while True:
            write(self.title, self.words, size, room * self._point, renderer)
            top = self.title.get_window_extent(renderer).y1
            above = float(top - self.ax.bbox.y1) / self._point
            if above <= most or size < LEAST_SIZE:
                return above
            # Lines get lower and hold more.
            size *= min(0.95, math.sqrt(max(most, 0.0) / above))

    def fit(
        self, width: float, height: float, renderer: "RendererBase | None" = None
    ) -> tuple[float, Rooms]:
        """Find the largest picture that has room with all the rest.

        Parameters
        ----------
        width, height
            What there is for all of it, in points.
        renderer
            What draws, None for that of the figure.

        Returns
        -------
        zoom, rooms
            The size of a pixel of the picture in points, and the room around the picture.
        """
        zoom = min(width / self.columns, height / self.rows)
        # Where text has less room, it takes more lines: the picture gets smaller until all fits.
        for _ in range(8):
            wide, high = zoom * self.columns, zoom * self.rows
            most = TITLE_SHARE * height, LEGEND_SHARE * width
            rooms = self.rooms(wide, high, renderer, *most)
            across = max(width - rooms.right, LEAST_SHARE * width)
            down = max(height - rooms.below - rooms.above, LEAST_SHARE * height)
            largest = min(across / self.columns, down / self.rows)
            if largest >= zoom * (1 - 1e-6):
                break
            zoom = largest
        return min(zoom, largest), rooms

    def place(self, box: "Bbox", rooms: Rooms, *, whole: bool) -> "list[Bbox]":
        """Return where the picture and the colour bars are, all in pixels of the figure.

        Parameters
        ----------
        box
            The place of the picture.
        rooms
            The room around it.
        whole
            Whether to put them on whole pixels.
        """
        from matplotlib.transforms import Bbox

        boxes, left = [box], box.x1
        for beside in rooms.beside:
            left += self.gap * self._point
            boxes.append(Bbox.from_bounds(left, box.y0, self.thick * self._point, box.height))
            left += (self.thick + beside) * self._point
        if not whole:
            return boxes
        return [Bbox.from_bounds(*whole_pixels(*b.bounds)) for b in boxes]

    def settle(self) -> None:
        """Keep the panel within the place of its axes from now on."""
        for axes in self.all_axes():
            axes.set_axes_locator(self)

    def __call__(self, axes: Any, renderer: Any) -> "Bbox":  # noqa: ANN401
        """Return where the picture or a colour bar is, in parts of the figure."""
        from matplotlib.transforms import Bbox

        if None in {self.ax.figure, self.shown.figure}:  # removed or cleared
            axes.set_visible(axes is self.ax)
            return Bbox(axes.get_position(original=True).get_points())
        figure, point = self.ax.figure, self._point
        outer = self.ax.get_position(original=True)
        if self.outer is not None:
            outer = self.outer(self.ax, renderer)
        cell = Bbox(outer.get_points()).transformed(figure.transSubfigure)
        whole = renderer is None or not renderer.option_scale_image()
        wanted = (round(cell.width, 3), round(cell.height, 3), point, whole)
        if self.fitted[0] != wanted:  # Matplotlib asks several times for each time it draws
            self.fitted = wanted, self.fit(cell.width / point, cell.height / point, renderer)
        zoom, rooms = self.fitted[1]
        width, height = zoom * self.columns, zoom * self.rows
        block = Bbox.from_bounds(
            0,
            0,
            (width + rooms.right) * point,
            (height + rooms.below + rooms.above) * point,
        )
        anchor: Any = self.ax.get_anchor()
        block = block.anchored(anchor, cell)
        picture = Bbox.from_bounds(
            block.x0, block.y0 + rooms.below * point, width * point, height * point
        )
        boxes = self.place(picture, rooms, whole=whole)
        # Matplotlib may name the axes around these instead.
        which = self.all_axes().index(axes) if axes in self.all_axes() else 0
        return boxes[which].transformed(figure.transSubfigure.inverted())

    def get_subplotspec(self) -> "SubplotSpec | None":
        """Return the place of the axes in a grid, by which Matplotlib's tight layout finds it."""
        return self.ax.get_subplotspec()

    def all_axes(self) -> "list[Axes]":
        """Return the axes of the picture and of the colour bars."""
        return [self.ax, *(bar.axes for bar in self.bars)]

    @property
    def _point(self) -> float:
        """How many pixels a point is."""
        return float(self.ax.figure.dpi) / INCH

    def _up(self, length: float) -> float:
        """Round a length up to half an em, so that panels alike are of the same size.

        A tenth of an em more, as a formula may be higher than letters, makes no difference.
        """
        return math.ceil(2 * length / self.em - 0.2) * self.em / 2
