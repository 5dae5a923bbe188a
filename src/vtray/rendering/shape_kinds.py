"""The kinds of bounded shapes, and all shapes of a kind as they are given."""

import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from vtray.geometry.bvh.primitives import Primitives
from vtray.geometry.shapes.cone_columns import GivenCones
from vtray.geometry.shapes.cylinder_columns import GivenCylinders
from vtray.geometry.shapes.sphere_columns import GivenSpheres
from vtray.geometry.world import CONE, CYLINDER, SPHERE
from vtray.rendering.pack_looks import MadeOf, joined_made, made_of
from vtray.scene.arrays import Arrays
from vtray.scene.cones import Cones
from vtray.scene.cylinders import Cylinders
from vtray.scene.materials import material_of, materials_of, varied
from vtray.scene.objects import Cone, Cylinder, Object, Sphere
from vtray.scene.spheres import Spheres


class Given(Primitives, Protocol):
    """Shapes as they are given, which know how to come into the order of a hierarchy."""

    data: NDArray[np.float64]


class Source(NamedTuple):
    """All shapes of a kind as they are given, in the order of their numbers.

    Attributes
    ----------
    geometry
        The columns that shapes are made of, in world space: points, (n, 3), and last the radii,
        each (n,), or (1,) if all are the same.
    color
        0 to 255, (n, 3), or (1, 3).
    color_end
        Those of second halves, likewise; None if they are as the first.
    lambert, opacity
        (n,), or (1,).
    made
        What they are made of.
    """

    geometry: tuple[NDArray[Any], ...]
    color: NDArray[np.uint8]
    color_end: NDArray[np.uint8] | None
    lambert: NDArray[np.float64]
    opacity: NDArray[np.float64]
    made: MadeOf


@dataclass(frozen=True)
class Kind:
    """A kind of bounded shapes.

    Attributes
    ----------
    name
        What they are called.
    shape
        Their number in the kernels.
    single, arrays
        The types of objects: of one shape, and of many.
    points
        The names of the points that a shape is made of.
    radii
        The names of its radii.
    given
        Makes of their geometry what a hierarchy is built over.
    """

    name: str
    shape: int
    single: type
    arrays: type[Arrays]
    points: tuple[str, ...]
    radii: tuple[str, ...]
    given: Callable[..., Given]

    def items_of(self, objects: Sequence[Object]) -> list[Any]:
        """Return those of some objects that are of this kind."""
        return [item for item in objects if isinstance(item, (self.single, self.arrays))]


KINDS = (
    Kind("spheres", SPHERE, Sphere, Spheres, ("center",), ("radius",), GivenSpheres),
    Kind(
        "cylinders",
        CYLINDER,
        Cylinder,
        Cylinders,
        ("start", "end"),
        ("radius",),
        GivenCylinders,
    ),
    Kind("cones", CONE, Cone, Cones, ("start", "end"), ("radius", "radius_end"), GivenCones),
)
"""In the order in which primitives are numbered; planes come last."""


def count_of(item: Object) -> int:
    """Return how many primitives an object has."""
    return len(item) if isinstance(item, Arrays) else 1


def collect(kind: Kind, items: Sequence[Any]) -> Source:
    """Return the shapes of all objects of a kind."""
    parts = []
    for is_array, group in groupby(items, lambda item: isinstance(item, Arrays)):
        if is_array:
            parts += [_from_arrays(kind, item) for item in group]
        else:
            parts.append(_from_objects(kind, list(group)))
    if not parts:
        return _from_objects(kind, [])
    return parts[0] if len(parts) == 1 else _join(parts)


