"""The picture that a render gives."""

import io
from collections.abc import Callable, Collection, Mapping
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.image_file import write_image, write_png
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

    def save(
        self, path: str | PathLike[str], *, bits: int = 8, aov: Collection[str] = ()
    ) -> None:
        """Write the picture to a file, whole or not at all.

        Parameters
        ----------
        path
            The file. Its ending chooses the format: ``.png``, also without an ending.

        Raises
        ------
        OutputError
            The ending is unknown, or the file cannot be written.
        """
        write_image(self.pixels, Path(path))

    def _repr_png_(self) -> bytes:
        """Return the picture as a PNG, by which notebooks show it."""
        buffer = io.BytesIO()
        write_png(self.pixels, buffer)
        return buffer.getvalue()
