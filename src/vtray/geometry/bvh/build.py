"""Builds the hierarchy, in parallel from the first step to the last but the topmost nodes.

Points are sorted along Morton's curve. A few topmost nodes divide them into some hundred ranges,
whose trees are then built side by side. The tree is the same for any number of threads.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import pinned, uncompiled
from vtray.base.pool import Progress, run_tasks, useful_threads
from vtray.geometry.bvh.key_sort import sort_keys
from vtray.geometry.bvh.morton import make_grid
from vtray.geometry.bvh.nodes import (
    Extent,
    Order,
    Points,
    build_subtree,
    find_extent,
    finish_top,
    new_points,
    new_scratch,
    set_keys,
    split_top,
)
from vtray.geometry.bvh.tree import SIDES, STACK, WIDTH, Bvh, Frame, Leaves
from vtray.geometry.vector import Vec

CHUNK = 1 << 16
"""Points that are looked at as one task."""

SUBTREES = 256
"""Ranges, about, whose trees are built as tasks of their own."""

SMALL = 1 << 14
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
    depth
        How many nodes lie one below the other at the most.
    largest
        The largest coordinate or radius.
    """

    leaves: Leaves
    bvh: Bvh
    frame: Frame
    depth: int
    largest: float


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
    points = new_points(center, radius)
    chunks = [(begin, min(begin + CHUNK, n)) for begin in range(0, n, CHUNK)]
    extents: list[Extent] = []
    unframed = pinned(points)
    _run(chunks, lambda chunk: extents.append(find_extent(unframed, *chunk)), threads)
    points, low, high, largest = _place_in_frame(points, extents)

    shared = pinned(points)
    grid = uncompiled(make_grid)(low, high, max(n - 1, 1).bit_length())
    order = Order(np.empty(n, np.uint64), grid)
    unsorted = pinned(order)
    _run(chunks, lambda chunk: set_keys(shared, *chunk, unsorted), threads)
    order = Order(sort_keys(order.keys, threads), order.grid)

    leaves = Leaves(np.empty(4 * n), np.empty(n, np.int32))
    bvh, depth = _build_nodes(points, order, leaves, threads, progress)
    return Built(leaves, bvh, points.frame, depth, largest)


def _build_nodes(
    points: Points, order: Order, leaves: Leaves, threads: int, progress: Progress | None
) -> tuple[Bvh, int]:
    """Build the nodes over sorted points, and put the spheres into their leaves.

    Returns
    -------
    bvh, depth
        As in `Built`.
    """
    n = len(order.keys)
    grain = max(n // SUBTREES, SMALL)
    # Nodes of one depth have points of their own, so at most n / grain of them are larger than
    # that. Memory that is never written to costs nothing.
    most = (n // grain + 1) * (STACK // WIDTH)
    top, found = _new_bvh(most), np.empty((most * WIDTH, 4), np.int64)
    top_nodes, count, deepest = split_top(points, order, grain, top, found, new_scratch())
    subtrees = found[:count]
    parts, depths = _build_subtrees(points, order, leaves, subtrees, threads, progress)

    parts.insert(0, Bvh(top.sides[: top_nodes * SIDES], top.child[: top_nodes * WIDTH]))
    bvh, roots = _join(parts, threads)
    bvh.child[subtrees[:, 0]] = roots[1:]
    finish_top(points, order, top_nodes, bvh, leaves)
    return bvh, 1 + max([deepest, *depths])


def _build_subtrees(
    points: Points,
    order: Order,
    leaves: Leaves,
    subtrees: NDArray[np.int64],
    threads: int,
    progress: Progress | None,
) -> tuple[list[Bvh], list[int]]:
    """Return the trees of ranges of points, each numbered from 0, and their depths."""
    # All nodes but the last, which have more points than a leaf, have eight children, so that a
    # tree of m points has fewer than m / 4 nodes.
    most = int((subtrees[:, 2] - subtrees[:, 1]).max(initial=0)) // 4 + 1
    cloud, sorted_, target = pinned(points), pinned(order), pinned(leaves)
    parts = [_new_bvh(0)] * len(subtrees)
    depths = [0] * len(subtrees)

    def new_worker() -> Callable[[int], None]:
        bvh = _new_bvh(most)
        tree, scratch = pinned(bvh), pinned(new_scratch())
        nothing = pinned(np.empty((0, 4), np.int64))

        def build_one(k: int) -> None:
            _, begin, end, depth = map(int, subtrees[k])
            size, depths[k] = build_subtree(
                cloud, sorted_, begin, end, depth, tree, target, nothing, scratch
            )
            parts[k] = Bvh(bvh.sides[: size * SIDES].copy(), bvh.child[: size * WIDTH].copy())

        return build_one

    run_tasks(range(len(subtrees)), new_worker, threads, progress=progress)
    return parts, depths


def _new_bvh(nodes: int) -> Bvh:
    """Return room for nodes."""
    return Bvh(np.empty(nodes * SIDES, np.float32), np.empty(nodes * WIDTH, np.int32))


def _join(parts: list[Bvh], threads: int) -> tuple[Bvh, NDArray[np.int64]]:
    """Return the nodes of several trees in one, and the numbers that their roots have there."""
    sizes = np.array([len(part.child) // WIDTH for part in parts])
    roots = np.cumsum(sizes) - sizes
    bvh = _new_bvh(int(sizes.sum()))

    def put(run: NDArray[np.int64]) -> None:
        nodes = slice(roots[run[0]], roots[run[-1]] + sizes[run[-1]])
        sides = bvh.sides[nodes.start * SIDES : nodes.stop * SIDES]
        child = bvh.child[nodes.start * WIDTH : nodes.stop * WIDTH]
        np.concatenate([parts[k].sides for k in run], out=sides)
        np.concatenate([parts[k].child for k in run], out=child)
        # Numbers of nodes are counted from the root of all; those of leaves are below 0.
        shift = np.repeat(roots[run], sizes[run] * WIDTH)
        np.add(child, shift, out=child, where=child >= 0, casting="unsafe")

    runs = np.array_split(np.arange(len(parts)), useful_threads(threads, len(parts)))
    run_tasks(runs, lambda: put, threads)
    return bvh, roots


def _place_in_frame(points: Points, extents: list[Extent]) -> tuple[Points, Vec, Vec, float]:
    """Find the space of the boxes.

    Returns
    -------
    points
        The points with that space.
    low, high
        The box around their centres in it.
    largest
        The largest coordinate or radius in world space.
    """
    low = np.min([extent.low for extent in extents], axis=0)
    high = np.max([extent.high for extent in extents], axis=0)
    largest = max(-float(low.min()), float(high.max()), *(extent.radius for extent in extents))
    # The scale and its inverse must be ordinary doubles.
    scale = math.ldexp(1.0, -max(math.frexp(largest)[1], -1000))
    middle = low * scale * 0.5 + high * scale * 0.5
    placed = points._replace(frame=Frame(scale, _vec(middle)))
    return placed, _vec(low * scale - middle), _vec(high * scale - middle), largest


def _vec(array: NDArray[np.float64]) -> Vec:
    """Return an array of three numbers as a tuple."""
    x, y, z = map(float, array)
    return x, y, z


def _run(
    chunks: list[tuple[int, int]], function: Callable[[tuple[int, int]], object], threads: int
) -> None:
    """Call a function with each chunk."""
    run_tasks(chunks, lambda: function, threads)
