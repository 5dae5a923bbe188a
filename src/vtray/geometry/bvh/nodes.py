"""The nodes of the hierarchy: ranges of sorted points, split where their codes differ.

References
----------
Lauterbach, Garland, Sengupta, Luebke, Manocha, "Fast BVH Construction on GPUs", 2009.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, input_array, kernel
from vtray.geometry.bvh.key_sort import Keys, sort_few
from vtray.geometry.bvh.morton import Grid, in_one_cell, key_number, make_grid, make_key
from vtray.geometry.bvh.tree import (
    EMPTY,
    LEAF,
    MAX_DEPTH,
    SIDES,
    STACK,
    WIDTH,
    Bvh,
    Frame,
    Leaves,
    leaf_code,
    leaf_range,
)
from vtray.geometry.packets.shaft import MARGIN
from vtray.geometry.vector import Vec, add, lower, magnitude, scale, sub, upper

FULL_ENOUGH = 3
"""The children of a node are split further until none has more spheres, or the node is full."""

OUTSIDE = 3.0e38
"""The low sides of an empty box, and minus its high sides."""


class Points(NamedTuple):
    """The spheres as they are given.

    Of two kinds of numbers, so that nobody waits for kernels of the other kind: one array holds the
    centres, and the other none.

    Attributes
    ----------
    center
        World space, (n, 3), or (0, 3) if they are single.
    single
        The same of numbers of single precision, (0, 3) or (n, 3).
    radius
        (n,), or (1,) if all are the same.
    frame
        The space of the boxes.
    """

    center: NDArray[np.float64]
    single: NDArray[np.float32]
    radius: NDArray[np.float64]
    frame: Frame


class Extent(NamedTuple):
    """The box around some points, and the largest radius."""

    low: Vec
    high: Vec
    radius: float


class Order(NamedTuple):
    """The points' order: their sorted keys, and the grid of these."""

    keys: Keys
    grid: Grid


class Scratch(NamedTuple):
    """The nodes that wait to be split, and the ranges of a node's children."""

    stack: NDArray[np.int64]
    begin: NDArray[np.int64]
    end: NDArray[np.int64]


def new_scratch() -> Scratch:
    """Return the scratch memory of one thread."""
    return Scratch(*(np.empty(size, np.int64) for size in (STACK, WIDTH, WIDTH)))


def new_points(center: NDArray[Any], radius: NDArray[Any]) -> Points:
    """Return spheres in world space, in no frame yet; the numbers are copied only if they must be.

    Parameters
    ----------
    center
        (n, 3), float32 or float64.
    radius
        (n,), or (1,) if all are the same.
    """
    single = center.dtype == np.float32
    return Points(
        input_array(center[:0] if single else center, np.float64),
        input_array(center if single else center[:0], np.float32),
        input_array(radius, np.float64),
        Frame(1.0, (0.0, 0.0, 0.0)),
    )


@kernel
def find_extent(points: Points, begin: int, end: int) -> Extent:
    """Return the extent in world space of a range of points."""
    low = math.inf, math.inf, math.inf
    high = -math.inf, -math.inf, -math.inf
    radius = 0.0
    last = points.radius.shape[0] - 1
    for k in range(begin, end):
        place = _center(points, k)
        low, high = lower(low, place), upper(high, place)
        radius = max(radius, points.radius[min(k, last)])
    return Extent(low, high, radius)


@kernel
def set_keys(points: Points, begin: int, end: int, order: Order) -> None:
    """Set the keys of a range of points."""
    for k in range(begin, end):
        order.keys[k] = make_key(_place(points, k), k, order.grid)


@kernel
def split_top(
    points: Points,
    order: Order,
    grain: int,
    bvh: Bvh,
    subtrees: NDArray[np.int64],
    scratch: Scratch,
) -> tuple[int, int, int]:
    """Make the topmost nodes.

    Parameters
    ----------
    grain
        The size of the ranges that are left for `build_subtree`.
    subtrees
        Out: for each of these ranges the place in ``bvh.child`` for its node, its begin, its end,
        and its depth, (n, 4).

    Returns
    -------
    nodes, subtrees, depth
        How many there are, and the depth of the deepest of these nodes.
    """
    end = order.keys.shape[0]
    return _split(points, order, 0, end, 0, grain, bvh, subtrees, scratch)


