"""Many spheres as arrays, and the checks of these arrays.

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
from vtray.scene.checks.checked import Checked, Frozen, bind, make_unchecked
from vtray.scene.checks.given_array import (
    COORDINATES,
    RED_GREEN_BLUE,
    is_masked,
    remedy_for,
    show_array,
    show_shape,
)
from vtray.scene.checks.limits import Byte, Fraction, NonNegative, Real

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from vtray.scene.colors.color_scale import ColorScale

    AnyArray = NDArray[Any]
    Floats = NDArray[np.float64] | NDArray[np.float32]
    Bytes = NDArray[np.uint8]
else:
    AnyArray = Floats = Bytes = Any


class Column(NamedTuple):
    """What one of the arrays must hold.

    Attributes
    ----------
    kind
        The kind of each number.
    row
        Shape of what belongs to one sphere: () for a number, (3,) for three.
    one
        What may stand for all spheres instead of an array, in words; "" if nothing may.
    columns
        What the columns of a table may be called.
    """

    kind: Any
    row: tuple[int, ...]
    one: str
    columns: tuple[str, ...]


COLUMNS = {
    "center": Column(Real, (3,), "", COORDINATES),
    "radius": Column(NonNegative, (), "a number", ("radius",)),
    "color": Column(Byte, (3,), "three integers", RED_GREEN_BLUE),
    "lambert": Column(Fraction, (), "a number", ("lambert",)),
}


def check_spares_data(path: "Path", objects: "Iterable[object]") -> None:
    """Raise OutputError if writing a file would destroy arrays that objects were read from."""
    from vtray.base.atomic_file import check_spares

    found = [item.source for item in objects if isinstance(item, Spheres)]
    what = "holds arrays of the scene itself"
    check_spares(path, filter(None, found), what, "choose another name for the image")


_NO_NAMES: Mapping[str, str] = {}


class _CheckedArrays(Checked):
    """Makes construction in code check and convert arrays."""

    def __call__(cls, *args: object, **kwargs: object) -> Any:  # noqa: ANN401, N805
        """Bind the arguments, check and convert them, and make the object."""
        values = bind(cls, args, kwargs)
        return make_unchecked(cls, **check_arrays(values, f"{cls.__name__}."))


class Spheres(
    Frozen,
    metaclass=_CheckedArrays,
    frozen=True,
    eq=False,
    dict=True,
    tag_field="type",
    tag="spheres",
):
    """Many spheres with matt surfaces, as arrays.

    An array may be anything that NumPy makes an array of: its own arrays, those of other packages
    (by ``__array__`` or ``__dlpack__``), or lists. An array of a dtype named below is not copied,
    in whatever order it lies in memory: the attribute is then a read-only view of it, and changes
    when it is changed; `Scene.check` looks at it again. The colour is white and `lambert` 1 unless
    they are given.

    Attributes
    ----------
    center : array (n, 3)
        Centres in world space, finite; float64 or float32 as given, all else becomes float64.
        There may be none.
    radius : array (n,) or float
        Radii in scene units, ≥ 0, or one for all; float64 or float32 as given.
    color : array (n, 3) or (3,)
        Colours, or one for all, as uint8; whole numbers from 0 to 255 of any other dtype are
        converted, and `Color` is one colour.
    lambert : array (n,) or float
        Share of the light that each surface scatters, from 0 to 1, or one for all; float64 or
        float32 as given.

    Raises
    ------
    SceneError
        If an array has the wrong shape, the wrong dtype, or holds a wrong number. The message
        names the place, for instance ``Spheres.radius[17]``.

    Examples
    --------
    >>> Spheres(center=[(0, 0, 5), (1, 0, 5)], radius=0.5, color=(255, 0, 0), lambert=1)
    Spheres(center=<float64 (2, 3)>, radius=0.5, color=<uint8 (3,)>, lambert=1.0)
    """

    center: Floats
    radius: Floats | float
    color: Bytes
    lambert: Floats | float

    _in_code = MappingProxyType({"color": (255, 255, 255), "lambert": 1.0})

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            center: ArrayLike,
            radius: ArrayLike,
            color: ArrayLike = ...,
            lambert: ArrayLike = 1.0,
        ) -> None: ...

    __hash__ = None  # type: ignore[assignment]  # arrays are compared, and may change

    @property
    def color_scale(self) -> "ColorScale | None":
        """How values became the colours, for a colour bar; None if they are no such colours.

        It is not a part of what makes spheres equal, nor of a scene file.
        """
        return self.__dict__.get("color_scale_")

    @property
    def source(self) -> "Path | None":
        """The file that the arrays were read from; None if they come from code."""
        return self.__dict__.get("source_")

    def read_from(self, source: "Path") -> "Spheres":
        """Return these spheres, which from now on remember the file that they were read from."""
        self.__dict__["source_"] = source.absolute()  # the folder may be changed
        return self

    def with_scale(self, scale: "ColorScale | None") -> "Spheres":
        """Return the same spheres, which remember how values became their colours."""
        spheres: Spheres = make_unchecked(Spheres, **msgspec.structs.asdict(self))
        spheres.__dict__["color_scale_"] = scale
        return spheres

    def __copy__(self) -> "Spheres":
        return self.with_scale(self.color_scale)

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (msgspec.structs.astuple(self), self.color_scale)

    def __len__(self) -> int:
        return len(self.center)

    def __eq__(self, other: object) -> bool:
        """Tell whether the same spheres stand in the same order, whatever the dtypes."""
        if not isinstance(other, Spheres):
            return NotImplemented
        if len(self) != len(other):
            return False
        import numpy as np

        pairs = ((getattr(self, name), getattr(other, name)) for name in COLUMNS)
        return len(self) == 0 or all(bool(np.all(one == two)) for one, two in pairs)

    def __ne__(self, other: object) -> bool:
        return NotImplemented if not isinstance(other, Spheres) else not self == other

    def __repr__(self) -> str:
        values = {name: getattr(self, name) for name in COLUMNS}
        shown = {
            name: value if isinstance(value, float) else f"<{value.dtype} {value.shape}>"
            for name, value in values.items()
        }
        return f"Spheres({', '.join(f'{name}={text}' for name, text in shown.items())})"

    def check(self, place: str = "Spheres") -> None:
        """Check the arrays again, after those that they share may have been changed.

        Parameters
        ----------
        place
            Where the spheres belong, for messages.

        Raises
        ------
        SceneError
            If a number is not right any more.
        """
        check_arrays(msgspec.structs.asdict(self), f"{place}.")


def _rebuild(values: tuple[Any, ...], scale: "ColorScale | None") -> Spheres:
    """Make spheres again after copying or pickling."""
    return Spheres(*values).with_scale(scale)


def from_arrays(
    values: Mapping[str, object], place: str, called: Mapping[str, str] = _NO_NAMES
) -> Spheres:
    """Make `Spheres` as calling the class does, with other places in the messages.

    Parameters
    ----------
    values
        What was given for center, radius, color and lambert.
    place
        What messages begin with, right before the name of an array.
    called
        The names of arrays in messages, where they differ.
    """
    spheres: Spheres = make_unchecked(Spheres, **check_arrays(values, place, called))
    return spheres


def check_arrays(
    values: Mapping[str, object], place: str, called: Mapping[str, str] = _NO_NAMES
) -> dict[str, Any]:
    """Check and convert the arrays of spheres.

    Parameters
    ----------
    values
        What was given for center, radius, color and lambert.
    place
        What messages begin with, right before the name of an array.
    called
        The names of arrays in messages, where they differ.

    Returns
    -------
    dict
        The arrays, and floats where one number stands for all.

    Raises
    ------
    SceneError
        If one of them is not right.
    """
    shaped = check_shapes(values, place, called)
    at = {name: place + called.get(name, name) for name in COLUMNS}
    return {name: _check_numbers(array, name, at[name]) for name, array in shaped.items()}


def check_shapes(
    values: Mapping[str, object], place: str, called: Mapping[str, str] = _NO_NAMES
) -> dict[str, AnyArray]:
    """Check the dtypes and the shapes of the arrays of spheres, but none of their numbers.

    Parameters, and what is raised, are those of `check_arrays`.
    """
    at = {name: place + called.get(name, name) for name in COLUMNS}
    found = {name: _to_array(values[name], name, at[name]) for name in COLUMNS}
    center = _check_center(found["center"], values["center"], at["center"])
    shaped = {"center": center}
    for name in ("radius", "color", "lambert"):
        as_center = f"as {called.get('center', 'center')} has shape {center.shape}"
        shape = (len(center), *COLUMNS[name].row)
        if found[name].shape == shape[:1] == (0,):  # what an empty list has
            found[name] = found[name].reshape(shape)
        if found[name].shape not in (shape, shape[1:]):
            words = f"{array_words(name, len(center))}, {as_center}"
            problem = _wrong_shape(found[name], values[name], name, words)
            raise SceneError(f"{at[name]}: {problem}")
        shaped[name] = found[name]
    return shaped


def _to_array(found: Any, name: str, place: str) -> AnyArray:  # noqa: ANN401
    """Return an array of numbers."""
    import numpy as np

    from vtray.scene.checks.json_tree import short

    given: Any = msgspec.structs.astuple(found) if isinstance(found, msgspec.Struct) else found
    remedy = remedy_for(given, COLUMNS[name].columns)
    words = f"{place}: expected {array_words(name)}"
    if remedy and not hasattr(given, "__array__"):  # atoms, which NumPy would take one by one
        raise SceneError(f"{words}, got {show_array(given)}{remedy}")
    only_dlpack = hasattr(given, "__dlpack__") and not hasattr(given, "__array__")
    try:
        array: AnyArray = np.from_dlpack(given) if only_dlpack else np.asarray(given)
    except (ValueError, TypeError, RuntimeError, OverflowError, BufferError) as error:
        got = f"{show_array(given)} ({short(str(error), 100)})"
    else:
        if array.dtype.kind in "iuf" and not is_masked(given):
            return array
        got = show_array(given)
    raise SceneError(f"{words}, got {got}{remedy}")


def array_words(name: str, count: object = "n") -> str:
    """Say what an array must be, to follow the word "expected"."""
    column = COLUMNS[name]
    shape = f"({count}, {column.row[0]})" if column.row else f"({count},)"
    words = f"an array of numbers of shape {shape}"
    return f"{column.one} or {words}" if column.one else words


def _check_center(center: AnyArray, given: object, place: str) -> AnyArray:
    """Return centres of shape (n, 3)."""
    if center.shape == (0,):  # what an empty list has
        return center.reshape(0, 3)
    if center.ndim == 2 and center.shape[1] == 3:
        return center
    hint = " (transpose it)" if center.ndim == 2 and center.shape[0] == 3 else ""
    problem = _wrong_shape(center, given, "center", array_words("center"))
    raise SceneError(f"{place}: {problem}{hint}")


def _wrong_shape(array: AnyArray, given: object, name: str, words: str) -> str:
    """Say what is wrong with the shape of an array."""
    remedy = remedy_for(given, COLUMNS[name].columns)
    return f"expected {words}, got {show_shape(given, array.shape)}{remedy}"


def _check_numbers(given: AnyArray, name: str, place: str) -> Any:  # noqa: ANN401
    """Return an array of right numbers, read-only and of the dtype of an attribute, or a float."""
    import numpy as np

    kind = COLUMNS[name].kind
    with np.errstate(over="ignore", invalid="ignore"):
        array = given
        if kind is not Byte and given.dtype not in (np.float32, np.float64):
            array = given.astype(np.float64)
        if not _are_right(array, kind):
            from vtray.scene.checks.scene_words import expected

            index = _first_wrong(array, kind)
            words = expected(kind if math.isfinite(array[index]) else Real)
            where = f"{place}[{', '.join(map(str, index))}]" if index else place
            raise SceneError(f"{where}: expected {words}, got {given[index]!s}")
    if kind is Byte:
        array = array.astype(np.uint8, copy=False)
    if array.ndim == 0:
        return float(array)
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
    return kind is not Byte or bool((array.astype("u1", copy=False) == array).all())


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
