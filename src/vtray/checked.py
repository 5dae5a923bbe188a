"""The metaclass that checks objects made in code as a file is checked."""

import math
import sys
from typing import Any

import msgspec


class Checked(msgspec.StructMeta):
    """Makes construction in code run the checks that decoding a file runs.

    Decoding does not go through ``__call__``, so it pays nothing for this.
    """

    def __call__(cls, *args: object, **kwargs: object) -> Any:  # noqa: ANN401, N805
        """Bind the arguments, check them, and make the object."""
        values = bind(cls, args, kwargs)
        if all(map(_is_plain, values.values())):
            try:
                return msgspec.convert(values, cls)
            except msgspec.ValidationError:
                pass  # the slow way also takes tuples and arrays, and names what is wrong
        from vtray.scene_check import construct

        return construct(cls, values)  # type: ignore[arg-type]


def make_unchecked(cls: type, **values: object) -> Any:  # noqa: ANN401
    """Make an object of values that are known to be right."""
    return msgspec.StructMeta.__call__(cls, **values)


def bind(cls: type, args: tuple[object, ...], kwargs: dict[str, object]) -> dict[str, object]:
    """Name the positional arguments, and raise TypeError as a call does.

    What is left to a default is not among the result.
    """
    names: tuple[str, ...] = cls.__struct_fields__  # type: ignore[attr-defined]
    if len(args) > len(names):
        message = f"{cls.__name__}() takes {len(names)} arguments, got {len(args)}"
        raise TypeError(message)
    values = dict(zip(names, args, strict=False))
    for name, value in kwargs.items():
        if name in values or name not in names:
            problem = "given twice" if name in values else "unknown"
            message = f"{cls.__name__}() argument {name!r} is {problem}"
            raise TypeError(message)
        values[name] = value
    required = names[: len(names) - len(cls.__struct_defaults__)]  # type: ignore[attr-defined]
    missing = [name for name in required if name not in values]
    if missing:
        message = f"{cls.__name__}() lacks the arguments {', '.join(missing)}"
        raise TypeError(message)
    return values


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
