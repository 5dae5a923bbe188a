"""The colours of particles: of their elements, of a column, of categories."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from blake3 import blake3
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.scene.checks.choices import is_one_of, listed
from vtray.scene.checks.given_array import UNCONVERTED, check_unmasked, converted
from vtray.scene.checks.object_column import without_objects
from vtray.scene.checks.scene_words import either, nearest, quoted, show
from vtray.scene.colors.color_arrays import ONE_COLOR, color_arrays
from vtray.scene.colors.color_scale import ColorScale
from vtray.scene.colors.names import Rgb, is_name, to_rgb
from vtray.scene.particles.column_names import column_called
from vtray.scene.particles.elements import SCHEMES, SYMBOLS, atomic_numbers, colors_of
from vtray.scene.particles.expression import BESIDE_COLUMNS, values_of
from vtray.scene.particles.particles import POSITION
from vtray.scene.vectors import Color

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vtray.scene.colors.color_scale import ColorMap, Norm
    from vtray.scene.colors.names import AnyColor
    from vtray.scene.particles.particles import Particles

Bytes = NDArray[np.uint8]
Integers = NDArray[np.int64]

CMAP = "viridis"
"""The colour map of values, where none is named."""

PALETTE = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442", "#999999")
"""Colours of categories that people with any colour vision can tell apart.

