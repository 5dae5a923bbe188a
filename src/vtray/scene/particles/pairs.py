"""Pairs of particles: bonds that are known."""

from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.checks.given_array import array_of, show_array

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def pairs_of(given: Any, count: int, place: str) -> "NDArray[np.int64]":  # noqa: ANN401
    """Return pairs of indices as an array, (m, 2).

    Parameters
    ----------
    given
        The pairs; floats where they are whole.
    count
        How many particles there are.
    place
        What messages begin with.

    Raises
    ------
    SceneError
        They are no pairs, or one has no such index.
    """
    import numpy as np

    words = "expected indices of shape (m, 2)"
    found = array_of(given, place, words)
    is_right = found.ndim == 2 and found.shape[1] == 2 and found.dtype.kind in "iuf"
    if not is_right and found.size:
        raise SceneError(f"{place}: {words}, got {show_array(given)}")
    pairs = found.reshape(-1, 2)
    is_index = (pairs >= 0) & (pairs < count) & (pairs == np.floor(pairs))  # NaN is none
    wrong = np.flatnonzero(~is_index.all(axis=1))
    if len(wrong):
        first = int(wrong[0])
        words = f"expected indices from 0 to {count - 1}, got {pairs[first].tolist()}"
        raise SceneError(f"{place}[{first}]: {words}")
    return pairs.astype(np.int64, copy=False)


def reach_residues(pairs: "NDArray[np.int64]", residues: "NDArray[Any]") -> bool:
    """Tell whether bonds reach each atom of all residues with more than one.

    Lines of bonds in PDB files are all that there are where they do, and else but a few of them.

    Parameters
    ----------
    pairs
        The bonds, (m, 2).
    residues
        What tells the residues of the atoms apart, (n,).
    """
    import numpy as np

    _, which, counts = np.unique(residues, return_inverse=True, return_counts=True)
    reached = counts[which] == 1
    reached[pairs.ravel()] = True
    return bool(reached.all())
