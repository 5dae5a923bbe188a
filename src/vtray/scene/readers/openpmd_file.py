"""openPMD: particles of plasmas and beams in HDF5 files, as WarpX, PIConGPU and others write them.

References
----------
https://github.com/openPMD/openPMD-standard/blob/1.1.0/STANDARD.md
"""

import math
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.particles.column_names import name_columns
from vtray.scene.particles.from_columns import columns_among
from vtray.scene.particles.joined_groups import joined_groups
from vtray.scene.particles.particles import POSITION, Particles
from vtray.scene.readers.libraries import check_bytes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vtray.scene.particles.joined_groups import Group

    Array = NDArray[Any]

_BASE, _PARTICLES = "data", "particles"
"""Where the iterations are, and in one of these the species, as the standard has it."""

_PLACES = ("position", "positionOffset")
"""What together is where particles are."""

_PATCHES = "particlePatches"
"""What of a species is nothing of its particles: which process had which of them."""

_COPIES = 3
"""How many copies of an array are in memory at once."""


def iterations_of(file: Any) -> list[Any]:  # noqa: ANN401
    """Return the groups of the iterations with particles, in the order of their numbers.

    There are none in an HDF5 file that is not one of openPMD.
    """
    groups = _groups_in(file.get(_BASE)) if "openPMD" in file.attrs else {}
    numbers = sorted(filter(str.isdecimal, groups), key=int)
    return [groups[number] for number in numbers if _species_of(groups[number])]


def read_iteration(iteration: Any, number: int) -> Particles:  # noqa: ANN401
    """Read an iteration, which is a frame of this number, given its group.

    All species are read, whose names are the ``type`` if there are several. Places are in metres,
    the time is in seconds, and all else is in units of the SI, as the file says what they are.
    Where places have two coordinates, the third is 0.

    Raises
    ------
    SceneError
        There are no places, or they are not for each particle.
    """
    species = _species_of(iteration).items()
    groups: list[Group] = [(name, _columns_of(group)) for name, group in species]
    columns = joined_groups(groups)
    positions = columns.pop("position")
    time: Any = iteration.attrs.get("time")
    seconds = None if time is None else float(time) * float(iteration.attrs.get("timeUnitSI", 1.0))
    return Particles(positions, name_columns(columns), frame=number, time=seconds)


def _species_of(iteration: Any) -> dict[str, Any]:  # noqa: ANN401
    """Return the groups of the species of an iteration, by their names; those with places."""
    groups = _groups_in(iteration.get(_PARTICLES))
    return {name: species for name, species in groups.items() if _PLACES[0] in species}


def _groups_in(node: Any) -> dict[str, Any]:  # noqa: ANN401
    """Return the groups in a group, by their names; none in an array, or in what is not there."""
    inner = node.items() if hasattr(node, "keys") else ()
    return {name: group for name, group in inner if hasattr(group, "keys")}


def _columns_of(species: Any) -> "dict[str, Array]":  # noqa: ANN401
    """Return what is known of the particles of a species, their places first."""
    import numpy as np

    place = _components_of(species[_PLACES[0]])
    offset = _components_of(species[_PLACES[1]]) if _PLACES[1] in species else {}
    rows = max((_length(of) for of in place.values()), default=0)
    lengths = {_length(of[axis]) for of in (place, offset) for axis in POSITION if axis in of}
    if not set(place) & {*POSITION} or lengths != {rows}:
        raise SceneError(f"{species.name}: expected positions x, y and z, got {', '.join(place)}")
    check_bytes(_COPIES * 8 * len(POSITION) * rows)
    positions = np.zeros((rows, len(POSITION)))
    for k, axis in enumerate(POSITION):
        for of in (place, offset):
            if axis in of:
                positions[:, k] += _values(of[axis])
    records = {name: of for name, of in species.items() if name not in (*_PLACES, _PATCHES)}
    arrays = {name: _record(of) for name, of in records.items()}
    return {"position": positions, **columns_among(arrays, rows)}


def _record(record: Any) -> "Array":  # noqa: ANN401
    """Return a record: a number for each particle, or a vector."""
    import numpy as np

    if _is_component(record):
        return _values(record)
    parts = [_values(of) for of in _components_of(record).values()]
    same = parts and len({len(part) for part in parts}) == 1
    return np.stack(parts, axis=1) if same else np.zeros(0)


def _components_of(record: Any) -> dict[str, Any]:  # noqa: ANN401
    """Return the components of a vector, by their names."""
    if not hasattr(record, "keys"):
        return {}
    return {name: record[name] for name in record if _is_component(record[name])}


def _is_component(given: Any) -> bool:  # noqa: ANN401
    """Tell whether something has numbers: an array, or one number for all."""
    return given.ndim == 1 if hasattr(given, "ndim") else "value" in given.attrs


def _length(component: Any) -> int:  # noqa: ANN401
    """Return how many particles a component is of."""
    if hasattr(component, "ndim"):
        return len(component)
    import numpy as np

    return math.prod(np.array(component.attrs.get("shape", ())).ravel().tolist())


def _values(component: Any) -> "Array":  # noqa: ANN401
    """Return the numbers of a component, in units of the SI."""
    import numpy as np

    values: Array
    check_bytes(_COPIES * 8 * _length(component))
    if hasattr(component, "ndim"):
        values = component[...]
        values = values.astype(values.dtype.newbyteorder("="), copy=False)
    else:
        values = np.full(_length(component), component.attrs["value"])
    unit = float(component.attrs.get("unitSI", 1.0))
    return values if unit == 1.0 else values * unit
