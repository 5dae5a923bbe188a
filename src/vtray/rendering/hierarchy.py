"""What is kept with a scene from render to render: its spheres, ready for tracing.

The spheres of all objects are numbered in the order of the scene, put into the order of the leaves
of a hierarchy, and kept until they change. A new camera, light or plane costs no new build.
"""

import operator
from dataclasses import dataclass
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.capacity import MAX_SPHERES
from vtray.base.errors import RenderError
from vtray.base.memory import check_memory_of_spheres
from vtray.base.pool import Progress
from vtray.geometry.bvh.tree import Bvh, Frame, no_bvh, node_count
from vtray.geometry.shapes.sphere_columns import Built, Leaves, build_spheres
from vtray.scene.fingerprint import arrays_of, hash_arrays
from vtray.scene.scene import Plane, Scene, Sphere
from vtray.scene.spheres import Spheres

FEW = 128
"""Up to so many spheres, no hierarchy is needed: testing each for a whole packet is faster.

The crossing was measured at 115 spheres with one light and at 200 with 64.
"""

Item = Sphere | Spheres


class Source(NamedTuple):
    """The spheres as they are given, in the order of their numbers.

    Attributes
    ----------
    center
        World space, (n, 3), float32 or float64.
    radius
        (n,), or (1,) if all are the same.
    color
        0 to 255, (n, 3), or (1, 3).
    lambert
        (n,), or (1,).
    """

    center: NDArray[np.float64]
    radius: NDArray[np.float64]
    color: NDArray[np.uint8]
    lambert: NDArray[np.float64]


@dataclass(frozen=True)
class Acceleration:
    """The spheres of a scene, ready for tracing.

    Attributes
    ----------
    leaves
        In the order of the leaves, or, if there are few, of their numbers.
    bvh
        The hierarchy, none if there are few.
    frame
        The space of its boxes.
    depth
        How many nodes lie one below the other at the most.
    largest
        The largest coordinate or radius.
    source
        The spheres by their numbers.
    items, first
        The objects that have spheres, and the number of the first sphere of each.
    fingerprint
        What the contents of their arrays came to.
    """

    leaves: Leaves
    bvh: Bvh
    frame: Frame
    depth: int
    largest: float
    source: Source
    items: list[Item]
    first: NDArray[np.int64]
    fingerprint: bytes

    @property
    def nodes(self) -> int:
        """How many nodes the hierarchy has."""
        return node_count(self.bvh)

    @property
    def memory(self) -> int:
        """Bytes that are used beside the arrays that were given."""
        arrays = (*self.leaves, *self.bvh, *self.source)
        return sum(array.nbytes for array in arrays if array.base is None)


def accelerate(scene: Scene, threads: int = 1, progress: Progress | None = None) -> Acceleration:
    """Return what is kept with a scene, made anew if its spheres have changed.

    Raises
    ------
    RenderError
        There are more spheres than a hierarchy or the memory can hold.
    """
    items = spheres_of(scene)
    fingerprint = _fingerprint(items, threads)
    kept: Acceleration | None = scene.__dict__.get(_KEPT)
    if kept and kept.fingerprint == fingerprint and _are_same(kept.items, items):
        return kept
    made = _make(items, fingerprint, threads, progress)
    scene.__dict__[_KEPT] = made
    return made


def spheres_of(scene: Scene) -> list[Item]:
    """Return the objects of a scene that have spheres."""
    return [item for item in scene.objects if not isinstance(item, Plane)]


def locate(scene: Scene, kept: Acceleration, number: int) -> tuple[int, int]:
    """Return the place in ``scene.objects`` that a sphere belongs to, and its index there."""
    item = int(np.searchsorted(kept.first, number, side="right")) - 1
    places = [place for place, other in enumerate(scene.objects) if not isinstance(other, Plane)]
    return places[item], number - int(kept.first[item])


def locate_all(
    scene: Scene, kept: Acceleration, primitives: NDArray[np.int32]
) -> NDArray[np.int32]:
    """Return place and index, as `locate` does, of spheres and planes by their numbers.

    Parameters
    ----------
    scene, kept
        The scene, and what is kept with it.
    primitives
        Numbers of primitives, -1 for none, of any shape.

    Returns
    -------
    array
        int32, of the same shape with two numbers for each: place and index; -1 for none.
    """
    count = len(kept.leaves.number)
    order = sorted(range(len(scene.objects)), key=lambda k: isinstance(scene.objects[k], Plane))
    # Each object with spheres has a range of numbers, and each plane one of its own.
    planes = np.arange(count, count + len(order) - len(kept.first))
    first = np.concatenate([kept.first, planes])
    places = np.array([*order, -1], np.int32)
    which = np.searchsorted(first, primitives, side="right") - 1
    ids = np.empty((*primitives.shape, 2), np.int32)
    ids[..., 0] = places[which]
    ids[..., 1] = np.where(which < 0, -1, primitives - np.append(first, 0)[which])
    return ids


