"""Particles of objects that other libraries make.

None of the libraries is imported: what an object is, is told by its attributes.
"""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.base.number import is_number, number_of
from vtray.scene.checks.given_array import (
    UNCONVERTED,
    array_of,
    check_unmasked,
    converted,
    fields_of,
    positions_in,
    remedy_for,
    show_array,
    show_unconverted,
)
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.object_column import without_objects
from vtray.scene.particles.beads import are_beads, types_of_beads
from vtray.scene.particles.column_names import name_columns, name_twice
from vtray.scene.particles.elements import are_symbols, symbols_among, symbols_of
from vtray.scene.particles.few_names import texts_of
from vtray.scene.particles.from_astronomy import particles_of_astronomy
from vtray.scene.particles.from_chemistry import particles_in
from vtray.scene.particles.from_columns import from_columns
from vtray.scene.particles.from_meshes import particles_of_mesh
from vtray.scene.particles.from_simulation import particles_of_simulation
from vtray.scene.particles.masses import elements_of_masses
from vtray.scene.particles.pairs import reach_residues
from vtray.scene.particles.particles import Particles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_RESULTS = ("forces", "charges", "magmoms", "energies")
"""What calculators of ASE find for each atom."""

_ATTRIBUTES = {
    "elements": "element",
    "names": "name",
    "types": "type",
    "resnames": "resname",
    "resids": "resid",
    "segids": "segid",
    "chainIDs": "chain",
    "charges": "charge",
    "masses": "mass",
    "radii": "radius",
    "tempfactors": "tempfactor",
    "occupancies": "occupancy",
}
"""What MDAnalysis may know of each atom, and what the column is called."""

_OVITO = {"Atom Name": "name", "Residue Type": "resname", "Molecule Identifier": "mol"}
"""What OVITO calls columns, where its name is not that of the column in other words."""


def from_ase(atoms: Any) -> Particles:  # noqa: ANN401
    """Return the particles of an object of ASE.

    Parameters
    ----------
    atoms : ase.Atoms
        In ASE's units: Å, eV and what follows from them.

    Returns
    -------
    Particles
        With the columns ``element`` (or ``type`` where all are unknown), ``velocity`` where there
        are momenta, what a calculator has found (``force``, ``charge``, ``magmom``), what it began
        with (``initial_charge``, ``initial_magmom``), and all other arrays by their names; and
        with the cell.

    Raises
    ------
    SceneError
        It is no such object.

    Examples
    --------
    >>> from ase.build import molecule
    >>> import vtray
    >>> vtray.from_ase(molecule("H2O"))
    Particles(3 particles, element)
    """
    import numpy as np

    if not is_ase(atoms):
        raise SceneError(f"from_ase: expected ase.Atoms, got {show_array(atoms)}")
    count = len(atoms)
    numbers = np.asarray(atoms.get_atomic_numbers())
    columns: dict[str, Any] = {"element": symbols_of(numbers)} if numbers.any() else {}
    if "momenta" in atoms.arrays:
        columns["velocity"] = atoms.get_velocities()
    others = {**atoms.arrays, **_results(atoms)}
    for name, values in others.items():
        if name not in ("numbers", "positions", "momenta"):
            columns[name] = np.asarray(values).reshape(count, -1) if values.ndim > 2 else values
    return Particles(
        np.array(atoms.positions, np.float64),
        name_columns(columns),
        cell=np.array(atoms.cell),
        origin=np.array(atoms.get_celldisp(), np.float64).reshape(3),
        periodic=tuple(map(bool, atoms.pbc)),
        time=_time(atoms.info.get("time", atoms.info.get("Time"))),
    )


def from_mdanalysis(group: Any) -> Particles:  # noqa: ANN401
    """Return the particles of a universe, or of a group of its atoms, at its current frame.

    Parameters
    ----------
    group : MDAnalysis.Universe or AtomGroup
        In MDAnalysis' units: Å, ps, u and e.

    Returns
    -------
    Particles
        With the columns that its topology knows: ``element``, ``name``, ``type``, ``resname``,
        ``resid``, ``segid``, ``chain``, ``charge``, ``mass``, ``radius``; with ``velocity`` and
        ``force`` where the frame has them; with its time, if the trajectory tells it; with the
        bonds of the topology, for those of a PDB file where they are all, and the cell.

    Raises
    ------
    SceneError
        It is no such object.
    """
    import numpy as np

    if not is_mdanalysis(group):
        problem = "expected a Universe or an AtomGroup of MDAnalysis"
        raise SceneError(f"from_mdanalysis: {problem}, got {show_array(group)}")
    universe, atoms = group.universe, group.atoms
    if not hasattr(universe, "trajectory"):
        remedy = 'load them first, as in universe.load_new("run.xtc")'
        raise SceneError(f"from_mdanalysis: the Universe has no places; {remedy}")
    now = universe.trajectory.ts
    columns: dict[str, Array] = {}
    for attribute, name in _ATTRIBUTES.items():
        if hasattr(atoms, attribute):
            columns[name] = without_objects(np.asarray(getattr(atoms, attribute)))
    elements = _elements_of(columns, universe)
    columns.pop("element", None)
    if elements is not None:
        columns = {"element": elements, **columns}
    elif _are_guessed(universe, "types") and are_beads(columns.get("name")):
        columns["type"] = types_of_beads(columns["name"])
    if now.has_velocities:
        columns["velocity"] = np.array(atoms.velocities)
    if now.has_forces:
        columns["force"] = np.array(atoms.forces)
    cell = now.triclinic_dimensions
    # A topology that has places itself has no frames.
    is_frame = now.frame >= 0
    return Particles(
        np.array(atoms.positions),
        name_columns(columns),
        bonds=_bonds_within(universe, np.asarray(atoms.indices)),
        cell=None if cell is None else np.array(cell, np.float64),
        frame=int(now.frame) if is_frame else 0,
        time=_time(now.time) if is_frame and _has_time(universe.trajectory) else None,
    )


