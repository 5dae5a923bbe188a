"""Which pixels need more than one ray.

A pixel gets samples if what its filter covers may not all look like its middle: if the outline of a
shape passes through it, seen or just missed by its middle ray, or if near it another surface, the
other half of one, or the shadow of another thing, begins. None of these questions has a threshold
for light, so the choice depends neither on colours nor on the strength of lights. The rays by which
pixels are chosen are not used in those that are: their samples are as unbiased as if all pixels had
them.

References
----------
Kirk, Arvo, "Unbiased Sampling Techniques for Image Synthesis", SIGGRAPH 1991 (why not to use them).
"""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.transport.film import Film


@kernel
def mark_rows(film: Film, near: int, top: int, bottom: int, marks: NDArray[np.bool_]) -> float:
    """Mark the pixels of some rows that need samples.

    Parameters
    ----------
    film
        What the middle rays found: light, primitives, their halves, shadows and rims.
    near
        How many pixels away what is near begins.
    top, bottom
        The rows from the first to before the last.
    marks
        Out: the pixels that need samples, (height, width).

    Returns
    -------
    float
        The largest channel of the pixels that are not marked.
    """
    height, width = marks.shape
    peak = 0.0
    for row in range(top, bottom):
        for column in range(width):
            marks[row, column] = film.rims[row, column]
        for other in range(max(row - near, 0), min(row + near + 1, height)):
            for shift in range(-near, near + 1):
                _mark_changes(film, row, other, shift, marks)
        for column in range(width):
            if not marks[row, column]:
                for channel in range(3):
                    peak = max(peak, film.linear[row, column, channel])
    return peak


@device
def _mark_changes(film: Film, row: int, other: int, shift: int, marks: NDArray[np.bool_]) -> None:
    """Mark the pixels of a row that differ from those of another, so many columns to the right."""
    for column in range(max(0, -shift), marks.shape[1] - max(0, shift)):
        beside = column + shift
        surface = film.primitive[row, column] != film.primitive[other, beside]
        half = film.half[row, column] != film.half[other, beside]
        shadow = film.shadows[row, column] != film.shadows[other, beside]
        marks[row, column] |= surface | half | shadow
