"""Labels and the triad on a picture on axes; only imported where there is Matplotlib."""

from typing import Any

import numpy as np
from matplotlib import rcParams
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke
from matplotlib.text import Text
from matplotlib.transforms import Affine2D, ScaledTranslation, Transform

from vtray.figures.ink import HALO, Ink, Pixels, Rgb, ink_on
from vtray.figures.point_labels import Label
from vtray.figures.sheet import INCH
from vtray.figures.triad import CAPITAL, LETTER, Arm, arrow, extent, name_places

MARGIN = 0.9
"""From the corner of the picture to the triad, in sizes of the font."""

HALO_WIDTH = 0.18
"""How wide the line around letters is that sets them off, both sides together."""

AROUND = 0.03
"""What part of the picture around a mark says whether it is dark there."""


class InnerText(Text):  # type: ignore[misc, unused-ignore]
    """A text around a point of axes which stays within them."""

    def draw(self, renderer: RendererBase) -> None:
        """Draw it, moved into the axes where it would stick out."""
        x, y = self.get_position()
        axes: Any = self.axes
        halo = HALO_WIDTH * float(self.get_fontsize()) * axes.figure.dpi / INCH
        box, area = self.get_window_extent(renderer), axes.bbox.padded(-halo)
        shift = [
            max(low - start, 0.0) + min(high - end, 0.0)
            for start, end, low, high in zip(box.min, box.max, area.min, area.max, strict=True)
        ]
        place = self.get_transform().transform((x, y)) + shift
        inner = self.get_transform().inverted().transform(place)
        self.set_position((float(inner[0]), float(inner[1])))
        super().draw(renderer)
        self.set_position((x, y))


def draw_labels(ax: Axes, pixels: Pixels, labels: list[Label]) -> list[Artist]:
    """Draw labels on a picture, whose pixels are the coordinates of the axes."""
    return [
        ax.add_artist(
            _text(
                label.text,
                (label.column, label.row),
                ax.transData,
                _ink_at(pixels, label.column, label.row),
                InnerText,
            )
        )
        for label in labels
    ]


def draw_triad(ax: Axes, pixels: Pixels, arms: list[Arm]) -> list[Artist]:
    """Draw axes in the lower left corner of a picture."""
    height, width = pixels.shape[:2]
    ink = _ink_at(pixels, AROUND * width, height - AROUND * height)
    em = float(rcParams["font.size"])
    low, high = extent(arms, [LETTER * len(arm.name) for arm in arms], CAPITAL)
    origin = em * np.array([MARGIN - low[0], MARGIN + high[1]])
    inches: Any = ax.figure.dpi_scale_trans
    axes: Any = ax.transAxes
    corner = ScaledTranslation(0.0, 0.0, axes)
    place = Affine2D().scale(em, -em).translate(*origin).scale(1 / INCH) + inches + corner
    halo, shapes = _floats(ink.halo), [(part, arm.color) for arm in arms for part in arrow(arm)]
    drawn = [
        Polygon(part, fc=halo, ec=halo, lw=HALO_WIDTH * em, transform=place) for part, _ in shapes
    ]
    drawn += [
        Polygon(part, fc=_floats(color), ec="none", transform=place) for part, color in shapes
    ]
    names = [
        _text(arm.name, middle, place, ink, Text)
        for arm, middle in zip(arms, name_places(arms), strict=True)
    ]
    return [ax.add_artist(part) for part in (*drawn, *names)]


def _text(
    text: str, middle: tuple[float, float], place: Transform, ink: Ink, kind: type[Text]
) -> Text:
    """Return a text around a point, with a halo."""
    em = float(rcParams["font.size"])
    halo = withStroke(linewidth=HALO_WIDTH * em, foreground=_floats(ink.halo), alpha=HALO)
    return kind(
        *middle,
        text,
        fontsize=em,
        color=_floats(ink.color),
        ha="center",
        va="center",
        transform=place,
        path_effects=[halo],
        zorder=10,
        clip_on=False,
    )


def _ink_at(pixels: Pixels, column: float, row: float) -> Ink:
    """Return what to write with around a place of a picture."""
    height, width = pixels.shape[:2]
    reach = max(1, round(AROUND * min(height, width)))
    left, top = max(int(column) - reach, 0), max(int(row) - reach, 0)
    return ink_on(pixels[top : int(row) + reach + 1, left : int(column) + reach + 1])


def _floats(color: Rgb) -> tuple[float, float, float]:
    """Return a colour as Matplotlib takes it."""
    red, green, blue = color
    return red / 255.0, green / 255.0, blue / 255.0
