"""Adds particles to a scene: the one function that the command and Python share."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

from vtray.scene.checks.unknown_names import explain_unknown

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from vtray.scene.camera import Camera
    from vtray.scene.colors.color_scale import ColorMap, Norm
    from vtray.scene.colors.names import AnyColor
    from vtray.scene.objects import Object
    from vtray.scene.particles.drawing import Drawn
    from vtray.scene.particles.particles import Particles
    from vtray.scene.particles.radii import Radii
    from vtray.scene.stars import Stretch

StyleName = Literal["spacefill", "ball-and-stick", "licorice", "points"]


class AddingParticles:
    """What makes objects of particles."""

    __slots__ = ()

    if TYPE_CHECKING:
        objects: list[Object]
        camera: Camera

    @explain_unknown
    def add_particles(
        self,
        particles: "Particles | ArrayLike | Any",  # noqa: ANN401
        style: StyleName | None = None,
        *,
        radii: "Radii | None" = None,
        scale: float = 1.0,
        color: "AnyColor | ArrayLike | None" = None,
        colors: Literal["jmol", "cpk"] = "jmol",
        cmap: "ColorMap | None" = None,
        clim: tuple[float, float] | None = None,
        norm: "Norm | None" = None,
        nan_color: "AnyColor" = "gray",
        categories: Sequence[Any] | None = None,
        select: "str | NDArray[np.bool_] | None" = None,
        highlight: "str | NDArray[np.bool_] | None" = None,
        opacity: "str | ArrayLike | None" = None,
        background: "AnyColor | None" = None,
        bonds: "bool | float | Literal['file'] | ArrayLike | None" = None,
        bond_radius: float | None = None,
        hydrogen_bonds: "bool | tuple[float, float]" = False,
        emission: "str | float | ArrayLike | None" = None,
        stretch: "Stretch" = "asinh",
        softening: float | None = None,
        peak: float | None = None,
        cell: bool | None = None,
        replicate: Sequence[int] = (1, 1, 1),
        boundary: bool | float = False,
        wrap: bool = False,
        unwrap: bool = False,
        camera: "Camera | None" = None,
    ) -> "Drawn":
        """Add particles to the objects: balls, bonds between them, and the edges of their cell.

        Parameters
        ----------
        particles
            What `vtray.read` returns; objects of ASE, MDAnalysis, OVITO, RDKit, pymatgen, MDTraj,
            Biotite, OpenMM or ParmEd, in ångström; of HOOMD-blue, freud, yt, pynbody, PyVista or
            meshio; or positions of shape (n, 3).
        style
            ``"spacefill"``: balls of van der Waals radii, or, in solids of which a fifth or more
            are metals or semimetals, of covalent radii. ``"ball-and-stick"``: 0.6 of covalent
            radii, and thin bonds. ``"licorice"``: bonds, and balls as thick as these. ``"points"``:
            balls of one size in the picture, 1.5 pixels wide, so that none falls between pixels;
            or, with `emission`, points whose light adds up.
            By default ball-and-stick where bonds or hydrogen bonds are asked for, or bonds known
            between at most 5000 atoms, and else spacefill.
        radii
            ``"covalent"`` or ``"vdw"`` for those of the elements in ångström, of which styles take
            a share; or as they are, in the unit of the positions, a number, an array (n,), or the
            name of a column. By default the column ``radius``, the elements, or half the mean
            distance: that is the side of the cube that each particle has in the box around all.
        scale
            What all radii are multiplied by, those of bonds too, from 1e-20 to 1e20.
        color
            A colour, in any of the ways of `vtray.colors.to_rgb`; the name of a column, or x, y or
            z; what is worked out of these, such as ``"velocity.x"`` or ``"norm(force)"``, as for
            `select`; or a colour, a number or a name for each particle, which is coloured as in a
            column. Names of which some are colours are all meant as such, unless `categories` is
            given. Three numbers are a colour, of three particles, too, unless `cmap`, `clim` or
            `norm` is given. Names, types and at most eight different integers get a colour each, of
            which people with any colour vision can tell the first eight apart; numbers those of
            `cmap`, and vectors those of their lengths. With `cmap`, `clim` or `norm`, few integers
            are numbers, too. By default the columns ``color``, ``element`` or ``type``, whichever
            is there first.
        colors
            Whose colours elements have.
        cmap
            Turns values into colours, as for `add_spheres`; viridis by default.
        clim
            The values of its first and last colour; by default the range of those that are drawn.
        norm
            ``"log"``: places between the limits are those of logarithms. ``"centered"``: 0 is in
            the middle, and the limit that is farther from it counts for both sides.
        nan_color
            The colour of values that are NaN.
        categories
            Names or integers that get a colour each, in their order, so that they have the same in
            several pictures; others get one by their names. By default those that there are,
            sorted. The first 8 colours are told apart by all eyes; up to 24 are darker and lighter
            ones of the same kinds, and then they come again. Elements keep their own colours, and
            those that are named stand in the legend, too.
        select
            What is drawn: an expression such as ``"element == 'O' and z > 3"``, or an array (n,) of
            bool.
        highlight
            What keeps its colour, in the same ways; all others come near `background`.
        opacity
            Share of the light that particles take on its way through, from 0 to 1: a number, one
            for each, (n,), or the name of a column. With `highlight`, of all others, which then
            keep their colours. Balls and bonds of one opacity are one body, without walls inside.
        background
            The colour that they come near; by default white, and black for points that shine.
        bonds
            True for pairs nearer than 1.2 times the sum of their covalent radii, by
            `find_bonds`; a number for pairs nearer than that; ``"file"`` for those that are known,
            as a file or a topology names them; pairs of indices, (m, 2); False for none. By default
            those that are known, or True, in styles that show bonds.
        bond_radius
            In the unit of the positions; by default as the style says.
        hydrogen_bonds
            Whether hydrogen bonds are drawn, as grey dashes from the hydrogen to the acceptor: of
            donors and acceptors N, O and F, at most 2.5 Å from the hydrogen to the acceptor, with
            an angle between them at the hydrogen of at least 120 degrees [1]_. Two numbers are
            another length, in the unit of the positions, and another angle, such as
            ``(2.2, 150)``. Donors are known by the bonds of the particles, or by those of
            `find_bonds` where there are none, or where `bonds` is True.
        emission
            Let points shine, as `Stars`: each adds so much light to the picture, a column, a
            number, or an array (n,), ≥ 0. Their colours are white unless `color` is given, the
            background is black unless it is set, and there are neither balls nor radii.
        stretch, softening, peak
            How the light that adds up becomes brightness: ``"linear"``, ``"asinh"`` or ``"log"``;
            from which part of the brightest on it counts by its logarithm; and the light of a
            pixel that is as bright as can be. See `Stars`.
        cell
            Whether the edges of the cell are drawn; by default, if there is one that holds at least
            a quarter of all particles, and nothing shines.
        replicate
            How many times the cell is shown along each of its edges. Where all
            cells together have more than half a million objects, they are `Copies`, which take no
            memory.
        boundary
            Whether particles on faces, edges and corners of the cell, or of the block of cells, are
            shown on the opposite ones, too, and only bonds between what is shown are drawn, whole.
            On a face is what is at most a thousandth of the cell's edge away from it, along the
            edge; a number is another part, up to 0.5, so that 0.1 shows a tenth of a cell more on
            each side. What lies outside the cell is not repeated: `wrap` brings it in.
        wrap
            Whether particles outside the cell are brought into it.
        unwrap
            Whether molecules that the border cuts are made whole, by their bonds, or by the columns
            ix, iy and iz, or image, where they are there.
        camera
            The camera of the picture, for points alone; by default that of the scene.

        Returns
        -------
        Drawn
            What was added, and what the colours mean.

        Raises
        ------
        SceneError
            An argument is not right, or something that it needs is not known of the particles.

        References
        ----------
        .. [1] E. N. Baker and R. E. Hubbard, "Hydrogen bonding in globular proteins", Progress in
           Biophysics and Molecular Biology 44, 1984.

        Examples
        --------
        >>> import vtray
        >>> water = vtray.Particles([(0, 0, 0), (0.76, 0.59, 0), (-0.76, 0.59, 0)],
        ...                         {"element": ["O", "H", "H"]})
        >>> drawn = vtray.Scene().add_particles(water, bonds=True)
        >>> len(drawn.spheres), len(drawn.bonds), drawn.legend
        (3, 2, [('H', (228, 228, 228)), ('O', (255, 13, 13))])
        """
        from vtray.scene.particles.drawing import draw

        return draw(
            self,
            particles,
            style=style,
            radii=radii,
            scale=scale,
            coloring={
                "color": color,
                "colors": colors,
                "cmap": cmap,
                "clim": clim,
                "norm": norm,
                "nan_color": nan_color,
                "categories": categories,
            },
            select=select,
            highlight=highlight,
            opacity=opacity,
            background=background,
            bonds=bonds,
            bond_radius=bond_radius,
            hydrogen_bonds=hydrogen_bonds,
            emission=emission,
            stretched={"stretch": stretch, "softening": softening, "peak": peak},
            cell=cell,
            replicate=replicate,
            boundary=boundary,
            wrap=wrap,
            unwrap=unwrap,
            camera=camera,
        )
