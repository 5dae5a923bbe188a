"""H5MD: trajectories in HDF5 files.

References
----------
https://www.nongnu.org/h5md/h5md.html
"""

from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.checks.object_column import without_objects
from vtray.scene.particles.column_names import name_columns
from vtray.scene.particles.few_names import texts_of
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.libraries import check_bytes

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Cell = NDArray[np.float64]

_NOT = ("position", "box")
"""What of a group of particles is no column."""

_COPIES = 2
"""How many copies of an array are in memory at once."""


def is_h5md(file: Any) -> bool:  # noqa: ANN401
    """Tell whether an HDF5 file is one of H5MD."""
    return "h5md" in file and "particles" in file


def count(file: Any) -> int:  # noqa: ANN401
    """Return how many frames there are."""
    position = _group_of(file)["position"]
    return len(position["value"]) if _changes(position) else 1


def read_frame(file: Any, number: int) -> Particles:  # noqa: ANN401
    """Read a frame, from 0, of the first group of particles that has places.

    Columns are what else is known of each particle, by its name in the file: ``velocity``,
    ``force``, ``species`` (a ``type``), ``mass``, ``charge`` and more. The edges of the box are the
    cell; where its faces are not said to be periodic, nothing repeats.

    Raises
    ------
    SceneError
        There are no places.
    """
    import numpy as np

    group = _group_of(file)
    positions = _values(group["position"], number)
    if positions is None:
        raise SceneError(f"frame {number}: expected places, got none")
    columns: dict[str, Array] = {}
    for name in group:
        if name in _NOT:
            continue
        values = _values(group[name], number)
        if values is not None and values.ndim in (1, 2) and len(values) == len(positions):
            columns[name] = _names_of(group[name], values)
    cell, periodic = _box_of(group, number)
    times: Any = group["position"].get("time") if _changes(group["position"]) else None
    is_each = times is not None and times.ndim == 1 and len(times) > number
    return Particles(
        np.array(positions),
        name_columns(columns),
        cell=cell,
        periodic=periodic,
        frame=number,
        time=float(times[number]) if is_each else None,
    )


def _group_of(file: Any) -> Any:  # noqa: ANN401
    """Return the first group of particles that has places."""
    for group in file["particles"].values():
        if hasattr(group, "keys") and "position" in group:
            position = group["position"]
            if not _changes(position) or "value" in position:
                return group
    raise SceneError("expected particles/.../position/value, as H5MD has it; there is none")


def _changes(element: Any) -> bool:  # noqa: ANN401
    """Tell whether something is kept for each frame, in a group: once for all, it is an array."""
    return hasattr(element, "keys")


def _values(element: Any, number: int) -> Any:  # noqa: ANN401
    """Return what is known of particles at a frame; None if nothing is."""
    if not _changes(element):
        check_bytes(_COPIES * element.nbytes)
        return element[...] if element.shape else None
    values = element.get("value")
    if values is None or values.ndim < 2 or len(values) <= number:
        return None
    check_bytes(_COPIES * values.nbytes // len(values))
    return values[number]


def _names_of(element: Any, values: "Array") -> "Array":  # noqa: ANN401
    """Return numbers as the names that they stand for, if there are some, or as integers."""
    import numpy as np

    stored = element["value"] if _changes(element) else element
    names = (stored.dtype.metadata or {}).get("enum")
    if isinstance(names, dict):
        texts = {number: name for name, number in names.items()}
        return texts_of(values.tolist(), lambda number: texts.get(number, str(number)))
    if element.name.endswith("/species") and values.dtype.kind == "f":
        whole = values.astype(np.int64)
        return whole if np.array_equal(whole, values) else values
    return values


def _box_of(group: Any, number: int) -> "tuple[Cell | None, tuple[bool, ...] | None]":  # noqa: ANN401
    """Return the cell at a frame, and along which edges it repeats."""
    import numpy as np

    box = group.get("box")
    if box is None or "edges" not in box:
        return None, None
    edges = box["edges"]
    values = edges["value"][min(number, len(edges["value"]) - 1)] if _changes(edges) else edges[...]
    cell = np.array(values, np.float64)
    cell = np.diag(cell) if cell.ndim == 1 else cell
    if cell.shape != (3, 3) or not cell.any():
        return None, None
    words = without_objects(np.array(box.attrs.get("boundary", ()))).ravel().tolist()
    return cell, tuple(word == "periodic" for word in words) if len(words) == 3 else None
