"""How bright points that shine make a pixel, as a scale that a colour bar shows."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from vtray.scene.stars import Stretch
from vtray.scene.stretch import stretched

LABEL = "emission per pixel"
"""What stands beside its bar, unless something else is said."""

SHADES = 256
"""How many shades its bar has."""


@dataclass(frozen=True, eq=False)
class BrightnessScale:
    """What light adds up to in a pixel, and the shade that it has then.

    Attributes
    ----------
    high
        The light of a pixel that is as bright as can be, in the unit of `Stars.emission`.
    norm, softening
        How light becomes brightness: `Stars.stretch` and `Stars.softening`.
    table
        The shades from dark to bright, evenly by brightness, uint8, (m, 3).
    """

    high: float
    norm: Stretch
    softening: float
    table: NDArray[np.uint8]

    low: ClassVar[float] = 0.0

    def __eq__(self, other: object) -> bool:
        """Tell whether all light has the same shades."""
        if not isinstance(other, BrightnessScale):
            return NotImplemented
        mine, its = (
            (scale.high, scale.norm, scale.softening, scale.table.tobytes())
            for scale in (self, other)
        )
        return mine == its

    def __hash__(self) -> int:
        return hash((self.high, self.norm, self.softening))

    def share(self, value: float) -> float:
        """Return the brightness of a pixel with so much light, from 0 to 1."""
        return float(stretched(np.array([value / self.high]), self.norm, self.softening)[0])
