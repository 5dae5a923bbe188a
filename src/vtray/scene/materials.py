"""What surfaces are made of, beside their colour and the share of light that they scatter."""

from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from msgspec import Meta

from vtray.scene.checks.checked import Frozen
from vtray.scene.checks.limits import Absorption, FieldError, NonNegative, YesOrNo
from vtray.scene.metals import MetalName
from vtray.scene.patterns import ImagePattern, Pattern
from vtray.scene.pictures.pattern_image import PatternImage

Index = Annotated[float, Meta(ge=0.1, le=10, description="a number from 0.1 to 10")]
Share = Annotated[float, Meta(ge=0, le=1, description="a number from 0 to 1")]
MaterialName = Literal["lambert", "mirror", "glass", "metal", "plastic", "emissive"]


class Patterned(Frozen, frozen=True, gc=False, kw_only=True, omit_defaults=True):
    """What may have a pattern.

    Attributes
    ----------
    pattern : Checker, Stripes or ImagePattern, optional
        Colours on the surface in place of that of the object.
    """

    pattern: Pattern | None = None


class Lambert(Patterned, frozen=True, gc=False, tag_field="type", tag="lambert"):
    """A matt surface, which scatters light evenly.

    Attributes
    ----------
    pattern : Checker, Stripes or ImagePattern, optional
        Colours on the surface in place of that of the object.
    """


class Mirror(Patterned, frozen=True, gc=False, tag_field="type", tag="mirror"):
    """A smooth mirror.

    Of red, green and blue it reflects as much as the colour of the object says: all if that is
    white.

    Attributes
    ----------
    pattern : Checker, Stripes or ImagePattern, optional
        As of Lambert.
    """


class Glass(Patterned, frozen=True, gc=False, tag_field="type", tag="glass"):
    """Clear glass, which mirrors a part of the light and refracts the rest.

    What passes its surface is tinted by the colour of the object.

    Attributes
    ----------
    ior : float
        Its index of refraction, from 0.1 to 10, that of what is around it being 1; 1.5 by default.
    absorption : tuple of float
        How much of red, green and blue light it absorbs per scene unit, each ≥ 0: of light that
        goes so far through it that much times the length is 1, 1/e is left (Beer's law). 0 by
        default.
    roughness : float
        From 0, smooth, the default, to 1: how rough its surface is, as frosted glass is. The
        whitted integrator takes it for smooth.
    thin : bool
        Whether the surface is a thin sheet with nothing within, as a bubble is; False by default.
        Then light goes straight through, and there is neither absorption nor roughness.
    pattern : Checker, Stripes or ImagePattern, optional
        As of Lambert.
    """

    ior: Index = 1.5
    absorption: Absorption = (0.0, 0.0, 0.0)
    roughness: Share = 0.0
    thin: YesOrNo = False

    def __post_init__(self) -> None:
        for name, value in (("absorption", max(self.absorption)), ("roughness", self.roughness)):
            if self.thin and value > 0:
                raise FieldError(name, "0 for glass that is thin")

    if TYPE_CHECKING:

        def __init__(
            self,
            ior: float = 1.5,
            absorption: tuple[float, float, float] = (0.0, 0.0, 0.0),
            roughness: float = 0.0,
            thin: bool = False,
            pattern: Pattern | None = None,
        ) -> None: ...


class Metal(Patterned, frozen=True, gc=False, tag_field="type", tag="metal"):
    """A metal, which mirrors more at grazing angles.

    Attributes
    ----------
    name : str, optional
        Which metal, by measured indices of refraction; its light is then tinted by the colour of
        the object. Without a name, that is what the metal mirrors of light that falls squarely.
    roughness : float
        From 0, smooth, the default, to 1: how rough its surface is, as brushed or cast metal is.
        The whitted integrator takes it for smooth.
    pattern : Checker, Stripes or ImagePattern, optional
        As of Lambert.
    """

    name: MetalName | None = None
    roughness: Share = 0.0

    if TYPE_CHECKING:

        def __init__(
            self,
            name: MetalName | None = None,
            roughness: float = 0.0,
            pattern: Pattern | None = None,
        ) -> None: ...


class Plastic(Patterned, frozen=True, gc=False, tag_field="type", tag="plastic"):
    """A clear coat over a matt surface of the object's colour.

    The coat mirrors white light; the surface below scatters what it does not mirror.

    Attributes
    ----------
    ior : float
        The coat's index of refraction, from 0.1 to 10; 1.5 by default.
    roughness : float
        From 0, smooth, the default, to 1: how rough the coat is. The whitted integrator takes it
        for smooth.
    pattern : Checker, Stripes or ImagePattern, optional
        As of Lambert.
    """

    ior: Index = 1.5
    roughness: Share = 0.0

    if TYPE_CHECKING:

        def __init__(
            self, ior: float = 1.5, roughness: float = 0.0, pattern: Pattern | None = None
        ) -> None: ...


