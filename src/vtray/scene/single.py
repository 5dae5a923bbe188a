"""Single objects, as the scene file defines them."""

from types import MappingProxyType
from typing import TYPE_CHECKING

from vtray.scene.checks.checked import Frozen
from vtray.scene.checks.limits import Fraction, NonNegative
from vtray.scene.materials import AnyMaterial
from vtray.scene.vectors import Color, Direction, Vector

if TYPE_CHECKING:
    from vtray.scene.vectors import Triple

_SURFACE = MappingProxyType({"color": Color(255, 255, 255), "lambert": 1.0})


class Sphere(Frozen, frozen=True, omit_defaults=True, gc=False, tag_field="type", tag="sphere"):
    """A sphere with a matt surface, which can also be seen from inside.

    In code, the colour is white and `lambert` 1 unless they are given.

    Attributes
    ----------
    center : Vector
        Centre in world space.
    radius : float
        Radius in scene units, ≥ 0; a sphere of radius 0 is never hit.
    color : Color
        Colour of the surface.
    lambert : float
        Share of the light that the surface scatters, from 0 to 1.
    opacity : float
        Share of the light that it takes on its way through, from 0 to 1; 1 by default.
    material : Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend or str
        What it is made of, or its name: "lambert" (the default), "mirror", "glass", "metal",
        "plastic" or "emissive".
    """

    center: Vector
    radius: NonNegative
    color: Color
    lambert: Fraction
    opacity: Fraction = 1.0
    material: AnyMaterial = "lambert"

    _in_code = _SURFACE

    if TYPE_CHECKING:

        def __init__(
            self,
            center: "Vector | Triple",
            radius: float,
            color: "Color | Triple" = ...,
            lambert: float = 1.0,
            opacity: float = 1.0,
            material: AnyMaterial = "lambert",
        ) -> None: ...

    def hull(self) -> list[tuple[Vector, float, Vector | None]]:
        """Return the ball whose hull this is, as `Spheres.hull` does."""
        return [(self.center, self.radius, None)]


class Cylinder(Frozen, frozen=True, omit_defaults=True, gc=False, tag_field="type", tag="cylinder"):
    """A solid cylinder with flat caps and a matt surface, which can also be seen from inside.

    In code, the colour is white and `lambert` 1 unless they are given.

    Attributes
    ----------
    start : Vector
        Middle of one cap in world space.
    end : Vector
        Middle of the other; a cylinder of length 0 is never hit.
    radius : float
        Radius in scene units, ≥ 0; a cylinder of radius 0 is never hit.
    color : Color
        Colour of the surface.
    lambert : float
        Share of the light that the surface scatters, from 0 to 1.
    opacity : float
        Share of the light that it takes on its way through, from 0 to 1; 1 by default.
    material : Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend or str
        What it is made of, or its name: "lambert" (the default), "mirror", "glass", "metal",
        "plastic" or "emissive".
    """

    start: Vector
    end: Vector
    radius: NonNegative
    color: Color
    lambert: Fraction
    opacity: Fraction = 1.0
    material: AnyMaterial = "lambert"

    _in_code = _SURFACE

    if TYPE_CHECKING:

        def __init__(
            self,
            start: "Vector | Triple",
            end: "Vector | Triple",
            radius: float,
            color: "Color | Triple" = ...,
            lambert: float = 1.0,
            opacity: float = 1.0,
            material: AnyMaterial = "lambert",
        ) -> None: ...

    def hull(self) -> list[tuple[Vector, float, Vector | None]]:
        """Return the discs whose hull this is, its caps, as `Cylinders.hull` does."""
        return [(self.start, self.radius, self.end), (self.end, self.radius, self.start)]


class Cone(Frozen, frozen=True, omit_defaults=True, gc=False, tag_field="type", tag="cone"):
    """A solid cone with flat caps and a matt surface, which can also be seen from inside.

    In code, it is pointed, the colour is white and `lambert` 1 unless they are given.

    Attributes
    ----------
    start : Vector
        Middle of one cap in world space.
    end : Vector
        Middle of the other, or the tip; a cone of length 0 is never hit.
    radius : float
        Radius at `start` in scene units, ≥ 0.
    radius_end : float
        Radius at `end`, ≥ 0: 0 for a tip, less than `radius` for a cone that is cut off. A cone
        whose radii are both 0 is never hit.
    color : Color
        Colour of the surface.
    lambert : float
        Share of the light that the surface scatters, from 0 to 1.
    opacity : float
        Share of the light that it takes on its way through, from 0 to 1; 1 by default.
    material : Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend or str
        What it is made of, or its name: "lambert" (the default), "mirror", "glass", "metal",
        "plastic" or "emissive".
    """

    start: Vector
    end: Vector
    radius: NonNegative
    radius_end: NonNegative
    color: Color
    lambert: Fraction
    opacity: Fraction = 1.0
    material: AnyMaterial = "lambert"

    _in_code = MappingProxyType({"radius_end": 0.0, **_SURFACE})

    if TYPE_CHECKING:

        def __init__(
            self,
            start: "Vector | Triple",
            end: "Vector | Triple",
            radius: float,
            radius_end: float = 0.0,
            color: "Color | Triple" = ...,
            lambert: float = 1.0,
            opacity: float = 1.0,
            material: AnyMaterial = "lambert",
        ) -> None: ...

    def hull(self) -> list[tuple[Vector, float, Vector | None]]:
        """Return the discs whose hull this is, its caps, as `Cones.hull` does."""
        return [(self.start, self.radius, self.end), (self.end, self.radius_end, self.start)]


class Plane(Frozen, frozen=True, omit_defaults=True, gc=False, tag_field="type", tag="plane"):
    """A plane without edges and with two matt sides.

    In code, the colour is white and `lambert` 1 unless they are given.

    Attributes
    ----------
    center : Vector
        Any point of the plane, in world space.
    normal : Direction
        Direction square to the plane, in world space.
    color : Color
        Colour of the surface.
    lambert : float
        Share of the light that the surface scatters, from 0 to 1.
    opacity : float
        Share of the light that it takes on its way through, from 0 to 1; 1 by default.
    material : Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend or str
        What it is made of, or its name: "lambert" (the default), "mirror", "glass", "metal",
        "plastic" or "emissive".
    """

    center: Vector
    normal: Direction
    color: Color
    lambert: Fraction
    opacity: Fraction = 1.0
    material: AnyMaterial = "lambert"

    _in_code = _SURFACE

    if TYPE_CHECKING:

        def __init__(
            self,
            center: "Vector | Triple",
            normal: "Direction | Vector | Triple",
            color: "Color | Triple" = ...,
            lambert: float = 1.0,
            opacity: float = 1.0,
            material: AnyMaterial = "lambert",
        ) -> None: ...
