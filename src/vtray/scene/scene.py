"""The scene: plain typed objects that are also the definition of the scene file.

The file format, its checks, the words of its error messages and the JSON Schema all come from the
annotations of these types, and of those in `vtray.scene.files.in_file`.
"""

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import msgspec

from vtray.base.errors import SceneError
from vtray.scene.arrays import Arrays
from vtray.scene.camera import Camera
from vtray.scene.checks.checked import Checked
from vtray.scene.checks.unknown_names import explain_unknown, unknown_attribute
from vtray.scene.colors.names import to_rgb
from vtray.scene.cylinders import Cylinders
from vtray.scene.objects import Cylinder, Light, Object, Plane, Sphere
from vtray.scene.settings import RenderSettings
from vtray.scene.spheres import Spheres
from vtray.scene.vectors import Color, Direction, Vector

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vtray.scene.colors.color_scale import ColorMap
    from vtray.scene.colors.names import AnyColor
    from vtray.scene.vectors import Triple

__all__ = [
    "Camera",
    "Color",
    "Cylinder",
    "Cylinders",
    "Direction",
    "Light",
    "Object",
    "Plane",
    "Scene",
    "Sphere",
    "Spheres",
    "Vector",
]


class Scene(msgspec.Struct, metaclass=Checked, dict=True):
    """All that a picture is made from.

    Its attributes may be replaced, its lists changed, and so may arrays that `Spheres` share;
    `check` looks at them again.

    Attributes
    ----------
    camera : Camera
        Where the picture is taken from; None until it is set.
    lights : list of Light
        The lights; may be empty.
    objects : list of Sphere, Cylinder, Plane, Spheres or Cylinders
        The objects; may be empty.
    render : RenderSettings
        How the picture is taken, unless `vtray.render` is told otherwise.

    Examples
    --------
    >>> scene = Scene()
    >>> spheres = scene.add_spheres([(0, 0, 5), (1, 0, 5)], radius=0.5, color=["red", "#00f"])
    >>> scene.camera = Camera.fit(scene)
    """

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold
        camera: Camera  # where None is left, `check` raises
        lights: list[Light]
        objects: list[Object]
        render: RenderSettings

        def __init__(
            self,
            camera: Camera | None = None,
            lights: Sequence[Light] = (),
            objects: Sequence[Object] = (),
            render: RenderSettings = ...,
        ) -> None: ...
    else:
        camera: Camera | None = None
        lights: list[Light] = msgspec.field(default_factory=list)
        objects: list[Object] = msgspec.field(default_factory=list)
        render: RenderSettings = msgspec.field(default_factory=RenderSettings)

    def __setattr__(self, name: str, value: object) -> None:
        """Set an attribute of these; a misspelt one would be ignored by everyone."""
        if name not in self.__struct_fields__:
            raise AttributeError(_no_attribute(name))
        super().__setattr__(name, value)

    @explain_unknown
    def add_sphere(
        self,
        center: "Vector | Triple",
        radius: float,
        color: "AnyColor" = "white",
        lambert: float = 1.0,
    ) -> Sphere:
        """Add a sphere to the objects.

        Parameters
        ----------
        center
            Centre in world space.
        radius
            Radius in scene units, ≥ 0.
        color
            A colour, in any of the ways of `vtray.colors.to_rgb`.
        lambert
            Share of the light that the surface scatters, from 0 to 1.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        place = _argument("add_sphere", "center", center, Vector)
        sphere = Sphere(place, radius, Color(*to_rgb(color, "add_sphere: color")), lambert)
        self.objects.append(sphere)
        return sphere

    @explain_unknown
    def add_spheres(
        self,
        positions: "ArrayLike",
        radius: "ArrayLike",
        color: "AnyColor | ArrayLike | Sequence[AnyColor]" = "white",
        lambert: "ArrayLike" = 1.0,
        *,
        cmap: "ColorMap | None" = None,
        clim: tuple[float, float] | None = None,
        nan_color: "AnyColor" = "gray",
    ) -> Spheres:
        """Add many spheres to the objects.

        Arrays may be of any package that NumPy understands: its own, lists, data frames of Pandas
        or Polars, and what speaks DLPack. Of positions, radii and Lambert coefficients, arrays of
        float32 and float64 are not copied.

        Parameters
        ----------
        positions
            Centres in world space, (n, 3).
        radius
            Radii in scene units, (n,), or one for all, ≥ 0.
        color
            One colour for all, in any of the ways of `vtray.colors.to_rgb`; or one for each, as a
            list of such or as numbers of shape (n, 3), integers from 0 to 255 or floats from 0 to
            1; or, with `cmap`, n values.
        lambert
            Share of the light that the surfaces scatter, from 0 to 1, (n,), or one for all.
        cmap
            Turns values into colours: the name of a colour map of Matplotlib, such as "viridis" or,
            reversed, "viridis_r", or a colour map of Matplotlib or of the package ``cmap``.
        clim
            The values of the map's first and last colour; by default the least and the largest of
            all finite values.
        nan_color
            The colour of values that are NaN.

        Returns
        -------
        Spheres
            What was added; its `color_scale` tells how values became colours.

        Raises
        ------
        SceneError
            If an argument is not right. The message names the place, for instance
            ``add_spheres: radius[17]``.
        """
        spheres = Spheres.colored(
            {"center": positions, "radius": radius, "lambert": lambert},
            {"color": color},
            "add_spheres: ",
            {"center": "positions"},
            cmap=cmap,
            clim=clim,
            nan_color=nan_color,
        )
        self.objects.append(spheres)
        return spheres

    @explain_unknown
    def add_cylinder(
        self,
        start: "Vector | Triple",
        end: "Vector | Triple",
        radius: float,
        color: "AnyColor" = "white",
        lambert: float = 1.0,
    ) -> Cylinder:
        """Add a solid cylinder with flat caps to the objects.

        Parameters
        ----------
        start, end
            Middles of its caps in world space.
        radius
            Radius in scene units, ≥ 0.
        color
            A colour, in any of the ways of `vtray.colors.to_rgb`.
        lambert
            Share of the light that the surface scatters, from 0 to 1.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        one = _argument("add_cylinder", "start", start, Vector)
        other = _argument("add_cylinder", "end", end, Vector)
        rgb = Color(*to_rgb(color, "add_cylinder: color"))
        cylinder = Cylinder(one, other, radius, rgb, lambert)
        self.objects.append(cylinder)
        return cylinder

    @explain_unknown
    def add_cylinders(
        self,
        start: "ArrayLike",
        end: "ArrayLike",
        radius: "ArrayLike",
        color: "AnyColor | ArrayLike | Sequence[AnyColor]" = "white",
        lambert: "ArrayLike" = 1.0,
        *,
        color_end: "AnyColor | ArrayLike | Sequence[AnyColor] | None" = None,
        cmap: "ColorMap | None" = None,
        clim: tuple[float, float] | None = None,
        nan_color: "AnyColor" = "gray",
    ) -> Cylinders:
        """Add many solid cylinders with flat caps to the objects: bonds, for instance.

        Arrays may be of any package, and are shared, as for `add_spheres`.

        Parameters
        ----------
        start, end
            Middles of their caps in world space, each (n, 3).
        radius
            Radii in scene units, (n,), or one for all, ≥ 0.
        color
            The colours, in any of the ways of `add_spheres`.
        lambert
            Share of the light that the surfaces scatter, from 0 to 1, (n,), or one for all.
        color_end
            In the same ways, the colours of the halves at `end`; `color` is then that of the halves
            at `start`. By default, each cylinder has one colour.
        cmap, clim, nan_color
            As for `add_spheres`; `color` and `color_end` are both values, with common limits.

        Returns
        -------
        Cylinders
            What was added; its `color_scale` tells how values became colours.

        Raises
        ------
        SceneError
            If an argument is not right. The message names the place, for instance
            ``add_cylinders: end[17, 2]``.
        """
        cylinders = Cylinders.colored(
            {"start": start, "end": end, "radius": radius, "lambert": lambert},
            {"color": color, "color_end": color_end},
            "add_cylinders: ",
            cmap=cmap,
            clim=clim,
            nan_color=nan_color,
        )
        self.objects.append(cylinders)
        return cylinders

    @explain_unknown
    def add_plane(
        self,
        point: "Vector | Triple",
        normal: "Direction | Vector | Triple",
        color: "AnyColor" = "white",
        lambert: float = 1.0,
    ) -> Plane:
        """Add a plane to the objects.

        Parameters
        ----------
        point
            Any point of the plane, in world space.
        normal
            Direction square to the plane, in world space, of any length but zero.
        color
            A colour, in any of the ways of `vtray.colors.to_rgb`.
        lambert
            Share of the light that the surface scatters, from 0 to 1.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        place = _argument("add_plane", "point", point, Vector)
        square = _argument("add_plane", "normal", normal, Direction)
        plane = Plane(place, square, Color(*to_rgb(color, "add_plane: color")), lambert)
        self.objects.append(plane)
        return plane

    @explain_unknown
    def add_light(self, location: "Vector | Triple", intensity: float = 1.0) -> Light:
        """Add a point light.

        Parameters
        ----------
        location
            Position in world space.
        intensity
            Strength, relative to the other lights, ≥ 0.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        light = Light(_argument("add_light", "location", location, Vector), intensity)
        self.lights.append(light)
        return light

    def check(self) -> None:
        """Check the scene after changes made in code.

        Raises
        ------
        SceneError
            If the camera is missing, or if it, a light, an object or the settings are not of their
            type.
        """
        Scene(self.camera, self.lights, self.objects, self.render)
        if _is_none(self.camera):
            remedy = "set one, for instance vtray.Camera.fit(scene)"
            raise SceneError(f"Scene.camera: there is none; {remedy}")
        for index, item in enumerate(self.objects):
            if isinstance(item, Arrays):
                item.check(f"Scene.objects[{index}]")

    def to_dict(self) -> dict[str, Any]:
        """Return the scene as a dictionary that `vtray.load_dict` makes an equal scene of.

        Returns
        -------
        dict
            What a scene file says, in Python's own types; `Spheres` are
            ``{"type": "spheres", "center": array, ...}`` with their read-only arrays, not copied.

        Raises
        ------
        SceneError
            If the scene is not valid.
        """
        from vtray.scene.files.scene_dict import to_dict

        self.check()
        return to_dict(self)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scene as indented JSON that `vtray.load` reads back as an equal scene.

        The arrays of `Spheres` go to files beside it: for scene.json to scene.npz, those of
        further `Spheres` to scene-2.npz and so on. A file of such a name is replaced if it belongs
        to the scene file that is replaced, or if these spheres were read from it.

        Parameters
        ----------
        path : str or path
            The file to write. Each file is replaced as a whole, or left as it was; arrays are
            written first, and the JSON last.

        Raises
        ------
        SceneError
            If the scene is not valid any more.
        OutputError
            If a file cannot be written, or one for arrays is there that is not the scene's own.
        """
        from vtray.scene.files.saving import save

        self.check()
        save(self, path)


def _no_attribute(name: str) -> str:
    """Say that a scene has no such attribute, and where it belongs."""
    if name not in RenderSettings.__struct_fields__:
        return unknown_attribute("Scene", name, Scene.__struct_fields__)
    ways = f"vtray.render(scene, {name}=...) or scene.render = scene.render.replace({name}=...)"
    return f"Scene has no attribute {name!r}, which is a setting of the render: {ways}"


def _is_none(value: object) -> bool:
    return value is None


def _argument(call: str, name: str, value: object, kind: Any) -> Any:  # noqa: ANN401
    """Return an argument of a call as an object of a kind, or raise SceneError naming it."""
    from vtray.scene.checks.scene_check import from_code

    return value if isinstance(value, kind) else from_code(value, kind, f"{call}: {name}")
