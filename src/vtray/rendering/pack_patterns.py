"""From the patterns of materials to what kernels know of them."""

import sys
from collections.abc import Sequence

import numpy as np

from vtray.base.compiler.compiled import input_array
from vtray.base.exact_math import cosine, sine
from vtray.geometry.vector import Vec
from vtray.rendering.joined import joined, rows_of
from vtray.rendering.pack_looks import MadeOf, Rows
from vtray.rendering.pack_skies import up_of
from vtray.scene.colors.color_light import light_of, light_of_numbers
from vtray.scene.patterns import Checker, ImagePattern, Pattern
from vtray.scene.pictures.pattern_image import PatternImage
from vtray.scene.placing.directions import beside, unit
from vtray.scene.scene import Scene
from vtray.scene.vectors import Color
from vtray.transport.materials.pattern import (
    ALONG,
    AROUND,
    CHECKER,
    IMAGE,
    NUMBERS,
    PLAIN,
    Patterns,
)

TINY = sys.float_info.min
"""No size is less, since lengths are divided by it."""

NO_PIXELS = np.zeros((0, 4), np.uint8)


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
    images = list({p.image: None for p in patterns if isinstance(p, ImagePattern)})
    pixels = [image.pixels.reshape(-1, 4) for image in images] or [NO_PIXELS]
    begins, _ = rows_of(pixels)
    first = dict(zip(images, begins.tolist(), strict=False))
    places = [_place_of(pattern, first) for pattern in patterns]
    return Patterns(
        *rows,
        np.array(kinds, np.int64),
        input_array(np.array(numbers), np.float64),
        np.array(places, np.int64),
        joined(pixels, np.uint8),
        light_of_numbers(scene.render.tonemap),
    )


def _place_of(pattern: Pattern | None, first: dict[PatternImage, int]) -> tuple[int, int, int]:
    """Return where the pixels of a pattern begin, and how many columns and rows it has."""
    if not isinstance(pattern, ImagePattern):
        return 0, 1, 1
    height, width, _ = pattern.image.pixels.shape
    return first[pattern.image], width, height


def _kind_of(pattern: Pattern | None) -> int:
    """Return the kind of a pattern."""
    if pattern is None:
        return PLAIN
    if isinstance(pattern, Checker):
        return CHECKER
    if isinstance(pattern, ImagePattern):
        return IMAGE
    return AROUND if pattern.run == "around" else ALONG


def _numbers_of(pattern: Pattern | None, unit_length: float, scene: Scene) -> list[float]:
    """Return the numbers of a pattern; see `Patterns`."""
    if pattern is None:
        return [0.0] * NUMBERS
    up = up_of(scene.camera) if pattern.up is None else unit(pattern.up)
    turn = cosine(pattern.rotation), sine(pattern.rotation)
    colors = (None, None) if isinstance(pattern, ImagePattern) else pattern.colors
    first, second = (_light_of(color, scene) for color in colors)
    size = -1.0 / unit_length if pattern.size is None else max(pattern.size / unit_length, TINY)
    return [size, *up, *beside(up), *turn, *first, *second]


def _light_of(color: Color | None, scene: Scene) -> Vec:
    """Return a colour as light, negative for none."""
    return (-1.0, -1.0, -1.0) if color is None else light_of(color, scene.render.tonemap)
