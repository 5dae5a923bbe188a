"""Lights, as the scene file defines them: points, and what throws softer shadows.

All are measured alike: a white surface that scatters all light (`lambert` 1) shows 1, which with an
exposure of 1 becomes 255, where one light of strength 1 shines on it squarely and unhindered. That
holds for a point, for a sun or a sphere of any size, for a sky around all of the scene, and for
ambient light with nothing near. Only lamps that are given a radiance, as real ones have, get weaker
with distance.
"""

import math
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias, TypeVar

import msgspec
from msgspec import Meta

from vtray.scene.checks.checked import Checked, Frozen
from vtray.scene.checks.limits import AngularSize, FieldError, NonNegative, Reach, Real, YesOrNo
from vtray.scene.pictures.sky_image import SkyImage, sky_image
from vtray.scene.placing.directions import are_square, unit
from vtray.scene.sky_types import Gradient, check_one_of
from vtray.scene.vectors import Color, Direction, Vector

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from vtray.scene.vectors import Triple

WHITE = Color(255, 255, 255)
BLACK = Color(0, 0, 0)

Sides = Annotated[tuple[Vector, Vector], Meta(description="two vectors")]

SUN_DEGREES = 0.53
"""How large the sun appears from the earth."""


class Light(Frozen, frozen=True, gc=False, tag_field="type", tag="point"):
    """A point light; it throws hard shadows, and its light does not fall off with distance.

    In code, the intensity is 1 unless it is given.

    Attributes
    ----------
    location : Vector
        Position in world space.
    intensity : float
        Strength, ≥ 0: a white, fully scattering surface that a light of intensity 1 shines on
        squarely shows 1.
    color : Color, optional
        Colour of the light, in linear light: each channel of a surface is multiplied by that of
        the light over 255. White, the default, changes none.
    """

    location: Vector
    intensity: NonNegative
    color: Color = WHITE

    _in_code = MappingProxyType({"intensity": 1.0})
    _tag_left_out = True

    if TYPE_CHECKING:

        def __init__(
            self,
            location: "Vector | Triple",
            intensity: float = 1.0,
            color: "Color | Triple" = ...,
        ) -> None: ...


class Sun(Frozen, frozen=True, gc=False, tag_field="type", tag="sun"):
    """A disc in the sky, infinitely far away; the larger it is, the softer are its shadows.

    Attributes
    ----------
    direction : Direction
        Where its light goes, in world space: (0, 0, -1) from straight above, if z is up.
    intensity : float, optional
        Strength, ≥ 0, 1 by default: a white, fully scattering surface that a sun of intensity 1
        shines on squarely, with nothing in between, shows 1, whatever the angle.
    angle : float, optional
        Diameter in degrees, as seen from the scene, from 0 to 180; 0.53 by default, that of the
        sun seen from the earth. 0 gives hard shadows. Mirrors and glass show suns of 5 and more.
    color : Color, optional
        Colour of the light, as for Light.
    """

    direction: Direction
    intensity: NonNegative = 1.0
    angle: AngularSize = SUN_DEGREES
    color: Color = WHITE

    if TYPE_CHECKING:

        def __init__(
            self,
            direction: "Direction | Vector | Triple",
            intensity: float = 1.0,
            angle: float = SUN_DEGREES,
            color: "Color | Triple" = ...,
        ) -> None: ...


class SphereLight(Frozen, frozen=True, gc=False, tag_field="type", tag="sphere"):
    """A shining ball; the larger it is, the softer are its shadows.

    Its light does not fall off with distance, as that of points, unless its radiance is given.

    Attributes
    ----------
    location : Vector
        Its centre in world space.
    radius : float
        Radius in scene units, ≥ 0; 0 is a point.
    intensity : float, optional
        Strength, ≥ 0, 1 by default: a white, fully scattering surface that a ball of intensity 1
        shines on squarely, with nothing in between, shows 1, whatever the radius.
    color : Color, optional
        Colour of the light, as for Light.
    radiance : float, optional
        Instead of an intensity: how brightly its surface shines, ≥ 0. A white, fully scattering
        surface that sees nothing but a ball of radiance 1 shows 1; less where the ball is
        smaller or farther away.
    visible : bool, optional
        Whether the camera sees it, in its colour: white if its strength and its colour are 1.
        False by default. In any case it throws no shadow.
    """

    location: Vector
    radius: NonNegative
    intensity: NonNegative | None = None
    color: Color = WHITE
    radiance: NonNegative | None = None
    visible: YesOrNo = False

    if TYPE_CHECKING:

        def __init__(
            self,
            location: "Vector | Triple",
            radius: float,
            intensity: float | None = None,
            color: "Color | Triple" = ...,
            radiance: float | None = None,
            visible: bool = False,
        ) -> None: ...

    def __post_init__(self) -> None:
        """Settle how strong it is."""
        _settle_strength(self)


