"""Sites of molecules that are no atoms: charges beside oxygen, in models of water and the like."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from vtray.scene.particles.elements import NO_ELEMENT

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Booleans = NDArray[np.bool_]

_CALLED = """
    M M1 M2 MW MW1 MW2 MW3 MW4 OM EP EP1 EP2 EP3 EP4 EPW LP LP1 LP2 LP3 LP4 LPA LPB VRT
"""
_NAMES = frozenset(_CALLED.split())
"""What CHARMM, AMBER, GROMACS, OpenMM and Desmond call them."""


def are_called_sites(names: "Array") -> "Booleans":
    """Tell which names of atoms are those of sites, (n,)."""
    import numpy as np

    return np.fromiter(map(_NAMES.__contains__, names.tolist()), np.bool_, len(names))


def are_sites(columns: "Mapping[str, Array]") -> "Booleans | None":
    """Tell which particles are sites: no elements, and called so, (n,); None if none is."""
    elements, names = columns.get("element"), columns.get("name")
    if elements is None or names is None:
        return None
    found = elements == NO_ELEMENT
    if not found.any():
        return None
    found[found] = are_called_sites(names[found])
    return found if found.any() else None
