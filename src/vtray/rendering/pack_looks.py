"""From the materials of objects to what kernels know of them."""

import math
from collections.abc import Iterable, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import input_array
from vtray.rendering.joined import joined, rows_of
from vtray.scene.materials import (
    Blend,
    Emissive,
    Glass,
    Lambert,
    Material,
    Metal,
    Mirror,
    Plastic,
    blended_in,
)
from vtray.scene.metals import METALS
from vtray.scene.scene import Scene
from vtray.transport.materials.albedo import NODES, mean_albedo, measure_albedo
from vtray.transport.materials.conductor import mean_shares
from vtray.transport.materials.facets import SMOOTH
from vtray.transport.materials.look import (
    BLEND,
    EMISSIVE,
    GLASS,
    MATT,
    MEANS,
    METAL,
    MIRROR,
    NUMBERS,
    PLASTIC,
    SPREAD,
    THIN,
    Looks,
)

Floats = NDArray[np.float64]
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


def materials_by_row(parts: Sequence[MadeOf]) -> list[Material]:
    """Return the materials of the rows of `Looks`: those of the parts, and what they blend."""
    materials = [material for one in parts for material in one.materials]
    return [*materials, *(part for material in materials for part in blended_in(material))]


class Rows(NamedTuple):
    """Of which materials primitives are made, as in `Looks`."""

    row: Integers
    step: Integers
    which: Integers


def rows_of_ranges(parts: Sequence[MadeOf], part: Integers, begin: Integers) -> Rows:
    """Return of which materials primitives are made.

    Parameters
    ----------
    parts
        What they are made of.
    part, begin
        The part of each range of their numbers, and where it begins there, (ranges,).
    """
    row, step = rows_of([one.which for one in parts])
    first = np.cumsum([0, *(len(one.materials) for one in parts)])
    which = [one.which + at for one, at in zip(parts, first, strict=False)]
    return Rows(row[part] + begin * step[part], step[part], joined(which, np.int64))


def pack_looks(parts: Sequence[MadeOf], rows: Rows, unit: float, scene: Scene) -> Looks | None:
    """Return how the primitives of a scene look; None where the integrator does not ask.

    Parameters
    ----------
    parts
        What they are made of.
    rows
        The same by ranges of their numbers.
    unit
        The length in scene units of length 1 in the arrays.
    scene
        The scene.
    """
    integrator = scene.render.integrator
    materials = [material for one in parts for material in one.materials]
    is_plain = all(isinstance(material, Lambert) for material in materials)
    is_plain &= scene.render.firefly == "off"
    if integrator == "direct" or (integrator == "whitted" and is_plain):
        return None
    looks = [_look_of(material, unit) for material in materials_by_row(parts)]
    after = len(materials)
    for material, (_, values) in zip(materials, looks, strict=False):
        if isinstance(material, Blend):
            values[:3] = [after, after + 1, material.weight]
            after += 2
    return Looks(
        *rows,
        np.array([kind for kind, _ in looks], np.int64),
        input_array(np.array([values for _, values in looks]).reshape(-1, NUMBERS), np.float64),
        int(scene.render.depth),
        _brightest(scene),
        _albedos(looks),
        True if any(_absorbs(material) for material in materials_by_row(parts)) else None,
    )


def _look_of(material: Material, unit: float) -> tuple[int, list[float]]:
    """Return the kind of a material and its numbers; see `Looks`."""
    values = [0.0] * NUMBERS
    roughness = getattr(material, "roughness", 0.0)
    values[SPREAD] = roughness * roughness if roughness * roughness >= SMOOTH else 0.0
    if isinstance(material, Glass):
        values[:4] = [material.ior, *(unit * share for share in material.absorption)]
        values[THIN] = 1.0 if material.thin else 0.0
        return GLASS, values
    if isinstance(material, Metal):
        if material.name is not None:
            n, k = METALS[material.name]
            values[:6] = [*n, *k]
            values[MEANS:] = mean_shares(n, k)
        return METAL, values
    if isinstance(material, Plastic):
        values[0] = material.ior
        return PLASTIC, values
    if isinstance(material, Emissive):
        values[0] = material.radiance
        return EMISSIVE, values
    plain = {Lambert: MATT, Mirror: MIRROR, Blend: BLEND}
    return plain[type(material)], values


def _absorbs(material: Material) -> bool:
    """Tell whether a material takes light that goes through it."""
    return isinstance(material, Glass) and not material.thin and any(material.absorption)


def _brightest(scene: Scene) -> float:
    """Return the brightest light of a sample, 255 for white."""
    firefly = scene.render.firefly
    return math.inf if firefly == "off" else 255.0 * float(firefly)


def _albedos(looks: Sequence[tuple[int, list[float]]]) -> Floats | None:
    """Return the tables of what rough surfaces and coats mirror; None if all are smooth.

    There are two for each material: what is met from outside, and from within.
    """
    if all(kind not in (PLASTIC, BLEND) and values[SPREAD] == 0.0 for kind, values in looks):
        return None
    tables = np.zeros((2 * len(looks), NODES + 2))
    for k, (kind, values) in enumerate(looks):
        if kind in (PLASTIC, METAL, GLASS):
            index = 1.0 if kind == METAL else values[0]
            tables[2 * k] = _table(kind, index, values[SPREAD])
            tables[2 * k + 1] = _table(kind, 1.0 / index, values[SPREAD])
    return input_array(tables, np.float64)


@cache
def _table(kind: int, ratio: float, spread: float) -> Floats:
    """Return the albedos of one surface, and their mean."""
    table = np.zeros(NODES + 2)
    measure_albedo(kind, ratio, spread, table)
    table[NODES + 1] = mean_albedo(table)
    return table
