"""What waits on a way through a hierarchy, nearest first.

A way through the hierarchy of what stands at a place begins above what waits on that over places.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.tree import STACK, WIDTH, Bvh
from vtray.geometry.packets.beam import Beam, children_met, enter_child

LEVELS = 2
"""Hierarchies that lie one in the other at the most: that over places, and that at a place."""


class Stack(NamedTuple):
    """The nodes and leaves that wait, and where the beam, or the ray, enters them."""

    node: NDArray[np.int64]
    enter: NDArray[np.float64]


def new_stack() -> Stack:
    """Return the scratch memory of one thread."""
    return Stack(np.zeros(LEVELS * STACK, np.int64), np.zeros(LEVELS * STACK))


@device
def push_met(
    bvh: Bvh, node: int, beam: Beam, start: float, end: float, stack: Stack, base: int
) -> int:
    """Push the children that a beam may meet, the nearest last; return the stack's new height."""
    met = children_met(bvh, node, beam, start, end)
    nodes, enters = stack.node, stack.enter
    child = node * WIDTH
    top = base
    while met > 0:
        if met & 1:
            enter = enter_child(bvh, child, beam)
            place = top
            while place > base and enters[place - 1] < enter:
                enters[place] = enters[place - 1]
                nodes[place] = nodes[place - 1]
                place -= 1
            enters[place] = enter
            nodes[place] = bvh.child[child]
            top += 1
        met >>= 1
        child += 1
    return top
