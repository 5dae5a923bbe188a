"""Lines through the crossings of a grid of pixels, as smooth as they can be."""

import math

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel

Shares = NDArray[np.float32]


@device
def reach_of_strokes(width: float) -> int:
    """Return how many pixels from a cell lines of a width in pixels may reach."""
    return int(0.5 * width + 0.5) + 1


@kernel
def draw_strokes(
    primitive: NDArray[np.int32],
    part: Shares,
    place: NDArray[np.uint8],
    share: Shares | None,
    steps: int,
    width: float,
    top: int,
    bottom: int,
    lines: Shares,
    points: NDArray[np.float64],
    marks: NDArray[np.bool_],
) -> None:
    """Draw lines into some rows of a picture.

    Four pixels are the corners of a cell. Where lines cross two sides of it, they are joined by a
    straight one; where they cross three, these meet in their middle.

    Parameters
    ----------
    primitive
        What each pixel sees, (height, width).
    part, place, share
        How wide the lines are that cross the ways from each pixel to those right of it and below,
        in parts of the width, 0 for none; where they cross these, and how much they hide, None for
        all; each (2, height, width).
    steps
        How many steps of `place` the whole way has.
    width
        The width of lines in pixels.
    top, bottom
        The rows from the first to before the last.
    lines
        Out: how much of each pixel of these rows lines hide, (height, width).
    points, marks
        Scratch memory, (5, 4) and (width,).
    """
    height, columns = primitive.shape
    reach = reach_of_strokes(width)
    lines[top:bottom] = 0.0
    for y in range(max(top - reach - 1, 0), min(bottom + reach, height - 1)):
        _mark_cells(part, y, columns - 1, marks)
        for x in range(columns - 1):
            if marks[x]:
                found = _crossings_of(part, place, share, steps, width, y, x, points)
                _join(primitive, y, x, found, points, top, bottom, lines)


@device
def _mark_cells(part: Shares, y: int, columns: int, marks: NDArray[np.bool_]) -> None:
    """Mark the cells of a row whose sides more than one line crosses: few do."""
    for x in range(columns):
        above, below = int(part[0, y, x] > 0.0), int(part[0, y + 1, x] > 0.0)
        before, after = int(part[1, y, x] > 0.0), int(part[1, y, x + 1] > 0.0)
        marks[x] = above + below + before + after > 1


@device
def _crossings_of(
    part: Shares,
    place: NDArray[np.uint8],
    share: Shares | None,
    steps: int,
    width: float,
    y: int,
    x: int,
    points: NDArray[np.float64],
) -> int:
    """Set column, row, width and share where lines cross the sides of a cell; return how many."""
    found = 0
    for side in range(4):
        # Above, right, below, left.
        axis = side & 1
        row, column = y + (1 if side == 2 else 0), x + (1 if side == 1 else 0)
        if part[axis, row, column] > 0.0:
            along = place[axis, row, column] / steps
            points[found, 0] = column + (1 - axis) * along
            points[found, 1] = row + axis * along
            points[found, 2] = width * part[axis, row, column]
            points[found, 3] = _share_at(share, axis, row, column)
            found += 1
    return found


@device
def _share_at(share: Shares | None, axis: int, row: int, column: int) -> float:
    """Return how much a line hides where it crosses a side of a cell."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if share is not None:
        return float(share[axis, row, column])
    return 1.0


@device
def _join(
    primitive: NDArray[np.int32],
    y: int,
    x: int,
    found: int,
    points: NDArray[np.float64],
    top: int,
    bottom: int,
    lines: Shares,
) -> None:
    """Draw the lines between the crossings of a cell."""
    if found == 2:
        _stroke(points, 0, 1, top, bottom, lines)
    elif found == 4 and primitive[y, x] == primitive[y + 1, x + 1]:
        _stroke(points, 0, 1, top, bottom, lines)
        _stroke(points, 2, 3, top, bottom, lines)
    elif found == 4 and primitive[y, x + 1] == primitive[y + 1, x]:
        _stroke(points, 0, 3, top, bottom, lines)
        _stroke(points, 1, 2, top, bottom, lines)
    else:
        for k in range(4):
            total = 0.0
            for point in range(found):
                total += points[point, k]
            points[4, k] = total / found
        for point in range(found):
            _stroke(points, point, 4, top, bottom, lines)


@device
def _stroke(
    points: NDArray[np.float64],
    one: int,
    two: int,
    top: int,
    bottom: int,
    lines: Shares,
) -> None:
    """Draw a line from one point to another, with round ends."""
    x, y = points[one, 0], points[one, 1]
    across, down = points[two, 0] - x, points[two, 1] - y
    square = across * across + down * down
    reach = 0.5 * max(points[one, 2], points[two, 2]) + 0.5
    first, last = min(y, points[two, 1]) - reach, max(y, points[two, 1]) + reach
    start, end = min(x, points[two, 0]) - reach, max(x, points[two, 0]) + reach
    for row in range(max(int(first), top), min(int(last) + 1, bottom)):
        for column in range(max(int(start), 0), min(int(end) + 1, lines.shape[1])):
            right, below = column - x, row - y
            along = (right * across + below * down) / square if square > 0.0 else 0.0
            along = min(max(along, 0.0), 1.0)
            off, under = right - along * across, below - along * down
            distance = math.sqrt(off * off + under * under)
            width = points[one, 2] + along * (points[two, 2] - points[one, 2])
            covered = min(max(0.5 * width + 0.5 - distance, 0.0), width, 1.0)
            covered *= points[one, 3] + along * (points[two, 3] - points[one, 3])
            lines[row, column] = max(lines[row, column], np.float32(covered))
