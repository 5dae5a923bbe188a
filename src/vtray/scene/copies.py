"""The same spheres, cylinders and cones at many places."""

import math
import operator
import typing
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self, TypeAlias

from vtray.base.errors import SceneError
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.arrays import Arrays, Floats
from vtray.scene.checks.checked import make_unchecked
from vtray.scene.checks.columns import POINT, check_arrays
from vtray.scene.cones import Cones
from vtray.scene.cylinders import Cylinders
from vtray.scene.single import Cone, Cylinder, Plane, Sphere
from vtray.scene.spheres import Spheres
from vtray.scene.vectors import Vector

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

Part: TypeAlias = Sphere | Cylinder | Cone | Spheres | Cylinders | Cones
"""What can be placed many times."""

PARTS: tuple[type[Part], ...] = typing.get_args(Part)

_SHOWN = 4
"""Objects that are shown of many."""


class Copies(ArrayHolder, frozen=True, eq=False, dict=True, tag_field="type", tag="copies"):
    """The same bounded shapes at many places, which takes no memory for each copy.

    A copy is the objects moved by one row of `at`. Each coordinate of a point that is moved is the
    sum of two doubles, rounded to a double; the picture is that of the copies written out, one
    after the other, to the last bit.

    Attributes
    ----------
    objects : tuple of Sphere, Cylinder, Cone, Spheres, Cylinders or Cones
        What is placed, at least one, in world space; in code, one may be given alone. Their arrays
        are shared.
    at : array (n, 3)
        Translations in world space, in scene units, finite; float64 or float32 as given, all else
        becomes float64. It is shared as the arrays of `Spheres` are. There may be none.

    Raises
    ------
    SceneError
        If there is no object, or one of another type, if the array is not right, or if a point
        would be moved out of the range of a double. The message names the place, for instance
        ``Copies.at[5, 1]``.

    Examples
    --------
    >>> Copies(Spheres([(0, 0, 0), (1, 0, 0)], 0.5), at=[(0, 0, 5), (0, 3, 5)])
    Copies(objects=(Spheres(center=<float64 (2, 3)>, radius=0.5, color=<uint8 (3,)>, \
lambert=1.0),), at=<float64 (2, 3)>)
    """

    objects: tuple[Part, ...]
    at: Floats

    COLUMNS = MappingProxyType({"at": POINT})

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(self, objects: Part | Sequence[Part], at: ArrayLike) -> None: ...

    @classmethod
    def from_arrays(cls, values: Mapping[str, object], place: str) -> Self:
        """Make copies as calling the class does, as `ArrayHolder.from_arrays` says."""
        objects = _checked_objects(values["objects"], f"{place}objects")
        arrays = check_arrays(cls.COLUMNS, values, place)
        _check_sums(objects, arrays["at"], f"{place}at")
        made: Self = make_unchecked(cls, objects=objects, **arrays)
        return made

    def sources(self) -> "list[Path]":
        """Return the files that arrays were read from, those of the objects too."""
        within = (item for item in self.objects if isinstance(item, Arrays))
        return [*super().sources(), *(source for item in within for source in item.sources())]

    def arrays(self) -> "list[NDArray[Any]]":
        """Return `at`, and all arrays of the objects."""
        within = (item for item in self.objects if isinstance(item, Arrays))
        return [self.at, *(array for item in within for array in item.arrays())]

    def _check_again(self, place: str) -> None:
        for index, item in enumerate(self.objects):
            if isinstance(item, Arrays):
                item.check(f"{place}.objects[{index}]")
        check_arrays(self.COLUMNS, {"at": self.at}, f"{place}.")
        _check_sums(self.objects, self.at, f"{place}.at")

    def locate(self, index: int) -> tuple[int, int]:
        """Return what an index leads to that `Image.ids` gives for a copy.

        Parameters
        ----------
        index
            Counts the spheres, cylinders and cones of a copy through all its objects, from 0.

        Returns
        -------
        place, index
            The place of one of `objects`, and the place in its arrays; 0 for a single object.

        Raises
        ------
        IndexError
            There is no such shape.
        """
        left = operator.index(index)
        for place, item in enumerate(self.objects):
            count = len(item) if isinstance(item, Arrays) else 1
            if 0 <= left < count:
                return place, left
            left -= count
        message = f"index: expected at least 0 and fewer than a copy has, got {index}"
        raise IndexError(message)

    def __copy__(self) -> Self:
        same: Self = make_unchecked(type(self), objects=self.objects, at=self.at)
        return same.remembering(self)

    def __len__(self) -> int:
        return len(self.at)

    __hash__ = None  # type: ignore[assignment]  # arrays are compared, and may change

    def __eq__(self, other: object) -> bool:
        """Tell whether the same objects stand at the same places in order, whatever the dtypes."""
        if not isinstance(other, Copies):
            return NotImplemented
        return (
            len(self) == len(other)
            and bool((self.at == other.at).all())
            and self.objects == other.objects
        )

    def __repr__(self) -> str:
        shown = ", ".join(map(repr, self.objects[:_SHOWN]))
        more = ", ..." if len(self.objects) > _SHOWN else "," * (len(self.objects) == 1)
        return f"Copies(objects=({shown}{more}), at=<{self.at.dtype} {self.at.shape}>)"


