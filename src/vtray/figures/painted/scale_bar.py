"""A scale bar, painted: a line as long as it says."""

from vtray.figures.painted.canvas import Canvas
from vtray.figures.painted.cover import rectangle
from vtray.figures.painted.letters import Letters
from vtray.figures.painted.words import Words
from vtray.figures.scale_bar import ScaleBar


class PaintedScaleBar:
    """A scale bar, as a block: its length above a line with ends.

    Parameters
    ----------
    bar
        What it is.
    letters, small
        The letters of its length, and those that say at which distance it is right.
    """

    def __init__(self, bar: ScaleBar, letters: Letters, small: Letters) -> None:
        em = letters.size
        self.length = max(1, round(bar.pixels))
        self.thick, self.rise = max(2, round(0.14 * em)), max(6, 2 * round(0.3 * em))
        self.words = Words([bar.text], letters, "center")
        self.note = Words([bar.note] if bar.note else [], small, "center")
        self.gap = round(0.35 * em)
        self.width = max(self.length, self.words.width, self.note.width)
        self.height = self.words.height + self.gap + self.rise
        if bar.note:
            self.height += self.gap + self.note.height

    def paint(self, canvas: Canvas, left: int, top: int) -> None:
        """Paint it where its rectangle begins."""
        ink = canvas.ink(left, top, self.width, self.height)
        self.words.write(canvas, left + (self.width - self.words.width) // 2, top, ink)
        top += self.words.height + self.gap
        start = left + (self.width - self.length) // 2
        drop = (self.rise - self.thick) // 2
        pieces = [
            (start, top + drop, self.length, self.thick),
            (start, top, self.thick, self.rise),
            (start + self.length - self.thick, top, self.thick, self.rise),
        ]
        covers = [rectangle(*piece) for piece in pieces]
        wider = [rectangle(*piece, canvas.halo) for piece in pieces]
        canvas.shapes(covers, wider, ink.color, ink)
        if self.note.lines:
            top += self.rise + self.gap
            self.note.write(canvas, left + (self.width - self.note.width) // 2, top, ink)