def _columns_of(table: Any, names: Iterable[Any]) -> "dict[str, Array]":  # noqa: ANN401
    """Return the columns of a table by their names.

    Raises
    ------
    SceneError
        One is no array, or some of its entries are masked; or two have one name.
    """
    listed = list(names)
    twice = name_twice([str(name) for name in listed])
    if twice is not None:
        raise SceneError(f"expected each column once, got {short(twice)!r} twice")
    words = "expected a value for each particle"
    return {str(name): array_of(table[name], f"column {str(name)!r}", words) for name in listed}


def as_particles(given: Any, place: str = "") -> Particles:  # noqa: ANN401
    """Return the particles of whatever has places.

    Parameters
    ----------
    given
        `Particles`; objects of ASE, MDAnalysis, OVITO, RDKit, pymatgen, MDTraj, Biotite, OpenMM,
        ParmEd, HOOMD-blue, freud, yt, pynbody, PyVista or meshio; what has ``positions`` or
        ``get_positions()``; tables, mappings and structured arrays with the columns x, y and z; or
        an array (n, 3).
    place
        What messages begin with.

    Raises
    ------
    SceneError
        It is none of these.
    """
    try:
        return _particles_of(given)
    except SceneError as error:
        raise SceneError(f"{place}{error}") from None


def _particles_of(given: Any) -> Particles:  # noqa: ANN401
    """Return what `as_particles` does."""
    if isinstance(given, Particles):
        return given
    if is_ase(given):
        return from_ase(given)
    if is_mdanalysis(given):
        return from_mdanalysis(given)
    inner = getattr(given, "particles", None)
    if inner is not None and hasattr(inner, "positions"):
        return _from_ovito(given)
    for find in (
        particles_in,
        particles_of_simulation,
        particles_of_astronomy,
        particles_of_mesh,
    ):
        found = find(given)
        if found is not None:
            return found
    if isinstance(given, Mapping):
        return from_columns(_columns_of(given, given))
    if fields_of(given):
        return from_columns(_columns_of(given, fields_of(given)))
    if hasattr(given, "shape") and hasattr(given, "columns"):
        # Those of pyarrow have their names apart.
        return from_columns(_columns_of(given, getattr(given, "column_names", given.columns)))
    return _from_positions(given)


def _from_positions(given: Any) -> Particles:  # noqa: ANN401
    """Return the particles of what has nothing but places."""
    places = positions_in(given)
    check_unmasked(places, "positions")
    try:
        positions = without_objects(converted(places))
    except UNCONVERTED as error:
        got = show_unconverted(given, error)
    else:
        if positions.ndim == 2 and positions.shape[1] == 3 and positions.dtype.kind in "iuf":
            return Particles(positions)
        got = show_array(given)
        if positions.ndim == 2 and positions.shape[0] == 3 != positions.shape[1]:
            got += " (transpose it)"
    problem = "expected vtray.Particles, an object of ASE, MDAnalysis or OVITO, a table with the"
    got = f"{got}{remedy_for(places, ())}"
    raise SceneError(f"{problem} columns x, y and z, or an array (n, 3), got {got}")


def _from_ovito(data: Any) -> Particles:  # noqa: ANN401
    """Return the particles of a data collection of OVITO."""
    import numpy as np

    inner = data.particles
    columns: dict[str, Array] = {}
    for name in inner.keys():  # noqa: SIM118  it is no dictionary
        if name != "Position":
            columns[_OVITO.get(name, str(name))] = _values_of(inner[name])
    types = getattr(inner, "particle_types", None)
    if types is not None:
        columns.pop("Particle Type", None)
        columns["element"] = _values_of(types)
    bonds = getattr(inner, "bonds", None)
    cell = getattr(data, "cell", None)
    edges = None if cell is None else np.array(cell[...], np.float64)
    return Particles(
        np.array(inner.positions),
        name_columns(columns),
        bonds=None if bonds is None else np.array(bonds["Topology"]),
        cell=None if edges is None else edges[:, :3].T,
        origin=(0.0, 0.0, 0.0) if edges is None else edges[:, 3],
        periodic=None if cell is None else tuple(map(bool, cell.pbc)),
    )


