"""How light that adds up becomes brightness."""

from typing import TYPE_CHECKING, Any

from vtray.base.exact_math import logarithm

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vtray.scene.stars import Stretch

    Floats = NDArray[np.float64]
else:
    Floats = Any


def stretched(light: Floats, stretch: "Stretch", softening: float) -> Floats:
    """Return brightness from 0 to 1 for light from 0 to 1, in parts of the peak.

    Parameters
    ----------
    light
        The light, of any shape.
    stretch, softening
        As for `Stars`.
    """
    import numpy as np

    if stretch == "linear":
        return light
    one = np.ones(1)
    if stretch == "log":
        return logarithm(1.0 + light / softening) / logarithm(1.0 + one / softening)
    return _asinh(light / softening) / _asinh(one / softening)


def _asinh(x: Floats) -> Floats:
    """Return the inverse hyperbolic sine of numbers from 0 to 1e9, to within 2**-49."""
    import numpy as np

    return logarithm(x + np.sqrt(x * x + 1.0))
