"""Particles of objects of RDKit, pymatgen, MDTraj and Biotite.

None of the libraries is imported: what an object is, is told by its attributes.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.checks.object_column import without_objects
from vtray.scene.particles.column_names import name_columns
from vtray.scene.particles.elements import symbols_among, symbols_of
from vtray.scene.particles.particles import Particles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_NM = 10.0
"""A nanometre in ångström."""

_BIOTITE = {
    "atom_name": "name",
    "res_name": "resname",
    "res_id": "resid",
    "chain_id": "chain",
    "b_factor": "tempfactor",
}
"""What Biotite calls columns, where its name is another."""


def particles_in(given: Any) -> Particles | None:  # noqa: ANN401
    """Return the particles of an object of one of these libraries, in ångström; None if it is none.

    Raises
    ------
    SceneError
        It has no places, or several frames.
    """
    if hasattr(given, "GetConformer") and hasattr(given, "GetAtoms"):
        return _of_rdkit(given)
    if hasattr(given, "cart_coords") and hasattr(given, "site_properties"):
        return _of_pymatgen(given)
    if hasattr(given, "xyz") and hasattr(given, "topology") and hasattr(given, "n_frames"):
        return _of_mdtraj(given)
    if hasattr(given, "coord") and hasattr(given, "get_annotation_categories"):
        return _of_biotite(given)
    return None


def _of_rdkit(molecule: Any) -> Particles:  # noqa: ANN401
    """Return the atoms and bonds of a molecule of RDKit, in its first conformer."""
    import numpy as np

    if molecule.GetNumConformers() == 0:
        remedy = "AllChem.EmbedMolecule(molecule) of RDKit finds some"
        raise SceneError(f"the molecule has no places; {remedy}")
    numbers = [atom.GetAtomicNum() for atom in molecule.GetAtoms()]
    bonds = [(bond.GetBeginAtomIdx(), bond.GetEndAtomIdx()) for bond in molecule.GetBonds()]
    return Particles(
        np.array(molecule.GetConformer().GetPositions()),
        {"element": symbols_of(numbers)},
        bonds=np.array(bonds, np.int64).reshape(-1, 2),
    )


def _of_pymatgen(structure: Any) -> Particles:  # noqa: ANN401
    """Return the sites of a structure or a molecule of pymatgen, with what is mostly there."""
    import numpy as np

    names = [max(site.species.items(), key=lambda part: part[1])[0].symbol for site in structure]
    elements = symbols_among(np.array(names, np.str_))
    columns: dict[str, Array] = {} if elements is None else {"element": elements}
    for name, values in structure.site_properties.items():
        column = np.array(values)
        if column.dtype.kind in "biufU" and column.ndim <= 2:
            columns[name] = column
    lattice = getattr(structure, "lattice", None)
    return Particles(
        np.array(structure.cart_coords),
        name_columns(columns),
        cell=None if lattice is None else np.array(lattice.matrix),
        periodic=None if lattice is None else tuple(map(bool, lattice.pbc)),
    )


def _of_mdtraj(trajectory: Any) -> Particles:  # noqa: ANN401
    """Return the atoms of the only frame of a trajectory of MDTraj."""
    import numpy as np

    _check_single(trajectory.n_frames, "frame")
    topology = trajectory.topology
    atoms = list(topology.atoms)
    columns = columns_of_atoms(atoms)
    columns["resid"] = np.array([atom.residue.resSeq for atom in atoms])
    pairs = [(one.index, two.index) for one, two in topology.bonds]
    cell = trajectory.unitcell_vectors
    return Particles(
        np.array(trajectory.xyz[0]) * np.float32(_NM),
        columns,
        bonds=bonds_of_pairs(pairs),
        cell=None if cell is None else np.array(cell[0], np.float64) * _NM,
        time=float(trajectory.time[0]),
    )


def columns_of_atoms(atoms: Sequence[Any]) -> "dict[str, Array]":
    """Return the elements, if they are known, names and residues of atoms of MDTraj or OpenMM."""
    import numpy as np

    symbols = [atom.element.symbol if atom.element else "" for atom in atoms]
    elements = symbols_among(np.array(symbols, np.str_))
    columns: dict[str, Array] = {} if elements is None else {"element": elements}
    columns["name"] = np.array([atom.name for atom in atoms], np.str_)
    columns["resname"] = np.array([atom.residue.name for atom in atoms], np.str_)
    return columns


def bonds_of_pairs(pairs: Sequence[tuple[int, int]]) -> "Array | None":
    """Return pairs of atoms as bonds; None where a topology has none."""
    import numpy as np

    return np.array(pairs, np.int64).reshape(-1, 2) if pairs else None


def _of_biotite(atoms: Any) -> Particles:  # noqa: ANN401
    """Return the atoms of an array of Biotite, or of a stack of one."""
    import numpy as np

    places, box = np.array(atoms.coord), atoms.box
    if places.ndim == 3:
        _check_single(len(places), "model")
        places, box = places[0], None if box is None else box[0]
    columns: dict[str, Array] = {}
    for name in atoms.get_annotation_categories():
        columns[_BIOTITE.get(name, name)] = without_objects(np.array(getattr(atoms, name)))
    elements = symbols_among(columns.pop("element", np.zeros(0, np.str_)))
    if elements is not None:
        columns = {"element": elements, **columns}
    return Particles(
        places,
        columns,
        bonds=None if atoms.bonds is None else atoms.bonds.as_array()[:, :2].astype(np.int64),
        cell=None if box is None else np.array(box, np.float64),
    )


def _check_single(count: int, what: str) -> None:
    """Raise SceneError if there is not one frame, or what else there is one of."""
    if count != 1:
        raise SceneError(f"expected one {what}, got {count}; give one of them, such as given[-1]")