@kernel
def build_subtree(
    points: Points,
    order: Order,
    begin: int,
    end: int,
    depth: int,
    bvh: Bvh,
    leaves: Leaves,
    subtrees: NDArray[np.int64],
    scratch: Scratch,
) -> tuple[int, int]:
    """Build the tree of a range of points, its root as node 0.

    Returns
    -------
    nodes, depth
        How many there are, and the depth of the deepest.
    """
    used, _, deepest = _split(points, order, begin, end, depth, LEAF, bvh, subtrees, scratch)
    _gather(points, order, begin, end, leaves)
    for node in range(used - 1, -1, -1):
        _find_boxes(node, bvh, leaves, points.frame)
    return used, deepest


@kernel
def finish_top(points: Points, order: Order, nodes: int, bvh: Bvh, leaves: Leaves) -> None:
    """Set leaves and boxes of the topmost nodes, whose subtrees are built."""
    for node in range(nodes - 1, -1, -1):
        for k in range(node * WIDTH, (node + 1) * WIDTH):
            if bvh.child[k] < EMPTY:
                begin, end = leaf_range(bvh.child[k])
                _gather(points, order, begin, end, leaves)
        _find_boxes(node, bvh, leaves, points.frame)


@device
def _center(points: Points, number: int) -> Vec:
    """Return the centre of a sphere in world space."""
    center, single = points.center, points.single
    if single.shape[0] > 0:
        return float(single[number, 0]), float(single[number, 1]), float(single[number, 2])
    return center[number, 0], center[number, 1], center[number, 2]


@device
def _place(points: Points, number: int) -> Vec:
    """Return the centre of a sphere in the boxes' space."""
    return _to_frame(_center(points, number), points.frame)


@device
def _to_frame(center: Vec, frame: Frame) -> Vec:
    """Return a point of world space in the boxes' space."""
    return sub(scale(frame.scale, center), frame.origin)


@device
def _split(
    points: Points,
    order: Order,
    begin: int,
    end: int,
    depth: int,
    grain: int,
    bvh: Bvh,
    subtrees: NDArray[np.int64],
    scratch: Scratch,
) -> tuple[int, int, int]:
    """Make nodes of a range, down to ranges of `grain`; return their number, subtrees, and depth.

    A child comes after its parent. Until a node is split, its begin, its end and its depth stand in
    the places of its children.
    """
    child, stack = bvh.child, scratch.stack
    used, found, waiting = 1, 0, 1
    stack[0] = 0
    child[0] = begin
    child[1] = end
    child[2] = depth
    deepest = depth
    while waiting > 0:
        waiting -= 1
        first = stack[waiting] * WIDTH
        depth = child[first + 2]
        deepest = max(deepest, depth)
        ranges = _split_node(points, order, child[first], child[first + 1], depth, grain, scratch)
        for k in range(WIDTH):
            low, high = scratch.begin[k], scratch.end[k]
            if k >= ranges:
                child[first + k] = EMPTY
            elif high - low <= LEAF:
                child[first + k] = leaf_code(low, high - low)
            elif high - low <= grain or _is_left(order, low, high, grain):
                subtrees[found, 0] = first + k
                subtrees[found, 1] = low
                subtrees[found, 2] = high
                subtrees[found, 3] = depth + 1
                found += 1
            else:
                child[first + k] = used
                child[used * WIDTH] = low
                child[used * WIDTH + 1] = high
                child[used * WIDTH + 2] = depth + 1
                stack[waiting] = used
                waiting += 1
                used += 1
    return used, found, deepest


@device
def _is_left(order: Order, begin: int, end: int, grain: int) -> bool:
    """Tell whether a range is left for a subtree, which sorts it by a finer grid."""
    return grain > LEAF and in_one_cell(order.keys[begin], order.keys[end - 1], order.grid)


@device
def _split_node(
    points: Points, order: Order, begin: int, end: int, depth: int, grain: int, scratch: Scratch
) -> int:
    """Split a range into up to eight, always the largest next; return how many."""
    starts, ends = scratch.begin, scratch.end
    starts[0] = begin
    ends[0] = end
    ranges = 1
    while ranges < WIDTH:
        largest = 0
        for k in range(1, ranges):
            if ends[k] - starts[k] > ends[largest] - starts[largest]:
                largest = k
        low, high = starts[largest], ends[largest]
        if high - low <= FULL_ENOUGH or _is_left(order, low, high, grain):
            break
        middle = _split_range(points, order, low, high, depth)
        for k in range(ranges, largest + 1, -1):
            starts[k] = starts[k - 1]
            ends[k] = ends[k - 1]
        ends[largest] = middle
        starts[largest + 1] = middle
        ends[largest + 1] = high
        ranges += 1
    return ranges


