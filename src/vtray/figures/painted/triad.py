"""The triad, painted: arrows from one place, with letters at their tips."""

import itertools
import math

import numpy as np

from vtray.figures.painted.canvas import Canvas
from vtray.figures.painted.cover import polygon
from vtray.figures.painted.letters import Letters
from vtray.figures.triad import Arm, arrow, extent, name_places


class PaintedTriad:
    """A triad, as a block, as large as its arrows and letters are in this view.

    Parameters
    ----------
    arms
        Its arrows, those that point away first.
    letters
        In which letters.
    """

    def __init__(self, arms: list[Arm], letters: Letters) -> None:
        self.arms, self.letters = arms, letters
        em = letters.size
        widths = [letters.width(arm.name) / em for arm in arms]
        low, high = (em * corner for corner in extent(arms, widths, letters.capital / em))
        self.origin = np.array([-math.floor(low[0]), -math.floor(low[1])])
        self.width, self.height = (math.ceil(high[k]) + int(self.origin[k]) for k in (0, 1))

    def paint(self, canvas: Canvas, left: int, top: int) -> None:
        """Paint it where its rectangle begins."""
        ink = canvas.ink(left, top, self.width, self.height)
        start, em = self.origin + np.array([left, top]), self.letters.size
        arrows = [[start + em * part for part in arrow(arm)] for arm in self.arms]
        for part in itertools.chain(*arrows):
            canvas.blend(polygon(part, canvas.halo), ink.halo)
        for arm, parts in zip(self.arms, arrows, strict=True):
            for part in parts:
                canvas.blend(polygon(part), arm.color)
        for arm, place in zip(self.arms, name_places(self.arms), strict=True):
            middle = start + em * np.array(place)
            begin = round(float(middle[0]) - self.letters.width(arm.name) / 2)
            baseline = round(float(middle[1])) + self.letters.drop(arm.name)
            canvas.write(self.letters, arm.name, begin, baseline, ink)
