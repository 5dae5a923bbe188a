"""Beads that stand for several atoms, whose names only look like those of atoms.

References
----------
S. J. Marrink et al., The MARTINI force field, J. Phys. Chem. B 2007, 111, 7812.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_NAMES = frozenset({"BB", "SC1", "GL1", "NC3", "PO4", "ROH", "W", "WF", "PW"})
"""Of the backbone and side chains of proteins, of lipids and of water in Martini."""


def are_beads(names: "Array | None") -> bool:
    """Tell whether the names of particles, if there are some, are those of beads."""
    return names is not None and not _NAMES.isdisjoint(names.tolist())


def types_of_beads(names: "Array") -> "Array":
    """Return what tells beads apart, of which there are as many names as in a molecule: letters."""
    return names.astype("U1")