def _values_of(entries: Any) -> "Array":  # noqa: ANN401
    """Return a property of OVITO, with the names of types instead of their numbers."""
    import numpy as np

    types = getattr(entries, "types", ())
    if len(types):
        names = {kind.id: kind.name or str(kind.id) for kind in types}
        return texts_of(np.asarray(entries).tolist(), lambda kind: names.get(kind, str(kind)))
    # Texts of any length are not given as an array.
    return np.array(list(entries) if entries.dtype.kind == "T" else entries)


def is_ase(given: Any) -> bool:  # noqa: ANN401
    """Tell whether an object is atoms of ASE."""
    return hasattr(given, "get_atomic_numbers") and hasattr(given, "get_celldisp")


def is_mdanalysis(given: Any) -> bool:  # noqa: ANN401
    """Tell whether an object is a universe of MDAnalysis, or a group of its atoms."""
    return hasattr(given, "universe") and hasattr(given, "atoms")


def _results(atoms: Any) -> "dict[str, Array]":  # noqa: ANN401
    """Return what a calculator has found for each atom, and nothing that it would have to find."""
    import numpy as np

    found = getattr(atoms.calc, "results", None) or {}
    arrays = {name: np.asarray(found[name]) for name in _RESULTS if found.get(name) is not None}
    return {name: values for name, values in arrays.items() if len(values) == len(atoms)}


def _elements_of(columns: "dict[str, Array]", universe: Any) -> "Array | None":  # noqa: ANN401
    """Return the elements of atoms by what tells them most surely; None if nothing does.

    That is what the topology calls them; their masses; what MDAnalysis takes their names for; and
    their types, where all are symbols. X is what is none, such as the sites without mass of some
    models of water.
    """
    wanted = ("element", "mass", "name", "type")
    elements, masses, names, types = (columns.get(name) for name in wanted)
    by_names = None if elements is None else symbols_among(elements)
    if by_names is not None and not _are_guessed(universe, "elements"):
        return by_names
    if masses is not None and not _are_guessed(universe, "masses"):
        by_masses = elements_of_masses(masses, names)
        if by_masses is not None:
            return by_masses
    if are_beads(names):
        return None
    if by_names is not None or types is None or types.dtype.kind != "U":
        return by_names
    if _are_guessed(universe, "types"):
        return symbols_among(types)
    return types if are_symbols(types.tolist()) else None


def _are_guessed(universe: Any, attribute: str) -> bool:  # noqa: ANN401
    """Tell whether MDAnalysis has guessed what it knows of atoms, as by their names."""
    known = getattr(getattr(universe, "_topology", None), attribute, None)
    return bool(getattr(known, "is_guessed", False))


def _has_time(trajectory: Any) -> bool:  # noqa: ANN401
    """Tell whether a frame of MDAnalysis has a time; others count 1 ps for each frame."""
    return not {"time", "dt"}.isdisjoint(trajectory.ts.data) or hasattr(trajectory, "_get_dt")


def _bonds_within(universe: Any, chosen: "Array") -> "Array | None":  # noqa: ANN401
    """Return the bonds between chosen atoms, by their places among these.

    Those of PDB files, where atoms have a type of record, may be but a few of all: then None.
    """
    import numpy as np

    pairs = bonds_of(universe)
    if pairs is None:
        return None
    atoms = universe.atoms
    if hasattr(atoms, "record_types") and not reach_residues(pairs, np.asarray(atoms.resindices)):
        return None
    places = np.full(len(atoms), -1)
    places[chosen] = np.arange(len(chosen))
    bonds: Array = places[pairs]
    within: Array = bonds[(bonds >= 0).all(axis=1)]
    return within


def bonds_of(universe: Any) -> "Array | None":  # noqa: ANN401
    """Return the bonds of a topology as pairs of atoms, in their order; None if it knows none.

    What MDAnalysis keeps is as ``universe.bonds.indices`` has them, which takes 20 times as long,
    for each frame of a movie.
    """
    import numpy as np

    known = getattr(getattr(universe, "_topology", None), "bonds", None)
    kept = getattr(known, "values", None)
    if isinstance(kept, (list, tuple)):
        pairs: Array = np.array(kept, np.int64).reshape(-1, 2)
        return np.unique(pairs, axis=0)
    bonds = getattr(universe, "bonds", None)
    return None if bonds is None else np.asarray(bonds.indices, np.int64).reshape(-1, 2)


def _time(value: object) -> float | None:
    """Return a time, if it is a number."""
    return number_of(value) if is_number(value) else None
