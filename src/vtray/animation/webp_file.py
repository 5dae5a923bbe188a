"""Movies as WebP, without loss: Pillow packs the pictures one by one, here they are put together.

References
----------
RFC 9649, WebP Image Format, section 2.7: the extended file format.
"""

import io
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from vtray.animation.feed import Feed
from vtray.animation.times import ends_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

ANIMATED, HAS_ALPHA = 0x02, 0x10
"""Flags of the head."""

REPLACED = 0x02
"""What a picture does to the one before it: it is not blended with that."""

PIXELS = (b"VP8 ", b"VP8L", b"ALPH")
"""The parts of a file that hold a picture."""


def write_webp(path: Path, feed: Feed, fps: float) -> None:
    """Write a movie that begins again at its end."""
    with path.open("wb") as file:
        for pixels, milliseconds in zip(feed, ends_of(fps, 1000), strict=False):
            height, width, channels = pixels.shape
            sides = _three_bytes(width - 1) + _three_bytes(height - 1)
            if file.tell() == 0:
                flags = ANIMATED | (HAS_ALPHA if channels == 4 else 0)
                file.write(b"RIFF\0\0\0\0WEBP")
                file.write(_chunk(b"VP8X", bytes([flags, 0, 0, 0]) + sides))
                file.write(_chunk(b"ANIM", bytes(6)))
            frame = bytes(6) + sides + _three_bytes(milliseconds) + bytes([REPLACED])
            for name, data in _chunks_of(pixels):
                if name in PIXELS:
                    frame += _chunk(name, data)
            file.write(_chunk(b"ANMF", frame))
        size = file.tell() - 8
        file.seek(4)
        file.write(struct.pack("<I", size))


def _chunks_of(pixels: "NDArray[np.uint8]") -> Iterator[tuple[bytes, bytes]]:
    """Give the parts of a file of a single picture."""
    import numpy as np
    from PIL import Image

    memory = io.BytesIO()
    picture = Image.fromarray(np.ascontiguousarray(pixels))
    picture.save(memory, "WEBP", lossless=True, exact=True)
    whole, place = memory.getvalue(), 12
    while place < len(whole):
        name, size = struct.unpack_from("<4sI", whole, place)
        yield name, whole[place + 8 : place + 8 + size]
        place += 8 + size + size % 2


def _chunk(name: bytes, data: bytes) -> bytes:
    """Return a part of a file, of an even length."""
    return name + struct.pack("<I", len(data)) + data + bytes(len(data) % 2)


def _three_bytes(number: int) -> bytes:
    return number.to_bytes(3, "little")
