"""Adds objects to a scene, with arguments in the ways that people write them."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.checks.argument import argument
from vtray.scene.checks.given_array import positions_in
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.colors.names import to_rgb
from vtray.scene.cones import Cones
from vtray.scene.copies import Copies
from vtray.scene.cylinders import Cylinders
from vtray.scene.objects import Cone, Cylinder, Object, Plane, Sphere
from vtray.scene.spheres import Spheres
from vtray.scene.vectors import Color, Direction, Vector

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vtray.scene.colors.color_scale import ColorMap
    from vtray.scene.colors.names import AnyColor
    from vtray.scene.copies import Part
    from vtray.scene.materials import AnyMaterial
    from vtray.scene.vectors import Triple


class Adding:
    """What can be added to the objects of a scene."""

    __slots__ = ()

    if TYPE_CHECKING:
        objects: list[Object]

    @explain_unknown
    def add_sphere(
        self,
        center: "Vector | Triple",
        radius: float,
        color: "AnyColor" = "white",
        lambert: float = 1.0,
        opacity: float = 1.0,
        material: "AnyMaterial" = "lambert",
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
        opacity
            Share of the light that it takes on its way through, from 0 to 1.
        material
            What it is made of: "lambert", "mirror", "glass", "metal", "plastic", "emissive", or one
            with its numbers, such as `vtray.Glass` (1.6).

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        place = argument("add_sphere", "center", center, Vector)
        rgb = Color(*to_rgb(color, "add_sphere: color"))
        sphere = Sphere(place, radius, rgb, lambert, opacity, material)
        self.objects.append(sphere)
        return sphere

    @explain_unknown
    def add_spheres(
        self,
        positions: "ArrayLike",
        radius: "ArrayLike",
        color: "AnyColor | ArrayLike | Sequence[AnyColor] | None" = None,
        lambert: "ArrayLike" = 1.0,
        *,
        cmap: "ColorMap | None" = None,
        clim: tuple[float, float] | None = None,
        nan_color: "AnyColor" = "gray",
        opacity: "ArrayLike | None" = None,
        material: "AnyMaterial | Sequence[AnyMaterial]" = "lambert",
        material_index: "ArrayLike | None" = None,
        roughness: "ArrayLike | None" = None,
        metalness: "ArrayLike | None" = None,
    ) -> Spheres:
        """Add many spheres to the objects.

        Arrays may be of any package that NumPy understands: its own, lists, data frames of Pandas
        or Polars, and what speaks DLPack. Of positions, radii and Lambert coefficients, arrays of
        float32 and float64 are not copied.

        Parameters
        ----------
        positions
            Centres in world space, (n, 3); or what has them: `Particles`, atoms of ASE, atoms or a
            universe of MDAnalysis, a table or a mapping with the columns x, y and z among others.
        radius
            Radii in scene units, (n,), or one for all, ≥ 0.
        color
            One colour for all, in any of the ways of `vtray.colors.to_rgb`, white by default; or
            one for each, as a list of such or as numbers of shape (n, 3), integers from 0 to 255 or
            floats from 0 to 1; or, with `cmap`, n values.
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
        opacity
            Share of the light that each takes on its way through, from 0 to 1, (n,), or one for
            all; 1 by default. Those of one opacity that overlap are one body.
        material
            What all of them are made of, as for `add_sphere`; or several materials.
        material_index
            Which of several materials each is made of: its number from 0, (n,).
        roughness, metalness
            How rough each is, if it is of metal, plastic or glass, and how much it is metal of its
            colour, if it is of plastic, from 0 to 1, (n,), or one for all; by default, what the
            material says.

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
            {
                "center": positions_in(positions),
                "radius": radius,
                "lambert": lambert,
                "opacity": opacity,
                "material": material,
                "material_index": material_index,
                "roughness": roughness,
                "metalness": metalness,
            },
            {"color": _color_of(color, cmap, "add_spheres")},
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
        opacity: float = 1.0,
        material: "AnyMaterial" = "lambert",
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
        opacity
            Share of the light that it takes on its way through, from 0 to 1.
        material
            What it is made of: "lambert", "mirror", "glass", "metal", "plastic", "emissive", or one
            with its numbers, such as `vtray.Glass` (1.6).

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        one = argument("add_cylinder", "start", start, Vector)
        other = argument("add_cylinder", "end", end, Vector)
        rgb = Color(*to_rgb(color, "add_cylinder: color"))
        cylinder = Cylinder(one, other, radius, rgb, lambert, opacity, material)
        self.objects.append(cylinder)
        return cylinder

    @explain_unknown
    def add_cylinders(
        self,
        start: "ArrayLike",
        end: "ArrayLike",
        radius: "ArrayLike",
        color: "AnyColor | ArrayLike | Sequence[AnyColor] | None" = None,
        lambert: "ArrayLike" = 1.0,
        *,
        color_end: "AnyColor | ArrayLike | Sequence[AnyColor] | None" = None,
        cmap: "ColorMap | None" = None,
        clim: tuple[float, float] | None = None,
        nan_color: "AnyColor" = "gray",
        opacity: "ArrayLike | None" = None,
        material: "AnyMaterial | Sequence[AnyMaterial]" = "lambert",
        material_index: "ArrayLike | None" = None,
        roughness: "ArrayLike | None" = None,
        metalness: "ArrayLike | None" = None,
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
        opacity, material, material_index, roughness, metalness
            As for `add_spheres`.

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
            {
                "start": start,
                "end": end,
                "radius": radius,
                "lambert": lambert,
                "opacity": opacity,
                "material": material,
                "material_index": material_index,
                "roughness": roughness,
                "metalness": metalness,
            },
            {"color": _color_of(color, cmap, "add_cylinders"), "color_end": color_end},
            "add_cylinders: ",
            cmap=cmap,
            clim=clim,
            nan_color=nan_color,
        )
        self.objects.append(cylinders)
        return cylinders

    @explain_unknown
    def add_cone(
        self,
        start: "Vector | Triple",
        end: "Vector | Triple",
        radius: float,
        radius_end: float = 0.0,
        color: "AnyColor" = "white",
        lambert: float = 1.0,
        opacity: float = 1.0,
        material: "AnyMaterial" = "lambert",
    ) -> Cone:
        """Add a solid cone with flat caps to the objects.

        Parameters
        ----------
        start, end
            Middles of its caps in world space; by default, the end is a tip.
        radius
            Radius at `start` in scene units, ≥ 0.
        radius_end
            Radius at `end`, ≥ 0.
        color
            A colour, in any of the ways of `vtray.colors.to_rgb`.
        lambert
            Share of the light that the surface scatters, from 0 to 1.
        opacity
            Share of the light that it takes on its way through, from 0 to 1.
        material
            What it is made of: "lambert", "mirror", "glass", "metal", "plastic", "emissive", or one
            with its numbers, such as `vtray.Glass` (1.6).

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        one = argument("add_cone", "start", start, Vector)
        other = argument("add_cone", "end", end, Vector)
        rgb = Color(*to_rgb(color, "add_cone: color"))
        cone = Cone(one, other, radius, radius_end, rgb, lambert, opacity, material)
        self.objects.append(cone)
        return cone

    @explain_unknown
    def add_cones(
        self,
        start: "ArrayLike",
        end: "ArrayLike",
        radius: "ArrayLike",
        radius_end: "ArrayLike" = 0.0,
        color: "AnyColor | ArrayLike | Sequence[AnyColor] | None" = None,
        lambert: "ArrayLike" = 1.0,
        *,
        color_end: "AnyColor | ArrayLike | Sequence[AnyColor] | None" = None,
        cmap: "ColorMap | None" = None,
        clim: tuple[float, float] | None = None,
        nan_color: "AnyColor" = "gray",
        opacity: "ArrayLike | None" = None,
        material: "AnyMaterial | Sequence[AnyMaterial]" = "lambert",
        material_index: "ArrayLike | None" = None,
        roughness: "ArrayLike | None" = None,
        metalness: "ArrayLike | None" = None,
    ) -> Cones:
        """Add many solid cones with flat caps to the objects.

        Arrays may be of any package, and are shared, as for `add_spheres`.

        Parameters
        ----------
        start, end
            Middles of their caps in world space, each (n, 3); by default, the ends are tips.
        radius, radius_end
            Radii at `start` and at `end` in scene units, (n,), or one for all, ≥ 0.
        color
            The colours, in any of the ways of `add_spheres`.
        lambert
            Share of the light that the surfaces scatter, from 0 to 1, (n,), or one for all.
        color_end, cmap, clim, nan_color, opacity, material, material_index, roughness, metalness
            As for `add_cylinders`.

        Returns
        -------
        Cones
            What was added; its `color_scale` tells how values became colours.

        Raises
        ------
        SceneError
            If an argument is not right. The message names the place, for instance
            ``add_cones: end[17, 2]``.
        """
        radii = {"radius": radius, "radius_end": radius_end}
        cones = Cones.colored(
            {
                "start": start,
                "end": end,
                **radii,
                "lambert": lambert,
                "opacity": opacity,
                "material": material,
                "material_index": material_index,
                "roughness": roughness,
                "metalness": metalness,
            },
            {"color": _color_of(color, cmap, "add_cones"), "color_end": color_end},
            "add_cones: ",
            cmap=cmap,
            clim=clim,
            nan_color=nan_color,
        )
        self.objects.append(cones)
        return cones

    @explain_unknown
    def add_copies(self, objects: "Part | Sequence[Part]", at: "ArrayLike") -> Copies:
        """Add the same spheres, cylinders and cones many times, each time at another place.

        A copy takes no memory but its row of `at`: spheres by the hundred thousand at thousands of
        places are as light as those spheres alone. The arrays of the objects, and `at` where it is
        of float32 or float64, are not copied.

        Parameters
        ----------
        objects
            What is placed, at least one: `Sphere`, `Cylinder`, `Cone`, `Spheres`, `Cylinders` or
            `Cones`, alone or in a sequence, in world space. They need not be among the objects of
            the scene: where they are, they are seen as they stand too.
        at
            Translations in world space, (n, 3), in scene units. One of (0, 0, 0) leaves the objects
            where they stand.

        Returns
        -------
        Copies
            What was added.

        Raises
        ------
        SceneError
            If an argument is not right. The message names the place, for instance
            ``add_copies: at[5, 1]``.

        Examples
        --------
        A molecule in the eight corners of a cube:

        >>> import vtray
        >>> oxygen = vtray.Sphere((0, 0, 0), 0.6, (255, 0, 0))
        >>> hydrogen = vtray.Spheres([(0.8, 0.6, 0), (-0.8, 0.6, 0)], 0.4)
        >>> corners = [(x, y, z) for x in (0, 3) for y in (0, 3) for z in (0, 3)]
        >>> scene = vtray.Scene()
        >>> copies = scene.add_copies([oxygen, hydrogen], at=corners)
        >>> len(copies)
        8
        """
        copies = Copies.from_arrays({"objects": objects, "at": at}, "add_copies: ")
        self.objects.append(copies)
        return copies

    @explain_unknown
    def add_plane(
        self,
        point: "Vector | Triple",
        normal: "Direction | Vector | Triple",
        color: "AnyColor" = "white",
        lambert: float = 1.0,
        opacity: float = 1.0,
        material: "AnyMaterial" = "lambert",
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
        opacity
            Share of the light that it takes on its way through, from 0 to 1.
        material
            What it is made of: "lambert", "mirror", "glass", "metal", "plastic", "emissive", or one
            with its numbers, such as `vtray.Glass` (1.6).

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        place = argument("add_plane", "point", point, Vector)
        square = argument("add_plane", "normal", normal, Direction)
        rgb = Color(*to_rgb(color, "add_plane: color"))
        plane = Plane(place, square, rgb, lambert, opacity, material)
        self.objects.append(plane)
        return plane


def _color_of(color: Any, cmap: object, call: str) -> Any:  # noqa: ANN401
    """Return the colours of many objects: white, where neither they nor a colour map are given."""
    if color is None and cmap is not None:
        words = "with cmap: expected values that it turns into colours, one for each"
        raise SceneError(f"{call}: color: {words}, got none")
    return "white" if color is None else color
