"""Particles of named columns: those of tables, data frames and mappings."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.column_names import canonical, name_columns
from vtray.scene.particles.particles import POSITION, Particles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]


def from_columns(
    columns: "Mapping[str, Array]", called: Mapping[str, str] | None = None
) -> Particles:
    """Return the particles whose places are the columns x, y and z, or `position`.

    Parameters
    ----------
    columns
        Arrays (n,) or (n, k) by their names, in any case for those of the places.
    called
        For some columns, what they are called in `columns`, such as ``{"x": "px"}``.

    Raises
    ------
    SceneError
        There are no places, or a column that was named is not there.
    """
    import numpy as np

    positions: Any
    left = renamed(columns, called or {})
    places = {name.lower(): name for name in reversed(left)}
    whole = [name for name in left if canonical(name) == "position" and left[name].ndim == 2]
    if all(name in places for name in POSITION):
        parts = [left.pop(places[name]) for name in POSITION]
        for name, part in zip(POSITION, parts, strict=True):
            if part.ndim != 1 or part.dtype.kind not in "biuf":
                raise SceneError(f"column {name!r}: expected numbers, got {_kind(part)}")
        kind = np.float32 if all(part.dtype == np.float32 for part in parts) else np.float64
        positions = np.stack(parts, axis=1).astype(kind, copy=False)
    elif whole:
        positions = left.pop(whole[0])
    else:
        known = short(", ".join(columns), 100) or "none"
        remedy = 'name them, as in columns={"x": "px", "y": "py", "z": "pz"}'
        raise SceneError(f"expected the columns x, y and z, got {known}; {remedy}")
    return Particles(positions, name_columns(left))


def renamed(columns: "Mapping[str, Array]", called: Mapping[str, str]) -> "dict[str, Array]":
    """Give some columns the names that were asked for.

    Raises
    ------
    SceneError
        There is no such column.
    """
    left = dict(columns)
    chosen = {}
    for name, theirs in called.items():
        if theirs not in left:
            known = short(", ".join(left), 100) or "none"
            raise SceneError(f"columns[{name!r}]: no column {theirs!r}; there are {known}")
        chosen[name] = left.pop(theirs)
    return {**chosen, **{name: values for name, values in left.items() if name not in chosen}}


def _kind(part: "Array") -> str:
    """Say what a column holds that is no numbers."""
    return f"shape {part.shape}" if part.ndim != 1 else f"such as {short(str(part[0]))!r}"
