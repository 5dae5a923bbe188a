"""The kernels of building: keys of boxes, the topmost nodes, and the trees below them."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.bvh.morton import key_number, make_key
from vtray.geometry.bvh.primitives import Boxes, Numbers
from vtray.geometry.bvh.split import Order, Scratch, box_place, split_range
from vtray.geometry.bvh.tree import (
    EMPTY,
    EVERYWHERE,
    FRAME,
    LEAF,
    SIDES,
    WIDTH,
    Bvh,
    Frame,
    leaf_code,
    leaf_range,
)
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import Vec, add, lower, magnitude, sub, upper

OUTSIDE = 1.0e7
"""The low sides of an empty box, and minus its high sides: much farther away than any box."""


class Extent(NamedTuple):
    """The box around the centres of some boxes, and the largest of half their extents."""

    low: Vec
    high: Vec
    half: float


@kernel
def find_extent(boxes: Boxes, count: int) -> Extent:
    """Return the extent in world space of the first boxes."""
    low = math.inf, math.inf, math.inf
    high = -math.inf, -math.inf, -math.inf
    half = 0.0
    for k in range(count):
        center = boxes[0, k], boxes[1, k], boxes[2, k]
        low, high = lower(low, center), upper(high, center)
        half = max(half, _largest_half(boxes, k))
    return Extent(low, high, half)


@kernel
def set_keys(boxes: Boxes, frame: Frame, begin: int, end: int, order: Order) -> None:
    """Set the keys of a range of primitives.

    Parameters
    ----------
    boxes
        Theirs are the first.
    frame
        The space of the keys' grid.
    begin, end
        The range, in numbers.
    order
        Out: the keys, not yet sorted.
    """
    for k in range(end - begin):
        order.keys[begin + k] = make_key(box_place(boxes, k, frame), begin + k, order.grid)


@kernel
def split_ranges(
    boxes: Boxes,
    frame: Frame,
    order: Order,
    grain: int,
    ranges: NDArray[np.int64],
    above: Bvh,
    bvh: Bvh,
    nodes: int,
    left: NDArray[np.int64],
    scratch: Scratch,
) -> tuple[int, int, int]:
    """Make the nodes of ranges of primitives, without boxes.

    Parameters
    ----------
    boxes, frame
        The boxes that the keys lead to, and the space of the hierarchy's boxes; where `grain` is
        not 0 they are not looked at.
    order
        The order of the primitives, which becomes finer where many are in one cell.
    grain
        The size of the ranges that are left for later, or 0 to go on to the leaves.
    ranges
        For each range the place in ``above.child`` for its node or leaf, its begin and its end in
        slots, and the depth in the tree of its node, (m, 4).
    above
        Out: where the ranges belong, the numbers of their nodes, or their leaves.
    bvh, nodes
        Out: the nodes, which follow those that it has already.
    left
        Out: the ranges that are left, with their places in ``bvh.child``, as in `ranges`.
    scratch
        Scratch memory.

    Returns
    -------
    nodes, ranges, tree_depth
        How many nodes there are, how many ranges are left, and the depth of the deepest node that
        was made, 0 if none was.
    """
    used, found, deepest = nodes, 0, 0
    for k in range(ranges.shape[0]):
        place, begin, end = ranges[k, 0], ranges[k, 1], ranges[k, 2]
        if grain == 0 and end - begin <= LEAF:
            above.child[place] = leaf_code(begin, end - begin)
        else:
            above.child[place] = used
            used, found, tree_depth = split_range(
                *(boxes, frame, order, begin, end, ranges[k, 3], grain, bvh, used),
                *(left, found, scratch),
            )
            deepest = max(deepest, tree_depth)
    return used, found, deepest


@kernel
def take_numbers(order: Order, begin: int, end: int, numbers: Numbers) -> None:
    """Take the numbers of a range of primitives out of their keys.

    From then on, the keys lead to where the numbers stand now, and where their boxes will.

    Parameters
    ----------
    order
        The order of the primitives.
    begin, end
        The range, in slots.
    numbers
        Out: the numbers, (m,), m >= end - begin.
    """
    keys, bits = order.keys, np.uint64(order.grid.number_bits)
    for k in range(end - begin):
        key = keys[begin + k]
        numbers[k] = key_number(key, order.grid)
        keys[begin + k] = key >> bits << bits | np.uint64(k)


@kernel
def finish_subtrees(
    boxes: Boxes,
    frame: Frame,
    order: Order,
    numbers: Numbers,
    ranges: NDArray[np.int64],
    above: Bvh,
    bvh: Bvh,
    nodes: int,
    ordered: Numbers,
) -> bool:
    """Set the boxes of neighbouring trees, and the numbers of their primitives.

    Parameters
    ----------
    boxes, numbers
        Boxes and numbers of the primitives, where the keys lead.
    frame, order, ranges
        As in `split_ranges`, the ranges one after the other, at least one.
    above
        Out: the boxes of those ranges that are leaves.
    bvh, nodes
        Out: the boxes of all nodes, of which there are so many.
    ordered
        Out: the numbers of all primitives by their slots, (n,).

    Returns
    -------
    bool
        Whether the numbers by slots are in another order than `numbers`.
    """
    changed = False
    first, last = ranges[0, 1], ranges[ranges.shape[0] - 1, 2]
    for k in range(last - first):
        drawn = key_number(order.keys[first + k], order.grid)
        changed |= drawn != k
        ordered[first + k] = numbers[drawn]
    for place in range(nodes * WIDTH - 1, -1, -1):
        if bvh.child[place] < EMPTY:
            set_box(bvh, place, _leaf_box(boxes, frame, order, bvh.child[place]))
        else:
            set_box(bvh, place, node_box(bvh.child[place], bvh))
    for k in range(ranges.shape[0]):
        place = ranges[k, 0]
        if above.child[place] < EMPTY:
            set_box(above, place, _leaf_box(boxes, frame, order, above.child[place]))
    return changed


@kernel
def finish_top(bvh: Bvh, nodes: int) -> None:
    """Set the boxes of the topmost nodes, whose subtrees are built and whose leaves have theirs."""
    for place in range(nodes * WIDTH - 1, -1, -1):
        if bvh.child[place] >= EMPTY:
            set_box(bvh, place, node_box(bvh.child[place], bvh))


@device
def _largest_half(boxes: Boxes, k: int) -> float:
    """Return the largest of half the extents of a box."""
    largest: float = max(boxes[3, k], boxes[4, k], boxes[5, k])
    return largest


@device
def _reach_of(boxes: Boxes, k: int, place: Vec, frame: Frame) -> float:
    """Return how far a box whose centre is at a place reaches in the space of a frame."""
    middle = max(abs(place[0]), abs(place[1]), abs(place[2]))
    reach: float = middle + _largest_half(boxes, k) * frame.scale
    return reach


@kernel
def count_beyond(boxes: Boxes, count: int, frame: Frame) -> int:
    """Return how many of the first boxes reach beyond what single precision is fine for."""
    beyond = 0
    for k in range(count):
        beyond += 0 if _reach_of(boxes, k, box_place(boxes, k, frame), frame) <= FRAME else 1
    return beyond


@device
def _leaf_box(boxes: Boxes, frame: Frame, order: Order, code: int) -> tuple[Vec, Vec]:
    """Return the box around the boxes of a leaf, wider than rounding could explain."""
    low = OUTSIDE, OUTSIDE, OUTSIDE
    high = -OUTSIDE, -OUTSIDE, -OUTSIDE
    begin, end = leaf_range(code)
    for slot in range(begin, end):
        k = key_number(order.keys[slot], order.grid)
        place = box_place(boxes, k, frame)
        if not _reach_of(boxes, k, place, frame) <= FRAME:
            return (-EVERYWHERE, -EVERYWHERE, -EVERYWHERE), (EVERYWHERE, EVERYWHERE, EVERYWHERE)
        margin = MARGIN * (magnitude(place) + _largest_half(boxes, k) * frame.scale)
        half = (
            boxes[3, k] * frame.scale + margin,
            boxes[4, k] * frame.scale + margin,
            boxes[5, k] * frame.scale + margin,
        )
        low, high = lower(low, sub(place, half)), upper(high, add(place, half))
    return (
        (_below(low[0]), _below(low[1]), _below(low[2])),
        (-_below(-high[0]), -_below(-high[1]), -_below(-high[2])),
    )


@device
def _below(value: float) -> float:
    """Return a number that is still below a value when it is rounded to float32."""
    return value - abs(value) * 2.0**-23 - 2.0**-149


@device
def node_box(node: int, bvh: Bvh) -> tuple[Vec, Vec]:
    """Return the box around a node's children, an empty one if there is no such node."""
    low = OUTSIDE, OUTSIDE, OUTSIDE
    high = -OUTSIDE, -OUTSIDE, -OUTSIDE
    sides = bvh.sides
    if node != EMPTY:
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


@device
def set_box(bvh: Bvh, place: int, box: tuple[Vec, Vec]) -> None:
    """Set the box of a child, whose place is that in ``bvh.child``."""
    low, high = box
    first = place // WIDTH * SIDES + place % WIDTH
    for axis in range(3):
        bvh.sides[first + axis * WIDTH] = low[axis]
        bvh.sides[first + (3 + axis) * WIDTH] = high[axis]
