"""Lines of text: titles, captions, labels."""

from collections.abc import Sequence
from typing import Literal

from vtray.figures.ink import Ink
from vtray.figures.painted.canvas import Canvas
from vtray.figures.painted.letters import Letters


class Words:
    """Lines of text, as a block.

    Parameters
    ----------
    lines
        What is written.
    letters
        In which letters.
    align
        Which sides of the lines are below each other.
    """

    def __init__(
        self,
        lines: Sequence[str],
        letters: Letters,
        align: Literal["left", "center", "right"] = "left",
    ) -> None:
        self.lines, self.letters = lines, letters
        self.shift = {"left": 0.0, "center": 0.5, "right": 1.0}[align]
        self.widths = [letters.width(line) for line in lines]
        self.width = max(self.widths, default=0)
        # From the top of capitals to the last line that letters stand on, and what hangs below.
        below = round(0.25 * letters.size)
        rows = letters.capital + letters.line * max(len(lines) - 1, 0)
        self.middle = rows / 2
        self.height = rows + below

    def paint(self, canvas: Canvas, left: int, top: int) -> None:
        """Write them where their rectangle begins."""
        self.write(canvas, left, top, canvas.ink(left, top, self.width, self.height))

    def write(self, canvas: Canvas, left: int, top: int, ink: Ink) -> None:
        """Write them with an ink."""
        for k, (line, width) in enumerate(zip(self.lines, self.widths, strict=True)):
            begin = left + round(self.shift * (self.width - width))
            baseline = top + self.letters.capital + k * self.letters.line
            canvas.write(self.letters, line, begin, baseline, ink)
