"""Several trees in one pair of arrays."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from vtray.base.pool import run_tasks, useful_threads
from vtray.geometry.bvh.tree import COUNT_BITS, EMPTY, SIDES, WIDTH, Bvh, new_bvh, node_count


def join_trees(
    parts: Sequence[Bvh], threads: int = 1, slots: Sequence[int] | None = None
) -> tuple[Bvh, NDArray[np.int64]]:
    """Return the nodes of several trees as one hierarchy with several roots.

    A search that begins at a root instead of node 0 finds its tree, and that alone.

    Parameters
    ----------
    parts
        The trees, each numbered from 0.
    threads
        How many threads to use.
    slots
        What is added to the slots in the leaves of each tree, which then stand one after the other
        in the columns of one shape; by default nothing.

    Returns
    -------
    bvh, first
        All nodes, and the number that the first node of each tree has there: its root.
    """
    sizes = np.array([node_count(part) for part in parts], np.int64)
    first = np.cumsum(sizes) - sizes
    bvh = new_bvh(sum(map(node_count, parts)))

    def put(run: NDArray[np.int64]) -> None:
        for k in map(int, run):
            begin, end = int(first[k]), int(first[k] + sizes[k])
            child, target = parts[k].child, bvh.child[begin * WIDTH : end * WIDTH]
            bvh.sides[begin * SIDES : end * SIDES] = parts[k].sides
            np.copyto(target, child)
            # Nodes are numbered upwards from 0; the codes of leaves go down from -2.
            np.add(child, begin, out=target, where=child > EMPTY)
            if slots:
                np.subtract(child, slots[k] << COUNT_BITS, out=target, where=child < EMPTY)

    runs = np.array_split(np.arange(len(parts)), useful_threads(threads, len(parts)))
    run_tasks(runs, lambda: put, threads)
    return bvh, first
