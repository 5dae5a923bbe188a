"""Movies as GIF: one table of 256 colours for all pictures, which are written one by one.

Pillow would hold all pictures in memory until the last. Here it packs each as a file of its own,
whose data are taken into the movie.

References
----------
Graphics Interchange Format, version 89a, CompuServe 1990.
"""

import io
import struct
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vtray.animation.feed import Feed
from vtray.animation.times import ends_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Pixels = NDArray[np.uint8]

LOOKED_AT = 16
"""Pictures, spread over the movie, whose colours the table is made of."""

SIDE = 200
"""Width and height at most of what is looked at of a picture."""

TRAILER = b";"


def write_gif(path: Path, feed: Feed, fps: float) -> None:
    """Write a movie that begins again at its end, without dithering."""
    table = _table_of([*feed.some(LOOKED_AT)])
    with path.open("wb") as file:
        for pixels, centiseconds in zip(feed, ends_of(fps, 100), strict=False):
            head, colors, data = _packed(pixels, table)
            if file.tell() == 0:
                file.write(head + colors)
                file.write(b"!\xff\x0bNETSCAPE2.0\x03\x01\0\0\0")
            file.write(b"!\xf9\x04\x04" + struct.pack("<H", centiseconds) + b"\0\0")
            file.write(data)
        file.write(TRAILER)


def _table_of(pictures: "list[Pixels]") -> Any:  # noqa: ANN401
    """Return a picture of Pillow's with the table of colours that suits some pictures."""
    import numpy as np
    from PIL import Image

    parts = []
    for pixels in pictures:
        step = max(1, -(-max(pixels.shape[:2]) // SIDE))
        parts.append(pixels[::step, ::step, :3].reshape(-1, 3))
    row = np.concatenate(parts)[None]
    return Image.fromarray(np.ascontiguousarray(row)).quantize(256, Image.Quantize.MEDIANCUT)


def _packed(pixels: "Pixels", table: Any) -> tuple[bytes, bytes, bytes]:  # noqa: ANN401
    """Return the head of a GIF, its table of colours, and a picture in it."""
    import numpy as np
    from PIL import Image

    picture = Image.fromarray(np.ascontiguousarray(pixels[..., :3]))
    picture = picture.quantize(palette=table, dither=Image.Dither.NONE)
    memory = io.BytesIO()
    picture.save(memory, "GIF", optimize=False)
    whole = memory.getvalue()
    size = 3 << ((whole[10] & 7) + 1)
    place = 13 + size
    while whole[place] == ord("!"):  # what is said of a single picture
        place += 2
        while whole[place]:
            place += 1 + whole[place]
        place += 1
    head = b"GIF89a" + whole[6:13]
    return head, whole[13 : 13 + size], whole[place:-1]
