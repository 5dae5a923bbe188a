"""Sorts keys: all of them by many threads, or a few within a kernel."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.base.pool import run_tasks, useful_threads

Keys = NDArray[np.uint64]

SMALL = 1 << 16
"""A thread for fewer keys than this is not worth its start."""

FEW_THREADS = 2
"""Up to so many threads, one is as fast: sample sort does twice the work."""

SAMPLES = 64
"""Keys of each part that are looked at to divide all keys evenly."""


def sort_keys(keys: Keys, threads: int) -> Keys:
    """Return the keys, which differ, in their order; `keys` itself is used as scratch memory.

    References
    ----------
    Sample sort: Blelloch et al., "A Comparison of Sorting Algorithms for the Connection Machine
    CM-2", 1991.
    """
    threads = useful_threads(threads, len(keys) // SMALL)
    if threads <= FEW_THREADS:
        keys.sort()
        return keys
    parts = np.array_split(keys, threads)
    run_tasks(parts, lambda: np.ndarray.sort, threads)
    sample = np.sort(np.concatenate([part[:: max(len(part) // SAMPLES, 1)] for part in parts]))
    splitters = sample[np.arange(1, threads) * len(sample) // threads]
    cuts = [[0, *np.searchsorted(part, splitters), len(part)] for part in parts]
    ends = np.cumsum([sum(cut[k + 1] - cut[k] for cut in cuts) for k in range(threads)])
    merged = np.empty_like(keys)

    def merge(k: int) -> None:
        pieces = [part[cut[k] : cut[k + 1]] for part, cut in zip(parts, cuts, strict=True)]
        target = merged[ends[k] - sum(map(len, pieces)) : ends[k]]
        np.concatenate(pieces, out=target)
        target.sort()

    run_tasks(range(threads), lambda: merge, threads)
    return merged


@device
def sort_few(keys: Keys, begin: int, end: int) -> None:
    """Sort keys in place, by heap sort."""
    size = end - begin
    for start in range(size // 2 - 1, -1, -1):
        _sift(keys, begin, start, size)
    for last in range(size - 1, 0, -1):
        largest = keys[begin]
        keys[begin] = keys[begin + last]
        keys[begin + last] = largest
        _sift(keys, begin, 0, last)


@device
def _sift(keys: Keys, begin: int, parent: int, size: int) -> None:
    """Move a key down the heap to where it belongs."""
    key = keys[begin + parent]
    child = 2 * parent + 1
    while child < size:
        if child + 1 < size and keys[begin + child] < keys[begin + child + 1]:
            child += 1
        if keys[begin + child] <= key:
            break
        keys[begin + parent] = keys[begin + child]
        parent = child
        child = 2 * parent + 1
    keys[begin + parent] = key
