"""Sites of molecules that are no atoms: charges beside oxygen, in models of water and the like."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from vtray.scene.particles.elements import NO_ELEMENT

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Booleans = NDArray[np.bool_]

_WATER = ("M", "M1", "M2", "MW", "MW1", "MW2", "MW3", "MW4", "OM", "EP", "EPW", "VRT")
_NAMES = (*_WATER, "EP1", "EP2", "EP3", "EP4", "LP", "LP1", "LP2", "LP3", "LP4", "LPA", "LPB")
"""What CHARMM, AMBER, GROMACS, OpenMM and Desmond call them."""


def are_called_sites(names: "Array") -> "Booleans":
    """Tell which names of atoms are those of sites, (n,)."""
    import numpy as np

    found: NDArray[np.bool_] = np.isin(names, _NAMES)
    return found


def are_sites(columns: "Mapping[str, Array]") -> "Booleans | None":
    """Tell which particles are sites: no elements, and called so, (n,); None if none is."""
    elements, names = columns.get("element"), columns.get("name")
    if elements is None or names is None:
        return None
    found = elements == NO_ELEMENT
    if not found.any():
        return None
    found &= are_called_sites(names)
    return found if found.any() else None