def _checked_objects(given: Any, place: str) -> tuple[Part, ...]:  # noqa: ANN401
    """Return what is placed as a tuple."""
    from vtray.scene.checks.scene_words import either, show

    words = either(kind.__name__ for kind in PARTS)
    if isinstance(given, PARTS):
        return (given,)
    if not isinstance(given, (list, tuple)):
        message = f"{place}: expected {words}, or a list of such, got {show(given)}"
        raise SceneError(message + _remedy(given))
    if not given:
        message = f"{place}: expected at least one object, got none"
        raise SceneError(message)
    if not all(issubclass(kind, PARTS) for kind in set(map(type, given))):
        wrong = next(k for k, item in enumerate(given) if not isinstance(item, PARTS))
        message = f"{place}[{wrong}]: expected {words}, got {show(given[wrong])}"
        raise SceneError(message + _remedy(given[wrong]))
    return tuple(given)


def _remedy(found: object) -> str:
    """Say what to do with an object that cannot be placed, to follow the problem."""
    if isinstance(found, Plane):
        return "; a plane has no edge: add it to the scene itself"
    if isinstance(found, Copies):
        places = "(at[:, None] + other.at).reshape(-1, 3)"
        return f"; place its objects themselves, at the sums of both translations: {places}"
    return ""


def _check_sums(objects: Sequence[Part], at: Floats, place: str) -> None:
    """Raise SceneError if a point would be moved out of the range of a double.

    Rounding keeps order, so the sums of the extremes tell it of all.
    """
    if len(at) == 0:
        return
    low, high = zip(*(_ends(array) for array in [*_points_of(objects), at]), strict=True)
    for k in range(3):
        for pick, ends in ((min, low), (max, high)):
            *of_points, of_at = (end[k] for end in ends)
            if of_points and not math.isfinite(pick(of_points) + of_at):
                row = int((at[:, k] == of_at).argmax())
                raise SceneError(f"{place}[{row}, {k}]: {_too_far(of_at, pick(of_points))}")


def _points_of(objects: Sequence[Part]) -> "list[NDArray[Any]]":
    """Return the points that objects are made of, each (m, 3) with at least one row."""
    import numpy as np

    hulls: list[Any] = [center for item in objects for center, _, _ in item.hull()]
    single = [(center.x, center.y, center.z) for center in hulls if isinstance(center, Vector)]
    arrays = [center for center in hulls if not isinstance(center, Vector)]
    return [array for array in (*arrays, np.array(single, np.float64)) if len(array)]


def _ends(points: "NDArray[Any]") -> tuple[list[float], list[float]]:
    """Return the least and the greatest coordinates of points."""
    # Column by column, which NumPy does forty times as fast as along an axis.
    return [float(c.min()) for c in points.T], [float(c.max()) for c in points.T]


def _too_far(at: float, coordinate: float) -> str:
    """Say that a sum is out of range."""
    words = "a number whose sums with all coordinates of the objects are doubles, up to 1.8e308"
    remedy = "move the objects, or their places, nearer to the origin"
    return f"expected {words}, got {at!r} for {coordinate!r}; {remedy}"