@device
def _split_range(points: Points, order: Order, begin: int, end: int, depth: int) -> int:
    """Return where the second part of a range begins."""
    keys, grid = order.keys, order.grid
    half = (begin + end) // 2
    if depth >= MAX_DEPTH:
        return half
    if in_one_cell(keys[begin], keys[end - 1], grid):
        _sort_within_cell(points, order, begin, end)
        if in_one_cell(keys[begin], keys[end - 1], grid):
            return half
    # The highest bit that changes between the first and the last key changes just once.
    first, last = keys[begin], keys[end - 1]
    low, high = begin, end - 1
    while low + 1 < high:
        half = (low + high) // 2
        # A key shares that bit with the one from which it differs by less.
        if keys[half] ^ first < keys[half] ^ last:
            low = half
        else:
            high = half
    return high


@device
def _sort_within_cell(points: Points, order: Order, begin: int, end: int) -> None:
    """Sort the points of one cell by a grid of their own, if they are not all in one place."""
    keys, grid = order.keys, order.grid
    low = _place(points, key_number(keys[begin], grid))
    high = low
    for k in range(begin, end):
        place = _place(points, key_number(keys[k], grid))
        low, high = lower(low, place), upper(high, place)
    finer = make_grid(low, high, grid.number_bits)
    if finer.cells > 0.0:
        for k in range(begin, end):
            number = key_number(keys[k], grid)
            keys[k] = make_key(_place(points, number), number, finer)
        sort_few(keys, begin, end)


@device
def _gather(points: Points, order: Order, begin: int, end: int, leaves: Leaves) -> None:
    """Copy a range of spheres to where they belong."""
    # A loop of its own: most of these loads miss all caches, and the less else there is to do, the
    # more of them the processor has under way at a time.
    last = points.radius.shape[0] - 1
    for slot in range(begin, end):
        number = key_number(order.keys[slot], order.grid)
        x, y, z = _center(points, number)
        leaves.data[4 * slot] = x
        leaves.data[4 * slot + 1] = y
        leaves.data[4 * slot + 2] = z
        leaves.data[4 * slot + 3] = points.radius[min(number, last)]
        leaves.number[slot] = number


@device
def _find_boxes(node: int, bvh: Bvh, leaves: Leaves, frame: Frame) -> None:
    """Set the boxes of a node's children, once the nodes below it have theirs."""
    for k in range(WIDTH):
        child = bvh.child[node * WIDTH + k]
        low = OUTSIDE, OUTSIDE, OUTSIDE
        high = -OUTSIDE, -OUTSIDE, -OUTSIDE
        if child >= 0:
            low, high = _node_box(child, bvh)
        elif child != EMPTY:
            begin, end = leaf_range(child)
            low, high = _leaf_box(begin, end, leaves, frame)
        for axis in range(3):
            bvh.sides[node * SIDES + axis * WIDTH + k] = low[axis]
            bvh.sides[node * SIDES + (3 + axis) * WIDTH + k] = high[axis]


@device
def _leaf_box(begin: int, end: int, leaves: Leaves, frame: Frame) -> tuple[Vec, Vec]:
    """Return the box around the spheres of a leaf, wider than rounding could explain."""
    low = OUTSIDE, OUTSIDE, OUTSIDE
    high = -OUTSIDE, -OUTSIDE, -OUTSIDE
    data = leaves.data
    for slot in range(begin, end):
        place = _to_frame((data[4 * slot], data[4 * slot + 1], data[4 * slot + 2]), frame)
        reach = data[4 * slot + 3] * frame.scale
        reach += MARGIN * (magnitude(place) + reach)
        corner = reach, reach, reach
        low, high = lower(low, sub(place, corner)), upper(high, add(place, corner))
    return (
        (_below(low[0]), _below(low[1]), _below(low[2])),
        (-_below(-high[0]), -_below(-high[1]), -_below(-high[2])),
    )


@device
def _below(value: float) -> float:
    """Return a number that is still below a value when it is rounded to float32."""
    return value - abs(value) * 2.0**-23 - 2.0**-149


@device
def _node_box(node: int, bvh: Bvh) -> tuple[Vec, Vec]:
    """Return the box around a node's children."""
    low = OUTSIDE, OUTSIDE, OUTSIDE
    high = -OUTSIDE, -OUTSIDE, -OUTSIDE
    sides = bvh.sides
    for k in range(node * SIDES, node * SIDES + WIDTH):
        low_k = float(sides[k]), float(sides[k + WIDTH]), float(sides[k + 2 * WIDTH])
        k_high = k + 3 * WIDTH
        high_k = (
            float(sides[k_high]),
            float(sides[k_high + WIDTH]),
            float(sides[k_high + 2 * WIDTH]),
        )
        low, high = lower(low, low_k), upper(high, high_k)
    return low, high
