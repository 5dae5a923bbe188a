"""From the materials of objects to what kernels know of them."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import input_array
from vtray.rendering.joined import joined, rows_of
from vtray.scene.materials import Emissive, Glass, Lambert, Material, Metal, Mirror
from vtray.scene.metals import METALS
from vtray.scene.scene import Scene
from vtray.transport.materials.look import EMISSIVE, GLASS, MATT, METAL, MIRROR, NUMBERS, Looks

Integers = NDArray[np.int64]


class MadeOf(NamedTuple):
    """What primitives are made of.

    Attributes
    ----------
    materials
        The materials that occur.
    which
        Which of them each is made of, (n,), or (1,) for all.
    """

    materials: tuple[Material, ...]
    which: Integers


def made_of(materials: Iterable[Material]) -> MadeOf:
    """Return what primitives are made of, given the material of each."""
    numbers: dict[Material, int] = {}
    which = [numbers.setdefault(material, len(numbers)) for material in materials]
    return MadeOf(tuple(numbers), np.array(which[:1] if len(numbers) == 1 else which, np.int64))


def joined_made(parts: Sequence[MadeOf], counts: Sequence[int]) -> MadeOf:
    """Return what the primitives of several parts, so many each, are made of."""
    materials = tuple(material for part in parts for material in part.materials)
    numbers = made_of(materials)
    if len(numbers.materials) == 1:
        return numbers
    first = np.cumsum([0, *(len(part.materials) for part in parts)])
    spread = [
        np.broadcast_to(numbers.which[begin + part.which], count)
        for begin, part, count in zip(first, parts, counts, strict=False)
    ]
    return MadeOf(numbers.materials, np.concatenate(spread))


def pack_looks(
    parts: Sequence[MadeOf], part: Integers, begin: Integers, unit: float, scene: Scene
) -> Looks | None:
    """Return how the primitives of a scene look; None where the integrator does not ask.

    Parameters
    ----------
    parts
        What they are made of.
    part, begin
        The part of each range of their numbers, and where it begins there, (ranges,).
    unit
        The length in scene units of length 1 in the arrays.
    scene
        The scene.
    """
    integrator = scene.render.integrator
    materials = [material for one in parts for material in one.materials]
    is_matt = all(isinstance(material, Lambert) for material in materials)
    if integrator == "direct" or (integrator == "whitted" and is_matt):
        return None
    row, step = rows_of([one.which for one in parts])
    first = np.cumsum([0, *(len(one.materials) for one in parts)])
    which = [one.which + at for one, at in zip(parts, first, strict=False)]
    looks = [_look_of(material, unit) for material in materials]
    numbers = np.array([values for _, values in looks], np.float64).reshape(-1, NUMBERS)
    return Looks(
        row[part] + begin * step[part],
        step[part],
        joined(which, np.int64),
        np.array([kind for kind, _ in looks], np.int64),
        input_array(numbers, np.float64),
        int(scene.render.depth),
    )


def _look_of(material: Material, unit: float) -> tuple[int, list[float]]:
    """Return the kind of a material and its numbers; see `Looks`."""
    values = [0.0] * NUMBERS
    if isinstance(material, Glass):
        values[:4] = [material.ior, *(unit * share for share in material.absorption)]
        return GLASS, values
    if isinstance(material, Metal):
        if material.name is not None:
            n, k = METALS[material.name]
            values[:6] = [*n, *k]
        return METAL, values
    if isinstance(material, Emissive):
        values[0] = material.radiance
        return EMISSIVE, values
    return (MIRROR if isinstance(material, Mirror) else MATT), values
