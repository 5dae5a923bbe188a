"""Builds the hierarchy, in parallel from the first step to the last but the topmost nodes.

Primitives are sorted along Morton's curve. A few topmost nodes divide them into ranges, whose trees
are then built side by side. The tree is the same for any number of threads.
"""

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import pinned, uncompiled
from vtray.base.pool import Progress, run_tasks
from vtray.geometry.bvh.join import join_trees
from vtray.geometry.bvh.key_sort import Keys, sort_keys
from vtray.geometry.bvh.morton import Grid, make_grid
from vtray.geometry.bvh.nodes import (
    Extent,
    count_beyond,
    find_extent,
    finish_subtrees,
    finish_top,
    set_keys,
    split_ranges,
    take_numbers,
)
from vtray.geometry.bvh.primitives import Boxes, Numbers, Primitives, new_boxes
from vtray.geometry.bvh.split import Order, new_scratch
from vtray.geometry.bvh.tree import LEAF, SIDES, STACK, WIDTH, Bvh, Frame, new_bvh, node_count
from vtray.geometry.vector import Vec

CHUNK = 1 << 15
"""Primitives whose boxes are looked at as one task."""

SMALL = 1 << 14
"""Primitives, about, whose trees are built as one task: a cache holds them and their boxes."""

FARTHEST = 24
"""By so many bits, the middle of all primitives may be farther from the origin than they reach."""

COARSE = 10
"""By so many bits, what few primitives reach is farther than nearly all: those are left beyond."""

FINITE = 900
"""By so many bits, what is beyond may be farther, and is still no infinity in the boxes' space."""

MOST_BEYOND = 32
"""So many primitives may be beyond the space of the boxes. Every ray is asked about them."""

FEWEST, RUN = 256, 8
"""Of so many primitives on, some of which runs of eight are looked at, it is asked which are."""

WIDER = 16.0
"""How many times as far as eight of ten primitives nearly all of them reach."""

CROWD = 1 << 16
"""If there are more primitives in one cell, all threads divide it together."""