def _from_objects(kind: Kind, items: list[Any]) -> Source:
    """Return single shapes as arrays."""

    def column(name: str) -> NDArray[np.float64]:
        return np.fromiter(map(operator.attrgetter(name), items), np.float64, len(items))

    points = tuple(
        np.stack([column(f"{name}.{axis}") for axis in "xyz"], axis=1) for name in kind.points
    )
    color = np.stack([column(f"color.{channel}") for channel in "rgb"], axis=1).astype(np.uint8)
    geometry = (*points, *map(column, kind.radii))
    made = made_of(material_of(item.material) for item in items)
    return Source(geometry, color, None, column("lambert"), column("opacity"), made)


def _from_arrays(kind: Kind, item: Any) -> Source:  # noqa: ANN401
    """Return shapes given as arrays, without a copy where that can be."""
    end = getattr(item, "color_end", None)
    return Source(
        (
            *(_row_by_row(getattr(item, name)) for name in kind.points),
            *(_row_by_row(np.atleast_1d(getattr(item, name)), np.float64) for name in kind.radii),
        ),
        _row_by_row(np.atleast_2d(item.color)),
        None if end is None else _row_by_row(np.atleast_2d(end)),
        _row_by_row(np.atleast_1d(item.lambert), np.float64),
        _row_by_row(np.atleast_1d(item.given_for("opacity")), np.float64),
        _made_of_each(item),
    )


STEPS = 50
"""In so many steps roughness and metalness of each go from 0 to 1."""


def _made_of_each(item: Any) -> MadeOf:  # noqa: ANN401
    """Return what shapes given as arrays are made of."""
    materials = materials_of(item.material)
    is_one = len(set(materials)) == 1
    which = np.zeros(1, np.int64) if is_one else item.material_index.astype(np.int64)
    if item.roughness is None and item.metalness is None:
        return made_of(materials[:1]) if is_one else MadeOf(materials, which)
    rough, metal = (
        np.rint(np.atleast_1d(np.asarray(item.given_for(name), float)) * STEPS).astype(np.int64)
        for name in ("roughness", "metalness")
    )
    # Those of a material itself, which are below 0, come first.
    kinds = np.maximum(rough, -1) + 1, np.maximum(metal, -1) + 1
    shape = len(materials), STEPS + 2, STEPS + 2
    numbers = np.ravel_multi_index((which, *kinds), shape)
    found, which = np.unique(numbers, return_inverse=True)
    made = [
        varied(materials[one], (roughness - 1) / STEPS, (metalness - 1) / STEPS)
        for one, roughness, metalness in zip(*np.unravel_index(found, shape), strict=True)
    ]
    return MadeOf(tuple(made), which.reshape(-1).astype(np.int64))


def _row_by_row(values: Any, dtype: type[np.generic] | None = None) -> NDArray[Any]:  # noqa: ANN401
    """Return an array as it should lie in memory; each render would copy others for the kernels."""
    return np.require(values, dtype, ["C", "A"])


def _join(parts: list[Source]) -> Source:
    """Return the shapes of several sources as one."""
    counts = [len(part.geometry[0]) for part in parts]
    ends = [part.color if part.color_end is None else part.color_end for part in parts]
    return Source(
        tuple(
            _in_one(columns, counts, np.float64)
            for columns in zip(*(part.geometry for part in parts), strict=True)
        ),
        _in_one([part.color for part in parts], counts, np.uint8),
        None if all(part.color_end is None for part in parts) else _in_one(ends, counts, np.uint8),
        _in_one([part.lambert for part in parts], counts, np.float64),
        _in_one([part.opacity for part in parts], counts, np.float64),
        joined_made([part.made for part in parts], counts),
    )


def _in_one(
    columns: Sequence[NDArray[Any]], counts: list[int], dtype: type[np.generic]
) -> NDArray[Any]:
    """Return one array of the columns of several sources."""
    whole = [
        np.broadcast_to(column, (count, *column.shape[1:]))
        for column, count in zip(columns, counts, strict=True)
    ]
    joined: NDArray[Any] = np.empty((sum(counts), *columns[0].shape[1:]), dtype)
    # On its own, it may choose column by column: where one colour stands for all.
    np.concatenate(whole, out=joined)
    return joined
