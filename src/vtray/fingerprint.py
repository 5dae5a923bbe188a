"""What the contents of arrays, and those of a whole scene, come to."""

import hashlib
import zlib
from collections.abc import Iterable
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from vtray.pool import run_tasks
from vtray.scene import Scene
from vtray.spheres import COLUMNS, Spheres

Sums = list[tuple[int, int]]

PIECE = 1 << 20
"""Bytes that are looked at as one task."""

THREADS = 2
"""Threads that look at a scene: with two, a million spheres take about 10 ms."""

DIGITS = 24


def add_up(arrays: Iterable[NDArray[Any]], threads: int) -> Sums:
    """Return numbers that change if a number in the arrays does, the same on every run."""
    pieces: list[NDArray[np.uint8]] = []
    for values in arrays:
        raw = np.ascontiguousarray(values).reshape(-1).view(np.uint8)
        pieces += [raw[begin : begin + PIECE] for begin in range(0, len(raw), PIECE)]
    sums = [(0, 0)] * len(pieces)

    def add_up_piece(k: int) -> None:
        # The sum tells any change of one number; the checksum those that sums do not see, such as
        # two numbers that change places, or all radii doubled.
        piece = pieces[k]
        words = piece[: len(piece) // 8 * 8].view(np.uint64)
        sums[k] = zlib.crc32(piece.data), int(words.sum())

    run_tasks(range(len(pieces)), lambda: add_up_piece, threads)
    return sums


def arrays_of(spheres: Spheres) -> list[NDArray[Any]]:
    """Return what the attributes of spheres hold, as arrays."""
    return [np.asarray(getattr(spheres, name)) for name in COLUMNS]


def scene_hash(scene: Scene, threads: int = THREADS) -> str:
    """Return a hash of all that a scene holds, as hexadecimal digits.

    It is that of the camera, the lights and the objects with the contents of their arrays, as they
    are given: one that has been saved and loaded again has the same. How the scene is to be
    rendered is no part of it.

    Parameters
    ----------
    scene
        The scene.
    threads
        How many threads look at its arrays.
    """
    parts: list[object] = [scene.camera, scene.lights]
    for item in scene.objects:
        if not isinstance(item, Spheres):
            parts.append(item)
            continue
        arrays = arrays_of(item)
        kinds = [(array.dtype.str, array.shape) for array in arrays]
        parts += ["spheres", kinds, add_up(arrays, threads)]
    digest = hashlib.blake2b(digest_size=DIGITS // 2)
    digest.update(msgspec.json.encode(parts))
    return digest.hexdigest()
