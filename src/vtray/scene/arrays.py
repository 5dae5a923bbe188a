"""Many objects of one kind as arrays: what `Spheres` and their like have in common."""

from collections.abc import Mapping
from copy import copy
from typing import TYPE_CHECKING, Any, ClassVar, Self

import msgspec

from vtray.base.errors import SceneError
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.checks.checked import make_unchecked
from vtray.scene.checks.columns import NO_NAMES, check_arrays, read_only
from vtray.scene.checks.limits import Byte
from vtray.scene.checks.scene_words import either
from vtray.scene.materials import (
    VARIED,
    Material,
    can_vary,
    checked_materials,
    images_in,
    is_default,
    materials_of,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from vtray.scene.colors.color_scale import ColorMap, ColorScale
    from vtray.scene.colors.names import AnyColor
    from vtray.scene.materials import AnyMaterials

    Floats = NDArray[np.float64] | NDArray[np.float32]
    Bytes = NDArray[np.uint8]
else:
    Floats = Bytes = Any


def check_spares_data(path: "Path", objects: "Iterable[object]") -> None:
    """Raise OutputError if writing a file would destroy arrays that objects were read from."""
    from vtray.base.atomic_file import check_spares

    found = [source for item in objects for source in _sources_of(item)]
    what = "holds arrays of the scene itself"
    check_spares(path, found, what, "choose another name for the image")


def _sources_of(item: object) -> "Iterator[Path]":
    """Give the files that arrays of an object, and pictures on it, were read from."""
    if isinstance(item, ArrayHolder):
        yield from item.sources()
    for part in getattr(item, "objects", (item,)):
        for image in images_in(getattr(part, "material", "lambert")):
            yield from image.sources()


class Arrays(ArrayHolder, frozen=True, eq=False, dict=True):
    """Many objects of one kind, as arrays.

    A kind is a class that says its arrays twice: as `COLUMNS`, and as fields of the same names in
    the same order. Besides there is the field `material`: what they are made of.
    """

    if TYPE_CHECKING:

        @property
        def material(self) -> AnyMaterials:
            """What they are made of."""
    else:
        material: ClassVar[str] = "lambert"  # what has no such field is made of nothing

    FIRST: ClassVar[int] = 0
    """The number of the material of those of which none is said."""

    OWN: ClassVar[float] = -1.0
    """Stands for the roughness or the metalness of a material itself, where none is said."""

    EACH: ClassVar[str]
    """What one of them is called in messages about colours."""

    OPAQUE: ClassVar[float] = 1.0
    """The opacity of those of which none is said."""

    @classmethod
    def from_arrays(
        cls, values: Mapping[str, object], place: str, called: Mapping[str, str] = NO_NAMES
    ) -> Self:
        """Make objects as calling the class does, with other places in the messages.

        Parameters
        ----------
        values
            What was given for each array.
        place
            What messages begin with, right before the name of an array.
        called
            The names of arrays in messages, where they differ.
        """
        arrays = check_arrays(cls.COLUMNS, values, place, called)
        material = checked_materials(values.get("material", "lambert"), f"{place}material")
        _check_index(arrays.get("material_index"), len(materials_of(material)), place)
        for name in VARIED:
            if arrays.get(name) is not None:
                _check_varied(name, materials_of(material), place)
        made: Self = make_unchecked(cls, **arrays, material=material)
        return made

    @classmethod
    def colored(
        cls,
        values: Mapping[str, object],
        colors: Mapping[str, object],
        place: str,
        called: Mapping[str, str] = NO_NAMES,
        *,
        cmap: "ColorMap | None",
        clim: object,
        nan_color: "AnyColor",
    ) -> Self:
        """Make objects whose colours are given in any of the ways of `Scene.add_spheres`.

        Parameters
        ----------
        values, place, called
            As for `from_arrays`; colours among the values are not looked at.
        colors
            What was given for each array of colours; one that may be left out is absent or None.
        cmap, clim, nan_color
            As for `Scene.add_spheres`.
        """
        from vtray.scene.colors.color_arrays import color_arrays

        black = {
            name: None if column.stand_in else (0, 0, 0)
            for name, column in cls.COLUMNS.items()
            if column.kind is Byte
        }
        plain = cls.from_arrays({**values, **black}, place, called)
        given = {name: value for name, value in colors.items() if value is not None}
        found, scale = color_arrays(
            given, len(plain), place, each=cls.EACH, cmap=cmap, clim=clim, nan_color=nan_color
        )
        shared = {name: read_only(array) for name, array in found.items()}
        made: Self = make_unchecked(cls, **{**msgspec.structs.asdict(plain), **shared})
        return made.with_scale(scale)

    @property
    def color_scale(self) -> "ColorScale | None":
        """How values became the colours, for a colour bar; None if they are no such colours.

        It is not a part of what makes objects equal, nor of a scene file.
        """
        return self.__dict__.get("color_scale_")

    def with_scale(self, scale: "ColorScale | None") -> Self:
        """Return the same objects, which remember how values became their colours."""
        same: Self = copy(self)
        same.__dict__["color_scale_"] = scale
        return same

    def __copy__(self) -> Self:
        same: Self = make_unchecked(type(self), **msgspec.structs.asdict(self))
        return same.remembering(self)

    def __len__(self) -> int:
        return len(getattr(self, self.__struct_fields__[0]))

    __hash__ = None  # type: ignore[assignment]  # arrays are compared, and may change

    def __eq__(self, other: object) -> bool:
        """Tell whether the same objects stand in the same order, whatever the dtypes."""
        if type(other) is not type(self):
            return NotImplemented
        if len(self) != len(other):
            return False
        import numpy as np

        if materials_of(self.material) != materials_of(other.material):
            return False
        pairs = ((self.given_for(name), other.given_for(name)) for name in self.COLUMNS)
        return len(self) == 0 or all(bool(np.all(one == two)) for one, two in pairs)

    def __repr__(self) -> str:
        shown = [
            f"{name}={_show(getattr(self, name))}"
            for name, column in self.COLUMNS.items()
            if getattr(self, name) is not None or column.stand_in in self.COLUMNS
        ]
        if not is_default(self.material):
            shown.append(f"material={self.material!r}")
        return f"{type(self).__name__}({', '.join(shown)})"

    def given_for(self, name: str) -> Any:  # noqa: ANN401
        """Return an array or a number, or what stands in for it where it was left out."""
        value = getattr(self, name)
        return getattr(self, self.COLUMNS[name].stand_in) if value is None else value

    def hull(self) -> list[tuple[Floats, Floats | float, Floats | None]]:
        """Return the balls or discs whose convex hull each object is.

        Returns
        -------
        list of tuple
            Centres in world space, (n, 3), radii, (n,) or one for all, and for discs other points
            of the lines that they are square to, (n, 3); None for balls. An object is the hull of
            its rows in all the tuples. The arrays are those of the objects, not copied.
        """
        raise NotImplementedError

    def arrays(self) -> "list[NDArray[Any]]":
        """Return what the attributes hold, as arrays, but for what was left out."""
        import numpy as np

        values = (getattr(self, name) for name in self.COLUMNS)
        return [np.asarray(value) for value in values if value is not None]

    def _check_again(self, place: str) -> None:
        self.from_arrays(msgspec.structs.asdict(self), f"{place}.")


def _check_index(index: Any, count: int, place: str) -> None:  # noqa: ANN401
    """Raise SceneError if shapes are made of materials that there are not."""
    if index is None and count > 1:
        words = f"expected the number of the material of each, as there are {count}"
        raise SceneError(f"{place}material_index: missing; {words}")
    if index is not None and len(index) and index.max() >= count:
        wrong = int((index >= count).argmax())
        there = f"as there are {count} materials" if count > 1 else "as there is one material"
        words = f"expected an integer from 0 to {count - 1}, {there}, got {index[wrong]}"
        raise SceneError(f"{place}material_index[{wrong}]: {words}")


def _check_varied(name: str, materials: tuple[Material, ...], place: str) -> None:
    """Raise SceneError if there is no material for which an array says anything."""
    if not any(can_vary(material, name) for material in materials):
        words = either(f'"{kind.__name__.lower()}"' for kind in VARIED[name])
        raise SceneError(f"{place}{name}: given for no material that it is of; expected {words}")


def _show(value: Any) -> str:  # noqa: ANN401
    """Write an array in short, or a number."""
    return f"<{value.dtype} {value.shape}>" if hasattr(value, "dtype") else repr(value)
