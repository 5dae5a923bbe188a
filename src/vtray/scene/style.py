"""How a picture is drawn, beside its light: outlines, fog, and what else `Style` holds.

`Style` defines each part of it once, as `vtray.scene.settings.Settings` does settings: its kind,
limits and default, how a command line writes it, and what code may give for it. From that come the
checks and the words of their errors, the JSON Schema, the options of the command, what pictures say
of how they were made, and what `vtray.render` takes.
"""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from msgspec import Meta

from vtray.base.errors import SceneError
from vtray.base.number import count_of, number_in
from vtray.scene.checks.checked import Checked, Frozen, from_mapping
from vtray.scene.checks.limits import FieldError, NonNegative, Positive, YesOrNo, alternatives
from vtray.scene.clip import ClipPlane, Slice
from vtray.scene.colors.names import to_rgb
from vtray.scene.settings import Option, RenderSettings, kinds_of
from vtray.scene.vectors import Color, Direction

if TYPE_CHECKING:
    from vtray.scene.vectors import Triple

Width = Annotated[float, Meta(gt=0, le=64, description="a number of pixels > 0 and at most 64")]

Share = Annotated[float, Meta(ge=0, lt=1, description="a number from 0 to below 1")]
Borders = Literal["objects", "particles", "none"]

ON = ("", "on", "auto")
OFF = ("off", "none")
"""What a command line, and code too, may write for true and false."""


class _Colored(Checked):
    """Makes construction in code take a colour in all ways to write one."""

    def _convert(cls, values: dict[str, Any]) -> None:  # noqa: N805
        """Convert what is given."""
        color: Any = values.get("color")
        if color is not None:
            values["color"] = Color(*to_rgb(color, f"{cls.__name__}.color"))


class Outline(Frozen, metaclass=_Colored, frozen=True, omit_defaults=True, gc=False):
    """Lines around what is seen.

    Attributes
    ----------
    width : float
        How wide the lines are, in pixels of the picture, > 0 and at most 64.
    color : Color
        Their colour, that of the picture's numbers.
    borders : str
        Where lines are that need no jump of distance: between "objects", between all "particles" of
        these, or "none".
    depth : bool
        Whether lines are where the distance jumps, as around what has nothing behind it.
    normals : bool
        Whether lines are where there is a crease.
    """

    width: Width = 1.0
    color: Color = Color(0, 0, 0)
    borders: Borders = "objects"
    depth: YesOrNo = True
    normals: YesOrNo = False

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            width: float = 1.0,
            color: "str | Color | Triple" = ...,
            borders: Borders = "objects",
            depth: bool = True,
            normals: bool = False,
        ) -> None: ...


