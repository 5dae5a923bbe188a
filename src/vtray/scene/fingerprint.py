"""What the contents of arrays, and those of a whole scene, come to.

Both are hashes by BLAKE3, for which nobody knows a way to make other contents of the same hash.
"""

from collections.abc import Iterable
from typing import Any

import msgspec
import numpy as np
from blake3 import blake3
from numpy.typing import NDArray

from vtray.base.pool import run_tasks
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.arrays import Arrays
from vtray.scene.checks.limits import Byte
from vtray.scene.copies import Copies
from vtray.scene.materials import is_default, materials_of
from vtray.scene.pictures.pattern_image import PatternImage
from vtray.scene.pictures.sky_image import SkyImage
from vtray.scene.scene import Scene
from vtray.scene.written_lights import as_written
from vtray.scene.written_objects import object_as_written

PIECE = 1 << 20
"""Bytes, about, that are hashed as one task."""

THREADS = 2
"""Threads that look at a scene: with two, a million spheres take about 8 ms."""

DIGITS = 32


def hash_arrays(arrays: Iterable[NDArray[Any]], threads: int) -> bytes:
    """Return a hash of the dtypes, the shapes and the numbers of arrays.

    It is the same on every run, and for the same numbers in any order in memory.
    """
    rows = [np.atleast_1d(values) for values in arrays]
    pieces = [piece for values in rows for piece in _pieces_of(values)]
    digests = [b""] * len(pieces)

    def hash_piece(k: int) -> None:
        # A copy only where the numbers do not stand in memory one after the other.
        flat = np.ascontiguousarray(pieces[k]).reshape(-1)
        digests[k] = blake3(flat.view(np.uint8).data).digest()

    run_tasks(range(len(pieces)), lambda: hash_piece, threads)
    kinds = [(values.dtype.str, values.shape) for values in rows]
    # As dtypes and shapes say how many pieces there are, no two lists of arrays give one text.
    return blake3(msgspec.json.encode(kinds) + b"".join(digests)).digest()


def _pieces_of(values: NDArray[Any]) -> Iterable[NDArray[Any]]:
    """Return an array as pieces of some rows each."""
    if values.size == 0:
        return []
    step = max(PIECE // (values.nbytes // len(values)), 1)
    return [values[begin : begin + step] for begin in range(0, len(values), step)]


def scene_hash(scene: Scene, threads: int = THREADS) -> str:
    """Return a hash of all that a scene holds, as hexadecimal digits.

    It is that of the camera, the lights and the objects with the contents of their arrays, as they
    are given: one that has been saved and loaded again has the same. How the scene is to be
    rendered is no part of it. Two scenes of the same hash are the same: no other is found, by
    accident or on purpose. (Who makes a picture may still write into it the hash of a scene that
    it does not show.)

    Parameters
    ----------
    scene
        The scene.
    threads
        How many threads look at its arrays.
    """

    def hash_image(image: SkyImage | PatternImage) -> str:
        return hash_arrays([image.pixels], threads).hex()

    lights = [as_written(light, hash_image) for light in scene.lights]
    parts = [scene.camera, lights, *_parts_of(scene.objects, threads)]
    return blake3(msgspec.json.encode(parts, enc_hook=hash_image)).hexdigest(DIGITS // 2)


def _parts_of(objects: Iterable[object], threads: int) -> list[object]:
    """Return what stands for objects in the hash of a scene."""
    parts: list[object] = []
    for item in objects:
        if isinstance(item, Copies):
            own = hash_arrays([item.at], threads).hex()
            parts += [item.__struct_config__.tag, _parts_of(item.objects, threads), own]
        elif isinstance(item, ArrayHolder):
            parts += [item.__struct_config__.tag, hash_arrays(item.arrays(), threads).hex()]
            parts += _names_of(item)
            if isinstance(item, Arrays) and not is_default(item.material):
                parts += materials_of(item.material)
        else:
            parts.append(object_as_written(item) if hasattr(item, "opacity") else item)
    return parts


def _names_of(item: ArrayHolder) -> list[str]:
    """Return the names of those arrays of numbers that may be left out; colours have a dtype."""
    return [
        name
        for name, column in item.COLUMNS.items()
        if column.stand_in and column.kind is not Byte and getattr(item, name) is not None
    ]
