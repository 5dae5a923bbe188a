"""What surfaces are made of, beside their colour and the share of light that they scatter."""

from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from msgspec import Meta

from vtray.scene.checks.checked import Frozen

Index = Annotated[float, Meta(ge=0.1, le=10, description="a number from 0.1 to 10")]
MaterialName = Literal["lambert", "mirror", "glass"]


class Lambert(Frozen, frozen=True, gc=False, tag_field="type", tag="lambert"):
    """A matt surface, which scatters light evenly."""


class Mirror(Frozen, frozen=True, gc=False, tag_field="type", tag="mirror"):
    """A smooth mirror.

    Of red, green and blue it reflects as much as the colour of the object says: all if that is
    white.
    """


class Glass(Frozen, frozen=True, gc=False, omit_defaults=True, tag_field="type", tag="glass"):
    """Smooth, clear glass, which mirrors a part of the light and refracts the rest.

    What passes its surface is tinted by the colour of the object.

    Attributes
    ----------
    ior : float
        Its index of refraction, from 0.1 to 10, that of what is around it being 1; 1.5 by default.
    """

    ior: Index = 1.5

    if TYPE_CHECKING:

        def __init__(self, ior: float = 1.5) -> None: ...


Material: TypeAlias = Lambert | Mirror | Glass

_BY_NAME: dict[str, Material] = {"lambert": Lambert(), "mirror": Mirror(), "glass": Glass()}


def material_of(given: Material | MaterialName) -> Material:
    """Return a material that may be given by its name."""
    return _BY_NAME[given] if isinstance(given, str) else given
