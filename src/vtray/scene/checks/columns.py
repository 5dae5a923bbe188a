"""What an array of many objects must hold, and the checks of such arrays.

The checks look at the least and the greatest number of an array, which costs about a millisecond
per million; only when one of them is wrong does a search find the first wrong number. NumPy is
imported here only when arrays are at hand.
"""

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from vtray.base.errors import SceneError
from vtray.scene.checks.given_array import (
    COORDINATES,
    RED_GREEN_BLUE,
    UNCONVERTED,
    converted,
    is_masked,
    remedy_for,
    show_array,
    show_shape,
    show_unconverted,
)
from vtray.scene.checks.limits import Byte, Fraction, MaterialNumber, NonNegative, Real
from vtray.scene.checks.object_column import without_objects

if TYPE_CHECKING:
    from numpy.typing import NDArray

    AnyArray = NDArray[Any]
else:
    AnyArray = Any


class Column(NamedTuple):
    """What one of the arrays must hold.

    Attributes
    ----------
    kind
        The kind of each number.
    row
        Shape of what belongs to one object: () for a number, (3,) for three.
    one
        What may stand for all objects instead of an array, in words; "" if nothing may.
    table
        What the columns of a table may be called.
    stand_in
        The array, or the constant of the class, that counts where this one is left out; "" if it
        must be given.
    """

    kind: Any
    row: tuple[int, ...]
    one: str
    table: tuple[str, ...]
    stand_in: str = ""


Columns = Mapping[str, Column]
"""The arrays of a kind of objects by their names; the first says how many objects there are."""

POINT = Column(Real, (3,), "", COORDINATES)
RADIUS = Column(NonNegative, (), "a number", ("radius",))
COLOR = Column(Byte, (3,), "three integers", RED_GREEN_BLUE)
LAMBERT = Column(Fraction, (), "a number", ("lambert",))
OPACITY = Column(Fraction, (), "a number", ("opacity",), "OPAQUE")
ROUGHNESS = Column(Fraction, (), "a number", ("roughness",), "OWN")
METALNESS = Column(Fraction, (), "a number", ("metalness",), "OWN")
MATERIAL_INDEX = Column(MaterialNumber, (), "", ("material_index",), "FIRST")

WHOLE = Byte, MaterialNumber
"""The kinds of what is kept as uint8."""

NO_NAMES: Mapping[str, str] = MappingProxyType({})


def check_arrays(
    columns: Columns, values: Mapping[str, object], place: str, called: Mapping[str, str] = NO_NAMES
) -> dict[str, Any]:
    """Check and convert the arrays of objects of one kind.

    Parameters
    ----------
    columns
        What the arrays must hold.
    values
        What was given for each; one that may be left out is absent or None.
    place
        What messages begin with, right before the name of an array.
    called
        The names of arrays in messages, where they differ.

    Returns
    -------
    dict
        The arrays, floats where one number stands for all, and None for what was left out.

    Raises
    ------
    SceneError
        If one of them is not right.
    """
    shaped = check_shapes(columns, values, place, called)
    return {
        name: _check_numbers(shaped[name], column.kind, place + called.get(name, name))
        if name in shaped
        else None
        for name, column in columns.items()
    }


def check_shapes(
    columns: Columns, values: Mapping[str, object], place: str, called: Mapping[str, str] = NO_NAMES
) -> dict[str, AnyArray]:
    """Check the dtypes and the shapes of arrays, but none of their numbers.

    Parameters, and what is raised, are those of `check_arrays`; what was left out is not returned.
    """
    given = {
        name: values[name]
        for name, column in columns.items()
        if not column.stand_in or values.get(name) is not None
    }
    at = {name: place + called.get(name, name) for name in given}
    found = {name: _to_array(value, columns[name], at[name]) for name, value in given.items()}
    first, *others = given
    shaped = {first: _check_first(found[first], given[first], columns[first], at[first])}
    count = len(shaped[first])
    as_first = f"as {called.get(first, first)} has shape {shaped[first].shape}"
    for name in others:
        column, array = columns[name], found[name]
        shape = (count, *column.row)
        if array.shape == shape[:1] == (0,):  # what an empty list has
            array = array.reshape(shape)
        if array.shape != shape and not (column.one and array.shape == column.row):
            words = f"{array_words(column, count)}, {as_first}"
            raise _wrong_shape(array, given[name], column, words, at[name])
        shaped[name] = array
    return shaped


