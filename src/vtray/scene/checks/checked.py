"""Objects made in code are checked as those of a file are, and most of them do not change."""

import math
import sys
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, Self, TypeVar

import msgspec

from vtray.base.errors import SceneError
from vtray.scene.checks.limits import limits_alone
from vtray.scene.checks.unknown_names import unknown_argument, unknown_attribute

if TYPE_CHECKING:
    from inspect import Signature

Made = TypeVar("Made")


class Checked(msgspec.StructMeta):
    """Makes construction in code run the checks that decoding a file runs.

    Decoding does not go through ``__call__``, so it pays nothing for this.
    """

    def __init__(cls, *args: object, **kwargs: object) -> None:  # noqa: N805
        super().__init__(*args, **kwargs)
        if cls.__struct_config__.frozen:
            # Not in a class body: msgspec puts its own, which names no remedy, in its place.
            type.__setattr__(cls, "__setattr__", _refuse)

    @property
    def __signature__(cls) -> "Signature":  # noqa: N805
        """How to call the type, with what code may leave out, for `help`."""
        found: Signature = super().__signature__
        left_out = getattr(cls, "_in_code", {})
        return found.replace(
            parameters=[
                parameter.replace(
                    default=left_out.get(name, parameter.default),
                    annotation=limits_alone(parameter.annotation),
                )
                for name, parameter in found.parameters.items()
            ]
        )

    def _convert(cls, values: dict[str, Any]) -> None:  # noqa: N805
        """Convert what code may write in other ways, by the names of the arguments; here, none."""

    # An object of the class that is called, so that type checkers ask its __init__.
    def __call__(cls: type[Made], *args: object, **kwargs: object) -> Made:  # noqa: N805
        """Bind the arguments, check them, and make the object."""
        values = bind(cls, args, kwargs)
        cls._convert(values)  # type: ignore[attr-defined]
        if all(map(_is_plain, values.values())):
            try:
                return msgspec.convert(values, cls)
            except msgspec.ValidationError:
                pass  # the slow way also takes tuples and arrays, and names what is wrong
        from vtray.scene.checks.scene_check import construct

        made: Made = construct(cls, values)  # type: ignore[arg-type]
        return made


def _refuse(self: msgspec.Struct, name: str, value: object) -> NoReturn:  # noqa: ARG001
    """Say what to do instead of setting an attribute of what does not change."""
    kind, known = type(self).__name__, self.__struct_fields__
    if name not in known:
        raise AttributeError(unknown_attribute(kind, name, known))
    remedy = f"make a new one by replace({name}=...), and put it in the place of this one"
    message = f"{kind}.{name}: cannot be changed; {remedy}"
    raise AttributeError(message)


class Frozen(msgspec.Struct, metaclass=Checked, frozen=True):
    """What is checked when it is made, and does not change."""

    _in_code: ClassVar[Mapping[str, object]] = MappingProxyType({})
    """What code may leave out, although a file has to say it, and what it is then."""

    _tag_left_out: ClassVar[bool] = False
    """Whether a file may leave out the type, where others can stand in the same place."""

    def replace(self, **changes: Any) -> Self:  # noqa: ANN401
        """Return the same with other values in place of some.

        Raises
        ------
        SceneError
            If a value is not right.
        TypeError
            If there is no attribute of a name.
        """
        fields = {name: getattr(self, name) for name in self.__struct_fields__}
        for name in changes:
            if name not in fields:
                raise TypeError(unknown_argument(f"{type(self).__name__}.replace", name, fields))
        return type(self)(**{**fields, **changes})

    __replace__ = replace  # for `copy.replace`


def make_unchecked(cls: type, **values: object) -> Any:  # noqa: ANN401
    """Make an object of values that are known to be right."""
    return msgspec.StructMeta.__call__(cls, **values)


def bind(cls: type, args: tuple[object, ...], kwargs: dict[str, object]) -> dict[str, object]:
    """Name the positional arguments, and raise TypeError as a call does.

    What is left to a default is not among the result, unless only code may leave it out.
    """
    names: tuple[str, ...] = cls.__struct_fields__  # type: ignore[attr-defined]
    if len(args) > len(names):
        message = f"{cls.__name__}() takes {len(names)} arguments, got {len(args)}"
        raise TypeError(message)
    values = dict(zip(names, args, strict=False))
    for name, value in kwargs.items():
        if name in values or name not in names:
            message = f"{cls.__name__}() argument {name!r} is given twice"
            raise TypeError(
                message if name in values else unknown_argument(cls.__name__, name, names)
            )
        values[name] = value
    values = {**getattr(cls, "_in_code", {}), **values}
    missing = _missing(cls, values)
    if missing:
        message = f"{cls.__name__}() lacks the arguments {', '.join(missing)}"
        raise TypeError(message)
    return values


def from_mapping(cls: type[Made], given: Mapping[Any, Any], place: str) -> Made:
    """Make an object of a dictionary of its attributes, as a call with these does.

    Raises
    ------
    SceneError
        If one is not right or is lacking.
    TypeError
        If there is no attribute of a name.
    """
    names: tuple[str, ...] = cls.__struct_fields__  # type: ignore[attr-defined]
    missing = _missing(cls, {**getattr(cls, "_in_code", {}), **given})
    if missing and set(given) <= set(names):
        raise SceneError(f"{place}: lacks {', '.join(missing)}; expected {', '.join(names)}")
    return cls(**{str(name): value for name, value in given.items()})


def _missing(cls: type, values: Mapping[str, object]) -> list[str]:
    """Return the names of what values for a call lack."""
    names: tuple[str, ...] = cls.__struct_fields__  # type: ignore[attr-defined]
    required = names[: len(names) - len(cls.__struct_defaults__)]  # type: ignore[attr-defined]
    return [name for name in required if name not in values]


def _is_plain(value: object) -> bool:
    """Whether msgspec alone can check the value: no dictionary, and no number beyond a double."""
    if isinstance(value, (list, tuple)):
        if all(issubclass(kind, msgspec.Struct) for kind in set(map(type, value))):
            return True
        return all(map(_is_plain_number, value))
    return value is None or _is_plain_number(value) or isinstance(value, (str, msgspec.Struct))


def _is_plain_number(value: object) -> bool:
    """Whether a value is a number within the range of a double."""
    if isinstance(value, int):
        return value.bit_length() < sys.float_info.max_exp
    return isinstance(value, float) and math.isfinite(value)
