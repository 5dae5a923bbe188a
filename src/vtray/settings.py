"""How a picture is taken of a scene, beside its camera: the settings of a render."""

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from vtray.kinds import Byte, Positive, SizePair

FILTERS = ("box", "tent", "gaussian", "mitchell", "blackman-harris")
"""The names of the reconstruction filters."""

MAX_SAMPLES = 2**16
MAX_SEED = 2**32 - 1

Samples = Annotated[
    int,
    Meta(ge=1, le=MAX_SAMPLES, description=f"an integer from 1 to {MAX_SAMPLES}"),
]
Seed = Annotated[int, Meta(ge=0, le=MAX_SEED, description=f"an integer from 0 to {MAX_SEED}")]
FilterName = Literal["box", "tent", "gaussian", "mitchell", "blackman-harris"]
Exposure = Literal["max"] | Positive
Background = Literal["black", "transparent"] | tuple[Byte, Byte, Byte]


class RenderSettings(msgspec.Struct, frozen=True, omit_defaults=True):
    """How a picture is taken of a scene.

    Attributes
    ----------
    samples : int
        Rays for each pixel that needs them, from 1 to 65536; 1 gives exactly the format's picture.
    filter : str
        How the samples of a pixel are weighted, if there is more than one: "box", "tent",
        "gaussian", "mitchell" or "blackman-harris".
    seed : int
        Chooses among equally good places of the samples, from 0 to 2**32 - 1.
    size : tuple of int, optional
        Width and height of the picture in pixels, instead of those of the camera; the view stays.
    exposure : "max" or float
        "max": the brightest channel of the picture becomes 255. A number: light is multiplied by
        it, so that for 1 a surface that a light of intensity 1 shines on squarely gets its color.
    background : "black", "transparent", or three integers
        What is seen where there is nothing.
    """

    samples: Samples = 1
    filter: FilterName = "blackman-harris"
    seed: Seed = 0
    size: SizePair | None = None
    exposure: Exposure = "max"
    background: Background = "black"
