"""OpenEXR: light as it is before exposure, and what else is known of each pixel.

Channels have the names that compositing programs look for:

- ``R``, ``G``, ``B`` and ``A``, with colour multiplied by alpha, and ``Z`` for depth: OpenEXR's
  "Technical Introduction" and "Interpreting OpenEXR Deep Pixels";
- ``N.X``, ``N.Y``, ``N.Z`` for normals: a layer ``N`` of a vector, as Arnold and pbrt write it;
- ``raw.R``, ``raw.G``, ``raw.B`` for light before it was denoised, in a layer ``raw``; likewise in
  layers ``direct``, ``indirect`` and ``emission``, as Arnold names these;
- ``objectid`` and ``particleid``, of 32-bit unsigned integers: "Standard ID Channel names" in the
  "OpenEXR Deep IDs Specification".

References
----------
https://openexr.com/en/latest/TechnicalIntroduction.html
https://openexr.com/en/latest/DeepIDsSpecification.html
"""

import io
from typing import TYPE_CHECKING, Any, BinaryIO

from vtray.base.version import SOFTWARE
from vtray.image.aovs import AOVS, aov_of
from vtray.image.formats.picture import How, Picture

if TYPE_CHECKING:
    from numpy.typing import NDArray

ATTRIBUTE = "vtray"
"""The attribute that says how a picture was made."""


def write_exr(picture: Picture, how: How, file: BinaryIO) -> None:
    """Write light divided by 255 as float32, so that 1 is white in a light of intensity 1.

    A picture whose background is not black has alpha: its light is that of the scene alone, which
    can be laid over any background. With the sky behind, light is that of both, without alpha.
    """
    import OpenEXR

    header = {
        "compression": OpenEXR.ZIP_COMPRESSION,
        "type": OpenEXR.scanlineimage,
        "software": SOFTWARE,
        ATTRIBUTE: how.provenance,
    }
    memory = io.BytesIO()  # the writer seeks, which a pipe cannot
    OpenEXR.File(header, _channels(picture, how)).write(memory)
    file.write(memory.getbuffer())


def _channels(picture: Picture, how: How) -> "dict[str, NDArray[Any]]":
    """Return all channels by their names, each (height, width), of float32 or uint32."""
    import numpy as np

    channels: dict[str, NDArray[Any]] = {}

    def add(names: tuple[str, ...], values: "NDArray[Any]") -> None:
        with np.errstate(over="ignore"):  # light beyond a float32 is infinite
            # -1, for nothing, becomes the largest 32-bit integer.
            planes: NDArray[Any] = values.astype("u4" if values.dtype.kind == "i" else "f4")
        for k, name in enumerate(names):
            channels[name] = np.ascontiguousarray(planes if len(names) == 1 else planes[..., k])

    light = picture.with_overlays / 255.0
    if picture.settings.background not in ("black", "sky"):
        add(("A",), picture.alpha)
        # What covers nothing sends no light; filters with negative sides leave a little.
        light = np.where(picture.alpha[..., None] > 0.0, light, 0.0)
    add(("R", "G", "B"), light)
    for name in how.aov:
        row, values = AOVS[name], aov_of(picture, name)
        add(row.channels, values / row.unit if row.unit != 1.0 else values)
    return channels


def read_exr(file: BinaryIO) -> str | None:
    """Return what an EXR says of how it was made, None if it says nothing."""
    import OpenEXR

    with OpenEXR.File(file, header_only=True) as found:
        text = found.header().get(ATTRIBUTE)
    return text if isinstance(text, str) else None
