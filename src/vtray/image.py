"""The picture that a render gives."""

import io
from collections.abc import Callable, Collection, Mapping
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.fingerprint import scene_hash
from vtray.image_file import write_picture
from vtray.image_format import check_format
from vtray.picture import has_alpha
from vtray.png_file import write_8_bits
from vtray.provenance import describe
from vtray.scene import Scene
from vtray.settings import RenderSettings

Floats = NDArray[np.float64]


class Surfaces(NamedTuple):
    """What the ray through the middle of each pixel meets.

    Attributes
    ----------
    depth
        Distance along the ray in scene units, infinite where nothing is, (height, width).
    normals
        Unit normals in world space on the ray's side, 0 where nothing is, (height, width, 3).
    ids
        Place in ``scene.objects``, and place in the arrays of that object, 0 if it has none; both
        -1 where nothing is; int32, (height, width, 2).
    """

    depth: Floats
    normals: Floats
    ids: NDArray[np.int32]


class Image:
    """A rendered picture.

    Attributes
    ----------
    linear
        Light before exposure, float64, (height, width, 3): the sums of cosine, Lambert
        coefficient, intensity and colour (0 to 255).
    pixels
        Light after exposure, uint8, (height, width, 3), or with alpha (height, width, 4) if the
        background is transparent.
    white
        The light that becomes 255; 0 if the whole picture is black.
    scene
        The scene as it was rendered. (Arrays that its spheres share are shared still.)
    settings
        How it was rendered.
    stats
        How the picture was made: seconds for ``"build"``, ``"pack"``, ``"compile"``, ``"trace"``
        and ``"develop"``; the number of ``"rays"`` cast; of the hierarchy, its ``"nodes"``, its
        ``"depth"``, and its ``"memory"`` in bytes.
    """

    def __init__(
        self,
        linear: Floats,
        pixels: NDArray[np.uint8],
        white: float,
        scene: Scene,
        settings: RenderSettings,
        stats: Mapping[str, float],
        *,
        look: Callable[[], Surfaces],
        alpha: Floats | None = None,
    ) -> None:
        self.linear = linear
        self.pixels = pixels
        self.white = white
        self.scene = scene
        self.settings = settings
        self.stats = stats
        self._look = look
        self._alpha = alpha

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
        """A hash of the scene, 24 hexadecimal digits: that of the same scene loaded again."""
        return scene_hash(self.scene)

    def develop(self, bits: int = 8) -> NDArray[Any]:
        """Return the picture after exposure with 8 or 16 bits a channel."""
        if bits == 8:
            return self.pixels
        maximum = 2**bits - 1
        light, cover = self.linear, None
        with np.errstate(divide="ignore", invalid="ignore"):
            if has_alpha(self.settings.background):
                cover = self.alpha[..., None]
                light = light / cover
            exposed = np.nan_to_num(np.floor((maximum * light) / self.white))
        exposed[light == self.white] = maximum if self.white > 0 else 0
        if cover is not None:
            exposed = np.concatenate([exposed, np.rint(maximum * cover)], axis=2)
        developed: NDArray[Any] = exposed.clip(0, maximum).astype(np.uint16)
        return developed

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
            missing, or the file cannot be written.
        """
        path = Path(path)
        size = self.linear.shape[:2]
        how = check_format(path, bits, aov, self.settings.background, size)
        write_picture(self, path, how._replace(provenance=describe(self, how).to_text()))

    def _repr_png_(self) -> bytes:
        """Return the picture as a PNG, by which notebooks show it."""
        buffer = io.BytesIO()
        write_8_bits(self.pixels, buffer, {})
        return buffer.getvalue()