_KEPT = "_acceleration"


def _are_same(these: list[Item], those: list[Item]) -> bool:
    """Tell whether two lists hold the same objects."""
    return len(these) == len(those) and all(map(operator.is_, these, those))


def _make(
    items: list[Item], fingerprint: bytes, threads: int, progress: Progress | None
) -> Acceleration:
    """Give numbers to the spheres, and build the hierarchy."""
    sizes = [len(item) if isinstance(item, Spheres) else 1 for item in items]
    count = sum(sizes)
    if count > MAX_SPHERES:
        message = f"objects: expected at most {MAX_SPHERES} spheres, got {count}"
        raise RenderError(message)
    check_memory_of_spheres(count)
    source = collect(items)
    if count <= FEW:
        built = Built(_in_order(source), no_bvh(), Frame(1.0, (0.0, 0.0, 0.0)), 0, _largest(source))
    else:
        built = build_spheres(source.center, source.radius, threads, progress)
    return Acceleration(
        *built,
        source=source,
        items=items,
        first=np.concatenate([[0], np.cumsum(sizes, dtype=np.int64)])[:-1],
        fingerprint=fingerprint,
    )


def _in_order(source: Source) -> Leaves:
    """Return spheres in the order of their numbers."""
    count = len(source.center)
    data = np.empty((count, 4))
    data[:, :3] = source.center
    data[:, 3] = source.radius
    return Leaves(data.reshape(-1), np.arange(count, dtype=np.int32))


def _largest(source: Source) -> float:
    """Return the largest coordinate or radius, 0 if there is none."""
    if len(source.center) == 0:
        return 0.0
    coordinates = max(-float(source.center.min()), float(source.center.max()))
    return max(coordinates, float(source.radius.max()))


def collect(items: list[Item]) -> Source:
    """Return the spheres of all objects."""
    parts = []
    for kind, group in groupby(items, type):
        if kind is Spheres:
            parts += [_from_arrays(item) for item in group if isinstance(item, Spheres)]
        else:
            parts.append(_from_objects(list(group)))
    if not parts:
        return _from_objects([])
    return parts[0] if len(parts) == 1 else Source(*(_join(parts, name) for name in Source._fields))


def _from_objects(spheres: list[Item]) -> Source:
    """Return single spheres as arrays."""
    count = len(spheres)

    def column(name: str) -> NDArray[np.float64]:
        return np.fromiter(map(operator.attrgetter(name), spheres), np.float64, count)

    center, color = np.empty((count, 3)), np.empty((count, 3), np.uint8)
    for axis, (coordinate, channel) in enumerate(zip("xyz", "rgb", strict=True)):
        center[:, axis] = column(f"center.{coordinate}")
        color[:, axis] = column(f"color.{channel}")
    return Source(center, column("radius"), color, column("lambert"))


def _from_arrays(spheres: Spheres) -> Source:
    """Return spheres given as arrays, without a copy where that can be."""
    return Source(
        _row_by_row(spheres.center),
        _row_by_row(np.atleast_1d(spheres.radius), np.float64),
        _row_by_row(np.atleast_2d(spheres.color)),
        _row_by_row(np.atleast_1d(spheres.lambert), np.float64),
    )


def _row_by_row(values: Any, dtype: type[np.generic] | None = None) -> NDArray[Any]:  # noqa: ANN401
    """Return an array as it should lie in memory; each render would copy others for the kernels."""
    return np.require(values, dtype, ["C", "A"])


def _join(parts: list[Source], name: str) -> NDArray[Any]:
    """Return one array of several objects."""
    columns = [getattr(part, name) for part in parts]
    counts = [len(part.center) for part in parts]
    whole = [
        np.broadcast_to(column, (count, *column.shape[1:]))
        for column, count in zip(columns, counts, strict=True)
    ]
    dtype = np.uint8 if name == "color" else np.float64
    joined: NDArray[Any] = np.empty((sum(counts), *columns[0].shape[1:]), dtype)
    # On its own, it may choose column by column: where one colour stands for all.
    np.concatenate(whole, out=joined)
    return joined


def _fingerprint(items: list[Item], threads: int) -> bytes:
    """Return what changes if a number in the arrays does, which may be written to."""
    arrays = [array for item in items if isinstance(item, Spheres) for array in arrays_of(item)]
    return hash_arrays(arrays, threads)
