"""What was given where an array is expected: as one, and for messages, where tables are names."""

import sys
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.checks.object_column import without_objects

if TYPE_CHECKING:
    from numpy.typing import NDArray

COORDINATES = ("x", "y", "z")
RED_GREEN_BLUE = ("r", "g", "b")

_HELD = ("atoms", "particles")
"""Attributes in which universes of MDAnalysis and data of OVITO have what has places."""

_MADE_BY = ("collect", "toarray")
"""Methods that make a table or an array of Polars' lazy tables and SciPy's sparse arrays."""

UNCONVERTED = (ValueError, TypeError, RuntimeError, OverflowError, BufferError)
"""What is raised by what cannot become an array: rows of different length, arrays on a GPU."""


def is_masked(given: object) -> bool:
    """Tell whether an array has masked numbers."""
    # Who has no masked arrays need not wait for NumPy to load them.
    if "numpy.ma" not in sys.modules:
        return False
    import numpy as np

    return bool(np.ma.is_masked(given))


def check_unmasked(given: object, place: str) -> None:
    """Raise SceneError if an array has masked numbers."""
    if is_masked(given):
        words = f"expected a value for each particle, got {show_array(given)}"
        raise SceneError(f"{place}: {words}{remedy_for(given, ())}")


def array_of(
    given: Any,  # noqa: ANN401
    place: str,
    words: str,
    names: Sequence[str] = (),
) -> "NDArray[Any]":
    """Return what was given as an array of numbers or names.

    Parameters
    ----------
    given
        Whatever NumPy makes an array of.
    place
        What messages begin with.
    words
        What was expected instead of what is no array, or has masked numbers.
    names
        As for `converted`.

    Raises
    ------
    SceneError
        It is one of these.
    """
    is_refused = is_masked(given) or _maker_of(given) is not None
    got = show_array(given) if is_refused else ""
    if not got:
        try:
            return without_objects(converted(given, names))
        except UNCONVERTED as error:
            got = show_unconverted(given, error)
    raise SceneError(f"{place}: {words}, got {got}{remedy_for(given, ())}")


def _maker_of(given: object) -> str | None:
    """Return the method that makes an array of what is one only on demand, None for all else."""
    makers = (name for name in _MADE_BY if hasattr(given, name))
    return None if hasattr(given, "__array__") else next(makers, None)


def converted(given: Any, names: Sequence[str] = ()) -> "NDArray[Any]":  # noqa: ANN401
    """Return what was given as an array; raise one of `UNCONVERTED` if it cannot be one.

    A table that has columns of some names and no others, in any order, becomes an array of these
    in the order of the names; all other tables become arrays of what they have, as it stands.
    """
    import numpy as np

    if names and len(_columns(given)) == len(names):
        given = _chosen(given, names)

    given = without_categories(given)
    only_dlpack = hasattr(given, "__dlpack__") and not hasattr(given, "__array__")
    found: NDArray[Any] = np.from_dlpack(given) if only_dlpack else np.asarray(given)
    return found


def without_categories(column: Any) -> Any:  # noqa: ANN401
    """Return a column of Arrow's categories as what they stand for; all else as it is.

    What is missing in such a column becomes its last category in NumPy.
    """
    kind: Any = getattr(column, "type", None)
    is_one = hasattr(kind, "value_type") and hasattr(kind, "index_type")
    return column.cast(kind.value_type) if is_one else column


def show_unconverted(given: Any, error: Exception) -> str:  # noqa: ANN401
    """Write what cannot become an array, and why."""
    from vtray.scene.checks.json_tree import short

    return f"{show_array(given)} ({short(str(error), 100)})"


def show_array(given: Any) -> str:  # noqa: ANN401
    """Write what was given, in short."""
    if is_masked(given):
        return "an array with masked numbers"
    if _columns(given):
        return _table(given)
    if hasattr(given, "dtype") and hasattr(given, "shape"):
        kind = "a sparse array" if hasattr(given, "toarray") else "an array"
        return f"{kind} of dtype {given.dtype} and shape {given.shape}"
    from vtray.scene.checks.scene_words import show

    return show(given)


def show_shape(given: Any, shape: tuple[int, ...]) -> str:  # noqa: ANN401
    """Write the wrong shape of what was given."""
    return _table(given) if _columns(given) else f"shape {shape}"


