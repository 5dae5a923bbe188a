"""Which pixels get more samples than others: those in which edges are sharpest."""

import numpy as np
from numpy.typing import NDArray

from vtray.scene.settings import RenderSettings
from vtray.scene.vectors import Color
from vtray.transport.film import Film

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

MOST, BUSY = 1 / 16, 1 / 4
"""The share of all pixels that have more samples, at the most; and from which share of pixels with
sharp edges on none has more: among so many, none is seen."""

SHARP = 0.1
"""From this standard error on, 1 for white, edges are sharp."""

ROWS = 64
"""Rows of pixels that are looked at at a time, to take little memory."""


def edge_pixels(film: Film, marks: Flags, settings: RenderSettings, white: float) -> Flags:
    """Return the pixels whose samples differ most, (height, width).

    Those are taken whose standard error is largest; the fewer, the more pixels have sharp edges.
    The light of a pixel with the background is L + (1 - c) B, where c is the share of it that is
    covered. Where nothing is, L is 0; so the squared error of n samples is that of L and
    (1 - c) B (c B - 2 L) / n.

    Parameters
    ----------
    film
        What was traced: light, its error, and coverage.
    marks
        The pixels that have samples.
    settings
        How many, and what is behind everything.
    white
        The light that becomes 255.
    """
    squared, behind = np.zeros(marks.shape), white * _background(settings)
    for top in range(0, len(marks), ROWS):
        rows = slice(top, top + ROWS)
        own = marks[rows]
        light, covered, error = (
            part[rows][own] for part in (film.linear, film.coverage, film.error)
        )
        bare, covered = 1.0 - covered[:, None], covered[:, None]
        with np.errstate(over="ignore", invalid="ignore"):
            more = (bare * behind * (covered * behind - 2.0 * light)).max(axis=-1)
            squared[rows][own] = error * error + more / int(settings.samples)
    sharp = SHARP * white
    return squared > _limit(squared, sharp * sharp)


def _limit(squared: Floats, sharp: float) -> float:
    """Return the squared error above which pixels have more samples, given that of sharp edges."""
    count = int(np.count_nonzero(squared > sharp))
    share = (BUSY - count / squared.size) / (BUSY - MOST) * MOST
    most = max(int(min(share, MOST) * squared.size), 0)
    if count <= most:
        return sharp
    # That of the first that is left, of all in their order.
    place = squared.size - most - 1
    return float(np.partition(squared.reshape(-1), place)[place])


def _background(settings: RenderSettings) -> Floats:
    """Return what is behind everything, 1 for white; what is not known is white."""
    if settings.background == "black":
        return np.zeros(3)
    if isinstance(settings.background, Color):
        color = settings.background
        return np.array([color.r, color.g, color.b]) / 255.0
    return np.ones(3)
