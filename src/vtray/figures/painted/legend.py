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
        How wide one column should be at the most, in pixels: longer names are broken at spaces.
    """

    def __init__(self, entries: Sequence[Entry], letters: Letters, most: int, room: int) -> None:
        self.letters = letters
        em = letters.size
        self.pitch, self.ball = round(PITCH * em), round(1.1 * em)
        self.indent, gap = self.ball + round(0.45 * em), round(1.2 * em)
        words = (word for entry in entries for word in entry.name.split())
        longest = max(room - self.indent, *map(letters.width, words))
        self.columns = [
            [
                entry._replace(name="\n".join(broken(entry.name, letters.width, longest)))
                for entry in entries
            ]
        ]
        if self._height(self.columns[0]) > most:
            fits = max(1, (most - self.ball) // self.pitch + 1)
            # As many columns as needed, all about as long.
            rows = math.ceil(len(entries) / math.ceil(len(entries) / fits))
            self.columns = [list(entries[k : k + rows]) for k in range(0, len(entries), rows)]
        widths = [
            self.indent
            + max(letters.width(line) for entry in column for line in entry.name.split("\n"))
            for column in self.columns
        ]
        self.starts = [sum(widths[:k]) + k * gap for k in range(len(widths))]
        self.width = self.starts[-1] + widths[-1]
        self.height = max(map(self._height, self.columns))

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