class RectangleLight(Frozen, frozen=True, gc=False, tag_field="type", tag="rectangle"):
    """A shining rectangle, which shines to both sides, and not along its plane.

    Its light does not fall off with distance, unless its radiance is given.

    Attributes
    ----------
    location : Vector
        Its middle in world space.
    edges : tuple of Vector
        Two of its sides, from corner to corner, in scene units, at right angles to each other.
    intensity : float, optional
        Strength, ≥ 0, 1 by default: a white, fully scattering surface straight in front of its
        middle that a rectangle of intensity 1 shines on squarely, with nothing in between, shows 1,
        whatever the size and the distance. From aside, it is seen smaller, and gives less.
    color : Color, optional
        Colour of the light, as for Light.
    radiance : float, optional
        Instead of an intensity: how brightly its surface shines, ≥ 0. A white, fully scattering
        surface that sees nothing but a rectangle of radiance 1 shows 1; less where the rectangle is
        smaller or farther away.
    visible : bool, optional
        Whether the camera sees it, in its colour: white if its strength and its colour are 1.
        False by default. In any case it throws no shadow.
    """

    location: Vector
    edges: Sides
    intensity: NonNegative | None = None
    color: Color = WHITE
    radiance: NonNegative | None = None
    visible: YesOrNo = False

    if TYPE_CHECKING:

        def __init__(
            self,
            location: "Vector | Triple",
            edges: "Sequence[Vector | Triple] | NDArray[Any]",
            intensity: float | None = None,
            color: "Color | Triple" = ...,
            radiance: float | None = None,
            visible: bool = False,
        ) -> None: ...

    def __post_init__(self) -> None:
        """Settle how strong it is, and refuse edges that make no rectangle."""
        _settle_strength(self)
        if not all(edge.x or edge.y or edge.z for edge in self.edges):
            raise FieldError("edges", "two vectors that are not zero (a tiny one will do)")
        one, other = map(unit, self.edges)
        if not are_square(one, other):
            raise FieldError("edges", "two vectors at right angles to each other")


class _CheckedSky(Checked):
    """Makes construction in code take a picture in all ways that `Sky` says."""

    def _convert(cls, values: dict[str, Any]) -> None:  # noqa: N805
        """Convert what is given."""
        if values.get("image") is not None:
            values["image"] = sky_image(values["image"], f"{cls.__name__}.image")


class Sky(Frozen, metaclass=_CheckedSky, frozen=True, gc=False, tag_field="type", tag="sky"):
    """Light from all directions: of one colour, or of colours that change with the direction.

    Attributes
    ----------
    radiance : float, optional
        Strength, ≥ 0, 1 by default: a white, fully scattering surface that sees nothing but a sky
        of radiance 1 shows 1.
    color : Color, optional
        Colour of the light, as for Light; that of a gradient or a picture is multiplied
        by it.
    gradient : Gradient, optional
        Colours by the height above the horizon.
    image : SkyImage, optional
        A picture of the light from all directions, as a map of the globe; not beside a gradient. In
        code, it may be given as an array (height, width, 3) of floats, 1 for the radiance of the
        sky, or as the path of a file.
    up : Direction, optional
        What is up in the world; by default the camera's `up`, or where it has none, up in the
        picture.
    rotation : float, optional
        By how many degrees the sky is turned around `up`, counterclockwise as seen from above.
    """

    radiance: NonNegative = 1.0
    color: Color = WHITE
    gradient: Gradient | None = None
    image: SkyImage | None = None
    up: Direction | None = None
    rotation: Real = 0.0

    def __post_init__(self) -> None:
        """Refuse two answers to what the colours are."""
        check_one_of(self.gradient, self.image)

    @property
    def intensity(self) -> float:
        """Strength, as other lights call it: the radiance."""
        return self.radiance

    if TYPE_CHECKING:

        def __init__(
            self,
            radiance: float = 1.0,
            color: "Color | Triple" = ...,
            gradient: Gradient | None = None,
            image: "SkyImage | NDArray[Any] | str | os.PathLike[str] | None" = None,
            up: "Direction | Vector | Triple | None" = None,
            rotation: float = 0.0,
        ) -> None: ...


