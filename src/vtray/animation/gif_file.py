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
from typing import TYPE_CHECKING

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

EXACT = 16
"""So many colours at the most are in the table as they are."""

COMMON = 0.002
"""Those are that so large a part of all pixels has."""

ROUNDS = 5
"""How often the others are moved to the middle of what they stand for."""

STEP = 1 << 14
"""Colours that are looked for at a time."""

SHIFTS = ((0, 16), (1, 8), (2, 0))
"""Where red, green and blue stand in the number of a colour."""

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


def _table_of(pictures: "list[Pixels]") -> "NDArray[np.int64]":
    """Return the colours that suit some pictures, (n, 3)."""
    import numpy as np
    from PIL import Image

    parts = []
    for pixels in pictures:
        step = max(1, -(-max(pixels.shape[:2]) // SIDE))
        parts.append(pixels[::step, ::step, :3].reshape(-1, 3))
    row = np.concatenate(parts)
    kinds, counts = np.unique(_numbers(row), return_counts=True)
    # Such as the background, which a mean of colours would tint.
    order = np.argsort(-counts, kind="stable")[:EXACT]
    common = order[counts[order] >= COMMON * len(row)]
    exact = [(number >> 16, number >> 8 & 255, number & 255) for number in kinds[common].tolist()]
    colors = [part for color in exact for part in color]
    is_other = np.ones(len(kinds), np.bool_)
    is_other[common] = False
    if is_other.any():
        # By the roots of their numbers: else the few pixels of an edge, or of a shadow, get the
        # colour of something else. Measured, what 99 of 100 pixels stay below halves by that.
        times = np.rint(np.sqrt(counts[is_other])).astype(np.int64)
        parts_of = [kinds[is_other] >> shift & 255 for _, shift in SHIFTS]
        others = np.repeat(np.stack(parts_of, axis=1).astype(np.uint8), times, axis=0)
        mixed = Image.fromarray(others[None]).quantize(
            256 - len(exact), Image.Quantize.MEDIANCUT, kmeans=ROUNDS
        )
        colors += (mixed.getpalette() or [])[: 3 * (256 - len(exact))]
    return np.array(colors, np.int64).reshape(-1, 3)


def _nearest(pixels: "Pixels", table: "NDArray[np.int64]") -> "Pixels":
    """Return for each pixel the row of the nearest colour of a table, (height, width).

    Not by Pillow, which looks for all colours that differ by less than 4 at once.
    """
    import numpy as np

    kinds, which = np.unique(_numbers(pixels), return_inverse=True)
    rows = np.empty(len(kinds), np.uint8)
    for begin in range(0, len(kinds), STEP):
        part = kinds[begin : begin + STEP, None]
        red, green, blue = ((part >> shift & 255) - table[:, k] for k, shift in SHIFTS)
        away = red * red + green * green + blue * blue
        rows[begin : begin + STEP] = away.argmin(axis=1)
    return rows[which].reshape(pixels.shape[:2])


def _numbers(pixels: "Pixels") -> "NDArray[np.int64]":
    """Return a number for the colour of each pixel, (n,)."""
    import numpy as np

    red, green, blue = pixels[..., :3].reshape(-1, 3).astype(np.int64).T
    return red << 16 | green << 8 | blue


def _packed(pixels: "Pixels", table: "NDArray[np.int64]") -> tuple[bytes, bytes, bytes]:
    """Return the head of a GIF, its table of colours, and a picture in it."""
    from PIL import Image

    height, width = pixels.shape[:2]
    picture = Image.frombytes("P", (width, height), _nearest(pixels, table).tobytes())
    picture.putpalette(table.astype("u1").tobytes())
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