def remedy_for(given: Any, columns: tuple[str, ...]) -> str:  # noqa: ANN401
    """Say what to give instead, to follow the problem; "" if nothing is known.

    Parameters
    ----------
    given
        What was given.
    columns
        What the columns of a table may be called that has what was expected.
    """
    if is_masked(given):
        return "; leave out what is masked, or give array.filled(...)"
    if maker := _maker_of(given):
        return f"; give what its {maker}() returns"
    if columns and _columns(given):
        from vtray.scene.checks.scene_words import quoted

        names = ", ".join(map(quoted, columns))
        if len(columns) == 1:
            return f"; choose one column, as in table[{names}]"
        chosen = f"table.select([{names}])" if _is_arrow(given) else f"table[[{names}]]"
        return f"; choose three columns, as in {chosen}"
    if columns == RED_GREEN_BLUE:
        return remedy_for_name(given)
    if columns == COORDINATES and hasattr(given, "positions"):
        return "; give its attribute positions"
    if columns == COORDINATES and hasattr(given, "get_positions"):
        return "; give what its get_positions() returns"
    return ""


def remedy_for_name(given: object) -> str:
    """Say how the name of a colour, or names in a list, become numbers; "" for all else."""
    name = given[0] if isinstance(given, (list, tuple)) and given else given
    if not isinstance(name, str):
        return ""
    from vtray.scene.checks.scene_words import show

    return f"; a name becomes numbers by vtray.colors.to_rgb({show(name)})"


def positions_in(given: Any) -> Any:  # noqa: ANN401
    """Return the places of what has some, or what was given itself.

    Atoms of ASE and MDAnalysis have them as ``positions`` or by ``get_positions()``, universes of
    MDAnalysis and data of OVITO in their ``atoms`` or ``particles``; tables and mappings in the
    columns x, y and z, among others; structured arrays in fields of these names.
    """
    for holder in (given, *(getattr(given, name, None) for name in _HELD)):
        if hasattr(holder, "positions"):
            return holder.positions
    if hasattr(given, "get_positions"):
        return given.get_positions()
    fields = fields_of(given)
    if all(name in fields and given.dtype[name].kind in "iuf" for name in COORDINATES):
        return _stacked(given[name] for name in COORDINATES)
    if isinstance(given, Mapping):
        chosen = _called(list(given), COORDINATES)
        try:
            return given if chosen is None else _stacked(given[name] for name in chosen)
        except UNCONVERTED:  # columns of different length
            return given
    return _chosen(given, COORDINATES)


def _stacked(columns: Iterable[Any]) -> "NDArray[Any]":
    """Return columns side by side; raise one of `UNCONVERTED` if they cannot be."""
    import numpy as np

    arrays = [c if is_masked(c) else without_objects(converted(c)) for c in columns]
    return np.ma.stack(arrays, axis=1)


def fields_of(given: Any) -> tuple[str, ...]:  # noqa: ANN401
    """Return the names of the fields of a structured array; none for what is no such."""
    return getattr(getattr(given, "dtype", None), "names", None) or ()


def _columns(given: Any) -> list[str]:  # noqa: ANN401
    """Return the names of the columns of a data frame; none for what is no such."""
    # Tables that are yet to be worked out have no shape, and warn where they are asked for names.
    columns = getattr(given, "columns", None) if hasattr(given, "shape") else None
    if columns is None:
        return []
    return list(map(str, given.column_names if _is_arrow(given) else columns))


def _chosen(table: Any, names: Sequence[str]) -> Any:  # noqa: ANN401
    """Return a table of the columns of some names, in any case; itself if it lacks one."""
    theirs = _columns(table)
    chosen = _called(theirs, names)
    if chosen is None or theirs == chosen:
        return table
    return table.select(chosen) if _is_arrow(table) else table[chosen]


def _called(theirs: Sequence[Any], names: Sequence[str]) -> list[Any] | None:
    """Return those that are some names in any case, in the order of these.

    None if one is not there, or twice, as tables may have it.
    """

    def called(name: str) -> Any:  # noqa: ANN401
        found = (own for own in theirs if str(own).lower() == name and theirs.count(own) == 1)
        return next(found, None)

    chosen = [called(name) for name in names]
    return None if None in chosen else chosen


def _is_arrow(table: Any) -> bool:  # noqa: ANN401
    """Tell whether a table is one of Arrow, which has its names apart from its columns."""
    return hasattr(table, "column_names")


def _table(given: Any) -> str:  # noqa: ANN401
    """Write a table, in short."""
    from vtray.scene.checks.scene_words import quoted

    names = [quoted(name) for name in _columns(given)]
    shown = [*names[:8], "..."] if len(names) > 8 else names
    return f"a table of shape {tuple(given.shape)} with the columns {', '.join(shown)}"
