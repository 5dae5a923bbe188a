"""From the patterns of materials to what kernels know of them."""

from collections.abc import Sequence

import numpy as np

from vtray.base.compiler.compiled import input_array
from vtray.base.exact_math import cosine, sine
from vtray.geometry.vector import Vec
from vtray.rendering.pack_looks import MadeOf, Rows
from vtray.rendering.pack_skies import up_of
from vtray.scene.colors.color_light import light_of
from vtray.scene.patterns import Checker, Pattern
from vtray.scene.placing.directions import beside, unit
from vtray.scene.scene import Scene
from vtray.scene.vectors import Color
from vtray.transport.materials.pattern import ALONG, AROUND, CHECKER, NUMBERS, PLAIN, Patterns


def pack_patterns(
    parts: Sequence[MadeOf], rows: Rows, unit_length: float, scene: Scene
) -> Patterns | None:
    """Return the patterns of primitives; None if there are none.

    Parameters
    ----------
    parts
        What the primitives are made of.
    rows
        The same by ranges of their numbers.
    unit_length
        The length in scene units of length 1 in the arrays.
    scene
        The scene.
    """
    patterns = [material.pattern for one in parts for material in one.materials]
    if all(pattern is None for pattern in patterns):
        return None
    kinds = [_kind_of(pattern) for pattern in patterns]
    numbers = [_numbers_of(pattern, unit_length, scene) for pattern in patterns]
    return Patterns(*rows, np.array(kinds, np.int64), input_array(np.array(numbers), np.float64))


def _kind_of(pattern: Pattern | None) -> int:
    """Return the kind of a pattern."""
    if pattern is None:
        return PLAIN
    if isinstance(pattern, Checker):
        return CHECKER
    return AROUND if pattern.run == "around" else ALONG


def _numbers_of(pattern: Pattern | None, unit_length: float, scene: Scene) -> list[float]:
    """Return the numbers of a pattern; see `Patterns`."""
    if pattern is None:
        return [0.0] * NUMBERS
    up = up_of(scene.camera) if pattern.up is None else unit(pattern.up)
    turn = cosine(pattern.rotation), sine(pattern.rotation)
    first, second = (_light_of(color, scene) for color in pattern.colors)
    return [pattern.size / unit_length, *up, *beside(up), *turn, *first, *second]


def _light_of(color: Color | None, scene: Scene) -> Vec:
    """Return a colour as light, negative for none."""
    return (-1.0, -1.0, -1.0) if color is None else light_of(color, scene.render.tonemap)
