"""The marks that a drawing of rays is made of."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.figures.scale_bar import length_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

FONT_SIZE = 8.5
"""Of notes, in points."""

INK, FAINT, RAY, LIT, BLOCKED = "#22262b", "#8b9199", "#1f5fa8", "#e39b00", "#c23b3b"


class Pen:
    """Draws marks on axes, at places in their coordinates."""

    def __init__(self, ax: "Axes") -> None:
        self.ax = ax

    def line(
        self,
        start: Floats,
        end: Floats,
        color: str,
        *,
        arrow: float | None = None,
        **style: Any,  # noqa: ANN401
    ) -> None:
        """Draw a straight line, with an arrow head at a part of its length if wanted."""
        self.ax.plot(*np.array([start, end]).T, color=color, zorder=5, **style)
        if arrow is not None:
            self.arrow(start, start + arrow * (end - start), color, lw=0)

    def lines(
        self,
        start: Floats,
        ends: Floats,
        color: str,
        style: str | tuple[float, tuple[float, ...]],
        alpha: Floats,
    ) -> None:
        """Draw thin lines from one place to many, (n, 2), each with an opacity of its own, (n,)."""
        from matplotlib.collections import LineCollection

        segments = np.stack([np.broadcast_to(start, ends.shape), ends], axis=1)
        lines = LineCollection(list(segments), colors=color, linewidths=0.7, linestyles=[style])
        lines.set(alpha=alpha if len(alpha) else None, zorder=4.5)
        self.ax.add_collection(lines, autolim=False)

    def arrow(self, start: Floats, tip: Floats, color: str, lw: float) -> None:
        """Draw an arrow, whose shaft has the width `lw`."""
        shape = {"arrowstyle": "-|>", "color": color, "lw": lw, "mutation_scale": 14}
        shape |= {"shrinkA": 0, "shrinkB": 0}
        self.ax.annotate("", tuple(tip), tuple(start), arrowprops=shape, zorder=7)

    def note(
        self,
        text: str,
        place: Floats,
        shift: tuple[float, float],
        *,
        color: str = INK,
        **style: Any,  # noqa: ANN401
    ) -> None:
        """Write beside a place, legible on whatever is there."""
        from matplotlib.patheffects import withStroke

        self.ax.annotate(
            text,
            (float(place[0]), float(place[1])),
            shift,
            textcoords="offset points",
            fontsize=FONT_SIZE,
            color=color,
            path_effects=[withStroke(linewidth=2.5, foreground="white", alpha=0.9)],
            zorder=10,
            annotation_clip=False,
            **style,
        )

    def width(self, text: str) -> float:
        """Return how wide a note is in the coordinates of the axes."""
        label = self.ax.text(0, 0, text, fontsize=FONT_SIZE)
        pixels = label.get_window_extent().width
        label.remove()
        low, high = self.ax.get_xlim()
        return float(pixels / self.ax.bbox.width * (high - low))

    def sun(self, place: Floats, color: str, size: float) -> None:
        """Draw a light."""
        self.ax.plot(*place, marker=(12, 1, 0), ms=17 * size, mfc=color, mec="none", zorder=7)
        self.ax.plot(*place, "o", ms=8 * size, mfc="#fff3cf", mec=color, mew=1.2 * size, zorder=8)

    def ball(self, place: Floats, radius: float, color: str, alpha: float) -> None:
        """Draw a light that is a ball."""
        from matplotlib.patches import Circle

        inside = Circle(tuple(place), radius, fc="#fff3cf", ec="none", alpha=0.6, zorder=0.5)
        edge = Circle(tuple(place), radius, fill=False, ec=color, lw=1.2, alpha=alpha, zorder=6)
        self.ax.add_patch(inside)
        self.ax.add_patch(edge)

    def panel(self, corners: Floats, color: str, alpha: float) -> None:
        """Draw a light that is a rectangle, of which these are the corners, (4, 2)."""
        from matplotlib.patches import Polygon

        inside = Polygon(corners, fc="#fff3cf", ec="none", alpha=0.6, zorder=0.5)
        edge = Polygon(corners, fill=False, ec=color, lw=1.2, alpha=alpha, zorder=6)
        self.ax.add_patch(inside)
        self.ax.add_patch(edge)

    def scale(self, start: float, length: float) -> None:
        """Draw a scale bar below the axes, from `start` in their coordinates."""
        transform = self.ax.get_xaxis_transform()
        self.ax.plot(
            [start, start + length],
            [-0.03] * 2,
            color=INK,
            lw=2,
            transform=transform,
            clip_on=False,
            solid_capstyle="butt",
        )
        self.ax.text(
            start + length / 2,
            -0.04,
            length_text(length),
            transform=transform,
            ha="center",
            va="top",
            fontsize=8,
            color=INK,
        )
