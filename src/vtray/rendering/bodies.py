"""Which faded shapes are one body: those of one object that are equally opaque."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.rendering.shape_kinds import Kind
from vtray.scene.arrays import Arrays
from vtray.scene.objects import Plane

Numbers = NDArray[np.int32]


class FadedBodies(NamedTuple):
    """The bodies of the shapes of a scene.

    Attributes
    ----------
    of_sources
        For each source of shapes the bodies of all its shapes, (n,), or (1,) for one body; without
        meaning for shapes that are not faded.
    opacity
        The opacities of the bodies, (bodies,).
    """

    of_sources: tuple[Numbers, ...]
    opacity: NDArray[np.float64]


def has_faded(bodies: FadedBodies | None, objects: Iterable[object]) -> bool:
    """Tell whether light passes in part through any of objects: planes are bodies of their own."""
    return bodies is not None or any(
        isinstance(item, Plane) and 0.0 < item.opacity < 1.0 for item in objects
    )


class BodyCount:
    """Gives bodies their numbers, from 0 on."""

    def __init__(self) -> None:
        self._found: dict[tuple[int, float], int] = {}

    def body_of(self, place: int, opacity: float) -> int:
        """Return the body of shapes of an object; 0 if no light passes them, or nothing is there.

        Parameters
        ----------
        place
            The place of the object in the scene.
        opacity
            Their opacity.
        """
        if not 0.0 < opacity < 1.0:
            return 0
        return self._found.setdefault((place, opacity), len(self._found))

    @property
    def opacity(self) -> NDArray[np.float64]:
        """The opacities of all bodies."""
        return np.array([opacity for _, opacity in self._found], np.float64)


def number_bodies(
    kind: Kind, items: Sequence[Any], places: Sequence[int], count: BodyCount
) -> Numbers:
    """Return the bodies of the shapes of a kind.

    Parameters
    ----------
    kind
        The kind.
    items, places
        Objects, and the places in the scene of these, or of what they are parts of.
    count
        What gives the numbers.
    """
    mine = [
        (item, place)
        for item, place in zip(items, places, strict=True)
        if isinstance(item, (kind.single, kind.arrays))
    ]
    parts = [_bodies_of(item, place, count) for item, place in mine]
    if len(parts) == 1:
        return parts[0]
    sizes = [len(item) if isinstance(item, Arrays) else 1 for item, _ in mine]
    whole = [np.broadcast_to(part, size) for part, size in zip(parts, sizes, strict=True)]
    return np.concatenate([np.zeros(0, np.int32), *whole])


def _bodies_of(item: Any, place: int, count: BodyCount) -> Numbers:  # noqa: ANN401
    """Return the bodies of the shapes of an object, (n,), or (1,) if all are in one."""
    given = item.given_for("opacity") if isinstance(item, Arrays) else item.opacity
    found, which = np.unique(np.atleast_1d(given), return_inverse=True)
    numbers = [count.body_of(place, float(opacity)) for opacity in found]
    bodies: Numbers = np.array(numbers, np.int32)[which]
    return bodies
