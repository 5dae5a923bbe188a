"""Eye-dome lighting: what lies behind its surroundings in the picture is darker.

It needs distances alone, no light and no normals, and shows the shape of clouds of points too small
to show it by themselves.

References
----------
C. Boucheny, "Interactive Scientific Visualization of Large Datasets: Towards a Perceptive-Based
Approach", PhD thesis, Université Joseph Fourier, Grenoble, 2009, chapter 3.
"""

import math

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel

AROUND = ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1))
"""The directions in which the surroundings are looked at."""

RINGS = (1.0, 0.5)
"""How far that is done, in parts of the radius."""


def surroundings(radius: float) -> NDArray[np.int64]:
    """Return pixels around one, rows of column, row and distance to it in 1/1024 of a pixel."""
    rows = []
    for ring in RINGS:
        for across, down in AROUND:
            length = max(ring * radius, 1.0) * (1.0 if 0 in (across, down) else math.sqrt(0.5))
            x, y = int(across * length + across * 0.5), int(down * length + down * 0.5)
            rows.append((x, y, round(1024 * math.sqrt(x * x + y * y))))
    return np.array([row for row in dict.fromkeys(rows) if row[2]], np.int64)


@kernel
def shade_rows(
    distance: NDArray[np.float64],
    size: float,
    growth: float,
    around: NDArray[np.int64],
    strength: float,
    top: int,
    bottom: int,
    shade: NDArray[np.float32],
) -> None:
    """Find how much light the pixels of some rows keep.

    With the slopes s at which the surroundings rise towards the eye, 0 where they fall, that is
    ``1 / (1 + x + x * x / 2)``, nearly ``exp(-x)``, for ``x = strength * mean of s``.

    Parameters
    ----------
    distance
        How far what the middle rays hit is, infinite for nothing, (height, width).
    size, growth
        The side of a pixel at a distance of 0, and how much it grows with each unit of that.
    around
        What surrounds a pixel; see `surroundings`.
    strength
        How dark it becomes.
    top, bottom
        The rows from the first to before the last.
    shade
        Out: the share of light, from 0 to 1, (height, width).
    """
    height, width = distance.shape
    for row in range(top, bottom):
        for column in range(width):
            total, count = 0.0, 0
            if distance[row, column] < np.inf:
                total, count = _shade_at(distance, size, growth, around, strength, row, column), 1
            else:
                # Samples may meet what the middle ray misses: that looks as it does beside it.
                for side in range(4):
                    y = row + (side - 1 if side in (0, 2) else 0)
                    x = column + (side - 2 if side in (1, 3) else 0)
                    if 0 <= x < width and 0 <= y < height and distance[y, x] < np.inf:
                        total += _shade_at(distance, size, growth, around, strength, y, x)
                        count += 1
            shade[row, column] = np.float32(total / count if count > 0 else 1.0)


@device
def _shade_at(
    distance: NDArray[np.float64],
    size: float,
    growth: float,
    around: NDArray[np.int64],
    strength: float,
    row: int,
    column: int,
) -> float:
    """Return how much light a pixel keeps in which something is hit."""
    height, width = distance.shape
    own = distance[row, column]
    pixel, total, count = size + growth * own, 0.0, 0
    for k in range(around.shape[0]):
        x, y = column + around[k, 0], row + around[k, 1]
        if 0 <= x < width and 0 <= y < height:
            rise = (own - distance[y, x]) * 1024.0 / (pixel * around[k, 2])
            total += max(rise, 0.0)
            count += 1
    darkness = strength * (total / count) if count > 0 else 0.0
    return 1.0 / (1.0 + darkness + 0.5 * darkness * darkness)
