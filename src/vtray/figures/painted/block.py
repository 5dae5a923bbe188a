"""What a painted mark is: a block of some size, which can be put anywhere."""

from typing import Protocol

from vtray.figures.painted.canvas import Canvas


class Block(Protocol):
    """A mark that takes a rectangle of a picture.

    Attributes
    ----------
    width, height
        Of the rectangle, in pixels.
    """

    width: int
    height: int

    def paint(self, canvas: Canvas, left: int, top: int) -> None:
        """Paint it, given where its rectangle begins."""
