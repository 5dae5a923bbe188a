"""What is left of a tree when some of its primitives are left out."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.bvh.nodes import OUTSIDE, node_box, set_box
from vtray.geometry.bvh.tree import (
    EMPTY,
    SIDES,
    WIDTH,
    Bvh,
    leaf_code,
    leaf_range,
    new_bvh,
    node_count,
)

Slots = NDArray[np.int32]


def prune(bvh: Bvh, root: int, is_left: NDArray[np.bool_], begin: int, slot: int) -> Bvh:
    """Return the nodes above those primitives of a tree that are left, numbered from 0.

    Boxes of leaves stay; those above become as small as that allows. Nothing is sorted or split
    anew, so that this takes less than a tenth of the time of a build.

    Parameters
    ----------
    bvh, root
        Where the tree stands, and its root.
    is_left
        Which of its primitives are left, in the order of their slots, (n,).
    begin, slot
        The first of their slots, and where those that are left will begin, in the same order.
    """
    before = np.zeros(len(is_left) + 1, np.int32)
    np.cumsum(is_left, out=before[1:])
    alive, made = np.zeros(node_count(bvh) - root, np.int32), new_bvh(node_count(bvh) - root)
    count = keep_nodes(bvh, root, before, begin, slot, alive, made)
    return Bvh(made.sides[: count * SIDES].copy(), made.child[: count * WIDTH].copy())


@kernel
def keep_nodes(
    bvh: Bvh, root: int, before: Slots, begin: int, slot: int, alive: Slots, made: Bvh
) -> int:
    """Make the nodes that are left; return how many.

    Parameters
    ----------
    bvh, root, begin, slot
        As in `prune`.
    before
        How many primitives are left before each, and at last of all, (n + 1,).
    alive
        Scratch memory, 0, for each node from the root on: after its number there, counted from 1.
    made
        Out: the nodes.
    """
    last = _last_node(bvh, root)
    for place in range((last + 1) * WIDTH - 1, root * WIDTH - 1, -1):
        code, node = bvh.child[place], place // WIDTH
        is_kept = alive[code - root] > 0 if code > EMPTY else _count_left(code, before, begin) > 0
        if is_kept:
            alive[node - root] = 1
    count = 0
    for k in range(last - root + 1):
        count += alive[k]
        alive[k] *= count
    for k in range(last - root + 1):
        if alive[k] > 0:
            node, target = root + k, alive[k] - 1
            for side in range(SIDES):
                made.sides[target * SIDES + side] = bvh.sides[node * SIDES + side]
            for place in range(WIDTH):
                code = bvh.child[node * WIDTH + place]
                kept = alive[code - root] - 1 if code > EMPTY else EMPTY
                if _count_left(code, before, begin) > 0:
                    first, _ = leaf_range(code)
                    kept = leaf_code(slot + before[first - begin], _count_left(code, before, begin))
                made.child[target * WIDTH + place] = kept
    _fit_boxes(made, count)
    return count


@device
def _last_node(bvh: Bvh, root: int) -> int:
    """Return the last node of a tree: its nodes follow its root, each the one that is above it."""
    node, last = root, root
    while node <= last:
        for place in range(node * WIDTH, (node + 1) * WIDTH):
            last = max(last, bvh.child[place])
        node += 1
    return last


@device
def _count_left(code: int, before: Slots, begin: int) -> int:
    """Return how many primitives are left of a leaf, 0 for a node."""
    if code >= EMPTY:
        return 0
    first, after = leaf_range(code)
    count: int = before[after - begin] - before[first - begin]
    return count


@device
def _fit_boxes(bvh: Bvh, count: int) -> None:
    """Set the boxes above leaves, and those of children that there are not."""
    nowhere = (OUTSIDE, OUTSIDE, OUTSIDE), (-OUTSIDE, -OUTSIDE, -OUTSIDE)
    for place in range(count * WIDTH - 1, -1, -1):
        if bvh.child[place] == EMPTY:
            set_box(bvh, place, nowhere)
        elif bvh.child[place] > EMPTY:
            set_box(bvh, place, node_box(bvh.child[place], bvh))
