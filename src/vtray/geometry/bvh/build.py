"""Builds the hierarchy, in parallel from the first step to the last but the topmost nodes.

Primitives are sorted along Morton's curve. A few topmost nodes divide them into ranges, whose trees
are then built side by side. The tree is the same for any number of threads.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import pinned, uncompiled
from vtray.base.pool import Progress, run_tasks
from vtray.geometry.bvh.join import join_trees
from vtray.geometry.bvh.key_sort import sort_keys
from vtray.geometry.bvh.morton import Grid, make_grid
from vtray.geometry.bvh.nodes import (
    Extent,
    build_subtree,
    find_extent,
    finish_top,
    set_keys,
    split_top,
    take_numbers,
)
from vtray.geometry.bvh.primitives import Boxes, Numbers, Primitives, new_boxes
from vtray.geometry.bvh.split import Order, new_scratch
from vtray.geometry.bvh.tree import LEAF, SIDES, STACK, WIDTH, Bvh, Frame, new_bvh
from vtray.geometry.vector import Vec

CHUNK = 1 << 14
"""Primitives whose boxes are looked at as one task."""

SMALL = 1 << 14
"""Primitives, about, whose trees are built as one task: a cache holds them and their boxes."""

Range = tuple[int, int]


class Tree(NamedTuple):
    """A hierarchy and what belongs to it.

    Attributes
    ----------
    numbers
        The numbers of the primitives in the order of the leaves, (n,).
    bvh
        The hierarchy.
    frame
        The space of its boxes.
    depth
        How many nodes lie one below the other at the most.
    largest
        The largest coordinate of a centre, or half extent, in world space.
    """

    numbers: Numbers
    bvh: Bvh
    frame: Frame
    depth: int
    largest: float


def build(primitives: Primitives, threads: int, progress: Progress | None = None) -> Tree:
    """Build the hierarchy of primitives.

    Parameters
    ----------
    primitives
        What it is built over, at least one.
    threads
        How many threads to use.
    progress
        Called from time to time with the number of tasks done and the number of all.
    """
    frame, grid, largest = _find_frame(primitives, threads)
    order = _sort(primitives, frame, grid, threads)
    numbers = np.empty(primitives.count, np.int32)
    bvh, depth = _build_nodes(primitives, frame, order, numbers, threads, progress)
    return Tree(numbers, bvh, frame, depth, largest)


def _find_frame(primitives: Primitives, threads: int) -> tuple[Frame, Grid, float]:
    """Find the space of the boxes.

    Returns
    -------
    frame
        The space.
    grid
        The grid of the keys, in that space.
    largest
        As in `Tree`.
    """
    found: dict[Range, Extent] = {}

    def look(chunk: Range, boxes: Boxes) -> None:
        found[chunk] = find_extent(boxes, chunk[1] - chunk[0])

    _bound_all(primitives, look, threads)
    # In the order of the chunks, as of 0 and -0 it is the first that is taken.
    extents = [found[chunk] for chunk in sorted(found)]
    low = np.min([extent.low for extent in extents], axis=0)
    high = np.max([extent.high for extent in extents], axis=0)
    largest = max(-float(low.min()), float(high.max()), *(extent.half for extent in extents))
    # The scale and its inverse must be ordinary doubles.
    scale = math.ldexp(1.0, -max(math.frexp(largest)[1], -1000))
    middle = low * scale * 0.5 + high * scale * 0.5
    number_bits = max(primitives.count - 1, 1).bit_length()
    corners = _vec(low * scale - middle), _vec(high * scale - middle)
    return Frame(scale, _vec(middle)), uncompiled(make_grid)(*corners, number_bits), largest


def _sort(primitives: Primitives, frame: Frame, grid: Grid, threads: int) -> Order:
    """Return the order of primitives along Morton's curve."""
    order = Order(np.empty(primitives.count, np.uint64), grid)
    place, target = pinned(frame), pinned(order)
    _bound_all(primitives, lambda chunk, boxes: set_keys(boxes, place, *chunk, target), threads)
    return Order(sort_keys(order.keys, threads, grid.number_bits), grid)


