"""Picture files of 16 bits per channel, of which Pillow gives the upper 8 in silence.

It knows both orders of the two bytes, and so gives the lower 8 when it is told the other one.
"""

import re
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from PIL.ImageFile import ImageFile

    Open: TypeAlias = Callable[[], ImageFile]

DEEP = re.compile(r"(RGBA?;16)([BLN])")
"""Pillow's names for 16 bits of red, green and blue in a file: with the upper byte first or last,
or in the order of the machine."""


def is_deep(image: "ImageFile") -> bool:
    """Tell whether a file that was opened has 16 bits per channel."""
    return any(";16" in str(_raw_mode(tile)) for tile in image.tile)


def read_deep(open_file: "Open") -> "NDArray[np.uint16] | None":
    """Read the pixels of a file that `is_deep`, (height, width, 3 or 4); None if that cannot be.

    Parameters
    ----------
    open_file
        Opens the file, anew each time.
    """
    import numpy as np

    halves = []
    for is_lower in (False, True):
        with open_file() as image:
            names = [DEEP.fullmatch(str(_raw_mode(tile))) for tile in image.tile]
            if "transparency" in image.info:
                return None
            for k, (tile, name) in enumerate(zip(image.tile, names, strict=True)):
                if name is None:
                    return None
                raw = f"{name[1]}{_turned(name[2])}" if is_lower else name[0]
                args: Any = raw if isinstance(tile.args, str) else (raw, *(tile.args or ())[1:])
                image.tile[k] = tile._replace(args=args)
            halves.append(np.asarray(image).astype(np.uint16))
    upper, lower = halves
    return np.bitwise_or(np.left_shift(upper, 8), lower)


def _raw_mode(tile: Any) -> object:  # noqa: ANN401
    """Return Pillow's name for what a part of a file holds, if it says any."""
    return tile.args[0] if isinstance(tile.args, tuple) and tile.args else tile.args


def _turned(order: str) -> str:
    """Return the other order of bytes."""
    own = {"little": "L", "big": "B"}[sys.byteorder] if order == "N" else order
    return "B" if own == "L" else "L"
