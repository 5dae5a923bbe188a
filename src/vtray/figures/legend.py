"""Legends: what the colours of particles stand for, as small balls with names."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.figures.flat import lit_colors
from vtray.figures.sheet import FigureError
from vtray.scene.colors.names import Rgb, to_rgb

if TYPE_CHECKING:
    from vtray.scene.colors.names import AnyColor

    LegendGiven: TypeAlias = Mapping[str, AnyColor] | Iterable[tuple[str, AnyColor]]

WANTED = 'pairs of a name and a colour, such as {"O": "red"}'

LIGHT = (-0.36, -0.48, 0.8)
"""Where the light of balls comes from: left, above, and from where one looks."""

SHADE = 0.45
"""How bright a ball is in shadow, in parts of its colour."""


class Entry(NamedTuple):
    """A line of a legend: a name, and the colour that it explains."""

    name: str
    color: Rgb


def legend_entries(legend: "LegendGiven") -> list[Entry]:
    """Return the lines of a legend.

    Parameters
    ----------
    legend
        Colours by names, or pairs of a name and a colour.

    Raises
    ------
    FigureError
        One is no such pair.
    """
    given: Any = legend
    try:
        pairs = list(given.items() if isinstance(given, Mapping) else given)
    except TypeError:
        message = f"legend: expected {WANTED}, or None, got {legend!r}"
        raise FigureError(message) from None
    return [_entry(pair, f"legend[{k}]") for k, pair in enumerate(pairs)]


def _entry(pair: Any, place: str) -> Entry:  # noqa: ANN401
    """Return a line of a legend."""
    try:
        name, color = pair
    except (TypeError, ValueError):
        name, color = "", None
    if not isinstance(name, str) or not name.strip():
        message = f"{place}: expected {WANTED}, got {pair!r}"
        raise FigureError(message)
    try:
        return Entry(" ".join(name.split()), to_rgb(color, place))
    except SceneError as error:
        raise FigureError(str(error)) from None


def ball(color: Rgb, size: int, *, flat: bool = False) -> NDArray[np.uint8]:
    """Return a small picture of a lit ball that fills it, with alpha, (size, size, 4).

    That of a flat picture differs in lightness only, as that does.
    """
    side = (2.0 * np.arange(size) + 1.0) / size - 1.0
    x, y = np.meshgrid(side, side)
    radius = np.sqrt(x * x + y * y)
    outside = np.maximum(radius, 1.0)
    x, y = x / outside, y / outside
    z = np.sqrt(np.maximum(1.0 - x * x - y * y, 0.0))
    lit = np.maximum(x * LIGHT[0] + y * LIGHT[1] + z * LIGHT[2], 0.0)
    picture = np.zeros((size, size, 4), np.uint8)
    if flat:
        colors = np.tile(np.array(color, np.uint8), (size * size, 1))
        picture[..., :3] = lit_colors(colors, lit.ravel()).reshape(size, size, 3)
    else:
        light = SHADE + (1.0 - SHADE) * lit
        picture[..., :3] = np.floor(light[..., None] * np.array(color, np.float64) + 0.5)
    picture[..., 3] = np.floor(255.0 * np.clip((1.0 - radius) * size / 2 + 0.5, 0.0, 1.0) + 0.5)
    return picture
