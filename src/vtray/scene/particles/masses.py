"""Elements by their masses, as simulations know atoms that they do not name.

References
----------
IUPAC, Standard atomic weights, abridged, 2021.
"""

from functools import cache
from typing import TYPE_CHECKING, Any

from vtray.scene.particles.elements import NO_ELEMENT, SYMBOLS
from vtray.scene.particles.sites import are_called_sites

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]

_WEIGHTS = """
    1.008 4.0026 6.94 9.0122 10.81 12.011 14.007 15.999 18.998 20.18 22.99 24.305 26.982 28.085
    30.974 32.06 35.45 39.95 39.098 40.078 44.956 47.867 50.942 51.996 54.938 55.845 58.933 58.693
    63.546 65.38 69.723 72.63 74.922 78.971 79.904 83.798 85.468 87.62 88.906 91.222 92.906 95.95
    nan 101.07 102.91 106.42 107.87 112.41 114.82 118.71 121.76 127.6 126.9 131.29 132.91 137.33
    138.91 140.12 140.91 144.24 nan 150.36 151.96 157.25 158.93 162.5 164.93 167.26 168.93 173.05
    174.97 178.49 180.95 183.84 186.21 190.23 192.22 195.08 196.97 200.59 204.38 207.2 208.98
"""
"""In u, of hydrogen to bismuth."""

_WITH_HYDROGEN = 2.014, 13.019, 14.027, 15.035, 16.043
"""In u, of heavy hydrogen, and of carbon with 1, 2, 3 and 4 hydrogens, where these are no atoms."""

_WITHOUT = ("H", "C", "C", "C", "C")
"""What these are drawn as."""

_ROUNDED, _ROUNDED_HEAVY = 0.012, 2e-4
"""By how much masses in files are off: in u, and as a share of large ones."""


def elements_of_masses(masses: "Array", names: "Array | None" = None) -> "Array | None":
    """Return the elements of atoms by their masses, if each mass is that of one.

    Parameters
    ----------
    masses : array (n,)
        If they are those of atoms, in u. Masses that are all whole numbers may be anything.
    names : array (n,) or None
        What the atoms are called, if that is known: those of sites tell that these have no mass.

    Returns
    -------
    array (n,) or None
        Symbols; X for sites without mass.

    Examples
    --------
    >>> import numpy as np
    >>> elements_of_masses(np.array([15.9994, 1.008, 1.008])).tolist()
    ['O', 'H', 'H']
    """
    import numpy as np

    if masses.dtype.kind not in "iuf" or masses.ndim != 1:
        return None
    if not (masses > 0.0).all():
        have_none = masses == 0.0
        if names is None or not are_called_sites(names[have_none]).all():
            return None
    different, which = np.unique(masses, return_inverse=True)
    known, symbols = _known_masses()
    if len(different) > len(known) or not np.isfinite(different).all():
        return None
    nearest = np.abs(different[:, None] - known).argmin(axis=1)
    off = np.abs(different - known[nearest])
    near = np.where(nearest == 0, 0.0, np.maximum(_ROUNDED, _ROUNDED_HEAVY * known[nearest]))
    are_whole = bool((different == np.rint(different)).all())
    if are_whole or (off > near).any():
        return None
    found: NDArray[np.str_] = symbols[nearest][which]
    return found


@cache
def _known_masses() -> "tuple[NDArray[np.float64], NDArray[np.str_]]":
    """Return masses, in u, and what has them; what has none is the first."""
    import numpy as np

    weights = np.array(_WEIGHTS.split(), np.float64)
    are_known = ~np.isnan(weights)
    masses = [0.0, *weights[are_known], *_WITH_HYDROGEN]
    symbols = np.array(SYMBOLS[1 : len(weights) + 1])[are_known]
    return np.array(masses), np.array([NO_ELEMENT, *symbols, *_WITHOUT])