class Fog(Frozen, metaclass=_Colored, frozen=True, omit_defaults=True, gc=False):
    """Fog, in which things fade with their distance.

    Attributes
    ----------
    start : float, optional
        The distance at which it begins, ≥ 0, as `Image.depth` gives distances; by default that of
        the nearest point of the scene's bounded objects or, in movies, of the ball around them.
    end : float, optional
        The distance from which on nothing but fog is seen, more than `start`; by default that of
        the farthest point of the same.
    color : Color, optional
        Its colour, that of the picture's numbers; by default things fade into the background.
    """

    start: NonNegative | None = None
    end: Positive | None = None
    color: Color | None = None

    if TYPE_CHECKING:

        def __init__(
            self,
            start: float | None = None,
            end: float | None = None,
            color: "str | Color | Triple | None" = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        """Refuse fog that ends where it begins."""
        if self.start is not None and self.end is not None and not self.end > self.start:
            field, message = "end", "a number > start"
            raise FieldError(field, message)


class EyeDome(Frozen, frozen=True, omit_defaults=True, gc=False):
    """Eye-dome lighting: what lies behind its surroundings is darker.

    Attributes
    ----------
    strength : float
        How much darker, > 0.
    radius : float
        How far the surroundings reach, in pixels of the picture, > 0 and at most 64.
    """

    strength: Positive = 1.0
    radius: Width = 1.5


def _outline(given: Any, place: str) -> Outline:  # noqa: ANN401
    """Return an outline of its width, or of that and a colour."""
    words = "a width in pixels, or that and a colour such as 1.5,navy"
    parts = _parts(given, place, 1, words)
    return Outline(*parts)


def _fog(given: Any, place: str) -> Fog:  # noqa: ANN401
    """Return fog between two distances, maybe of a colour."""
    words = "two distances, maybe a colour, such as 5,20 or 5,20,white"
    parts = _parts(given, place, 2, words)
    return Fog(*parts)


def _eye_dome(given: Any, place: str) -> EyeDome:  # noqa: ANN401
    """Return eye-dome lighting of a strength, maybe of a radius too."""
    words = "a strength, or that and a radius in pixels such as 1,1.5"
    parts = _parts(given, place, 1, words)
    if len(parts) > 1:
        parts[1] = _number(parts[1], place, words, given)
    return EyeDome(*parts)


def _clip(given: Any, place: str) -> tuple[ClipPlane, ...]:  # noqa: ANN401
    """Return clip planes of four numbers each, of texts with semicolons between them too."""
    words = "planes as NX,NY,NZ or NX,NY,NZ,D, with semicolons between them, such as 1,0,0,2.5"
    whole = given
    if hasattr(given, "tolist"):
        given = given.tolist()
    if isinstance(given, (bool, ClipPlane, Mapping)) or given is None:
        given = () if given is False else (given,)
    elif isinstance(given, str):
        given = given.split(";")
    elif not isinstance(given, Sequence):
        raise _wrong(whole, place, words)
    elif given and all(not isinstance(one, ClipPlane) and count_of(one) is None for one in given):
        given = (given,)
    planes = []
    for one in given:
        if isinstance(one, ClipPlane):
            planes.append(one)
        elif isinstance(one, Mapping):
            planes.append(from_mapping(ClipPlane, one, place))
        else:
            try:
                *normal, distance = _numbers(one, place, 3, words)
            except SceneError:
                raise _wrong(whole, place, words) from None
            planes.append(ClipPlane(_direction(normal, place, words, whole), distance))
    return tuple(planes)


def _slice(given: Any, place: str) -> Slice:  # noqa: ANN401
    """Return a slice of a plane of four numbers and a thickness."""
    words = "a slab as NX,NY,NZ,THICKNESS or NX,NY,NZ,D,THICKNESS, such as 0,0,1,2.5,1"
    if given is True:
        raise _wrong(given, place, words)
    x, y, z, first, last = _numbers(given, place, 4, words)
    distance, thickness = (None, first) if last is None else (first, last)
    return Slice(_direction([x, y, z], place, words, given), thickness, distance)


def _numbers(given: Any, place: str, numbers: int, words: str) -> list[Any]:  # noqa: ANN401
    """Return so many numbers and one more, None in its place if it is not given."""
    found = _parts(given, place, numbers, words)
    return [*found[:numbers], *(_number(part, place, words, given) for part in found[numbers:])] + [
        None
    ] * (numbers + 1 - len(found))


def _cap(given: Any, place: str) -> Color:  # noqa: ANN401
    """Return the colour of caps."""
    try:
        return Color(*to_rgb(given, place))
    except SceneError as error:
        if not isinstance(given, str):
            raise
        hint = "".join(str(error).partition("; ")[1:])
        words = "a colour such as red or #ff8000, or on or off"
        raise SceneError(f"{_wrong(given, place, words)}{hint}") from None


def _direction(normal: list[Any], place: str, words: str, given: Any) -> Direction:  # noqa: ANN401
    """Return a normal of three numbers."""
    x, y, z = normal
    if x == y == z == 0:
        raise _wrong(given, place, f"{words}, whose normal is not all zero")
    return Direction(x, y, z)


class _CheckedStyle(Checked):
    """Makes construction in code take each part in all ways to write it."""

    def _convert(cls, values: dict[str, Any]) -> None:  # noqa: N805
        """Convert what is given."""
        kind: Any = cls
        for name, value in values.items():
            values[name] = taken(kind, name, value, f"{cls.__name__}.{name}")


class Style(Frozen, metaclass=_CheckedStyle, frozen=True, omit_defaults=True, gc=False):
    """How a picture is drawn, beside its light.

    Each part has a default, which is what versions did that did not know it. False is without it,
    and true with all as it is by default.

    Attributes
    ----------
    outline : Outline or bool
        Lines around what is seen. Code may also give their width.
    fog : Fog or bool
        Fog, in which things fade with their distance. Code may also give two distances, and a
        colour as a third.
    eye_dome : EyeDome or bool
        Eye-dome lighting, by which points and landscapes show their shape. Code may also give its
        strength.
    clip : tuple of ClipPlane
        Planes; nothing exists on the sides that their normals point to. Code may also give a plane
        as its normal, or as four numbers: that, and its distance from the origin.
    slice : Slice or bool
        A slab; nothing exists outside of it. Code may also give a normal and the thickness as four
        numbers, or five with the distance from the origin before the thickness.
    cap : bool or Color
        Whether what is cut is closed, in its own colour or in another. If not, its inside is seen,
        but for bodies that let light through, which are solid and always closed.
    solid_from : float
        Depth, ids and normals are those of the first surface that is more opaque than that, from 0
        to below 1.
    """

    outline: Annotated[
        Outline | YesOrNo,
        Option(
            "WIDTH[,COLOR]", "lines around what is seen, so many pixels wide; or off", of=_outline
        ),
    ] = False
    fog: Annotated[
        Fog | YesOrNo,
        Option(
            "FROM,TO[,COLOR]",
            "things fade with their distance, fitted to the scene unless it is given; or off",
            of=_fog,
        ),
    ] = False
    eye_dome: Annotated[
        EyeDome | YesOrNo,
        Option(
            "STRENGTH[,RADIUS]",
            "darken what lies behind its surroundings, as far as RADIUS pixels; or off",
            of=_eye_dome,
        ),
    ] = False
    clip: Annotated[
        tuple[ClipPlane, ...],
        Option(
            "NX,NY,NZ[,D][;...]",
            "leave out what lies beyond planes, on the sides that their normals point to; or off",
            of=_clip,
        ),
    ] = ()
    slice: Annotated[
        Slice | YesOrNo,
        Option(
            "NX,NY,NZ[,D],THICKNESS", "leave out what lies outside of a slab; or off", of=_slice
        ),
    ] = False
    cap: Annotated[
        Color | YesOrNo,
        Option("COLOR", "close what is cut, in its own colour unless it is given; or off", of=_cap),
    ] = False

    solid_from: Annotated[
        Share,
        Option("NUMBER", "depth, ids and normals are of the first surface more opaque than that"),
    ] = 0.5

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            outline: Any = ...,  # noqa: ANN401
            fog: Any = ...,  # noqa: ANN401
            eye_dome: Any = ...,  # noqa: ANN401
            clip: Any = ...,  # noqa: ANN401
            slice: Any = ...,  # noqa: ANN401, A002
            cap: Any = ...,  # noqa: ANN401
            solid_from: float = 0.5,
        ) -> None: ...

    def __post_init__(self) -> None:
        """Hold what is true as what it stands for, and equal parts equally."""
        for name, (kind, _) in kinds_of(type(self)).items():
            if getattr(self, name) is True and name != "cap":
                if name == "slice":
                    message = "false, or a plane with a thickness"
                    raise FieldError(name, message)
                msgspec.structs.force_setattr(self, name, _structs(kind)[0]())


