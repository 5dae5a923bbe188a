"""The picture that a render gives."""

import io
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import RenderError
from vtray.image.exposure import (
    check_brightness,
    develop,
    locked_white,
    put_on_background,
    white_of,
)
from vtray.image.formats.image_file import write_picture
from vtray.image.formats.image_format import check_format
from vtray.image.formats.png_file import write_8_bits
from vtray.image.provenance import describe
from vtray.image.surfaces import Surfaces
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.edits import recolored, relit
from vtray.scene.fingerprint import scene_hash
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.scene.spheres import check_spares_data

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from vtray.scene.colors.color_scale import ColorMap
    from vtray.scene.colors.names import AnyColor

Floats = NDArray[np.float64]


class Image:
    """A rendered picture.

    Attributes
    ----------
    linear
        Light before exposure, float64, (height, width, 3): the sums of cosine, Lambert
        coefficient, intensity and colour (0 to 255).
    white
        The light that becomes 255; 0 if the whole picture is black.
    scene
        The scene as it was rendered. (Arrays that its spheres share are shared still.)
    settings
        How it was rendered.
    locked
        Whether its exposure is that of another picture.
    stats
        How the picture was made: seconds for ``"build"``, ``"pack"``, ``"compile"``, ``"trace"``
        and ``"develop"``; the number of ``"rays"`` cast; of the hierarchy, its ``"nodes"``, its
        ``"depth"``, and its ``"memory"`` in bytes.
    """

    def __init__(
        self,
        linear: Floats,
        pixels: NDArray[np.uint8] | None,
        white: float,
        scene: Scene,
        settings: RenderSettings,
        stats: Mapping[str, float],
        *,
        look: Callable[[], Surfaces],
        alpha: Floats | None = None,
        relighting: Callable[[Scene], Floats] | None = None,
        threads: int = 1,
        original: Scene | None = None,
        locked: bool = False,
    ) -> None:
        self.linear = linear
        self.white = white
        self.scene = scene
        self.settings = settings
        self.stats = stats
        self._look = look
        self._pixels = pixels
        self._alpha = alpha
        self._relighting = relighting
        self._threads = threads
        self._original = original or scene
        self.locked = locked

    def __repr__(self) -> str:
        height, width = self.linear.shape[:2]
        return f"<Image of {width} x {height} pixels, {self.settings}>"

    @property
    def pixels(self) -> NDArray[np.uint8]:
        """Light after exposure, uint8, (height, width, 3), or with alpha (height, width, 4)."""
        return self.develop()

    def develop(self, bits: int = 8) -> NDArray[Any]:
        """Return light after exposure with 8 or 16 bits for each channel.

        A channel v of light becomes ``floor(maximum * v / white)``, where the maximum is 255 or
        65535. With a transparent background there is a fourth channel, alpha, and colours are not
        multiplied by it.
        """
        background = self.settings.background
        if bits != 8:
            alpha = self.alpha if background != "black" else np.ones(self.linear.shape[:2])
            maximum = 2**bits - 1
            exposed = put_on_background(self.linear, self.white, background, alpha, maximum)
            return exposed.astype(np.uint16)
        if self._pixels is None:
            self._pixels = develop(
                self.linear, self.white, background, lambda: self.alpha, self._threads
            )
        return self._pixels

    @cached_property
    def _surfaces(self) -> Surfaces:
        return self._look()

    @property
    def depth(self) -> Floats:
        """Distance along the ray in scene units, infinite where nothing is, (height, width)."""
        return self._surfaces.depth

    @property
    def normals(self) -> Floats:
        """Unit normals in world space on the ray's side, 0 where nothing is, (h, w, 3)."""
        return self._surfaces.normals

    @property
    def ids(self) -> NDArray[np.int32]:
        """What is seen, (height, width, 2): the place in ``scene.objects``, and that in its arrays.

        Both are -1 where nothing is; the second is 0 for a single sphere and for a plane.
        """
        return self._surfaces.ids

    @cached_property
    def alpha(self) -> Floats:
        """How much of each pixel is covered, from 0 to 1, (height, width)."""
        if self._alpha is not None:
            return self._alpha
        return (self.ids[..., 0] >= 0).astype(np.float64)

    @cached_property
    def scene_hash(self) -> str:
        """A hash of the scene, 32 hexadecimal digits: that of the same scene loaded again."""
        return scene_hash(self._original)

    def expose(
        self, exposure: Literal["max"] | float | None = None, *, lock: "Image | None" = None
    ) -> "Image":
        """Return the same light with another exposure.

        Parameters
        ----------
        exposure
            ``"max"``, the default, or what light is multiplied by, > 0, as in `render`.
        lock
            A picture whose exposure is taken; not together with `exposure`.

        Raises
        ------
        SceneError
            The exposure is neither.
        RenderError
            `lock` is no picture, or `exposure` is given too.
        """
        if lock is not None:
            locked_white(lock, exposure)
            return self._with(self.linear, self.scene, self.settings, lock)
        settings = self.settings.replace(exposure="max" if exposure is None else exposure)
        return self._with(self.linear, self.scene, settings, None)

    def relight(self, intensities: Sequence[float], *, lock: "Image | None" = None) -> "Image":
        """Return the picture with other intensities of its lights, exactly as a new render.

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
        lights = relit(self.scene.lights, intensities)
        scene = Scene(self.scene.camera, lights, self.scene.objects, self.scene.render)
        return self._relit(scene, lock)

    @explain_unknown
    def recolor(
        self,
        index: int,
        color: "AnyColor | ArrayLike | Sequence[AnyColor]",
        *,
        cmap: "ColorMap | None" = None,
        clim: tuple[float, float] | None = None,
        nan_color: "AnyColor" = "gray",
        lock: "Image | None" = None,
    ) -> "Image":
        """Return the picture with other colours of an object, exactly as a new render.

        Parameters
        ----------
        index
            The place of the object in ``scene.objects``.
        color
            The colour or colours, in all ways of `Scene.add_spheres`.
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
        objects = recolored(
            self.scene.objects, index, color, cmap=cmap, clim=clim, nan_color=nan_color
        )
        scene = Scene(self.scene.camera, self.scene.lights, objects, self.scene.render)
        return self._relit(scene, lock)

    def _relit(self, scene: Scene, lock: "Image | None") -> "Image":
        """Return the picture of a scene that differs in lights and colours alone."""
        if self._relighting is None:
            message = "image: its lights were not kept; render it with keep_lights=True"
            raise RenderError(message)
        check_brightness(scene.lights)
        return self._with(self._relighting(scene), scene, self.settings, lock)

    def _with(
        self, linear: Floats, scene: Scene, settings: RenderSettings, lock: "Image | None"
    ) -> "Image":
        """Return a picture of the same view with other light or exposure."""
        if lock is None:
            white = white_of(settings.exposure, max(float(linear.max()), 0.0))
        else:
            white = locked_white(lock)
        camera = self._original.camera  # its size may be another, and the hash is of this one
        return Image(
            linear,
            None,
            white,
            scene,
            settings,
            self.stats,
            look=lambda: self._surfaces,
            alpha=self._alpha,
            relighting=self._relighting,
            threads=self._threads,
            original=Scene(camera, scene.lights, scene.objects, scene.render),
            locked=lock is not None,
        )

    def save(
        self, path: str | PathLike[str], *, bits: int | None = None, aov: Collection[str] = ()
    ) -> None:
        """Write the picture to a file, whole or not at all.

        All formats but JPEG hold the pixels exactly. A file also says how the picture was made,
        which `read_provenance` and ``vtray --replay`` read.

        Parameters
        ----------
        path
            The file. Its ending chooses the format: ``.png``, also without an ending, ``.tif``,
            ``.jpg`` and ``.webp`` for pixels; ``.exr`` for light before exposure, divided by 255;
            ``.npz`` for the arrays of this object.
        bits
            Bits of each channel: 8, or 16 in ``.png``, ``.tif`` and ``.npz``; ``.exr`` has 32.
        aov
            What to write beside the picture in ``.exr`` and ``.npz``: ``"depth"``, ``"normals"``,
            ``"ids"``.

        Raises
        ------
        OutputError
            The ending is unknown, the format cannot hold what is asked for, the package for it is
            missing, the file holds arrays that the scene was read from, or it cannot be written.
        """
        path = Path(path)
        check_spares_data(path, self.scene.objects)
        size = self.linear.shape[:2]
        how = check_format(path, bits, aov, self.settings.background, size)
        write_picture(self, path, how._replace(provenance=describe(self, how).to_text()))

    def _repr_png_(self) -> bytes:
        """Return the picture as a PNG, by which notebooks show it."""
        buffer = io.BytesIO()
        write_8_bits(self.pixels, buffer, {})
        return buffer.getvalue()

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

    def figure(
        self,
        *,
        colorbar: bool | str | Sequence[str] = True,
        scalebar: bool | str = True,
        title: str | None = None,
        flat: bool = False,
        width: float | None = None,
        dpi: float | None = None,
        fontsize: float | None = None,
        at: "ArrayLike | None" = None,
        ax: "Axes | None" = None,
    ) -> "Figure":
        """Return the picture as a Matplotlib figure: with colour bars, a scale bar and a title.

        Nothing is drawn over the picture. Unless both `width` and `dpi` are given, or `ax`, it is
        shown as it is: one pixel of the figure for each of its own (small pictures: a square of
        pixels for each). The figure is none of pyplot's: save it by
        ``figure.savefig("figure.png")``. Needs Matplotlib: ``pip install matplotlib``.

        Fonts, their sizes and the width of lines are those of Matplotlib's ``rcParams``. Text that
        is too long is broken into lines.

        Parameters
        ----------
        colorbar
            Whether to show a colour bar for each colour scale of the objects; a text to write
            beside it, such as ``"energy (eV)"``; or a list of texts if there are more scales.
        scalebar
            Whether to show a scale bar, in scene units; or the name of the unit, such as ``"nm"``.
            In perspective, things look smaller the farther away they are: the bar is right for
            those at one distance (see `at`), and ``≈`` before its length says so. A text with
            ``{length}`` in it replaces all that, and can say the distance, which is measured along
            the camera's view: ``"{length} nm at a distance of {distance} nm"``.
        title
            What to write above the picture.
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
            for the median of the spheres that are seen (without any: of the planes).
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
        from vtray.figures.figure import make_figure

        return make_figure(
            self,
            colorbar=colorbar,
            scalebar=scalebar,
            title=title,
            flat=flat,
            width=width,
            dpi=dpi,
            fontsize=fontsize,
            at=at,
            ax=ax,
        )
