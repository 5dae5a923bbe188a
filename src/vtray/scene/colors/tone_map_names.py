"""The names of the tone maps, and which take the numbers of colours for sRGB."""

from typing import Literal

ToneMapName = Literal["linear", "srgb", "filmic", "agx"]


def is_encoded(tonemap: ToneMapName) -> bool:
    """Tell whether a tone map encodes light as sRGB, so that colours are decoded for it."""
    return tonemap != "linear"