def array_words(column: Column, count: object = "n") -> str:
    """Say what an array must be, to follow the word "expected"."""
    shape = f"({count}, {column.row[0]})" if column.row else f"({count},)"
    words = f"an array of numbers of shape {shape}"
    return f"{column.one} or {words}" if column.one else words


def _to_array(found: Any, column: Column, place: str) -> AnyArray:  # noqa: ANN401
    """Return an array of numbers."""
    import numpy as np

    given: Any = msgspec.structs.astuple(found) if isinstance(found, msgspec.Struct) else found
    remedy = remedy_for(given, column.table)
    words = f"{place}: expected {array_words(column)}"
    if remedy and not hasattr(given, "__array__"):  # atoms, which NumPy would take one by one
        raise SceneError(f"{words}, got {show_array(given)}{remedy}")
    try:
        array: AnyArray = converted(given, column.table if column.row else ())
        if column.row:  # tables whose columns differ, or lack entries, are arrays of objects
            is_empty = array.dtype == object and array.size == 0
            array = array.astype(np.float64) if is_empty else without_objects(array)
    except UNCONVERTED as error:
        got = show_unconverted(given, error)
    else:
        if array.dtype.kind in "iuf" and not is_masked(given):
            return array
        got = show_array(given)
    raise SceneError(f"{words}, got {got}{remedy}")


def _check_first(array: AnyArray, given: object, column: Column, place: str) -> AnyArray:
    """Return the array that says how many objects there are, of shape (n, 3)."""
    if array.shape == (0,):  # what an empty list has
        return array.reshape(0, *column.row)
    if array.ndim == 1 + len(column.row) and array.shape[1:] == column.row:
        return array
    raise _wrong_shape(array, given, column, array_words(column), place)


def _wrong_shape(
    array: AnyArray, given: object, column: Column, words: str, place: str
) -> SceneError:
    """Give the error for an array of a wrong shape."""
    is_wide = array.ndim == 2 and len(array) == 3 != array.shape[1]
    hint = " (transpose it)" if column is POINT and is_wide else ""
    shape, remedy = show_shape(given, array.shape), remedy_for(given, column.table)
    return SceneError(f"{place}: expected {words}, got {shape}{remedy}{hint}")


def _check_numbers(given: AnyArray, kind: Any, place: str) -> Any:  # noqa: ANN401
    """Return an array of right numbers, read-only and of the dtype of an attribute, or a float."""
    import numpy as np

    with np.errstate(over="ignore", invalid="ignore"):
        array = given
        if kind not in WHOLE and given.dtype not in (np.float32, np.float64):
            array = given.astype(np.float64)
        if not _are_right(array, kind):
            from vtray.scene.checks.scene_words import expected

            index = _first_wrong(array, kind)
            words = expected(kind if math.isfinite(array[index]) else Real)
            where = f"{place}[{', '.join(map(str, index))}]" if index else place
            raise SceneError(f"{where}: expected {words}, got {given[index]!s}")
    if kind in WHOLE:
        array = array.astype(np.uint8, copy=False)
    if array.ndim == 0:
        return float(array)
    return read_only(array)


def read_only(array: AnyArray) -> AnyArray:
    """Return a view of an array by which it cannot be changed."""
    view = array.view()
    view.flags.writeable = False
    return view


def _are_right(array: AnyArray, kind: Any) -> bool:  # noqa: ANN401
    """Tell whether all numbers of an array are of a kind."""
    if array.size == 0:
        return True
    # All kinds are intervals of the finite numbers, and NaN is its own least and greatest.
    extremes = [float(array.min()), float(array.max())]
    if not all(map(math.isfinite, extremes)):
        return False
    try:
        msgspec.convert(extremes, list[kind])
    except msgspec.ValidationError:
        return False
    return kind not in WHOLE or bool((array.astype("u1", copy=False) == array).all())


def _first_wrong(array: AnyArray, kind: Any) -> tuple[int, ...]:  # noqa: ANN401
    """Return the index of the first number that is not of a kind; one there is."""
    import numpy as np

    flat = array.ravel()
    first, end = 0, flat.size
    while end - first > 1:
        middle = (first + end) // 2
        if _are_right(flat[first:middle], kind):
            first = middle
        else:
            end = middle
    return tuple(int(i) for i in np.unravel_index(first, array.shape))
