"""The bounding volume hierarchy: which primitives a ray, or a beam of rays, may meet.

A node has up to eight children, whose boxes stand side by side in float32, so that one loop of
eight lanes tests them all. The boxes are rounded outwards, and wider than rounding errors of what
is tested against them, so that nothing is ever missed; what is hit is decided by the
primitives themselves, in doubles. The hierarchy does not depend on the camera.

References
----------
Wald, Benthin, Boulos, "Getting Rid of Packets: Efficient SIMD Single-Ray Traversal using
Multi-branching BVHs", 2008.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.capacity import MAX_SPHERES
from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec

WIDTH = 8
"""Children of a node at the most."""

SIDES = 6 * WIDTH
"""Numbers of a node in ``Bvh.sides``: eight for each side of a box."""

LEAF = 8
"""Primitives of a leaf at the most."""

COUNT_BITS = 31 - (MAX_SPHERES - 1).bit_length()
"""Low bits of a leaf's code, which say how many primitives it has; the others say the first."""

COUNT_MASK = (1 << COUNT_BITS) - 1

EMPTY = -1
"""In place of a child: there is none. (As a leaf, it has no primitives.)"""

MAX_TREE_DEPTH = 96
"""From this depth on, nodes are split into halves, which bounds the depth of all trees."""

FRAME = 4.0
"""No box reaches farther from the origin of its space, but for those that every ray meets."""

EVERYWHERE = 1e30
"""How far such a box reaches to all sides, which holds what is too far away for others."""

STACK = (MAX_TREE_DEPTH + 32) * WIDTH
"""Nodes that can wait at the same time on a way through a tree."""


class Frame(NamedTuple):
    """The space of the boxes: ``world * scale - origin``, in which they reach up to ``FRAME``.

    Attributes
    ----------
    scale
        A power of two.
    origin
        The middle of the primitives' centres, scaled.
    """

    scale: float
    origin: Vec


class Bvh(NamedTuple):
    """One hierarchy whose root is node 0, or several; without nodes there is none.

    Several stand one after the other, each with its root first: see `join_trees`.

    Attributes
    ----------
    sides
        For each node the low sides x, y, z, then the high sides x, y, z of its eight children,
        (nodes * 48,).
    child
        For each child the number of its node, or the `leaf_code` of its leaf, (nodes * 8,).
    """

    sides: NDArray[np.float32]
    child: NDArray[np.int32]


@device
def leaf_code(first: int, count: int) -> int:
    """Return what stands in ``Bvh.child`` for a leaf."""
    return ~(first << COUNT_BITS | count)


@device
def leaf_range(code: int) -> tuple[int, int]:
    """Return the first slot of a leaf, and the first that no longer belongs to it."""
    first = ~code >> COUNT_BITS
    return first, first + (~code & COUNT_MASK)


def new_bvh(nodes: int) -> Bvh:
    """Return room for nodes."""
    return Bvh(np.empty(nodes * SIDES, np.float32), np.empty(nodes * WIDTH, np.int32))


def no_bvh() -> Bvh:
    """Return a hierarchy without nodes."""
    return new_bvh(0)


def node_count(bvh: Bvh) -> int:
    """Return how many nodes there are."""
    return len(bvh.child) // WIDTH
