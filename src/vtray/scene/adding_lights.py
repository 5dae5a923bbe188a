"""Adds lights to a scene, with arguments in the ways that people write them."""

import math
from collections.abc import Mapping
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
from vtray.scene.pictures.sky_image import SkyImage, sky_image
from vtray.scene.sky_types import Gradient
from vtray.scene.vectors import Color, Direction, Vector

if TYPE_CHECKING:
    import os
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
    def add_sky(
        self,
        radiance: float = 1.0,
        color: "AnyColor" = "white",
        gradient: "Gradient | Mapping[str, AnyColor] | None" = None,
        image: "SkyImage | NDArray[Any] | str | os.PathLike[str] | None" = None,
        up: "Direction | Vector | Triple | None" = None,
        rotation: float = 0.0,
    ) -> Sky:
        """Add light from all directions.

        Parameters
        ----------
        radiance
            Strength, ≥ 0: a white surface that sees nothing but a sky of radiance 1 shows 1.
        color
            Colour of the light, in any of the ways of `vtray.colors.to_rgb`; that of a gradient
            or a picture is multiplied by it.
        gradient
            Colours by the height above the horizon: a `Gradient`, or a dictionary of some of
            ``"zenith"``, ``"horizon"`` and ``"ground"`` in any of the ways to write a colour.
        image
            A picture of the light from all directions, as a map of the globe: an array (height,
            width, 3) of floats, 1 for the radiance of the sky, or the path of an .exr, .hdr, .png,
            .jpg, .npy or .npz file. Not beside a gradient.
        up
            What is up in the world; None for the camera's `up`, or where it has none, up in the
            picture.
        rotation
            By how many degrees the sky is turned around `up`, counterclockwise as seen from above.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        way = None if up is None else argument("add_sky", "up", up, Direction)
        picture = None if image is None else sky_image(image, "add_sky: image")
        colors = _gradient(gradient)
        rgb = _color("add_sky", color)
        return self._added(Sky(radiance, rgb, colors, picture, way, rotation))

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
            How far away something still darkens a surface, in scene units, ≥ 0; at 0 nothing does.
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


def _color(call: str, color: "AnyColor", name: str = "color") -> Color:
    """Return a colour, or raise SceneError naming the call."""
    return Color(*to_rgb(color, f"{call}: {name}"))


def _gradient(given: "Gradient | Mapping[str, AnyColor] | None") -> Gradient | None:
    """Return a gradient, or raise SceneError naming the call."""
    if given is None or isinstance(given, Gradient):
        return given
    from vtray.scene.checks.scene_words import show

    known = Gradient.__struct_fields__
    if isinstance(given, Mapping) and all(name in known for name in given):
        colors = {name: _color("add_sky", given[name], f"gradient: {name}") for name in given}
        return Gradient(**colors)
    words = f"a Gradient, or a dictionary of some of {', '.join(known)}"
    raise SceneError(f"add_sky: gradient: expected {words}, got {show(given)}")
