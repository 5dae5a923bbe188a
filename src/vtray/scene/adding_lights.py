"""Adds lights to a scene, with arguments in the ways that people write them."""

import math
from typing import TYPE_CHECKING, Any, overload

from vtray.base.errors import SceneError
from vtray.scene.checks.argument import argument
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.colors.names import to_rgb
from vtray.scene.light_types import (
    SUN_DEGREES,
    Ambient,
    AnyLight,
    Light,
    OneLight,
    RectangleLight,
    Sky,
    SphereLight,
    Sun,
)
from vtray.scene.vectors import Color, Direction, Vector

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vtray.scene.colors.names import AnyColor
    from vtray.scene.vectors import Triple

_KINDS = (Light, Sun, SphereLight, RectangleLight, Sky, Ambient)


class AddingLights:
    """What can be added to the lights of a scene."""

    __slots__ = ()

    if TYPE_CHECKING:

        @property
        def lights(self) -> list[AnyLight]: ...  # noqa: D102

        @lights.setter
        def lights(self, lights: Sequence[AnyLight]) -> None: ...

    @overload
    def add_light(self, location: OneLight) -> OneLight: ...

    @overload
    def add_light(
        self, location: "Vector | Triple", intensity: float = 1.0, color: "AnyColor" = "white"
    ) -> Light: ...

    @explain_unknown
    def add_light(
        self,
        location: "AnyLight | Vector | Triple",
        intensity: float = 1.0,
        color: "AnyColor" = "white",
    ) -> AnyLight:
        """Add a point light, or a light that is there already.

        Parameters
        ----------
        location
            Position in world space; or, alone, a light of any kind: `Light`, `Sun`, `SphereLight`,
            `RectangleLight`, `Sky` or `Ambient`.
        intensity
            Strength, ≥ 0: a white surface that a light of intensity 1 shines on squarely shows 1.
        color
            Colour of the light, in any of the ways of `vtray.colors.to_rgb`.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        if isinstance(location, _KINDS):
            if intensity != 1.0 or color != "white":
                words = "expected a light alone, or the location, intensity and color of a point"
                raise SceneError(f"add_light: {words}, got a {type(location).__name__} and more")
            self.lights.append(location)
            return location
        place = argument("add_light", "location", location, Vector)
        return self._added(Light(place, intensity, _color("add_light", color)))

    @explain_unknown
    def add_sun(
        self,
        direction: "Direction | Vector | Triple",
        intensity: float = 1.0,
        angle: float = SUN_DEGREES,
        color: "AnyColor" = "white",
    ) -> Sun:
        """Add a sun: a disc in the sky, infinitely far away.

        Parameters
        ----------
        direction
            Where its light goes, in world space: (0, 0, -1) from straight above, if z is up.
        intensity
            Strength, ≥ 0: a white surface that a sun of intensity 1 shines on squarely shows 1.
        angle
            Diameter in degrees, as seen from the scene, from 0 to 180; 0 gives hard shadows.
        color
            Colour of the light, in any of the ways of `vtray.colors.to_rgb`.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        way = argument("add_sun", "direction", direction, Direction)
        return self._added(Sun(way, intensity, angle, _color("add_sun", color)))

    @explain_unknown
    def add_sphere_light(
        self,
        location: "Vector | Triple",
        radius: float,
        intensity: float | None = None,
        color: "AnyColor" = "white",
        *,
        radiance: float | None = None,
        visible: bool = False,
    ) -> SphereLight:
        """Add a shining ball.

        Parameters
        ----------
        location
            Its centre in world space.
        radius
            Radius in scene units, ≥ 0; the larger, the softer its shadows.
        intensity
            Strength at any distance, ≥ 0, 1 by default: a white surface that a ball of intensity 1
            shines on squarely shows 1.
        color
            Colour of the light, in any of the ways of `vtray.colors.to_rgb`.
        radiance
            Instead of an intensity: how brightly its surface shines, ≥ 0, so that its light gets
            weaker with distance.
        visible
            Whether the camera sees it, in its colour.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        place = argument("add_sphere_light", "location", location, Vector)
        rgb = _color("add_sphere_light", color)
        return self._added(SphereLight(place, radius, intensity, rgb, radiance, visible))

    @explain_unknown
    def add_rectangle_light(
        self,
        location: "Vector | Triple",
        edges: "Sequence[Vector | Triple] | NDArray[Any]",
        intensity: float | None = None,
        color: "AnyColor" = "white",
        *,
        radiance: float | None = None,
        visible: bool = False,
    ) -> RectangleLight:
        """Add a shining rectangle, which shines to both sides.

        Parameters
        ----------
        location
            Its middle in world space.
        edges
            Two of its sides, from corner to corner, in scene units, at right angles to each other.
        intensity
            Strength at any distance, ≥ 0, 1 by default: a white surface straight in front of its
            middle that a rectangle of intensity 1 shines on squarely shows 1.
        color
            Colour of the light, in any of the ways of `vtray.colors.to_rgb`.
        radiance
            Instead of an intensity: how brightly its surface shines, ≥ 0, so that its light gets
            weaker with distance.
        visible
            Whether the camera sees it, in its colour.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        place = argument("add_rectangle_light", "location", location, Vector)
        rgb = _color("add_rectangle_light", color)
        return self._added(RectangleLight(place, edges, intensity, rgb, radiance, visible))

    @explain_unknown
    def add_sky(self, radiance: float = 1.0, color: "AnyColor" = "white") -> Sky:
        """Add light from all directions.

        Parameters
        ----------
        radiance
            Strength, ≥ 0: a white surface that sees nothing but a sky of radiance 1 shows 1.
        color
            Colour of the light, in any of the ways of `vtray.colors.to_rgb`.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        return self._added(Sky(radiance, _color("add_sky", color)))

    @explain_unknown
    def add_ambient(
        self, intensity: float = 1.0, distance: float = math.inf, color: "AnyColor" = "white"
    ) -> Ambient:
        """Add light from all directions that only what is near keeps off: ambient occlusion.

        Parameters
        ----------
        intensity
            Strength, ≥ 0: a white surface with nothing near shows 1 at intensity 1.
        distance
            How far away something still darkens a surface, in scene units, > 0.
        color
            Colour of the light, in any of the ways of `vtray.colors.to_rgb`.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        return self._added(Ambient(intensity, distance, _color("add_ambient", color)))

    def _added(self, light: OneLight) -> OneLight:
        """Add a light, and return it."""
        self.lights.append(light)
        return light


def _color(call: str, color: "AnyColor") -> Color:
    """Return a colour, or raise SceneError naming the call."""
    return Color(*to_rgb(color, f"{call}: color"))
