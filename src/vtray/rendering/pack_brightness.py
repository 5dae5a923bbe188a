"""Where skies are bright: the tables by which their rays are chosen.

All numbers come from single steps of exact operations, and sums have one order, so that they are
the same on every machine.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.exact_math import cosine
from vtray.transport.lights.sky import BLUE, GREEN, RED, Brightness

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Pictures = NDArray[np.float32]

SHARE = 0.5
"""The share of rays that are chosen by brightness: half of each fan, which fills the square."""

PEAK = 4.0
"""A sky that is nowhere brighter than so many times its mean needs no table."""


def pack_brightness(maps: Sequence[Pictures]) -> Brightness:
    """Return the tables of skies, given the nodes of their maps."""
    tables = [_table_of(nodes) for nodes in maps]
    return Brightness(
        np.array([table.share for table in tables], float),
        np.array([table.level for table in tables], float),
        np.array([table.rows[-1] for table in tables], float),
        starts_of([len(table.rows) for table in tables]),
        starts_of([table.cells.size for table in tables]),
        _joined([np.append(table.band, 0.0) for table in tables]),
        _joined([table.rows for table in tables]),
        _joined([table.cells for table in tables]),
    )


def starts_of(sizes: Sequence[int]) -> Integers:
    """Return where parts of these sizes begin when they stand one after the other."""
    counts = np.array(sizes, np.int64)
    starts: Integers = np.cumsum(counts) - counts
    return starts


def _joined(parts: Sequence[Floats]) -> Floats:
    """Return all numbers of some arrays, one after the other."""
    return np.concatenate([np.zeros(0), *(part.reshape(-1) for part in parts)])


class _Table(NamedTuple):
    """The table of one sky, as in `Brightness`."""

    share: float
    level: float
    band: Floats
    rows: Floats
    cells: Floats


def _table_of(nodes: Pictures) -> _Table:
    """Return the table of a sky, given the nodes of its map, (height + 2, width + 1, 3)."""
    brightness = RED * nodes[..., 0].astype(np.float64)
    brightness += GREEN * nodes[..., 1].astype(np.float64)
    brightness += BLUE * nodes[..., 2].astype(np.float64)
    heights, angles = _rows_of(len(nodes) - 2)
    rows, cells = _sums(brightness, heights)
    level = float(rows[-1]) / (2.0 * (cells.shape[1] - 1))
    if not float(brightness.max()) > PEAK * level:
        return _Table(0.0, level, np.zeros(0), np.zeros(1), np.zeros(0))
    rows, cells = _sums(np.maximum(brightness - level, 0.0), heights)
    return _Table(SHARE, level, heights / angles, rows, cells)


@lru_cache(maxsize=16)
def _rows_of(height: int) -> tuple[Floats, Floats]:
    """Return what part of an axis from 1 to -1 each row of cells takes, and its angle in radians.

    Both (height + 1,); by Archimedes, the first is its solid angle over 2 pi.
    """
    turns = [min(max((row - 0.5) / height, 0.0), 1.0) for row in range(height + 2)]
    places = np.array([cosine(180.0 * turn) for turn in turns])
    down = np.array(turns)
    return places[:-1] - places[1:], np.pi * (down[1:] - down[:-1])


def _sums(values: Floats, heights: Floats) -> tuple[Floats, Floats]:
    """Return `rows` and `cells` of `Brightness` for values at nodes."""
    cells = np.zeros((len(values) - 1, values.shape[1]))
    above, below = values[:-1], values[1:]
    means = 0.25 * ((above[:, :-1] + above[:, 1:]) + (below[:, :-1] + below[:, 1:]))
    np.cumsum(means, axis=1, out=cells[:, 1:])
    rows = np.zeros(len(values))
    np.cumsum(heights * cells[:, -1], out=rows[1:])
    return rows, cells
