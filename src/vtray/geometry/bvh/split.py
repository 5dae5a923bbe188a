"""Splits ranges of sorted keys into nodes, where their codes differ.

References
----------
Lauterbach, Garland, Sengupta, Luebke, Manocha, "Fast BVH Construction on GPUs", 2009.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.key_sort import Keys, sort_few
from vtray.geometry.bvh.morton import Grid, in_one_cell, key_number, make_grid, make_key
from vtray.geometry.bvh.primitives import Boxes
from vtray.geometry.bvh.tree import EMPTY, LEAF, MAX_TREE_DEPTH, STACK, WIDTH, Bvh, Frame, leaf_code
from vtray.geometry.vector import Vec, lower, scale, sub, upper


class Order(NamedTuple):
    """The order of the primitives.

    Attributes
    ----------
    keys
        Sorted; the low bits of a key lead to the primitive, (n,).
    grid
        The grid of the keys.
    """

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


@device
def box_place(boxes: Boxes, k: int, frame: Frame) -> Vec:
    """Return the centre of a box in the space of the hierarchy's boxes."""
    center = boxes[0, k], boxes[1, k], boxes[2, k]
    return sub(scale(frame.scale, center), frame.origin)


@device
def split_range(
    boxes: Boxes,
    frame: Frame,
    order: Order,
    begin: int,
    end: int,
    tree_depth: int,
    grain: int,
    bvh: Bvh,
    root: int,
    left: NDArray[np.int64],
    found: int,
    scratch: Scratch,
) -> tuple[int, int, int]:
    """Make the nodes of a range, down to ranges of `grain` or to leaves.

    A child comes after its parent. Until a node is split, its begin, its end and its depth stand in
    the places of its children.

    Parameters
    ----------
    boxes, frame, order, grain, left, scratch
        As in `split_ranges`.
    begin, end, tree_depth
        The range, in slots, and the depth of its node in the tree.
    bvh, root
        Out: the nodes, and the number of the first.
    found
        How many ranges are left already.

    Returns
    -------
    nodes, ranges, tree_depth
        How many nodes there are now, how many ranges are left, and the depth of the deepest node.
    """
    child, stack = bvh.child, scratch.stack
    used, waiting = root + 1, 1
    stack[0] = root
    child[root * WIDTH] = begin
    child[root * WIDTH + 1] = end
    child[root * WIDTH + 2] = tree_depth
    deepest = tree_depth
    while waiting > 0:
        waiting -= 1
        first = stack[waiting] * WIDTH
        tree_depth = child[first + 2]
        deepest = max(deepest, tree_depth)
        count = _split_node(
            boxes, frame, order, child[first], child[first + 1], tree_depth, grain, scratch
        )
        for k in range(WIDTH):
            low, high = scratch.begin[k], scratch.end[k]
            if k >= count:
                child[first + k] = EMPTY
            elif high - low <= grain or _is_left(order, low, high, grain):
                left[found, 0] = first + k
                left[found, 1] = low
                left[found, 2] = high
                left[found, 3] = tree_depth + 1
                found += 1
            elif high - low <= LEAF:
                child[first + k] = leaf_code(low, high - low)
            else:
                child[first + k] = used
                child[used * WIDTH] = low
                child[used * WIDTH + 1] = high
                child[used * WIDTH + 2] = tree_depth + 1
                stack[waiting] = used
                waiting += 1
                used += 1
    return used, found, deepest


@device
def _is_left(order: Order, begin: int, end: int, grain: int) -> bool:
    """Tell whether a range is left to who has boxes, and can sort it by a finer grid."""
    return grain > 0 and in_one_cell(order.keys[begin], order.keys[end - 1], order.grid)


@device
def _split_node(
    boxes: Boxes,
    frame: Frame,
    order: Order,
    begin: int,
    end: int,
    tree_depth: int,
    grain: int,
    scratch: Scratch,
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
        if high - low == 1 or _is_left(order, low, high, grain):
            break
        middle = _split_in_two(boxes, frame, order, low, high, tree_depth)
        for k in range(ranges, largest + 1, -1):
            starts[k] = starts[k - 1]
            ends[k] = ends[k - 1]
        ends[largest] = middle
        starts[largest + 1] = middle
        ends[largest + 1] = high
        ranges += 1
    return ranges


@device
def _split_in_two(
    boxes: Boxes, frame: Frame, order: Order, begin: int, end: int, tree_depth: int
) -> int:
    """Return where the second part of a range begins."""
    keys, grid = order.keys, order.grid
    half = (begin + end) // 2
    if tree_depth >= MAX_TREE_DEPTH:
        return half
    if in_one_cell(keys[begin], keys[end - 1], grid):
        _sort_within_cell(boxes, frame, order, begin, end)
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
def _sort_within_cell(boxes: Boxes, frame: Frame, order: Order, begin: int, end: int) -> None:
    """Sort the boxes of one cell by a grid of their own, if they are not all in one place."""
    keys, grid = order.keys, order.grid
    low = box_place(boxes, key_number(keys[begin], grid), frame)
    high = low
    for k in range(begin, end):
        place = box_place(boxes, key_number(keys[k], grid), frame)
        low, high = lower(low, place), upper(high, place)
    finer = make_grid(low, high, grid.number_bits)
    if finer.cells > 0.0:
        for k in range(begin, end):
            number = key_number(keys[k], grid)
            keys[k] = make_key(box_place(boxes, number, frame), number, finer)
        sort_few(keys, begin, end)
