"""From values to colours: colour maps by name, and the scale that was used."""

import functools
import math
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vtray.base.caller_warning import warn_caller
from vtray.base.errors import SceneError
from vtray.base.exact_math import logarithm
from vtray.base.extras import pip_install
from vtray.scene.checks.scene_words import either, nearest, quoted, show
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.colors.names import Rgb, to_rgb

if TYPE_CHECKING:
    import cmap as cmap_package
    from matplotlib.colors import Colormap

    ColorMap: TypeAlias = str | Colormap | cmap_package.Colormap
    from vtray.scene.colors.names import AnyColor

Bytes = NDArray[np.uint8]
Spread = Literal["linear", "log"]
Norm = Literal["linear", "log", "centered"]
"""How values are spread over a map: "centered" is linear, with 0 in the middle."""


class ColorScale:
    """How values become colours: as a colour bar shows it.

    A value from `low` to `high` gets the colour of the map at its place between them, that in the
    middle if they are equal, one below `low` the first colour, one above `high` the last, and NaN
    `nan_color`. Scales do not change.

    Attributes
    ----------
    cmap : str or colour map
        The name of a map of Matplotlib, or a map of Matplotlib or of the package ``cmap``.
    low, high : float
        The values of the first and the last colour, low ≤ high.
    norm : str
        "linear"; or "log" for places between them by logarithms: what is not above 0 then counts as
        NaN.
    nan_color : tuple of int
        Red, green and blue for NaN, from 0 to 255.

    Parameters
    ----------
    place : str
        What the messages of errors begin with: ``"ColorScale: "`` by default.

    Raises
    ------
    SceneError
        If there is no such map, or none can be had as neither package is installed; or if an
        argument is not right.
    """

    __slots__ = ("_table", "cmap", "high", "low", "nan_color", "norm")

    cmap: "ColorMap"
    low: float
    high: float
    norm: Spread
    nan_color: Rgb

    @explain_unknown
    def __init__(
        self,
        cmap: "ColorMap",
        low: float,
        high: float,
        nan_color: "AnyColor" = "gray",
        *,
        norm: Spread = "linear",
        place: str = "ColorScale: ",
    ) -> None:
        _check_norm(norm, Spread, place)
        _check_limits((low, high), f"{place}clim", norm)
        values = {
            "cmap": cmap,
            "low": float(low),
            "high": float(high),
            "norm": norm,
            "nan_color": to_rgb(nan_color, f"{place}nan_color"),
            "_table": color_table(cmap, f"{place}cmap"),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def __setattr__(self, name: str, value: object) -> None:
        message = f"a ColorScale does not change; make another one instead of setting {name}"
        raise AttributeError(message)

    def __eq__(self, other: object) -> bool:
        """Tell whether all values get the same colours."""
        if not isinstance(other, ColorScale):
            return NotImplemented
        mine, its = (
            (scale.low, scale.high, scale.norm, scale.nan_color, scale.table.tobytes())
            for scale in (self, other)
        )
        return mine == its

    def __hash__(self) -> int:
        return hash((self.low, self.high, self.nan_color))

    def __repr__(self) -> str:
        name = getattr(self.cmap, "name", self.cmap)
        norm = "" if self.norm == "linear" else f", norm={self.norm!r}"
        values = f"{name!r}, {self.low!r}, {self.high!r}, nan_color={self.nan_color}"
        return f"ColorScale({values}{norm})"

    def __reduce__(self) -> tuple[Any, ...]:
        make = functools.partial(ColorScale, norm=self.norm)
        return make, (self.cmap, self.low, self.high, self.nan_color)

    @property
    def table(self) -> Bytes:
        """The colours of the map from first to last, uint8, (m, 3)."""
        return self._table  # type: ignore[no-any-return, attr-defined]

    def colors(self, values: ArrayLike) -> Bytes:
        """Return the colours of values, exactly as the picture uses them.

        Parameters
        ----------
        values
            Numbers of any shape; they may be infinite or NaN.

        Returns
        -------
        array
            uint8, of the shape of `values` with 3 appended.
        """
        whole, low, high = np.asarray(values, np.float64), self.low, self.high
        given = whole.reshape(-1)
        if self.norm == "log":
            given, ends = logarithm(given), logarithm(np.array([low, high]))
            low, high = float(ends[0]), float(ends[1])
        # Halves, as the difference of the limits may be more than a double can be.
        half = given * 0.5
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            half -= low * 0.5
            half /= high * 0.5 - low * 0.5
            if low == high:
                half[given == low] = 0.5
            half *= len(self.table)
            missing = np.isnan(given)
            # What is not above 0, NaN too, gets the first colour.
            np.fmin(np.fmax(half, 0.0, out=half), len(self.table) - 1.0, out=half)
        colors = self.table[half.astype(np.intp)]
        if missing.any():
            colors[missing] = self.nan_color
        return colors.reshape(*whole.shape, 3)


def scale_of(
    values: NDArray[np.float64],
    cmap: "ColorMap",
    clim: object,
    nan_color: "AnyColor",
    place: str,
    norm: Norm | None = None,
) -> ColorScale:
    """Return the scale for values; its limits are the finite range unless they are given.

    With the norm "log", that of what is above 0; with "centered", 0 is in the middle.
    """
    if norm is not None:
        _check_norm(norm, Norm, place)
    spread: Spread = "log" if norm == "log" else "linear"
    if clim is None:
        finite = values[np.isfinite(values)]
        if norm == "log" and finite.size and finite.max() <= 0.0:
            words = "no value is above 0, as logarithms need; all get nan_color"
            warn_caller(f"{place}norm: {words}")
        finite = finite[finite > 0.0] if norm == "log" else finite
        usual = (1.0, 10.0) if norm == "log" else (0.0, 1.0)
        low, high = (float(finite.min()), float(finite.max())) if finite.size else usual
    else:
        low, high = _check_limits(clim, f"{place}clim", spread)
    if norm == "centered":
        high = max(abs(low), abs(high))
        low = -high
    return ColorScale(cmap, low, high, nan_color, norm=spread, place=place)


def _check_norm(norm: object, known: Any, place: str) -> None:  # noqa: ANN401
    """Raise SceneError if a norm is none of those that are known."""
    if not isinstance(norm, str) or norm not in get_args(known):
        words = either(map(quoted, get_args(known)))
        raise SceneError(f"{place}norm: expected {words}, got {show(norm)}")


def _check_limits(clim: Any, place: str, norm: str) -> tuple[float, float]:  # noqa: ANN401
    """Return limits that are two finite numbers, the lower first, above 0 for logarithms."""
    try:
        low, high = (float(limit) for limit in clim)
        right = not isinstance(clim, str) and math.isfinite(low) and math.isfinite(high)
    except (TypeError, ValueError, OverflowError):
        right = False
    if not right:
        raise SceneError(f"{place}: expected two finite numbers, got {show(clim)}")
    if low > high:
        hint = 'for the colours in reverse, add "_r" to the name of the colour map'
        raise SceneError(f"{place}: expected the lower number first, got {show(clim)}; {hint}")
    if norm == "log" and low <= 0.0:
        raise SceneError(f"{place}: for logarithms, expected numbers above 0, got {show(clim)}")
    return low, high


def color_table(cmap: "ColorMap", place: str = "cmap") -> Bytes:
    """Return the colours of a colour map from first to last, uint8, (m, 3), read-only.

    Raises
    ------
    SceneError
        If there is no such map, or none can be had as neither package is installed.
    """
    return _named_table(cmap, place) if isinstance(cmap, str) else _table(cmap, place)


@functools.lru_cache(maxsize=64)
def _named_table(name: str, place: str) -> Bytes:
    try:
        import matplotlib as mpl
    except ModuleNotFoundError:
        return _table_of_cmap(name, place)
    if name not in mpl.colormaps:
        raise _unknown(name, list(mpl.colormaps), place)
    return _table(mpl.colormaps[name], place)


def _table_of_cmap(name: str, place: str) -> Bytes:
    """Return the colours of a map of the package ``cmap``."""
    try:
        import cmap
    except ImportError:
        problem = f"colour maps need the package cmap, or Matplotlib: {pip_install('cmap')}"
        raise SceneError(f"{place}: {problem}") from None
    import logging

    logger = logging.getLogger("cmap")
    was_disabled, logger.disabled = logger.disabled, True  # it tells of names that are used twice
    try:
        known = cmap.Catalog()[name.removesuffix("_r")].qualified_name
        return _table(cmap.Colormap(known + "_r" * name.endswith("_r")), place)
    except (ValueError, TypeError, KeyError):
        raise _unknown(name, list(cmap.Catalog().short_keys()), place) from None
    finally:
        logger.disabled = was_disabled


def _unknown(name: str, names: list[str], place: str) -> SceneError:
    close = nearest(name, names, cutoff=0.6)
    hint = f"; did you mean {close}?" if close else ""
    return SceneError(
        f'{place}: expected the name of a colour map such as "viridis", got {show(name)}{hint}'
    )


def _table(cmap: Any, place: str) -> Bytes:  # noqa: ANN401
    """Return the colours of a map object of either package."""
    try:
        # A map of Matplotlib has N colours, one of the package cmap any number of them, or few.
        few = getattr(cmap, "interpolation", "") == "nearest"
        size = int(cmap.num_colors if few else getattr(cmap, "N", 256))
        rgba = np.asarray(cmap.lut(size) if hasattr(cmap, "lut") else cmap(np.arange(size)))
        table: Bytes = np.floor(rgba[:, :3] * 255.0 + 0.5).astype(np.uint8)
    except (TypeError, ValueError, AttributeError, IndexError):
        words = 'expected the name of a colour map such as "viridis", or a colour map'
        raise SceneError(f"{place}: {words}, got {show(cmap)}") from None
    table.flags.writeable = False
    return table
