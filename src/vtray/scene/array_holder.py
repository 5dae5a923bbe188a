"""What holds arrays that others may change: `Spheres` and their like, and `Copies` of these."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Self

import msgspec

from vtray.scene.checks.checked import Checked, Frozen, Made, bind
from vtray.scene.checks.columns import POINT, Columns
from vtray.scene.checks.limits import Byte

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray


class _CheckedArrays(Checked):
    """Makes construction in code check and convert arrays."""

    def __call__(cls: type[Made], *args: object, **kwargs: object) -> Made:  # noqa: N805
        """Bind the arguments, check and convert them, and make the object."""
        values = bind(cls, args, kwargs)
        made: Made = cls.from_arrays(values, f"{cls.__name__}.")  # type: ignore[attr-defined]
        return made


OF_COLORS = ("color_scale_",)
"""What is remembered of the colours alone."""

OF_ROWS = ("made_of_", "ends_")
"""What is remembered of each row, whatever stands there."""


class ArrayHolder(Frozen, metaclass=_CheckedArrays, frozen=True, eq=False, dict=True):
    """What holds arrays, which may change, and may have been read from a file.

    Objects remember where they come from: the file, the values of their colours, the particles.
    That is no part of what makes them equal, but goes with them into what is made of them.
    """

    COLUMNS: ClassVar[Columns]

    @classmethod
    def from_arrays(cls, values: Mapping[str, object], place: str) -> Self:
        """Make an object as calling the class does, with other places in the messages.

        Parameters
        ----------
        values
            What was given for each attribute.
        place
            What messages begin with, right before the name of an attribute.
        """
        raise NotImplementedError

    @property
    def source(self) -> "Path | None":
        """The file that the arrays were read from; None if they come from code."""
        return self.__dict__.get("source_")

    def read_from(self, source: "Path") -> Self:
        """Return this object, which from now on remembers the file that it was read from."""
        self.__dict__["source_"] = source.absolute()  # the folder may be changed
        return self

    def remembering(self, other: Self, changed: Iterable[str] = ()) -> Self:
        """Return this object, which from now on remembers what another does, as far as it holds.

        Parameters
        ----------
        other
            What this object was made of.
        changed
            Which attributes may differ.
        """
        lost: set[str] = set() if len(self) == len(other) else set(OF_ROWS)
        columns = [self.COLUMNS[name] for name in changed if name in self.COLUMNS]
        if any(column.kind is Byte for column in columns):
            lost.update(OF_COLORS)
        if POINT in columns:  # the rows may be in another order
            lost.update(OF_ROWS)
        known = {name: what for name, what in other.__dict__.items() if name not in lost}
        self.__dict__.update(known)
        return self

    def replace(self, **changes: Any) -> Self:  # noqa: ANN401
        """Return the same with other values in place of some, as `Frozen.replace` does."""
        return super().replace(**changes).remembering(self, changes)

    __replace__ = replace

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (type(self), msgspec.structs.astuple(self), self.__dict__)

    def __len__(self) -> int:
        """Return how many rows there are."""
        raise NotImplementedError

    def sources(self) -> "list[Path]":
        """Return the files that arrays were read from, those of objects within too."""
        return [self.source] if self.source else []

    def arrays(self) -> "list[NDArray[Any]]":
        """Return what the attributes hold, as arrays, but for what was left out."""
        raise NotImplementedError

    def check(self, place: str = "") -> None:
        """Check the arrays again, after those that they share may have been changed.

        Parameters
        ----------
        place
            Where the objects belong, for messages; the name of the type by default.

        Raises
        ------
        SceneError
            If a number is not right any more.
        """
        self._check_again(place or type(self).__name__)

    def _check_again(self, place: str) -> None:
        """Check the arrays again, with the place in full."""
        raise NotImplementedError

    def __ne__(self, other: object) -> bool:
        return NotImplemented if type(other) is not type(self) else not self == other


def _rebuild(
    kind: type[ArrayHolder], values: tuple[object, ...], known: dict[str, Any]
) -> ArrayHolder:
    """Make an object again after copying or pickling, with what it remembers."""
    made: ArrayHolder = kind(*values)
    made.__dict__.update(known)
    return made