def _bound_all(
    primitives: Primitives, look: Callable[[Range, Boxes], object], threads: int
) -> None:
    """Have the boxes of all primitives looked at, chunk by chunk."""
    n = primitives.count
    chunks = [(begin, min(begin + CHUNK, n)) for begin in range(0, n, CHUNK)]

    def new_worker() -> Callable[[Range], None]:
        boxes = new_boxes(min(CHUNK, n))

        def bound(chunk: Range) -> None:
            primitives.bound(*chunk, boxes)
            look(chunk, boxes)

        return bound

    run_tasks(chunks, new_worker, threads)


def _build_nodes(
    primitives: Primitives,
    frame: Frame,
    order: Order,
    numbers: Numbers,
    threads: int,
    progress: Progress | None,
) -> tuple[Bvh, int]:
    """Build the nodes over sorted primitives, and set the numbers of these by their slots.

    Returns
    -------
    bvh, depth
        As in `Tree`.
    """
    top, ranges, depth = _split_top(frame, order)
    tasks = _tasks(ranges)
    parts, depths = [top] * (len(tasks) + 1), [depth] * (len(tasks) + 1)
    largest = max(int(task[-1, 2] - task[0, 1]) for task in tasks)
    shared = pinned(frame), pinned(order)
    above, target = pinned(top), pinned(numbers)

    def new_worker() -> Callable[[int], None]:
        # All nodes but the last, which have more primitives than a leaf, have eight children, so
        # that a tree of m primitives has fewer than m / 4 nodes.
        bvh, boxes, drawn = (
            new_bvh(largest // 4 + 1),
            new_boxes(largest),
            np.empty(largest, np.int32),
        )
        tree, scratch = pinned(bvh), pinned(new_scratch())

        def build_one(k: int) -> None:
            begin, end = int(tasks[k][0, 1]), int(tasks[k][-1, 2])
            take_numbers(shared[1], begin, end, drawn)
            primitives.gather(drawn[: end - begin], begin, boxes)
            size, depths[k + 1], changed = build_subtree(
                boxes, *shared, drawn, tasks[k], tree, above, target, scratch
            )
            if changed:
                primitives.gather(numbers[begin:end], begin, boxes)
            parts[k + 1] = Bvh(bvh.sides[: size * SIDES].copy(), bvh.child[: size * WIDTH].copy())

        return build_one

    run_tasks(range(len(tasks)), new_worker, threads, progress=progress)
    bvh, first = join_trees(parts, threads)
    for task, root in zip(tasks, first[1:], strict=True):
        places = task[task[:, 2] - task[:, 1] > LEAF, 0]
        bvh.child[places] += root
    finish_top(bvh, len(top.child) // WIDTH)
    return bvh, 1 + max(depths)


def _split_top(frame: Frame, order: Order) -> tuple[Bvh, NDArray[np.int64], int]:
    """Make the topmost nodes.

    Returns
    -------
    top
        The nodes, without boxes.
    ranges
        The ranges below, as `split_top` sets them, in the order of their slots.
    depth
        The depth of the deepest of these nodes.
    """
    # Nodes of one depth have primitives of their own, so at most n / SMALL of them are larger than
    # that. Memory that is never written to costs nothing.
    most = (len(order.keys) // SMALL + 1) * (STACK // WIDTH)
    top, found = new_bvh(most), np.empty((most * WIDTH, 4), np.int64)
    no_boxes = new_boxes(0)
    size, count, depth = split_top(no_boxes, frame, order, SMALL, top, found, new_scratch())
    ranges = found[:count]
    ranges = ranges[ranges[:, 1].argsort()]
    return Bvh(top.sides[: size * SIDES], top.child[: size * WIDTH]), ranges, depth


def _tasks(ranges: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Return neighbouring ranges together; several have no more primitives than `SMALL`."""
    cuts, begin = [], 0
    for k, end in enumerate(ranges[:, 2].tolist()):
        if end - begin > SMALL and k > 0:
            cuts.append(k)
            begin = int(ranges[k, 1])
    return np.split(ranges, cuts)


def _vec(array: NDArray[np.float64]) -> Vec:
    """Return an array of three numbers as a tuple."""
    x, y, z = map(float, array)
    return x, y, z
