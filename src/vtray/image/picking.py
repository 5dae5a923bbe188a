"""What is seen in a pixel, down to the particle that it was made of."""

import operator
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vtray.base.errors import RenderError
from vtray.scene.checks.scene_words import show
from vtray.scene.copies import Copies
from vtray.scene.particles.made_of import copy_of, made_of

if TYPE_CHECKING:
    from vtray.image.rendered import Rendered

NONE = -1
"""In place of a copy: there is none."""


@dataclass(frozen=True)
class Pick:
    """What is seen in the middle of a pixel.

    Attributes
    ----------
    object : int
        The place in ``scene.objects``.
    index : int
        The place in the arrays of that object, 0 if it has none, as `Image.ids` counts.
    copy : int or None
        Which copy of what stands at many places, such as a cell that is shown several times; None
        of what is neither copied nor made of particles.
    distance : float
        Distance along the ray, in scene units.
    particle : int or None
        Which particle it was made of, as an index; of a bond, the one at this half. None for what
        was not made of particles.
    kind : str or None
        What it stands for, if it was made of particles: "particle", "bond" or "hydrogen bond".
    values : dict
        What the columns say of that particle, and x, y and z, by name; empty if there is none.
    """

    object: int
    index: int
    copy: int | None
    distance: float
    particle: int | None
    kind: str | None
    values: Mapping[str, Any]


def whole(number: object, call: str, what: str = "a pixel has a whole column and row") -> int:
    """Return a number as an integer, or raise RenderError that says for which call and why."""
    try:
        return operator.index(number)  # type: ignore[arg-type]
    except TypeError:
        words = f"{what}, got {show(number)}; round it, as by int()"
        raise RenderError(f"{call}: {words}") from None


def pick(image: "Rendered", x: int, y: int) -> Pick | None:
    """Return what `Image.pick` does."""
    column, row = whole(x, "pick"), whole(y, "pick")
    height, width = image.linear.shape[:2]
    if not (-width <= column < width and -height <= row < height):
        size = f"{width} x {height}"
        raise RenderError(f"pick: there is no pixel {column}, {row} in a picture of {size}")
    place, index = (int(part) for part in image.ids[row, column])
    if place < 0:
        return None
    copy, half = int(image.copies[row, column]), int(image.halves[row, column])
    item: Any = image.scene.objects[place]
    within, copies = index, None
    if isinstance(item, Copies):
        part, within = item.locate(index)
        item, copies = item.objects[part], item
    source, particle, kind, values = made_of(item), None, None, {}
    if source is not None:
        particle = source.particle(within, half)
        kind, values = source.kind, source.values(particle)
        if copies is None:
            copy = source.image(within, half)
        else:
            copy = copy_of(copies, copy, source, within, half)
    distance = float(image.depth[row, column])
    return Pick(place, index, None if copy == NONE else copy, distance, particle, kind, values)
