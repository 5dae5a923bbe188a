"""What files may hold beside the picture itself: its arbitrary output variables (AOVs)."""

from typing import TYPE_CHECKING, Any, Literal, NamedTuple

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Aov(NamedTuple):
    """An array of what is known of each pixel: the attribute of a picture that has its name.

    Attributes
    ----------
    dtype
        Of its numbers.
    channels
        What OpenEXR calls its channels, of float32 or, for integers, of uint32. The array is
        (height, width) if there is one, else (height, width, channels).
    unit
        What is 1 in OpenEXR: 255 for light.
    """

    dtype: str
    channels: tuple[str, ...]
    unit: float = 1.0


AOVS = {
    "depth": Aov("float64", ("Z",)),
    "normals": Aov("float64", ("N.X", "N.Y", "N.Z")),
    "ids": Aov("int32", ("objectid", "particleid")),
    "copies": Aov("int32", ("copyid",)),
    "raw": Aov("float64", ("raw.R", "raw.G", "raw.B"), 255.0),
    "albedo": Aov("float64", ("albedo.R", "albedo.G", "albedo.B")),
    "error": Aov("float64", ("error",), 255.0),
    "samples": Aov("int32", ("samples",)),
    "direct": Aov("float64", ("direct.R", "direct.G", "direct.B"), 255.0),
    "indirect": Aov("float64", ("indirect.R", "indirect.G", "indirect.B"), 255.0),
    "emission": Aov("float64", ("emission.R", "emission.G", "emission.B"), 255.0),
}
"""The AOVs by their names, in their usual order."""

if TYPE_CHECKING:
    AovName = str
else:
    AovName = Literal[tuple(AOVS)]


def aov_of(picture: object, name: str) -> "NDArray[Any]":
    """Return an AOV of a picture."""
    import numpy as np

    return np.asarray(getattr(picture, name), AOVS[name].dtype)