class Ambient(Frozen, frozen=True, gc=False, tag_field="type", tag="ambient"):
    """Light from all directions that only what is near keeps off: ambient occlusion.

    Attributes
    ----------
    intensity : float, optional
        Strength, ≥ 0, 1 by default: a white, fully scattering surface with nothing near shows 1 in
        ambient light of intensity 1.
    distance : float, optional
        How far away something still darkens a surface, in scene units, ≥ 0. By default it is
        infinite, for which a file leaves it out. At 0 nothing does: light that is the same
        everywhere, and takes no rays, in place of what has bounced many times; `path`, which
        follows that, takes it as infinite.
    color : Color, optional
        Colour of the light, as for Light.
    """

    intensity: NonNegative = 1.0
    distance: Reach = math.inf
    color: Color = WHITE

    if TYPE_CHECKING:

        def __init__(
            self,
            intensity: float = 1.0,
            distance: float = math.inf,
            color: "Color | Triple" = ...,
        ) -> None: ...


Lamp: TypeAlias = SphereLight | RectangleLight
"""What has a place and a size."""

AnyLight: TypeAlias = Light | Sun | SphereLight | RectangleLight | Sky | Ambient

OneLight = TypeVar("OneLight", Light, Sun, SphereLight, RectangleLight, Sky, Ambient)


class NeverSet(list[AnyLight]):
    """The lights of a new scene: none yet, which is not the same as none on purpose."""


def images_of(lights: "Iterable[AnyLight]") -> list[SkyImage]:
    """Return the pictures of skies."""
    return [light.image for light in lights if isinstance(light, Sky) and light.image is not None]


def _settle_strength(light: "Lamp") -> None:
    """Give a lamp the intensity 1 if it has no strength, and refuse two."""
    if light.radiance is None and light.intensity is None:
        msgspec.structs.force_setattr(light, "intensity", 1.0)
    elif light.radiance is not None and light.intensity is not None:
        raise FieldError("radiance", "either this or the intensity, not both")


def strength_of(light: AnyLight) -> float:
    """Return what the light of a lamp is multiplied by: its intensity, or its radiance."""
    if isinstance(light, Lamp | Sky) and light.radiance is not None:
        return light.radiance
    assert light.intensity is not None  # noqa: S101 - one of the two is given
    return light.intensity


def brightest(light: AnyLight) -> float:
    """Return the strength of a light, of a picture that of its brightest channel."""
    image = light.image if isinstance(light, Sky) else None
    return strength_of(light) * (max(image.peak, 1.0) if image else 1.0)


def gives_light(light: AnyLight) -> bool:
    """Tell whether a light has a strength and a colour."""
    return strength_of(light) > 0 and light.color != BLACK


def falls_off(light: AnyLight) -> bool:
    """Tell whether a lamp gets weaker with distance."""
    return isinstance(light, Lamp) and light.radiance is not None


def measure_of(light: AnyLight) -> str:
    """Return what the strength of a light is called: "intensity" or "radiance"."""
    return "radiance" if isinstance(light, Sky) or falls_off(light) else "intensity"


def with_strength(light: AnyLight, strength: float) -> AnyLight:
    """Return the same light with another intensity, or radiance if it has one.

    Raises
    ------
    SceneError
        If it is not right.
    """
    return light.replace(**{measure_of(light): strength})