Range = tuple[int, int]
Bound = Callable[[Range, Boxes], None]


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
    tree_depth
        How many nodes lie one below the other at the most.
    largest
        The largest coordinate of a centre, or half extent, in world space.
    """

    numbers: Numbers
    bvh: Bvh
    frame: Frame
    tree_depth: int
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
    everything = 0, primitives.count

    def bound(chunk: Range, boxes: Boxes) -> None:
        primitives.bound(*chunk, boxes)

    extent = _find_extent(everything, bound, threads)
    largest = _largest_of(extent)
    frame = _make_frame(extent, largest)
    core = _core_of(everything, bound)
    if core is not None and _is_apart(core, extent):
        small = _make_frame(core, _largest_of(core))
        if _count_beyond(everything, bound, small, threads) <= MOST_BEYOND:
            extent, frame = core, small
    grid = _make_grid(extent, frame, max(primitives.count - 1, 1).bit_length())
    keys = sort_keys(_new_keys(everything, bound, frame, grid, threads), threads, grid.number_bits)
    order = Order(keys, grid)
    numbers = np.empty(primitives.count, np.int32)
    bvh, tree_depth = _build_nodes(primitives, frame, order, numbers, threads, progress)
    return Tree(numbers, bvh, frame, tree_depth, largest)


def bounds_of(primitives: Primitives, threads: int) -> tuple[Vec, Vec]:
    """Return the corners of a box that holds primitives, in world space; they may be infinite."""

    def bound(chunk: Range, boxes: Boxes) -> None:
        primitives.bound(*chunk, boxes)

    low, high, half = _find_extent((0, primitives.count), bound, threads)
    with np.errstate(over="ignore"):
        return _vec(np.subtract(low, half)), _vec(np.add(high, half))


def _find_extent(whole: Range, bound: Bound, threads: int) -> Extent:
    """Return the extent of a range of primitives."""
    found: dict[Range, Extent] = {}

    def look(chunk: Range, boxes: Boxes) -> None:
        found[chunk] = find_extent(boxes, chunk[1] - chunk[0])

    _look_at_all(whole, bound, look, threads)
    # In the order of the chunks, as of 0 and -0 the first is taken.
    extents = [found[chunk] for chunk in sorted(found)]
    low = np.min([extent.low for extent in extents], axis=0)
    high = np.max([extent.high for extent in extents], axis=0)
    return Extent(_vec(low), _vec(high), max(extent.half for extent in extents))


def _core_of(whole: Range, bound: Bound) -> Extent | None:
    """Return an extent that holds nearly all of a range of primitives, None if that is not known.

    It is told by some of them that are spread over the range, of which a tenth counts for nothing
    on each side.
    """
    count = whole[1] - whole[0]
    if count < FEWEST:
        return None
    runs = range(whole[0], whole[1] - RUN + 1, max((count - RUN) // (FEWEST // RUN - 1), 1))
    some = [new_boxes(RUN) for _ in runs]
    for begin, boxes in zip(runs, some, strict=True):
        bound((begin, begin + RUN), boxes)
    found = np.concatenate([boxes[:, :RUN] for boxes in some], axis=1)
    found[3] = found[3:].max(axis=0)
    tenth = found.shape[1] // 10
    low, middle, high = np.sort(found[:4], axis=1)[:, [tenth, 5 * tenth, -tenth]].T
    half = float(middle[3])
    reach = WIDER * max(float((0.5 * high[:3] - 0.5 * low[:3]).max()), half)
    with np.errstate(over="ignore"):
        corners = _vec(middle[:3] - reach), _vec(middle[:3] + reach)
    return Extent(*corners, half) if 0.0 < reach < math.inf else None


def _is_apart(core: Extent, extent: Extent) -> bool:
    """Tell whether an extent is so much larger than its core that boxes there would be coarse."""
    (_, inner), (_, outer) = (math.frexp(_width_of(one)) for one in (core, extent))
    return COARSE <= outer - inner <= FINITE


def _count_beyond(whole: Range, bound: Bound, frame: Frame, threads: int) -> int:
    """Return how many of a range of primitives reach beyond the space of a frame."""
    place, counts = pinned(frame), []

    def look(chunk: Range, boxes: Boxes) -> None:
        counts.append(count_beyond(boxes, chunk[1] - chunk[0], place))

    _look_at_all(whole, bound, look, threads)
    return sum(counts)


def _new_keys(whole: Range, bound: Bound, frame: Frame, grid: Grid, threads: int) -> Keys:
    """Return keys of a range of primitives, whose low bits count the primitives from 0."""
    order = Order(np.empty(whole[1] - whole[0], np.uint64), grid)
    place, target = pinned(frame), pinned(order)

    def look(chunk: Range, boxes: Boxes) -> None:
        set_keys(boxes, place, chunk[0] - whole[0], chunk[1] - whole[0], target)

    _look_at_all(whole, bound, look, threads)
    return order.keys


def _look_at_all(
    whole: Range, bound: Bound, look: Callable[[Range, Boxes], None], threads: int
) -> None:
    """Have the boxes of a range of primitives looked at, chunk by chunk."""
    begins = range(*whole, CHUNK)
    chunks = [(begin, min(begin + CHUNK, whole[1])) for begin in begins]

    def new_worker() -> Callable[[Range], None]:
        boxes = new_boxes(min(CHUNK, whole[1] - whole[0]))

        def work(chunk: Range) -> None:
            bound(chunk, boxes)
            look(chunk, boxes)

        return work

    run_tasks(chunks, new_worker, threads)


def _largest_of(extent: Extent) -> float:
    """Return the largest coordinate of a centre, or half extent."""
    return max(-min(extent.low), *extent.high, extent.half)


def _width_of(extent: Extent) -> float:
    """Return how far from their middle centres are, or half of the largest extent."""
    low, high = np.array(extent.low), np.array(extent.high)
    return max(float((0.5 * high - 0.5 * low).max()), extent.half)


def _make_frame(extent: Extent, largest: float) -> Frame:
    """Return the space of the boxes of an extent, and of the largest number in it."""
    # Single precision is fine enough for boxes that are far from the world's origin, too.
    exponent = max(math.frexp(_width_of(extent))[1], math.frexp(largest)[1] - FARTHEST)
    # The scale and its inverse must be ordinary doubles.
    scale = math.ldexp(1.0, -max(exponent, -1000))
    low, high = np.array(extent.low), np.array(extent.high)
    return Frame(scale, _vec(low * scale * 0.5 + high * scale * 0.5))


def _make_grid(extent: Extent, frame: Frame, number_bits: int) -> Grid:
    """Return the grid over the centres of primitives."""
    low, high = (np.array(corner) * frame.scale - frame.origin for corner in extent[:2])
    return uncompiled(make_grid)(_vec(low), _vec(high), number_bits)


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
    bvh, tree_depth
        As in `Tree`.
    """
    top, ranges, tree_depth = _split_top(primitives, frame, order, threads)
    tasks = _tasks(ranges)
    parts, tree_depths = [top] * (len(tasks) + 1), [tree_depth] * (len(tasks) + 1)
    largest = max(int(task[-1, 2] - task[0, 1]) for task in tasks)
    place, sorted_, above = pinned(frame), pinned(order), pinned(top)
    ordered, nothing = pinned(numbers), pinned(np.empty((0, 4), np.int64))

    def new_worker() -> Callable[[int], None]:
        # All nodes but the last, which have more primitives than a leaf, have eight children, so
        # that a tree of m primitives has fewer than m / 4 nodes.
        bvh, boxes = new_bvh(largest // 4 + 1), new_boxes(largest)
        tree, scratch, drawn = pinned(bvh), pinned(new_scratch()), np.empty(largest, np.int32)

        def build_one(k: int) -> None:
            task, begin, end = tasks[k], int(tasks[k][0, 1]), int(tasks[k][-1, 2])
            take_numbers(sorted_, begin, end, drawn)
            primitives.gather(drawn[: end - begin], begin, boxes)
            size, _, tree_depths[k + 1] = split_ranges(
                boxes, place, sorted_, 0, task, above, tree, 0, nothing, scratch
            )
            if finish_subtrees(boxes, place, sorted_, drawn, task, above, tree, size, ordered):
                primitives.gather(numbers[begin:end], begin, boxes)
            parts[k + 1] = Bvh(bvh.sides[: size * SIDES].copy(), bvh.child[: size * WIDTH].copy())

        return build_one

    run_tasks(range(len(tasks)), new_worker, threads, progress=progress)
    bvh, first = join_trees(parts, threads)
    for task, root in zip(tasks, first[1:], strict=True):
        bvh.child[task[task[:, 2] - task[:, 1] > LEAF, 0]] += root
    finish_top(bvh, node_count(top))
    return bvh, 1 + max(tree_depths)


def _split_top(
    primitives: Primitives, frame: Frame, order: Order, threads: int
) -> tuple[Bvh, NDArray[np.int64], int]:
    """Make the topmost nodes.

    Returns
    -------
    top
        The nodes, without boxes.
    ranges
        The ranges below, as in `split_ranges`, in the order of their slots.
    tree_depth
        The depth of the deepest of these nodes.
    """
    n = primitives.count
    # Nodes of one depth have primitives of their own, so at most n / SMALL of them are larger than
    # that. Memory that is never written to costs nothing.
    most = (n // SMALL + 1) * (STACK // WIDTH)
    top, left = new_bvh(most), np.empty((most * WIDTH, 4), np.int64)
    waiting, done = np.array([[0, 0, n, 0]]), []
    nodes, deepest = 0, 0
    while len(waiting) > 0:
        nodes, found, tree_depth = split_ranges(
            new_boxes(0), frame, order, SMALL, waiting, top, top, nodes, left, new_scratch()
        )
        deepest = max(deepest, tree_depth)
        crowded = left[:found, 2] - left[:found, 1] > CROWD
        done.append(left[:found][~crowded])
        waiting = left[:found][crowded]
        for begin, end in waiting[:, 1:3].tolist():
            _divide_crowd(primitives, frame, order, (begin, end), threads)
    ranges = np.concatenate(done)
    ranges = ranges[ranges[:, 1].argsort()]
    return Bvh(top.sides[: nodes * SIDES], top.child[: nodes * WIDTH]), ranges, deepest


def _divide_crowd(
    primitives: Primitives, frame: Frame, order: Order, crowd: Range, threads: int
) -> None:
    """Sort the primitives of one cell by a grid of their own, or else divide them by numbers."""
    keys, bits = order.keys[slice(*crowd)], np.uint64(order.grid.number_bits)
    numbers = (keys & ((np.uint64(1) << bits) - np.uint64(1))).astype(np.int32)

    def bound(chunk: Range, boxes: Boxes) -> None:
        begin, end = chunk
        primitives.gather(numbers[begin - crowd[0] : end - crowd[0]], begin, boxes)

    grid = _make_grid(_find_extent(crowd, bound, threads), frame, order.grid.number_bits)
    if grid.cells > 0.0:
        finer = _new_keys(crowd, bound, frame, grid, threads)
    else:
        finer = np.arange(len(keys), dtype=np.uint64) << bits
    keys[...] = sort_keys(finer >> bits << bits | numbers.astype(np.uint64), threads, int(bits))


def _tasks(ranges: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Return neighbouring ranges together; several have no more primitives than `SMALL`."""
    cuts, begin = [], 0
    for k, end in enumerate(ranges[:, 2].tolist()):
        if end - begin > SMALL and k > 0:
            cuts.append(k)
            begin = int(ranges[k, 1])
    return np.split(ranges, cuts)


def _vec(values: Iterable[float]) -> Vec:
    """Return three numbers as a tuple."""
    x, y, z = map(float, values)
    return x, y, z
