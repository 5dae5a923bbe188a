"""A colour bar, painted: what values colours stand for."""

from typing import Any

import numpy as np

from vtray.figures.bar_marks import marks_of, share_of
from vtray.figures.lettering import broken
from vtray.figures.painted.canvas import Canvas
from vtray.figures.painted.letters import Letters
from vtray.figures.painted.words import Words

THICK = 0.9
"""How wide the colours are, in sizes of the font."""

LEAST = 4.0
"""How long a bar is at least, in sizes of the font."""

MOST = 16.0
"""How long it is at most, where there is room."""


class PaintedColorBar:
    """A colour bar, as a block: its label above the colours, numbers on their right.

    Parameters
    ----------
    scale
        The colour scale that it shows.
    label
        What stands above it, "" for nothing.
    letters
        In which letters.
    most_wide, most_high
        What room there is for it, in pixels.
    """

    def __init__(
        self,
        scale: Any,  # noqa: ANN401
        label: str,
        letters: Letters,
        most_wide: int,
        most_high: int,
    ) -> None:
        em = letters.size
        self.scale, self.letters = scale, letters
        lines = broken(label, letters.width, most_wide) if label else []
        self.label = Words(list(lines), letters)
        self.above = self.label.height + round(0.2 * em) if lines else 0
        # Room for half a number above the colours, and half a one below.
        self.rim = letters.capital // 2 + 1
        room = most_high - self.above - 2 * self.rim
        self.length = round(min(max(room, LEAST * em), MOST * em))
        self.thick, self.tick = round(THICK * em), max(2, round(0.25 * em))
        self.line = max(1, round(0.06 * em))
        self.marks = marks_of(scale, max(1, min(6, self.length // (2 * em))))
        self.indent = self.thick + self.tick + round(0.3 * em)
        numbers = max((letters.width(text) for _, text in self.marks), default=0)
        self.width = max(self.label.width, self.indent + numbers)
        self.height = self.above + self.length + 2 * self.rim

    def paint(self, canvas: Canvas, left: int, top: int) -> None:
        """Paint it where its rectangle begins."""
        ink = canvas.ink(left, top, self.width, self.height)
        if self.label.lines:
            self.label.write(canvas, left, top, ink)
        top += self.above + self.rim
        line, thick, length = self.line, self.thick, self.length
        canvas.rectangle(left, top, thick, length, ink.color)
        inside = length - 2 * line
        colors = np.repeat(self._colors(inside)[:, None], thick - 2 * line, axis=1)
        canvas.rectangle(left + line, top + line, thick - 2 * line, inside, colors)
        for value, text in self.marks:
            y = top + line + round((1.0 - share_of(self.scale, value)) * (inside - 1))
            canvas.rectangle(left + thick, y - line // 2, self.tick, line, ink.color)
            baseline = y + (self.letters.capital + 1) // 2
            canvas.write(self.letters, text, left + self.indent, baseline, ink)

    def _colors(self, count: int) -> Any:  # noqa: ANN401
        """Return the colours of so many rows, the highest value first, (count, 3)."""
        table = self.scale.table
        if self.scale.low == self.scale.high:
            return np.repeat(self.scale.colors([self.scale.low]), count, axis=0)
        rows = ((np.arange(count) + 0.5) / count * len(table)).astype(np.intp)
        return table[rows[::-1]]