class Emissive(Patterned, frozen=True, gc=False, tag_field="type", tag="emissive"):
    """A surface that shines in the colour of the object, and neither scatters nor mirrors light.

    Attributes
    ----------
    radiance : float
        How bright it is, ≥ 0: at 1, the default, it looks as bright as a white surface that a light
        of intensity 1 shines on squarely.
    pattern : Checker, Stripes or ImagePattern, optional
        As of Lambert.
    """

    radiance: NonNegative = 1.0

    if TYPE_CHECKING:

        def __init__(self, radiance: float = 1.0, pattern: Pattern | None = None) -> None: ...


Single: TypeAlias = Lambert | Mirror | Glass | Metal | Plastic | Emissive
"""A material that is no blend."""


class Blend(Patterned, frozen=True, gc=False, tag_field="type", tag="blend"):
    """Two materials in one, as dust on metal is.

    Attributes
    ----------
    first, second : Lambert, Mirror, Glass, Metal, Plastic, Emissive or str
        The two, none of them a blend, and neither with a pattern: the blend has that.
    weight : float
        The share of the second, from 0 to 1; 0.5 by default.
    pattern : Checker, Stripes or ImagePattern, optional
        As of Lambert.
    """

    first: Single | MaterialName
    second: Single | MaterialName
    weight: Share = 0.5

    def __post_init__(self) -> None:
        for name in ("first", "second"):
            if material_of(getattr(self, name)).pattern is not None:
                raise FieldError(name, "a material without a pattern, which the blend may have")

    if TYPE_CHECKING:

        def __init__(
            self,
            first: Single | MaterialName,
            second: Single | MaterialName,
            weight: float = 0.5,
            pattern: Pattern | None = None,
        ) -> None: ...


Material: TypeAlias = Single | Blend

VARIED: dict[str, tuple[type[Material], ...]] = {
    "roughness": (Metal, Plastic, Glass),
    "metalness": (Plastic,),
}
"""What may differ among many objects of one material, and of which."""

_BY_NAME: dict[str, Material] = {
    "lambert": Lambert(),
    "mirror": Mirror(),
    "glass": Glass(),
    "metal": Metal(),
    "plastic": Plastic(),
    "emissive": Emissive(),
}


AnyMaterial: TypeAlias = Material | MaterialName
"""A material, or the name of one as it is by default."""

AnyMaterials: TypeAlias = (
    AnyMaterial
    | Annotated[
        tuple[AnyMaterial, ...], Meta(min_length=1, description="an array of such materials")
    ]
)
"""A material for all of many objects, or those of which each is made of one."""


def material_of(given: Material | MaterialName) -> Material:
    """Return a material that may be given by its name."""
    return _BY_NAME[given] if isinstance(given, str) else given


def is_default(given: AnyMaterials) -> bool:
    """Tell whether all is made of the one material that everything is made of by default."""
    return materials_of(given) == (_BY_NAME["lambert"],)


def materials_of(given: AnyMaterials) -> tuple[Material, ...]:
    """Return the materials of which many objects are made, in the order of their numbers."""
    return tuple(map(material_of, given)) if isinstance(given, tuple) else (material_of(given),)


def images_in(given: AnyMaterials) -> list[PatternImage]:
    """Return the pictures that surfaces of some materials show."""
    patterns = (material.pattern for material in materials_of(given))
    return [pattern.image for pattern in patterns if isinstance(pattern, ImagePattern)]


def blended_in(material: Material) -> tuple[Material, ...]:
    """Return the two materials of a blend; nothing for others."""
    if not isinstance(material, Blend):
        return ()
    return material_of(material.first), material_of(material.second)


def can_vary(material: Material, name: str) -> bool:
    """Tell whether ``VARIED`` of a name is for a material: thin glass is always smooth."""
    is_thin = isinstance(material, Glass) and material.thin
    return isinstance(material, VARIED[name]) and not is_thin


def varied(material: Material, roughness: float, metalness: float) -> Material:
    """Return a material with a roughness and a metalness of its own; below 0, as it is."""
    if roughness >= 0 and can_vary(material, "roughness"):
        material = material.replace(roughness=roughness)
    if metalness > 0 and isinstance(material, Plastic):
        metal, pattern = Metal(roughness=material.roughness), material.pattern
        if metalness == 1:
            return metal.replace(pattern=pattern)
        return Blend(material.replace(pattern=None), metal, metalness, pattern)
    return material


def checked_materials(given: object, place: str) -> AnyMaterials:
    """Return a material that is given in code, or a sequence of them as a tuple.

    Raises
    ------
    SceneError
        If one is none, or there are none; the message begins with the place.
    """
    from vtray.scene.checks.scene_check import from_code

    found: AnyMaterials
    if isinstance(given, (list, tuple)) and given:
        found = tuple(from_code(one, AnyMaterial, f"{place}[{k}]") for k, one in enumerate(given))
    else:
        found = from_code(given, AnyMaterial, place)
    return found