PICTURE = (*RenderSettings.__struct_fields__, *Style.__struct_fields__)
"""What a render takes: its settings and the parts of its style, by their names."""


def check_picture(given: Mapping[str, Any]) -> None:
    """Raise SceneError if one of the settings or a part of a style is not right.

    Parameters
    ----------
    given
        Values by their names, all of `PICTURE`.
    """
    for kind in (RenderSettings, Style):
        kind(**{name: value for name, value in given.items() if name in kind.__struct_fields__})


def taken(cls: type[msgspec.Struct], name: str, given: Any, place: str) -> Any:  # noqa: ANN401
    """Return a part of a style that was given in code or on a command line.

    Parameters
    ----------
    cls
        The type of the style.
    name
        The part.
    given
        False or true, what the part holds, a dictionary of that, or what its option's `of` knows.
    place
        What the part is called in messages.

    Raises
    ------
    SceneError
        It is none of these.
    """
    kind, option = kinds_of(cls)[name]
    structs = _structs(kind)
    if name == "clip":
        return _clip(() if isinstance(given, str) and given in OFF else given, place)
    if isinstance(given, str) and given in (*ON, *OFF) and bool in alternatives(kind):
        return _slice(True, place) if name == "slice" and given in ON else given in ON
    if isinstance(given, (bool, *structs)) or option.of is None:
        return given
    if isinstance(given, Mapping) and len(structs) == 1:
        return from_mapping(structs[0], given, place)
    return option.of(given, place)


def _structs(kind: Any) -> list[Any]:  # noqa: ANN401
    """Return the types of what a part may hold."""
    return [part for part in alternatives(kind) if isinstance(part, msgspec.StructMeta)]


def _parts(given: Any, place: str, numbers: int, words: str) -> list[Any]:  # noqa: ANN401
    """Return numbers, and maybe one thing more, of a text with commas or of a sequence."""
    if isinstance(given, str):
        found: list[Any] = given.split(",", numbers)
    elif isinstance(given, Sequence) or hasattr(given, "tolist"):
        found = [*given] if count_of(given) else [given]
    else:
        found = [given]
    is_none = given is None or isinstance(given, (bytes, bytearray))
    if is_none or not numbers <= len(found) <= numbers + 1:
        raise _wrong(given, place, words)
    return [_number(part, place, words, given) for part in found[:numbers]] + found[numbers:]


def _number(part: Any, place: str, words: str, given: Any) -> Any:  # noqa: ANN401
    """Return a number as such, of a text too."""
    if isinstance(part, str):
        value = number_in(part)
        if math.isnan(value):
            raise _wrong(given, place, words)
        return value
    return part


def _wrong(given: object, place: str, words: str) -> SceneError:
    """Give the error for what is none of the ways to write a part."""
    from vtray.scene.checks.scene_words import show

    shown = given if isinstance(given, str) else show(given)
    return SceneError(f"{place}: expected {words}, got {shown}")
