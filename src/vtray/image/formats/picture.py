"""What a file of a picture is made from, as the formats see it."""

from collections.abc import Collection
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.scene.style import Style

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

LONGEST_TEXT = 1 << 20
"""Bytes that a file may hold to say how its picture was made; it takes some hundred."""


class Picture(Protocol):
    """A picture, as `vtray.Image` is one; it also has an attribute for each of `AOVS`."""

    linear: "Floats"
    white: float
    scene: Scene
    settings: RenderSettings
    style: Style
    locked: bool
    keep_lights: bool
    partial: float | None

    @property
    def scene_hash(self) -> str:
        """A hash of the scene."""

    @property
    def shown_hash(self) -> str | None:
        """A hash of the scene as it was rendered, if that has another camera."""

    @property
    def with_overlays(self) -> "Floats":
        """Light of all that is seen: the sky too, fog and lines, (height, width, 3)."""

    @property
    def alpha(self) -> "Floats":
        """How much of each pixel is covered, from 0 to 1, (height, width)."""

    def develop(self, bits: int) -> "NDArray[Any]":
        """Return exposed pixels of 8 or 16 bits, (height, width, 3), or 4 with alpha."""


class How(NamedTuple):
    """How a picture is to be written.

    Attributes
    ----------
    bits
        Bits of each channel.
    aov
        What to write beside the picture, of `AOVS`.
    provenance
        How the picture was made, as ASCII text; "" to leave that out.
    """

    bits: int = 8
    aov: Collection[str] = ()
    provenance: str = ""


def has_alpha(background: object) -> bool:
    """Tell whether a background leaves what is not covered transparent."""
    return background == "transparent"
