"""A legend, painted: a small ball and a name in each line."""

import math
from collections.abc import Sequence

from vtray.figures.legend import Entry, ball
from vtray.figures.painted.canvas import Canvas
from vtray.figures.painted.cover import Cover
from vtray.figures.painted.letters import Letters

PITCH = 1.5
"""From one line to the next, in sizes of the font."""


class PaintedLegend:
    """A legend, as a block.

    Parameters
    ----------
    entries
        Its lines.
    letters
        In which letters names are written.
    most
        How high it is at the most, in pixels; if its lines need more, they stand in columns.
    """

    def __init__(self, entries: Sequence[Entry], letters: Letters, most: int) -> None:
        self.letters = letters
        em = letters.size
        self.pitch, self.ball = round(PITCH * em), round(1.1 * em)
        self.indent, gap = self.ball + round(0.45 * em), round(1.2 * em)
        fits = max(1, (most - self.ball) // self.pitch + 1)
        # As many columns as needed, all about as long.
        count = math.ceil(len(entries) / fits)
        rows = math.ceil(len(entries) / count)
        self.columns = [entries[k : k + rows] for k in range(0, len(entries), rows)]
        widths = [
            self.indent + max(letters.width(entry.name) for entry in column)
            for column in self.columns
        ]
        self.starts = [sum(widths[:k]) + k * gap for k in range(len(widths))]
        self.width = self.starts[-1] + widths[-1]
        self.height = (rows - 1) * self.pitch + self.ball

    def paint(self, canvas: Canvas, left: int, top: int) -> None:
        """Paint it where its rectangle begins."""
        ink = canvas.ink(left, top, self.width, self.height)
        drop = (self.ball + self.letters.capital) // 2
        for start, column in zip(self.starts, self.columns, strict=True):
            for k, entry in enumerate(column):
                x, y = left + start, top + k * self.pitch
                picture = ball(entry.color, self.ball)
                canvas.blend(Cover(x, y, picture[..., 3]), picture[..., :3])
                canvas.write(self.letters, entry.name, x + self.indent, y + drop, ink)
