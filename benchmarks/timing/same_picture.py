"""Whether two renderers have made the same picture."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image

MEAN_TOLERANCE = 1.0
SHARE_TOLERANCE = 0.01
FAR = 8.0


class Difference(NamedTuple):
    """How far two pictures are apart, once the second is as bright as the first.

    Attributes
    ----------
    mean
        The mean difference of the channels, in steps of 255.
    share
        The share of pixels with a channel that is more than `FAR` steps off: edges.
    """

    mean: float
    share: float

    def __str__(self) -> str:
        """Write both."""
        return f"{self.mean:.2f}, {self.share:.2%}"


def difference(ours: Path, theirs: Path, column: int = 0) -> Difference:
    """Compare two image files of the same size.

    Renderers round differently and their edges run through other pixels. Brightness is scaled
    for the best fit, in the least squares.

    Parameters
    ----------
    ours, theirs
        The files.
    column
        Which column of our picture shows what the first column of theirs shows.
    """
    a, b = _read(ours), _read(theirs)
    if a.shape != b.shape:
        return Difference(255.0, 1.0)
    a, b = a[:, column:], b[:, : b.shape[1] - column]
    power = float((b * b).sum())
    fit = float((a * b).sum()) / power if power > 0 else 1.0
    off = np.abs(fit * b - a)
    return Difference(float(off.mean()), float((off.max(axis=2) > FAR).mean()))


def is_same(found: Difference) -> bool:
    """Tell whether the pictures are the same but for rounding and edges."""
    return found.mean <= MEAN_TOLERANCE and found.share <= SHARE_TOLERANCE


def _read(path: Path) -> NDArray[np.float64]:
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"), np.float64)
