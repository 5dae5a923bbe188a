"""Which particles objects were made of: remembered by the objects, and told of a pixel."""

from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from vtray.scene.arrays import Arrays

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

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
        Which of them, (n,) for spheres, (n, 2) for the two ends of cylinders.
    """

    particles: "Particles"
    indices: Integers

    def particle(self, index: int, half: int) -> int:
        """Return the particle of an object; of a cylinder, that at its start or, 1, its end."""
        return int(self.indices[index] if self.indices.ndim == 1 else self.indices[index, half])

    def values(self, particle: int) -> dict[str, Any]:
        """Return what is known of a particle, by name: its place, and its columns."""
        x, y, z = (float(part) for part in self.particles.positions[particle])
        columns = self.particles.columns
        return {"x": x, "y": y, "z": z} | {
            name: value.tolist() if hasattr(value := values[particle], "tolist") else value
            for name, values in columns.items()
        }


def remember(item: Kind, source: MadeOf) -> Kind:
    """Let objects remember what they were made of, which is no part of what makes them equal."""
    item.__dict__["made_of_"] = source
    return item


def made_of(item: object) -> MadeOf | None:
    """Return what objects were made of; None where that is not known."""
    found: MadeOf | None = getattr(item, "__dict__", {}).get("made_of_")
    return found
