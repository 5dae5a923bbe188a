"""Builds the hierarchy, in parallel from the first step to the last but the topmost nodes.

Points are sorted along Morton's curve. A few topmost nodes divide them into some hundred ranges,
whose trees are then built side by side. The tree is the same for any number of threads.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.bvh import SIDES, STACK, WIDTH, Bvh, Frame, Leaves
from vtray.bvh_nodes import (
    Extent,
    Order,
    Points,
    build_subtree,
    find_extent,
    finish_top,
    new_scratch,
    set_keys,
    split_top,
)
from vtray.compiled import pinned
from vtray.key_sort import sort_keys
from vtray.morton import make_grid
from vtray.pool import Progress, run_tasks
from vtray.vector import Vec

CHUNK = 1 << 16
"""Points that are looked at as one task."""

SUBTREES = 256
"""Ranges, about, whose trees are built as tasks of their own."""

SMALL = 1 << 11
"""A range of fewer points is not worth a task."""


class Built(NamedTuple):
    """A hierarchy and what belongs to it.

    Attributes
    ----------
    leaves
        The spheres in the order of the leaves.
    bvh
        The hierarchy.
    frame
        The space of its boxes.
    nodes
        How many nodes there are; ``bvh`` has room for more.
    """

    leaves: Leaves
    bvh: Bvh
    frame: Frame
    nodes: int


def build(
    center: NDArray[np.float64],
    radius: NDArray[np.float64],
    threads: int,
    progress: Progress | None = None,
) -> Built:
    """Build the hierarchy of spheres.

    Parameters
    ----------
    center
        World space, (n, 3), float32 or float64, at least one.
    radius
        (n,), or (1,) if all are the same.
    threads
        How many threads to use.
    progress
        Called from time to time with the number of tasks done and the number of all.
    """
    n = len(center)
    points = Points(center, radius, 0 if len(radius) == 1 else 1, Frame(1.0, (0.0, 0.0, 0.0)))
    chunks = [(begin, min(begin + CHUNK, n)) for begin in range(0, n, CHUNK)]
    extents: list[Extent] = []
    unframed = pinned(points)
    _run(chunks, lambda chunk: extents.append(find_extent(unframed, *chunk)), threads)
    points, low, high = _place_in_frame(points, extents)

    shared = pinned(points)
    order = Order(np.empty(n, np.uint64), make_grid(low, high, max(n - 1, 1).bit_length()))
    unsorted = pinned(order)
    _run(chunks, lambda chunk: set_keys(shared, *chunk, unsorted), threads)
    order = Order(sort_keys(order.keys, threads), order.grid)

    leaves = Leaves(np.empty(4 * n), np.empty(n, np.int32))
    bvh, nodes = _build_nodes(points, order, leaves, threads, progress)
    return Built(leaves, bvh, points.frame, nodes)


def _build_nodes(
    points: Points, order: Order, leaves: Leaves, threads: int, progress: Progress | None
) -> tuple[Bvh, int]:
    """Build the nodes over sorted points, put the spheres into their leaves, count the nodes."""
    n = len(order.keys)
    grain = max(n // SUBTREES, SMALL)
    # Nodes of one depth have points of their own, so at most n / grain of them are larger than
    # that. A subtree of m points has fewer than m / 4 nodes: but for the last, which have more than
    # a leaf, each has eight children. Memory that is never written to costs nothing.
    top_limit = (n // grain + 1) * (STACK // WIDTH)
    found = np.empty((top_limit * WIDTH, 3), np.int64)
    size = top_limit + n // 4 + len(found)
    bvh = Bvh(np.empty(size * SIDES, np.float32), np.empty(size * WIDTH, np.int32))
    top, count = split_top(points, order, grain, bvh, found, new_scratch())
    subtrees = found[:count]
    sizes = (subtrees[:, 2] - subtrees[:, 1]) // 4 + 1
    roots = top + np.cumsum(sizes) - sizes
    shared = pinned(points), pinned(order), pinned(bvh), pinned(leaves)
    used: list[int] = []

    def new_worker() -> Callable[[int], None]:
        nothing, scratch = pinned(np.empty((0, 3), np.int64)), pinned(new_scratch())

        def build_one(k: int) -> None:
            cloud, sorted_, tree, target = shared
            place, begin, end = map(int, subtrees[k])
            root = int(roots[k])
            bvh.child[place] = root
            used.append(
                build_subtree(cloud, sorted_, begin, end, root, tree, target, nothing, scratch)
            )

        return build_one

    run_tasks(range(count), new_worker, threads, progress=progress)
    finish_top(points, order, top, bvh, leaves)
    return bvh, top + sum(used)


def _place_in_frame(points: Points, extents: list[Extent]) -> tuple[Points, Vec, Vec]:
    """Return the points with the boxes' space, and the box around their centres in it."""
    low = np.min([extent.low for extent in extents], axis=0)
    high = np.max([extent.high for extent in extents], axis=0)
    largest = max(-float(low.min()), float(high.max()), *(extent.radius for extent in extents))
    # The scale and its inverse must be ordinary doubles.
    scale = math.ldexp(1.0, -max(math.frexp(largest)[1], -1000))
    middle = low * scale * 0.5 + high * scale * 0.5
    placed = points._replace(frame=Frame(scale, _vec(middle)))
    return placed, _vec(low * scale - middle), _vec(high * scale - middle)


def _vec(array: NDArray[np.float64]) -> Vec:
    """Return an array of three numbers as a tuple."""
    x, y, z = map(float, array)
    return x, y, z


def _run(
    chunks: list[tuple[int, int]], function: Callable[[tuple[int, int]], object], threads: int
) -> None:
    """Call a function with each chunk."""
    run_tasks(chunks, lambda: function, threads)
