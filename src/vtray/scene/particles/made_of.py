"""Which particles objects were made of: remembered by the objects, and told of a pixel."""

from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from vtray.scene.array_holder import ArrayHolder
from vtray.scene.arrays import Arrays
from vtray.scene.checks.columns import POINT
from vtray.scene.checks.limits import Byte

if TYPE_CHECKING:
    from collections.abc import Iterable

    import numpy as np
    from numpy.typing import NDArray

    from vtray.scene.copies import Copies
    from vtray.scene.particles.particles import Particles

    Integers = NDArray[np.int64]
else:
    Integers = Any

Kind = TypeVar("Kind", bound=Arrays)


class MadeOf(NamedTuple):
    """What objects were made of.

    Attributes
    ----------
    particles
        The particles.
    indices
        Which of them, (n,) for spheres, (n, 2) for the two ends of cylinders. Objects that stand
        at several places come n at a time.
    kind
        What the objects stand for.
    copies
        At which of several places stands what each object repeats, (n,), or each of its two ends,
        (n, 2); None where it is told by their order.
    joined
        Which particles bonds join of which only halves are shown, (n, 2); None where `indices`
        tells it.
    """

    particles: "Particles"
    indices: Integers
    kind: str
    copies: Integers | None = None
    joined: Integers | None = None

    def particle(self, index: int, half: int) -> int:
        """Return the particle of an object; of a cylinder, that at its start or, 1, its end."""
        row = self.indices[index % len(self.indices)]
        return int(row if self.indices.ndim == 1 else row[half])

    def image(self, index: int, half: int) -> int:
        """Return at which of several places an object stands; of a cylinder, one of its ends."""
        if self.copies is None:
            return index // len(self.indices)
        row = self.copies[index]
        return int(row if self.copies.ndim == 1 else row[half])

    def values(self, particle: int) -> dict[str, Any]:
        """Return what is known of a particle, by name: its place, and its columns."""
        x, y, z = (float(part) for part in self.particles.positions[particle])
        columns = self.particles.columns
        return {"x": x, "y": y, "z": z} | {
            name: value.tolist() if hasattr(value := values[particle], "tolist") else value
            for name, values in columns.items()
        }


def written_out(item: Kind, places: "NDArray[np.float64]") -> Kind:
    """Return objects at several places, one after the other, each moved by a row of (m, 3)."""
    import numpy as np

    count, changed = len(places), {}
    for name in item.COLUMNS:
        value, is_point = getattr(item, name), item.COLUMNS[name] is POINT
        rank = 2 if is_point or item.COLUMNS[name].kind is Byte else 1
        if is_point:
            changed[name] = (places[:, None] + value).reshape(-1, 3)
        elif getattr(value, "ndim", 0) == rank:
            changed[name] = np.tile(value, (count, 1) if rank == 2 else count)
    made: Kind = item.replace(**changed).with_scale(item.color_scale)
    source = made_of(item)
    return made if source is None else remember(made, source)


def repeated(item: Kind, which: Integers, steps: "NDArray[np.float64]", copies: Integers) -> Kind:
    """Return the balls of particles that are shown again.

    Parameters
    ----------
    item
        The balls, one of each particle that is drawn.
    which
        The particles, (n,).
    steps
        By how much each is moved, (n, 3).
    copies
        At which of several places stands what each repeats, (n,).
    """
    import numpy as np

    source = made_of(item)
    assert source is not None  # noqa: S101 - they are made of particles
    rows = np.searchsorted(source.indices, which)
    changed = {}
    for name, column in item.COLUMNS.items():
        value = getattr(item, name)
        if column is POINT:
            changed[name] = value[rows] + steps
        elif getattr(value, "ndim", 0) == (2 if column.kind is Byte else 1):
            changed[name] = value[rows]
    made: Kind = item.replace(**changed).with_scale(item.color_scale)
    return remember(made, source._replace(indices=which, copies=copies))


def remember(item: Kind, source: MadeOf) -> Kind:
    """Let objects remember what they were made of, which is no part of what makes them equal."""
    item.__dict__["made_of_"] = source
    return item


def made_of(item: object) -> MadeOf | None:
    """Return what objects were made of; None where that is not known."""
    found: MadeOf | None = getattr(item, "__dict__", {}).get("made_of_")
    return found


def remember_cell(objects: "Iterable[object]") -> None:
    """Let objects remember that the particles which they show have a cell, drawn or not."""
    for item in objects:
        if isinstance(item, ArrayHolder):
            item.__dict__["has_cell_"] = True


def has_cell(objects: "Iterable[object]") -> bool:
    """Tell whether some objects, or some that are copied, show particles that have a cell."""
    return any(
        "has_cell_" in getattr(item, "__dict__", {}) or has_cell(getattr(item, "objects", ()))
        for item in objects
    )


def remember_ends(item: "Copies", copies: Integers) -> "Copies":
    """Let copies of bonds remember in which cells the two ends of each are, (k, 2)."""
    item.__dict__["ends_"] = copies
    return item


def copy_of(item: "Copies", place: int, source: MadeOf, within: int, half: int) -> int:
    """Return which copy of a cell something is in that stands at one of the places of copies.

    Parameters
    ----------
    item
        The copies.
    place
        At which of their places it stands.
    source, within
        What the objects were made of, and which of these it is.
    half
        Of a cylinder, which half.
    """
    ends = item.__dict__.get("ends_")
    if ends is not None:
        return int(ends[place, half])
    # All cells, written out, may stand at one place, so that they are one body.
    return source.image(within, half) if len(item) == 1 else place
