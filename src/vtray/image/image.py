"""The picture that a render gives, with all that can be done with it.

Each of that stands in a module of its own, which knows no more of a picture than it uses.
"""

from collections.abc import Collection, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import OutputError, RenderError
from vtray.base.file_name import file_name
from vtray.image.formats.png_file import as_png
from vtray.image.rendered import Rendered
from vtray.image.saving import save_picture
from vtray.image.white import locked_white
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.colors.tone_map_names import ToneMapName, is_encoded
from vtray.scene.edits import recolored, relit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from vtray.figures.legend import LegendGiven
    from vtray.figures.point_labels import LabelsGiven
    from vtray.image.annotated import AnnotatedPicture
    from vtray.image.picking import Pick
    from vtray.scene.colors.color_scale import ColorMap
    from vtray.scene.colors.names import AnyColor


class Image(Rendered):
    """A rendered picture.

    Attributes
    ----------
    linear
        Light before exposure, float64, (height, width, 3): the sums of cosine, Lambert
        coefficient, intensity and colour (0 to 255). With ``settings.denoise``, it is
        without grain, and `raw` is as it was traced.
    white
        The light that becomes 255; 0 if the whole picture is black.
    scene
        The scene as it was rendered. (Arrays that its spheres share are shared still.)
    settings
        How it was rendered.
    style
        How it is drawn, beside its light.
    locked
        Whether its exposure is that of another picture.
    keep_lights
        Whether its lights were kept, for `relight` and `recolor`.
    partial
        None for a whole picture. While it is rendered, the share of its tiles that are done, from
        0 to 1: the others are filled in with what is known, and the peak that decides the exposure
        "max" is that of what is there.
    stats
        How the picture was made: seconds for ``"build"``, ``"pack"``, ``"compile"``, ``"trace"``
        and ``"develop"``; the number of ``"rays"`` cast; of the hierarchy, its ``"nodes"``, its
        ``"depth"``, and its ``"memory"`` in bytes.
    """

    @explain_unknown
    def expose(
        self,
        exposure: Literal["max", "auto"] | float | None = None,
        *,
        stops: float | None = None,
        tonemap: ToneMapName | None = None,
        lock: "Image | None" = None,
    ) -> "Image":
        """Return the same light with another exposure, or by another tone map.

        Parameters
        ----------
        exposure
            ``"max"``, the default, ``"auto"``, or what light is multiplied by, > 0, as in `render`.
            Where only stops or a tone map are given, it stays as it is.
        stops
            How often light is doubled after that; 0 by default, or as they are where only a tone
            map is given.
        tonemap
            The tone map, as in `render`; by default that of this picture. A picture whose tone map
            is linear has no other, and others are never linear, as their colours are other light.
        lock
            A picture whose exposure is taken; not together with `exposure` or `stops`.

        Raises
        ------
        SceneError
            The exposure, the stops or the tone map are wrong.
        RenderError
            `lock` is no picture, or `exposure` or `stops` is given too; or stops alone are given,
            and the exposure of this picture is that of another one; or the tone map cannot be
            had without another render.
        """
        settings = self.settings.replace(tonemap=tonemap)
        if is_encoded(settings.tonemap) != is_encoded(self.settings.tonemap):
            own, words = self.settings.tonemap, "by which its colours became other light"
            remedy = f'render it with tonemap="{settings.tonemap}"'
            raise RenderError(f'tonemap: the picture was rendered with "{own}", {words}; {remedy}')
        if lock is not None:
            locked_white(lock, exposure, stops)
            return self._again(lock, settings=settings)
        if exposure is None and stops is None and tonemap is not None:
            return self._again(self if self.locked else None, settings=settings)
        if exposure is None:
            if stops is not None and self.locked:
                words = "the exposure of this picture is that of another one, with its stops"
                raise RenderError(f"stops: {words}; give an exposure too")
            exposure = "max" if stops is None else self.settings.exposure
        stops = 0.0 if stops is None else stops
        return self._again(None, settings=settings.replace(exposure=exposure, stops=stops))

    @explain_unknown
    def relight(self, intensities: Sequence[float], *, lock: "Image | None" = None) -> "Image":
        """Return the picture with other intensities of its lights, exactly as a new render.

        That is one with ``keep_lights=True`` as well: which pixels get samples depends on it where
        lights are no points.

        Parameters
        ----------
        intensities
            One for each of ``scene.lights``, ≥ 0.
        lock
            A picture whose exposure is taken, instead of what ``settings.exposure`` says.

        Raises
        ------
        RenderError
            The picture was rendered without ``keep_lights=True``.
        SceneError
            An intensity is wrong, or there are too many or too few.
        """
        return self._relit(relit(self.scene, intensities), lock)

    @explain_unknown
    def recolor(
        self,
        index: int,
        color: "AnyColor | ArrayLike | Sequence[AnyColor]",
        *,
        color_end: "AnyColor | ArrayLike | Sequence[AnyColor] | None" = None,
        cmap: "ColorMap | None" = None,
        clim: tuple[float, float] | None = None,
        nan_color: "AnyColor" = "gray",
        lock: "Image | None" = None,
    ) -> "Image":
        """Return the picture with other colours of an object, exactly as a new render.

        That is one with ``keep_lights=True`` as well, as for `relight`.

        Parameters
        ----------
        index
            The place of the object in ``scene.objects``.
        color
            The colour or colours, in all ways of `Scene.add_spheres`. Of `Copies` of several
            objects, one colour for all, or a list with an entry for each object.
        color_end
            Those of the second halves of cylinders and cones, as for `Scene.add_cylinders`; None
            for the same as the first.
        cmap, clim, nan_color
            How values become colours, as for `Scene.add_spheres`.
        lock
            A picture whose exposure is taken, instead of what ``settings.exposure`` says.

        Raises
        ------
        RenderError
            The picture was rendered without ``keep_lights=True``.
        SceneError
            There is no such object, or a colour is wrong.
        """
        scene = recolored(
            self.scene,
            index,
            color,
            color_end=color_end,
            cmap=cmap,
            clim=clim,
            nan_color=nan_color,
        )
        return self._relit(scene, lock)

    def pick(self, x: int, y: int) -> "Pick | None":
        """Return what is seen in the middle of a pixel.

        Parameters
        ----------
        x, y
            Column and row of the pixel, from 0 at the top left; negative ones count from the end.

        Returns
        -------
        Pick or None
            The object, and the particle that it was made of by `Scene.add_particles` with what its
            columns say; None where nothing is.

        Raises
        ------
        RenderError
            The picture has no such pixel, or what is given are no integers.
        """
        from vtray.image.picking import pick

        return pick(self, x, y)

    @explain_unknown
    def save(
        self, path: str | PathLike[str], *, bits: int | None = None, aov: Collection[str] = ()
    ) -> None:
        """Write the picture to a file, whole or not at all.

        All formats but JPEG hold the pixels exactly, or the light before exposure. A file also
        says how the picture was made, which `read_provenance` and ``vtray --replay`` read.

        Parameters
        ----------
        path
            The file. Its ending chooses the format: ``.png``, also without an ending, ``.tif``,
            ``.jpg`` and ``.webp`` for pixels; ``.exr`` for light before exposure, divided by 255;
            ``.npz`` for the arrays of this object.
        bits
            Bits of each channel: 8, or 16 in ``.png``, ``.tif`` and ``.npz``; ``.exr`` has 32.
        aov
            What to write beside the picture in ``.exr`` and ``.npz``, by the names of attributes:
            ``"depth"``, ``"normals"``, ``"ids"``, ``"copies"``, ``"raw"``, ``"albedo"``,
            ``"error"``, ``"samples"``, ``"direct"``, ``"indirect"``, ``"emission"``.

        Raises
        ------
        OutputError
            The ending is unknown, the format cannot hold what is asked for, the package for it is
            missing, the file holds arrays that the scene was read from, or it cannot be written.
        """
        save_picture(self, Path(file_name(path, OutputError)), bits, aov)

    def _repr_png_(self) -> bytes:
        """Return the picture as a PNG, by which notebooks show it."""
        return as_png(self.pixels)

    def flat(self) -> NDArray[np.uint8]:
        """Return the picture with light that changes lightness only: colours can be read back.

        Each pixel has the colour of the surface in its middle, and of its two sides a and b in the
        colour space OKLab exactly these numbers, as nearly as 8 bits allow (to 0.002). Only its
        lightness L says how much light there is. So a value that became a colour can be found
        again: it is that of the colour in the map with the same a and b, whatever the light.

        This works with colour maps whose colours differ in a and b: viridis, plasma, inferno,
        magma, turbo, cividis, Spectral, coolwarm, RdBu, twilight, YlGnBu and most others (viridis
        to 2 of 256 colours). It does not with those that only get lighter, such as gray. Colours
        that are as strong as a monitor can show, such as pure red, have no room for light: they
        look the same everywhere.

        Returns
        -------
        array
            uint8, (height, width, 3). What is empty is black, or has the colour of the background.
        """
        from vtray.figures.flat import flat_pixels

        return flat_pixels(self)

    @explain_unknown
    def annotated(
        self,
        *,
        title: str | None = None,
        time: str | float | None = None,
        frame: int | None = None,
        legend: "LegendGiven | None" = None,
        colorbar: bool | str | Sequence[str] = False,
        scalebar: bool | str = False,
        axes: "bool | Mapping[str, ArrayLike]" = False,
        labels: "LabelsGiven" = (),
        hide_labels: bool = False,
        at: "ArrayLike | None" = None,
        fontsize: float | None = None,
    ) -> "AnnotatedPicture":
        """Return the picture with annotations painted onto it, without Matplotlib.

        It is as large as the picture, and what no annotation covers is as it was. Letters are dark
        where the picture is light, light where it is dark, and have a halo where it is both. They
        are DejaVu Sans, of Latin and Greek.

        Parameters
        ----------
        title
            What to write at the top left; too long lines are broken.
        time, frame
            Which frame of a simulation it is, to write below that: a number, or a text such as
            ``"12.5 ps"``, which becomes ``t = 12.5 ps``; and an integer.
        legend
            Names and colours to show at the top right as small balls: ``{"O": "red",
            "H": "white"}`` or pairs of these.
        colorbar
            Whether to show a colour bar on the right for each colour scale of the objects, and
            where points shine, one that tells how much of their emission adds up in a pixel of each
            shade; a text to write above it, such as ``"energy (eV)"``; or a list of texts if there
            are more. Without one, that of brightness is "emission per pixel".
        scalebar
            Whether to show a scale bar at the bottom right, in scene units; or the name of the
            unit, such as ``"nm"``. In perspective, at which distance from the eye it is right is
            written below it (see `at`). A text with ``{length}`` in it replaces all that, as for
            `figure`.
        axes
            Whether to show the axes of the world at the bottom left as the camera sees them in the
            middle of the picture: x red, y green, z blue. Or up to three directions in world space
            by their names, such as ``{"a": (1, 0, 0)}``.
        labels
            Texts and points in world space to write them at: pairs such as ``("O", (0, 0, 1))``, or
            points by their texts. They stay within the picture; those of points outside of it are
            left out, and so is one that would overlap another mark, the label of a nearer point,
            or one given before it.
        hide_labels
            Whether to leave out labels of points that are behind something. The sphere or cylinder
            in which a point lies does not hide it.
        at
            For perspective, a point in world space at whose distance the scale bar is right; None
            for the median of the spheres and cylinders that are seen (without any: of the planes).
        fontsize
            The size of letters in pixels. None for one that suits the size of the picture, and is
            smaller where there would be no room.

        Returns
        -------
        AnnotatedPicture
            It has ``pixels`` and a method ``save``, and shows itself in notebooks.

        Raises
        ------
        FigureError
            An argument is not right, or there is no room.
        """
        from vtray.figures.annotations import Annotations
        from vtray.figures.painted.picture import annotated_pixels
        from vtray.image.annotated import AnnotatedPicture

        wanted = Annotations(
            title=title,
            time=time,
            frame=frame,
            legend=legend,
            colorbar=colorbar,
            scalebar=scalebar,
            axes=axes,
            labels=labels,
            hide_labels=hide_labels,
            at=at,
        )
        return AnnotatedPicture(annotated_pixels(self, wanted, fontsize), self)

    @explain_unknown
    def figure(
        self,
        *,
        colorbar: bool | str | Sequence[str] = True,
        scalebar: bool | str = True,
        title: str | None = None,
        time: str | float | None = None,
        frame: int | None = None,
        legend: "LegendGiven | None" = None,
        axes: "bool | Mapping[str, ArrayLike]" = False,
        labels: "LabelsGiven" = (),
        hide_labels: bool = False,
        flat: bool = False,
        width: float | None = None,
        dpi: float | None = None,
        fontsize: float | None = None,
        at: "ArrayLike | None" = None,
        ax: "Axes | None" = None,
    ) -> "Figure":
        """Return the picture as a Matplotlib figure: with colour bars, a scale bar and a title.

        Nothing but `axes` and `labels` is drawn over the picture. Unless both `width` and `dpi` are
        given, or `ax`, it is shown as it is: one pixel of the figure for each of its own (small
        pictures: a square of pixels for each). The figure is none of pyplot's: save it by
        ``figure.savefig("figure.png")``. Needs Matplotlib: ``pip install matplotlib``.

        Fonts, their sizes and the width of lines are those of Matplotlib's ``rcParams``. Text that
        is too long is broken into lines.

        Parameters
        ----------
        colorbar
            Whether to show a colour bar for each colour scale of the objects, and where points
            shine, one that tells how much of their emission adds up in a pixel of each shade; a
            text to write beside it, such as ``"energy (eV)"``; or a list of texts if there are
            more. Without one, that of brightness is "emission per pixel".
        scalebar
            Whether to show a scale bar, in scene units; or the name of the unit, such as ``"nm"``.
            In perspective, things look smaller the farther away they are: the bar is right for
            those at one distance (see `at`), and ``≈`` before its length says so. A text with
            ``{length}`` in it replaces all that, and can say the distance, which is measured along
            the camera's view: ``"{length} nm at a distance of {distance} nm"``. Panoramas have
            none.
        title
            What to write above the picture.
        time, frame
            Which frame of a simulation it is, to write above the picture: a number, or a text such
            as ``"12.5 ps"``, which becomes ``t = 12.5 ps``; and an integer.
        legend
            Names and colours to show as small balls: ``{"O": "red", "H": "white"}`` or pairs of
            these.
        axes
            Whether to show the axes of the world in the lower left corner as the camera sees them
            in the middle of the picture: x red, y green, z blue. Or up to three directions in world
            space by their names, such as ``{"a": (1, 0, 0)}``.
        labels
            Texts and points in world space to write them at: pairs such as
            ``("O", (0, 0, 1))``, or points by their texts.
        hide_labels
            Whether to leave out labels of points that are behind something. The sphere or cylinder
            in which a point lies does not hide it.
        flat
            Whether to show `flat`, from which values can be read off. Its colour bars show each
            colour from shadow to full light.
        width
            The width of the whole figure in inches. None for as much as the picture needs with
            `dpi`.
        dpi
            Dots per inch, which are pixels. None for one that shows the picture as it is: without
            `width`, 6.5 inches wide, but at least with 100.
        fontsize
            The size of all text in points; None for those of ``rcParams``.
        at
            For perspective, a point in world space at whose distance the scale bar is right; None
            for the median of the bounded shapes that are seen (without any: of the planes).
        ax
            Axes of Matplotlib to draw in, for instance of ``pyplot.subplots()``; `width` and `dpi`
            are those of their figure then. Picture, title and bars are kept within the place that
            the axes have. What was drawn in the same axes before is replaced.

        Returns
        -------
        Figure
            The figure: a new one, or that of `ax`.

        Raises
        ------
        ExtraError
            Matplotlib is not installed.
        FigureError
            An argument is not right.

        Notes
        -----
        Where the figure has another number of pixels for the picture than a multiple of its own,
        pixels are mixed (Matplotlib's interpolation "antialiased"). Files such as PDF hold the
        pixels of the picture as they are.
        """
        from vtray.figures.annotations import Annotations
        from vtray.figures.figure import make_figure

        wanted = Annotations(
            title=title,
            time=time,
            frame=frame,
            legend=legend,
            colorbar=colorbar,
            scalebar=scalebar,
            axes=axes,
            labels=labels,
            hide_labels=hide_labels,
            at=at,
        )
        return make_figure(self, wanted, flat=flat, width=width, dpi=dpi, fontsize=fontsize, ax=ax)
