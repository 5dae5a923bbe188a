"""FLIP: how much people notice who flip between two pictures.

References
----------
Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020.
"""

from typing import TYPE_CHECKING, Any

from vtray.base.errors import VtrayError
from vtray.base.extras import need
from vtray.base.memory import lack_of_memory

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Pixels = NDArray[np.uint8]


BYTES_PER_PIXEL = 240
"""What the library takes, as measured."""


def flip_error(a: "NDArray[Any]", b: "NDArray[Any]", user: str) -> "tuple[float, Pixels]":
    """Return the mean FLIP error, from 0 to 1, and its map in magma colours.

    Parameters
    ----------
    a, b
        The pixels of both, uint8 or uint16, (height, width, 3).
    user
        What needs this, for the message if the package is missing.

    Raises
    ------
    ExtraError
        The package ``flip-evaluator`` is not installed.
    VtrayError
        There is not enough memory, for lack of which the library would end the process.
    """
    evaluate = need("flip_evaluator", "diff", user).evaluate
    import numpy as np

    height, width = a.shape[:2]
    lack = lack_of_memory(height * width * BYTES_PER_PIXEL)
    if lack:
        message = f"to compare pictures of {width} x {height} pixels needs {lack}"
        raise VtrayError(message)
    reference, test = (
        np.ascontiguousarray(pixels, np.float32) / np.iinfo(pixels.dtype).max for pixels in (a, b)
    )
    colors, mean, _ = evaluate(reference, test, "LDR", applyMagma=True)
    return float(mean), np.round(colors * 255).astype(np.uint8)