References
----------
M. Okabe and K. Ito, "Color Universal Design", 2008; black, which shows no shape, is left out, and
grey is added.
"""

TYPE = "type"
"""The column of integers that are categories, however many there are."""

NAMELESS = "(none)"
"""What a legend calls the category whose name is empty."""

SHADE, TINT = 0.55, 0.5
"""How much of the palette's colours there is where it comes a second time, darker, and a third
time, lighter; the rest is black, or white."""

PLAIN = "#7aa6c2"
"""The colour of particles of which nothing is known."""

LIGHTEST = 228
"""The grey of elements that are white, or nearly: they would be lost on white paper."""

FADED = 5
"""What is not highlighted keeps one part in so many of its colour; the rest is the background."""


class Coloring(NamedTuple):
    """Colours of particles, and what they mean.

    Attributes
    ----------
    colors
        uint8, (n, 3), or (3,) for one colour.
    scale
        How values became colours, if they did.
    legend
        What colours stand for, if they are of elements or categories: names and colours.
    categories
        Those that there are, in the order of their colours, if these are of categories; or the
        elements of the legend.
    """

    colors: Bytes
    scale: ColorScale | None = None
    legend: Sequence[tuple[str, Rgb]] = ()
    categories: Sequence[Any] | None = None


def color_particles(
    particles: "Particles",
    rows: Integers,
    color: "str | AnyColor | ArrayLike | None" = None,
    *,
    colors: str = "jmol",
    cmap: "ColorMap | None" = None,
    clim: object = None,
    norm: "Norm | None" = None,
    nan_color: "AnyColor" = "gray",
    categories: Sequence[Any] | None = None,
) -> Coloring:
    """Return the colours of some particles.

    Parameters
    ----------
    particles
        All particles.
    rows
        Which of them are drawn, (n,).
    color, colors, cmap, clim, norm, nan_color, categories
        As for `Scene.add_particles`.

    Raises
    ------
    SceneError
        An argument is not right.
    """
    if not is_one_of(colors, SCHEMES):
        raise SceneError(f"colors: expected {either(map(quoted, SCHEMES))}, got {show(colors)}")
    if categories is not None:
        categories = listed(categories, "categories", "a list of names or integers")
    scaled = {"cmap": cmap, "clim": clim, "norm": norm, "nan_color": nan_color}
    asked = _asked(scaled)
    if color is None:
        known = [name for name in ("color", "element", "type") if name in particles.columns]
        if not known and asked:
            raise SceneError(f"{asked[0]}: is for values; give color, such as color={quoted('x')}")
        color = known[0] if known else PLAIN
    if isinstance(color, str):
        if color == "element" and color in particles.columns and not asked:
            return _of_elements(particles["element"][rows], colors, categories or ())
        called = column_called(color, particles.columns)
        if called in particles.columns or color in POSITION:
            return _of_column(called, particles[called], rows, scaled, categories)
        if not is_name(color):
            values = _worked_out(color, particles)
            return _of_column(color, values, rows, scaled, categories)
        one = np.array(to_rgb(color), np.uint8)
        if asked:
            words = f"{show(color)} is one colour, which no colour map is for"
            raise SceneError(f"color: {words}; leave {' and '.join(asked)} out")
        return Coloring(one)
    return _of_array(color, len(particles), rows, scaled, categories)


def faded(colors: Bytes, kept: NDArray[np.bool_], background: "AnyColor") -> Bytes:
    """Return colours of which only some are kept, and the others are near the background.

    Parameters
    ----------
    colors
        uint8, (n, 3) or (3,).
    kept
        Which ones are kept, (n,).
    background
        The colour that the others come near.
    """
    each = np.broadcast_to(colors, (len(kept), 3)).astype(np.int64)
    behind = np.array(to_rgb(background, "background"), np.int64)
    pale = (each + (FADED - 1) * behind) // FADED
    return np.where(kept[:, None], each, pale).astype(np.uint8)


def _of_elements(symbols: NDArray[Any], colors: str, known: Sequence[Any]) -> Coloring:
    """Return the colours of elements; those that are known stand in the legend, too."""
    numbers = atomic_numbers(symbols)
    others = atomic_numbers([symbol for symbol in known if symbol in SYMBOLS])
    table = colors_of(SYMBOLS, colors)
    table[np.flatnonzero(table.min(axis=1) > LIGHTEST)] = LIGHTEST
    shown = np.union1d(numbers, others).tolist()
    legend = [(SYMBOLS[k], _rgb(table[k])) for k in shown]
    return Coloring(table[numbers], None, legend, [SYMBOLS[k] for k in shown])


def _one_for_each(given: Any, count: int) -> NDArray[Any] | None:  # noqa: ANN401
    """Return a number or a name for each particle, as in a column; None if they are none."""
    try:
        array = converted(given)
    except UNCONVERTED:
        return None
    if array.shape != (count,) or (array.dtype == object and any(map(_is_color, array))):
        return None
    return without_objects(array)


def _is_color(item: object) -> bool:
    """Tell whether one of many is meant as a colour as such, not by its name."""
    return isinstance(item, (Color, tuple, list, np.ndarray))


def _of_array(
    given: Any,  # noqa: ANN401
    count: int,
    rows: Integers,
    scaled: dict[str, Any],
    categories: Sequence[Any] | None,
) -> Coloring:
    """Return the colours that are given, or those of what a column could hold instead."""
    check_unmasked(given, "color")
    values, asked = _one_for_each(given, count), _asked(scaled)
    if values is None or (values.shape in ONE_COLOR and values.dtype.kind in "iuf" and not asked):
        return _of_values(given, count, rows, scaled, may_be_one=True)
    try:
        return _of_column("", values, rows, scaled, categories)
    except SceneError as error:
        if asked or values.dtype.kind != "U":
            raise
        hint = f"to colour by names, give these, as in categories=[{show(str(values[0]))}, ...]"
        raise SceneError(f"{error}; {hint}") from None


def _of_column(
    name: str,
    values: NDArray[Any],
    rows: Integers,
    scaled: dict[str, Any],
    categories: Sequence[Any] | None,
) -> Coloring:
    """Return the colours of what a column holds, or an array without a name: one for each."""
    are_dates = values.dtype.kind in "mM"
    if are_dates:
        values = values.astype(np.str_)  # dates and times stand for themselves, as names do
    may_be_colors = name == "color" or (not name and categories is None)
    if may_be_colors and (values.ndim == 2 or _has_colors(values)):
        return _of_values(values, len(values), rows, scaled)
    if values.ndim == 2:
        values = _lengths(values, name)
    is_text = values.dtype.kind in "OUST"
    few = values.dtype.kind in "iub" and (
        name == TYPE or categories is not None or len(np.unique(values)) <= len(PALETTE)
    )
    asked = _asked(scaled)
    if not asked and (is_text or few):
        return _of_categories(values, rows, categories)
    if is_text:
        what = f"column {show(name)}" if name else "the array"
        words = f"{what} holds {'dates' if are_dates else 'names'}, which no colour map is for"
        remedy = f"leave {' and '.join(asked)} out"
        if are_dates:
            remedy = 'give numbers, such as of days: (dates - dates[0]) / np.timedelta64(1, "D")'
        raise SceneError(f"color: {words}; {remedy}")
    return _of_values(values, len(values), rows, scaled)


def _asked(scaled: dict[str, Any]) -> list[str]:
    """Return what is asked for of the colour map of values."""
    return [argument for argument in ("cmap", "clim", "norm") if scaled[argument] is not None]


def _has_colors(values: NDArray[Any]) -> bool:
    """Tell whether some values are names of colours, so that all are meant as such."""
    if values.dtype.kind not in "OUST":
        return False
    return any(map(is_name, set(values.astype(np.str_).tolist())))


def _of_categories(values: NDArray[Any], rows: Integers, known: Sequence[Any] | None) -> Coloring:
    """Return colours of which each stands for one value; of more than 24, some come again."""
    found, which = np.unique(
        values.astype(str) if values.dtype.kind == "O" else values, return_inverse=True
    )
    kinds = found.tolist()
    palette = _palette()
    places = _places(kinds, kinds if known is None else known, len(palette))
    table = np.array([palette[place] for place in places], np.uint8).reshape(-1, 3)
    drawn = which[rows]
    named = dict(zip(kinds, (_rgb(row) for row in table), strict=True))
    shown = {kinds[k] for k in np.unique(drawn)}
    in_order = sorted((kind for kind in kinds if kind in shown), key=_natural)
    legend = [(_label(kind), named[kind]) for kind in in_order]
    if known is not None:
        listed = [(_label(kind), palette[k % len(palette)]) for k, kind in enumerate(known)]
        known_names = dict(listed)
        legend = listed + [(name, color) for name, color in legend if name not in known_names]
    return Coloring(table[drawn], None, legend, kinds if known is None else known)


def _label(kind: object) -> str:
    """Return what a legend calls a category."""
    return str(kind).strip() or NAMELESS


def _natural(kind: object) -> list[tuple[int, int, str]]:
    """Return by what names are sorted as people do: a2 before a10, integers by their value."""
    if isinstance(kind, int):
        return [(0, kind, "")]
    parts = enumerate(re.split("([0-9]+)", str(kind)))
    return [(0, int(part), part) if k % 2 else (1, 0, part) for k, part in parts if part]


def _palette() -> list[Rgb]:
    """Return the colours of categories: those of the palette, then darker and lighter ones."""
    colors = np.array([to_rgb(color, "") for color in PALETTE], float)
    darker, lighter = SHADE * colors, TINT * colors + (1.0 - TINT) * 255.0
    all_of_them = np.concatenate([colors, darker, lighter])
    return [_rgb(row) for row in np.rint(all_of_them).astype(np.uint8)]


def _places(kinds: Sequence[Any], known: Sequence[Any], most: int) -> list[int]:
    """Return the places of categories in a palette of so many colours.

    One that is not known has a place by its name alone, among those that are free, if some are: so
    it has the same colour wherever it is met.
    """
    size = len(PALETTE) if len(known) < len(PALETTE) else most
    first = len(known) if len(known) < size else 0
    place_of = {str(kind): k % size for k, kind in enumerate(known)}
    return [
        place_of[str(kind)]
        if str(kind) in place_of
        else first + int.from_bytes(blake3(str(kind).encode()).digest(8), "little") % (size - first)
        for kind in kinds
    ]


def _of_values(
    given: Any,  # noqa: ANN401
    count: int,
    rows: Integers,
    scaled: dict[str, Any],
    *,
    may_be_one: bool = False,
) -> Coloring:
    """Return the colours of values, or colours that are given as such, one for all if it may be."""
    try:
        array = converted(given)
    except UNCONVERTED:
        array = np.empty(())
    may_be_one &= array.shape in ONE_COLOR and array.dtype.kind in "iuf" and not _asked(scaled)
    are_values = array.shape == (count,) and array.dtype.kind in "biuf"
    is_scaled = are_values and not may_be_one
    if is_scaled and scaled["cmap"] is None:
        scaled = {**scaled, "cmap": CMAP}
    try:
        found, scale = color_arrays(
            {"color": array[rows] if is_scaled else given},
            len(rows) if is_scaled else count,
            "add_particles: ",
            each="particle",
            **scaled,
        )
    except SceneError as error:
        if not (are_values and may_be_one):
            raise
        hint = f"for values, give a colour map too, for instance cmap={quoted(CMAP)}"
        raise SceneError(f"{error}; {hint}") from None
    colors = found["color"]
    return Coloring(colors if is_scaled or colors.ndim == 1 else colors[rows], scale)


def _lengths(vectors: NDArray[Any], name: str) -> NDArray[np.float64]:
    """Return the lengths of vectors, (n, k)."""
    if vectors.dtype.kind not in "biuf":
        raise SceneError(f"color: column {show(name)} holds no numbers")
    squares = np.zeros(len(vectors))
    for column in vectors.T:
        part = column.astype(np.float64)
        squares += part * part
    return np.sqrt(squares)


def _worked_out(color: str, particles: "Particles") -> NDArray[Any]:
    """Return what an expression is, or explain what is neither a column nor a colour nor that."""
    if not _is_expression(color):
        words = f"expected a colour or the name of a column, got {show(color)}"
        raise SceneError(f"color: {words}; {columns_like(color, particles)}")
    try:
        return values_of(particles, color, "color")
    except SceneError as error:
        raise SceneError(f"{error} (nor is it a colour or a column)") from None


def _is_expression(color: str) -> bool:
    """Tell whether a text is meant to be worked out: it has a sign or a word that no name has."""
    if color.strip() in BESIDE_COLUMNS:
        return True
    pattern = r"[^\W\d].*[-(\[.*+/%<>=&|^~!]|[-(*+/%<>=&|^~!].*[^\W\d]|\b(and|or|not|in)\b"
    return re.search(pattern, color) is not None


def columns_like(name: str, particles: "Particles") -> str:
    """Say which column may be meant by a name that none has, or which there are."""
    known = [*POSITION, *particles.columns]
    close = nearest(name, known, cutoff=0.6)
    return f"did you mean {close}?" if close else f"the columns are {', '.join(known)}"


def _rgb(row: Bytes) -> Rgb:
    red, green, blue = (int(part) for part in row)
    return red, green, blue
