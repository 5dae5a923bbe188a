"""What figures are made from, as this room sees it."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from vtray.figures.brightness_scale import BrightnessScale
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings

Floats = NDArray[np.float64]
Pixels = NDArray[np.uint8]


class Shown(Protocol):
    """Surfaces that are seen in a picture; of `Subject`, where nothing is solid, faint ones."""

    @property
    def depth(self) -> Floats:
        """Distance along the ray, infinite where nothing is, (height, width)."""

    @property
    def ids(self) -> NDArray[np.int32]:
        """Places in the scene and in the object's arrays, -1 where nothing is, (h, w, 2)."""

    @property
    def copies(self) -> NDArray[np.int32]:
        """Which copy is seen, -1 where nothing is that is one, (height, width)."""

    @property
    def halves(self) -> NDArray[np.int8]:
        """Which half of a cylinder or cone is seen, 1 for that at its end, (height, width)."""


class HasPixels(Protocol):
    """Anything that has pixels."""

    @property
    def pixels(self) -> Pixels:
        """Light after exposure, (height, width, 3), or with alpha (height, width, 4)."""


class Subject(HasPixels, Shown, Protocol):
    """What a figure shows: a picture, as `vtray.Image` is one."""

    @property
    def linear(self) -> Floats:
        """Light before exposure, (height, width, 3)."""

    @property
    def white(self) -> float:
        """The light that becomes 255."""

    @property
    def scene(self) -> Scene:
        """The scene as it was rendered."""

    @property
    def settings(self) -> RenderSettings:
        """How it was rendered."""

    @property
    def alpha(self) -> Floats:
        """How much of each pixel is covered, from 0 to 1, (height, width)."""

    @property
    def shown(self) -> Shown:
        """What is measured and coloured: itself, or faint surfaces where none is solid."""

    @property
    def brightness_scales(self) -> Sequence[BrightnessScale]:
        """How bright points that shine make its pixels."""

    def flat(self) -> Pixels:
        """Return the picture with light that changes lightness only, (height, width, 3)."""
