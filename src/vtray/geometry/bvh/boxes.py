"""The eight boxes of a node, tested side by side, and nodes that are asked for early.

Compilers put such a loop into one register of eight lanes only with luck. So what these functions
do is written out in `boxes_in_llvm`; here it stands in NumPy's words, and equal to the last bit.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, written_in_llvm
from vtray.geometry.bvh.tree import SIDES, WIDTH, Bvh

CACHE_LINE = 16
"""Numbers of single precision that memory hands over at once."""

Sides = tuple[int, int, int]
Singles = tuple[np.float32, np.float32, np.float32]


class Bounds(NamedTuple):
    """Bounds on the parameter of a ray, linear in the sides of a box, for each axis.

    Attributes
    ----------
    side
        Where a node's sides begin from which the bound is taken.
    factor, term
        The bound is ``side * factor + term``.
    """

    side: Sides
    factor: Singles
    term: Singles


@written_in_llvm("vtray.geometry.bvh.boxes_in_llvm:write_boxes_met")
def boxes_met(
    bvh: Bvh,
    first: int,
    near: Bounds,
    far: Bounds,
    start: np.float32,
    end: np.float32,
    entered: NDArray[np.float32],
) -> int:
    """Return a bit for each box of a node in which the bounds leave something between.

    Parameters
    ----------
    bvh, first
        The node, by where its sides begin.
    near, start
        Lower bounds.
    far, end
        Upper bounds.
    entered
        Out: the greatest lower bound of each box, (8,).
    """
    sides = bvh.sides[first : first + SIDES]
    enter, leave = np.full(WIDTH, start), np.full(WIDTH, end)
    for axis in range(3):
        low, high = near.side[axis], far.side[axis]
        bound = sides[low : low + WIDTH] * near.factor[axis] + near.term[axis]
        enter = np.where(bound > enter, bound, enter)
        bound = sides[high : high + WIDTH] * far.factor[axis] + far.term[axis]
        leave = np.where(bound < leave, bound, leave)
    entered[:] = enter
    return int(np.packbits(enter <= leave, bitorder="little")[0])


@device
def fetch_node(bvh: Bvh, child: int) -> None:
    """Have the sides of a child's node brought from memory while there is other work.

    A leaf, which has none, costs less than to ask whether it is one: the root is brought instead.
    """
    first = max(child, 0) * SIDES
    fetch_early(bvh.sides, first)
    fetch_early(bvh.sides, first + CACHE_LINE)
    fetch_early(bvh.sides, first + 2 * CACHE_LINE)


@written_in_llvm("vtray.geometry.bvh.boxes_in_llvm:write_fetch_early")
def fetch_early(values: NDArray[np.float32], at: int) -> None:
    """Have what lies at a place brought from memory; nothing else happens."""
