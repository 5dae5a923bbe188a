"""The kinds of value in a scene: their limits, and the words for them.

Each description completes "expected ..." in an error message.
"""

import types
import typing
from typing import Annotated, Any, Literal

from msgspec import Meta

Real = Annotated[float, Meta(description="a finite number")]
Positive = Annotated[float, Meta(gt=0, description="a number > 0")]
Zoom = Annotated[float, Meta(ge=1e-9, le=1e9, description="a number from 1e-9 to 1e9")]
NonNegative = Annotated[float, Meta(ge=0, description="a number ≥ 0")]
Fraction = Annotated[float, Meta(ge=0, le=1, description="a number from 0 to 1")]
# An integer may be written 255 or 255.0: JSON knows only numbers.
Byte = Annotated[
    Annotated[int, Meta(ge=0, le=255)] | Annotated[float, Meta(ge=0, le=255, multiple_of=1)],
    Meta(description="an integer from 0 to 255"),
]
MaterialNumber = Annotated[Byte, Meta(description="the number of a material, from 0 to 255")]
MAX_SIZE = 2**31 - 1  # the largest side of a PNG
Size = Annotated[
    Annotated[int, Meta(ge=1, le=MAX_SIZE)]
    | Annotated[float, Meta(ge=1, le=MAX_SIZE, multiple_of=1)],
    Meta(description=f"an integer from 1 to {MAX_SIZE}"),
]
SizePair = Annotated[tuple[Size, Size], Meta(description="an array of two integers > 0")]
PositivePair = Annotated[tuple[Positive, Positive], Meta(description="an array of two numbers > 0")]
Absorption = Annotated[
    tuple[NonNegative, NonNegative, NonNegative],
    Meta(description="three numbers ≥ 0, of red, green and blue"),
]
YesOrNo = Annotated[bool, Meta(description="true or false")]
Projection = Literal["perspective", "orthographic", "panorama"]
FlatProjection = Literal["perspective", "orthographic"]
Margin = Annotated[float, Meta(ge=0, lt=0.5, description="a number from 0 to less than 0.5")]
AngularSize = Annotated[float, Meta(ge=0, le=180, description="a number of degrees from 0 to 180")]
# Infinite only in code: JSON has no infinity.
Reach = Annotated[float, Meta(ge=0, description="a number ≥ 0", extra={"may_be_infinite": True})]
FieldOfView = Annotated[float, Meta(gt=0, lt=180, description="a number of degrees > 0 and < 180")]
# The end, in the words of Python and of JavaScript: a $ of Python's may stand before a newline.
END = r"(?![\s\S])"
DataPath = Annotated[
    str, Meta(pattern=rf"\.np[yz]{END}", description="the path of a .npz or .npy file")
]
ImagePath = Annotated[
    str,
    Meta(
        pattern=rf"\.(exr|hdr|png|jpe?g|np[yz]){END}",
        description="the path of an .exr, .hdr, .png, .jpg, .npy or .npz file",
    ),
]
NpzPath = Annotated[str, Meta(pattern=rf"\.npz{END}", description="the path of a .npz file")]


def alternatives(kind: Any) -> tuple[Any, ...]:  # noqa: ANN401
    """Return the plain types that a kind allows, without limits and descriptions."""
    if hasattr(kind, "__metadata__"):
        return alternatives(kind.__origin__)
    if typing.get_origin(kind) not in (typing.Union, types.UnionType):
        return (kind,)
    return tuple(plain for part in typing.get_args(kind) for plain in alternatives(part))


def limits_alone(kind: Any) -> Any:  # noqa: ANN401
    """Return a kind without what is not for checks, such as how a command line writes it."""
    if not hasattr(kind, "__metadata__"):
        return kind
    limits = tuple(item for item in kind.__metadata__ if isinstance(item, Meta))
    return Annotated[(kind.__origin__, *limits)] if limits else kind.__origin__


def may_be_infinite(kind: Any) -> bool:  # noqa: ANN401
    """Tell whether a kind allows infinity, where it is given in code."""
    limits = getattr(kind, "__metadata__", ())
    return any((limit.extra or {}).get("may_be_infinite", False) for limit in limits)


class FieldError(ValueError):
    """Says that one field does not fit the others, where a type looks at them together.

    Parameters
    ----------
    field : str
        The field.
    message : str
        What was expected of it.
    """

    def __init__(self, field: str, message: str) -> None:
        super().__init__(message)
        self.field = field
