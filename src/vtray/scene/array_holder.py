"""What holds arrays that others may change: `Spheres` and their like, and `Copies` of these."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Self

from vtray.scene.checks.checked import Checked, Frozen, bind
from vtray.scene.checks.columns import Columns

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray


class _CheckedArrays(Checked):
    """Makes construction in code check and convert arrays."""

    def __call__(cls, *args: object, **kwargs: object) -> Any:  # noqa: ANN401, N805
        """Bind the arguments, check and convert them, and make the object."""
        values = bind(cls, args, kwargs)
        return cls.from_arrays(values, f"{cls.__name__}.")  # type: ignore[attr-defined]


class ArrayHolder(Frozen, metaclass=_CheckedArrays, frozen=True, eq=False, dict=True):
    """What holds arrays, which may change, and may have been read from a file."""

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
