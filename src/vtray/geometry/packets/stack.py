"""What waits on a way through a hierarchy, the nearest child of a node first.

A way through the hierarchy of what stands at a place begins above what waits on that over places.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.bits import lowest_bit
from vtray.geometry.bvh.boxes import fetch_node
from vtray.geometry.bvh.tree import LEAF, STACK, WIDTH, Bvh
from vtray.geometry.packets.beam import Beam, children_met

LEVELS = 2
"""Hierarchies that lie one in the other at the most: that over places, and that at a place."""


class Stack(NamedTuple):
    """What waits, and scratch memory.

    Attributes
    ----------
    node, enter
        The nodes and leaves that wait, and where the beam enters them, as its bounds count.
    entered
        The same for the children of one node, (8,).
    rays
        The rays of a fan for which a node waits.
    balls
        The balls around the children of one node, or the shapes of a leaf, as `balls_seen` has
        them, (32,).
    slot
        The slots of these shapes, (8,).
    """

    node: NDArray[np.int64]
    enter: NDArray[np.float32]
    entered: NDArray[np.float32]
    rays: NDArray[np.uint64]
    balls: NDArray[np.float32]
    slot: NDArray[np.int64]


def new_stack() -> Stack:
    """Return the scratch memory of one thread."""
    size = LEVELS * STACK
    return Stack(
        np.zeros(size, np.int64),
        np.zeros(size, np.float32),
        np.zeros(WIDTH, np.float32),
        np.zeros(size, np.uint64),
        np.zeros(4 * WIDTH, np.float32),
        np.zeros(LEAF, np.int64),
    )


@device
def push_met(
    bvh: Bvh, node: int, beam: Beam, start: np.float32, end: np.float32, stack: Stack, base: int
) -> int:
    """Push the children that a beam may meet, the nearest last; return the stack's new height."""
    met = children_met(bvh, node, beam, start, end, stack.entered)
    return push_some(bvh, node, met, stack, base)


@device
def push_some(bvh: Bvh, node: int, met: int, stack: Stack, base: int) -> int:
    """Push those children of a node whose bits are set, the nearest last; return the new height.

    Where they are entered stands in the stack's `entered`.
    """
    nodes, enters, entered = stack.node, stack.enter, stack.entered
    if met == 0:
        return base
    first = node * WIDTH
    nearest = lowest_bit(met)
    nearest_enter = entered[nearest]
    met &= met - 1
    top = base
    while met != 0:
        k = lowest_bit(met)
        enter = entered[k]
        met &= met - 1
        # Both are chosen without a branch, which processors would often guess wrong.
        is_nearer = enter < nearest_enter
        child = bvh.child[first + (nearest if is_nearer else k)]
        fetch_node(bvh, child)
        nodes[top] = child
        enters[top] = nearest_enter if is_nearer else enter
        nearest = k if is_nearer else nearest
        nearest_enter = enter if is_nearer else nearest_enter
        top += 1
    nodes[top] = bvh.child[first + nearest]
    enters[top] = nearest_enter
    return top + 1
