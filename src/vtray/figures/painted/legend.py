"""A legend, painted: a small ball and a name in each line."""

import math
from collections.abc import Sequence

from vtray.figures.legend import Entry, ball
from vtray.figures.lettering import broken
from vtray.figures.painted.canvas import Canvas
from vtray.figures.painted.cover import Cover
from vtray.figures.painted.letters import Letters

PITCH = 1.5
"""From one name to the next, in sizes of the font."""


class PaintedLegend:
    """A legend, as a block.

    Parameters
    ----------
    entries
        Its lines.
    letters
        In which letters names are written.
    most
        How high it is at the most, in pixels; if its names need more, they stand in columns.
    room
        How wide it should be at the most, in pixels: longer names are broken at spaces.
    widest
        How wide it may be where that does not do, over what is shown.
    """

    def __init__(
        self, entries: Sequence[Entry], letters: Letters, most: int, room: int, widest: int
    ) -> None:
        self.letters = letters
        em = letters.size
        self.pitch, self.ball = round(PITCH * em), round(1.1 * em)
        self.indent, self.gap = self.ball + round(0.45 * em), round(1.2 * em)
        words = (word for entry in entries for word in entry.name.split())
        longest = max(room - self.indent, *map(letters.width, words))
        in_lines = [
            entry._replace(name="\n".join(broken(entry.name, letters.width, longest)))
            for entry in entries
        ]
        layouts = [self._in_columns(names, most) for names in (in_lines, entries)]
        fitting = [columns for columns in layouts if self._size(columns)[1] <= most]
        # Beside what is shown, or over as little of it as can be.
        sizes = [self._size(columns) for columns in fitting]
        order = [(wide > widest, wide > room, wide * high) for wide, high in sizes]
        self.columns = fitting[order.index(min(order))] if fitting else layouts[-1]
        widths = self._widths(self.columns)
        self.starts = [sum(widths[:k]) for k in range(len(widths))]
        self.width, self.height = self._size(self.columns)

    def _in_columns(self, entries: Sequence[Entry], most: int) -> list[list[Entry]]:
        """Return names in as many columns as their height needs, all about as long."""
        for count in range(1, len(entries) + 1):
            rows = math.ceil(len(entries) / count)
            columns = [list(entries[k : k + rows]) for k in range(0, len(entries), rows)]
            if self._size(columns)[1] <= most:
                break
        return columns

    def _size(self, columns: Sequence[Sequence[Entry]]) -> tuple[int, int]:
        """Return width and height of columns, in pixels."""
        return sum(self._widths(columns)) - self.gap, max(map(self._height, columns))

    def _widths(self, columns: Sequence[Sequence[Entry]]) -> list[int]:
        """Return how wide columns are with the gap after each, in pixels."""
        return [
            self.indent
            + max(self.letters.width(line) for entry in column for line in entry.name.split("\n"))
            + self.gap
            for column in columns
        ]

    def _height(self, column: Sequence[Entry]) -> int:
        """Return the height of a column of names, in pixels."""
        return sum(map(self._step, column)) - self.pitch + self.ball

    def _step(self, entry: Entry) -> int:
        """Return how far it is from a name to the next, in pixels."""
        return self.pitch + entry.name.count("\n") * self.letters.line

    def paint(self, canvas: Canvas, left: int, top: int) -> None:
        """Paint it where its rectangle begins."""
        ink = canvas.ink(left, top, self.width, self.height)
        drop = (self.ball + self.letters.capital) // 2
        for start, column in zip(self.starts, self.columns, strict=True):
            x, y = left + start, top
            for entry in column:
                picture = ball(entry.color, self.ball)
                canvas.blend(Cover(x, y, picture[..., 3]), picture[..., :3])
                for k, line in enumerate(entry.name.split("\n")):
                    below = y + drop + k * self.letters.line
                    canvas.write(self.letters, line, x + self.indent, below, ink)
                y += self._step(entry)
