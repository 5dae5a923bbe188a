"""Where marks stand on a picture.

Title and caption stand at the top left, the triad at the bottom left, the scale bar at the bottom
right; above that, from the top, the legend and then colour bars.
"""

import math
from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

from vtray.figures.annotations import Marks
from vtray.figures.lettering import broken
from vtray.figures.painted.block import Block
from vtray.figures.painted.color_bar import LEAST, PaintedColorBar
from vtray.figures.painted.legend import PaintedLegend
from vtray.figures.painted.letters import Letters, letters
from vtray.figures.painted.scale_bar import PaintedScaleBar
from vtray.figures.painted.triad import PaintedTriad
from vtray.figures.painted.words import Words

MARGIN = 0.9
"""From the edge of the picture, and at least between marks, in sizes of the font."""

MOST_BESIDE = 0.4
"""The share of the width from which on a legend stands on what is shown, so that it stays large."""

TITLE, SMALL = 1.2, 0.8
"""The sizes of a title and of remarks, in those of the font."""

LEAST_WORD = 8.0
"""A word of a title so long may be broken, in sizes of the font."""


class Placed(NamedTuple):
    """A mark, and where its rectangle begins."""

    block: Block
    left: int
    top: int


class _Column:
    """Marks below each other on one side of a picture.

    Parameters
    ----------
    width, height
        Of the picture, in pixels.
    margin
        From its edge, and between marks.
    right
        Whether it is on the right.
    """

    def __init__(self, width: int, height: int, margin: int, *, right: bool) -> None:
        self.width, self.margin, self.right = width, margin, right
        self.top, self.bottom = margin, height - margin
        self.placed: list[Placed] = []

    @property
    def left_over(self) -> int:
        """How much of its height is free, in pixels."""
        return self.bottom - self.top

    @property
    def widest(self) -> int:
        """The width of its widest mark, in pixels."""
        return max((block.width for block, _, _ in self.placed), default=0)

    def add_below(self, block: Block) -> None:
        """Put a mark below what stands at the top."""
        self._add(block, self.top)
        self.top += block.height + self.margin

    def add_above(self, block: Block) -> None:
        """Put a mark above what stands at the bottom."""
        self._add(block, self.bottom - block.height)
        self.bottom -= block.height + self.margin

    def _add(self, block: Block, top: int) -> None:
        left = self.width - self.margin - block.width if self.right else self.margin
        self.placed.append(Placed(block, left, top))


def arranged(
    marks: Marks, em: int, width: int, height: int, *, above: bool = False
) -> list[Placed] | None:
    """Return where marks stand on a picture, None if there is no room for all of them.

    Parameters
    ----------
    marks
        What stands there; labels, which stand at their points, must only fit by themselves.
    em
        The size of letters, in pixels.
    width, height
        Of the picture, in pixels.
    above
        Whether title and caption stand above the legend and colour bars, as they do in any case
        where beside these words would be broken.
    """
    plain, title = letters(em), letters(round(TITLE * em))
    small = letters(max(1, round(SMALL * em)))
    margin = round(MARGIN * em)
    texts = [(text, of) for text, of in ((marks.title, title), (marks.caption, plain)) if text]
    left, right = (_Column(width, height, margin, right=side) for side in (False, True))
    if above:
        _add_titles(left, texts, width - 2 * margin)
        right.top = left.top + margin // 2
    if marks.scale_bar is not None:
        right.add_above(PaintedScaleBar(marks.scale_bar, plain, small))
    if marks.legend:
        bars = round(len(marks.scales) * (LEAST + 3) * em)
        room = math.ceil(MOST_BESIDE * width) - 2 * margin - 1
        most, widest = right.left_over - bars, width - 2 * margin
        right.add_below(PaintedLegend(marks.legend, plain, most, room, widest))
    for k, (scale, label) in enumerate(zip(marks.scales, marks.bar_labels, strict=True)):
        others = len(marks.scales) - k
        room = (right.left_over - (others - 1) * margin) // others
        right.add_below(PaintedColorBar(scale, label, plain, round(0.4 * width), room))
    beside = [block.width for block, _, top in right.placed if top < height // 3]
    room = width - 2 * margin - max((wide + margin for wide in beside), default=0)
    if not above:
        words = (of.width(word) for text, of in texts for word in text.split())
        if beside and room < min(max(words, default=0), LEAST_WORD * em):
            return arranged(marks, em, width, height, above=True)
        _add_titles(left, texts, room)
    if marks.triad:
        left.add_above(PaintedTriad(marks.triad, plain))
    placed = [*left.placed, *right.placed]
    labels = [Words(label.text.split("\n"), plain) for label in marks.labels]
    inside = all(_is_inside(one, width, height, margin) for one in placed)
    fits = all(words.width + 2 <= width and words.height + 2 <= height for words in labels)
    apart = all(_are_apart(*pair, margin // 2) for pair in combinations(placed, 2))
    return placed if inside and fits and apart else None


def _add_titles(column: _Column, texts: Sequence[tuple[str, Letters]], room: int) -> None:
    """Put texts below each other, each in its letters, in lines as long as there is room."""
    for text, of_size in texts:
        lines = [part for line in text.split("\n") for part in broken(line, of_size.width, room)]
        column.add_below(Words(lines, of_size))
        column.top -= column.margin // 2


def _is_inside(one: Placed, width: int, height: int, margin: int) -> bool:
    """Tell whether a mark is within the margins of a picture."""
    across = margin <= one.left and one.left + one.block.width <= width - margin
    return across and margin <= one.top and one.top + one.block.height <= height - margin


def _are_apart(one: Placed, other: Placed, gap: int) -> bool:
    """Tell whether there are so many pixels between two marks."""
    return (
        one.left + one.block.width + gap <= other.left
        or other.left + other.block.width + gap <= one.left
        or one.top + one.block.height + gap <= other.top
        or other.top + other.block.height + gap <= one.top
    )
