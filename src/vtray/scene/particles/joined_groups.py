"""Groups of particles, such as gas and stars, as one."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Group: TypeAlias = tuple[str, dict[str, Array]]
    """The name of a group, and its columns."""


def joined_groups(groups: "Sequence[Group]") -> "dict[str, Array]":
    """Return the columns of several groups as one.

    Parameters
    ----------
    groups
        At least one; what has the same name is one group. Each has at least one column.

    Returns
    -------
    columns : dict of str to ndarray
        With the name of the group as ``type``, if there are several. What is not known in one is
        NaN there, or a text without letters; what is not the same thing in all is left out.
    """
    import numpy as np

    counts = [len(next(iter(columns.values()))) for _, columns in groups]
    names = [name for name, _ in groups]
    found: dict[str, Array] = {}
    if len(set(names)) > 1:
        found["type"] = np.repeat(names, counts).astype(np.str_)
    for name, values in joined_columns([columns for _, columns in groups], counts).items():
        found["type2" if name == "type" and "type" in found else name] = values
    return found


def joined_columns(
    parts: "Sequence[Mapping[str, Array]]", counts: Sequence[int]
) -> "dict[str, Array]":
    """Return the columns of several parts as those of one, one part after the other.

    What is not known in a part is NaN there, or a text without letters; what is not the same thing
    in all that know it, as a vector and a number, is left out.

    Parameters
    ----------
    parts
        The columns of each, by their names.
    counts
        How many rows each has.
    """
    import numpy as np

    if len(parts) == 1:
        return dict(parts[0])
    found: dict[str, Array] = {}
    for name in dict.fromkeys(name for part in parts for name in part):
        known = [part[name] for part in parts if name in part]
        if len({(of.ndim, of.shape[1:], of.dtype.kind == "U") for of in known}) > 1:
            continue
        lacking = np.str_("") if known[0].dtype.kind == "U" else np.nan
        columns = [
            part[name] if name in part else np.full((count, *known[0].shape[1:]), lacking)
            for part, count in zip(parts, counts, strict=True)
        ]
        found[name] = np.concatenate(columns)
    return found
