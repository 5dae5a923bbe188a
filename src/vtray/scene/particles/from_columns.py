"""Particles of named columns: those of tables, data frames and mappings."""

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.object_column import without_objects
from vtray.scene.particles.column_names import (
    canonical,
    components_among,
    name_columns,
    without_unit,
)
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.plain_numbers import of_fortran

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]


def in_column(row: int, name: str) -> str:
    """Return the place of an entry in a column, for messages."""
    return f"column {name!r}[{row}]"


def places_among(names: Iterable[str]) -> list[str]:
    """Return which columns are the places: x, y and z, or else those called position.

    They are in that order; none where there are no places.
    """
    known = list(names)
    return components_among(known) or _positions_among(known)


def _positions_among(names: Iterable[str]) -> list[str]:
    """Return which columns are called position."""
    return [name for name in names if canonical(name) == "position"]


def from_columns(
    columns: "Mapping[str, Array]",
    called: Mapping[str, str] | None = None,
    place_of: Callable[[int, str], str] = in_column,
) -> Particles:
    """Return the particles whose places are the columns x, y and z, or `position`.

    Parameters
    ----------
    columns
        Arrays (n,) or (n, k) by their names, in any case for those of the places.
    called
        For some columns, what they are called in `columns`, such as ``{"x": "px"}``.
    place_of
        Returns where the entry of a row from 0 on stands, given also the name of the column.

    Raises
    ------
    SceneError
        There are no places, one is no finite number, or a column that was named is not there.
    """
    import numpy as np

    positions: Any
    left = {name: without_objects(of) for name, of in renamed(columns, called or {}).items()}
    places = components_among(left)
    if places:
        for name in places:
            _check_numbers(left[name], name, place_of)
        parts = [left.pop(name) for name in places]
        _check_lengths(parts, places)
        kind = np.float32 if all(part.dtype == np.float32 for part in parts) else np.float64
        positions = np.stack(parts, axis=1).astype(kind, copy=False)
        left = _in_unit(left, without_unit(places[0])[1])
    elif called_so := _positions_among(left):
        positions = left.pop(min(called_so, key=lambda name: left[name].ndim != 2))
    else:
        known = short(", ".join(columns), 100) or "none"
        names = '{"x": "px", "y": "py", "z": "pz"}'
        remedy = f"name them, as in columns={names} or --position px,py,pz"
        if called is None:  # of a table that is at hand
            remedy = 'rename them, as in table.rename(columns={"px": "x", "py": "y", "pz": "z"})'
        if {"x", "y"} <= {name.lower() for name in left}:
            remedy = "places in a plane need a column z of zeros"
        raise SceneError(f"expected the columns x, y and z, got {known}; {remedy}")
    return Particles(positions, name_columns(left))


def _in_unit(columns: "dict[str, Array]", unit: str) -> "dict[str, Array]":
    """Leave the unit of the places out of the names of lengths that have the same."""
    found = {}
    for name, values in columns.items():
        bare, own = without_unit(name)
        is_length = own == unit and canonical(bare) in ("radius", "diameter")
        found[bare if is_length and bare not in columns else name] = values
    return found


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


def _check_numbers(part: "Array", name: str, place_of: Callable[[int, str], str]) -> None:
    """Raise SceneError if a column does not hold one finite number for each row."""
    import numpy as np

    if part.ndim != 1:
        raise SceneError(f"column {name!r}: expected numbers, got shape {part.shape}")
    if part.size and part.dtype.kind not in "iuf":
        row = next((k for k, entry in enumerate(part) if not _is_number(entry)), 0)
        shown = short(str(part[row]))
        raise SceneError(f"{place_of(row, name)}: expected numbers, got such as {shown!r}")
    is_finite = np.isfinite(part)
    if not is_finite.all():
        row = int(np.argmin(is_finite))
        raise SceneError(f"{place_of(row, name)}: must be finite, got {part[row]}")


def _check_lengths(parts: "list[Array]", names: list[str]) -> None:
    """Raise SceneError if one of the columns of places is not as long as the first."""
    first, count = names[0], len(parts[0])
    for part, name in zip(parts, names, strict=True):
        if len(part) != count:
            words = f"expected {count} numbers, as column {first!r} has, got {len(part)}"
            raise SceneError(f"column {name!r}: {words}")


def columns_among(arrays: "Mapping[str, Array]", count: int) -> "dict[str, Array]":
    """Return those of some arrays that have numbers, or a text, for each of so many particles."""
    return {
        name: of
        for name, of in arrays.items()
        if of.dtype.kind in "biufU" and of.ndim in (1, 2) and len(of) == count
    }


def _is_number(entry: object) -> bool:
    """Tell whether an entry of a column that holds others may be a number."""
    try:
        of_fortran(str(entry))
    except ValueError:
        return False
    return True
