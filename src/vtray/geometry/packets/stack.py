"""What waits on a way through a hierarchy, the nearest child of a node first.

A way through the hierarchy of what stands at a place begins above what waits on that over places.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.bits import lowest_bit
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
    if met == 0:
        return base
    nodes, enters = stack.node, stack.enter
    nearest = node * WIDTH + lowest_bit(met)
    nearest_enter = enter_child(bvh, nearest, beam)
    met &= met - 1
    top = base
    while met != 0:
        child = node * WIDTH + lowest_bit(met)
        enter = enter_child(bvh, child, beam)
        met &= met - 1
        # Both are chosen without a branch, which processors would often guess wrong.
        is_nearer = enter < nearest_enter
        nodes[top] = bvh.child[nearest if is_nearer else child]
        enters[top] = nearest_enter if is_nearer else enter
        nearest = child if is_nearer else nearest
        nearest_enter = enter if is_nearer else nearest_enter
        top += 1
    nodes[top] = bvh.child[nearest]
    enters[top] = nearest_enter
    return top + 1
