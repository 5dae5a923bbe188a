"""The table of files of data: what they are called, and the module that reads them.

What a file is, is told by ``format=``, the ending of its name, or else how it begins.
"""

import os
from collections.abc import Mapping
from fnmatch import fnmatchcase
from typing import BinaryIO, NamedTuple

from vtray.base.errors import SceneError
from vtray.base.file_series import files_of, stands_for_several
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.scene_words import show
from vtray.scene.readers.by_content import kind_of_content
from vtray.scene.readers.packing import packing_of


class Given(NamedTuple):
    """What a reader is given.

    Attributes
    ----------
    file
        Open, at its beginning; any place can be sought.
    path
        Its name.
    format
        What the table calls files of its kind.
    frame
        From 0, or from -1, the last, backwards.
    columns
        For some names of columns, what the file calls them.
    trajectory
        A second file with the places; None if there is none.
    """

    file: BinaryIO
    path: str
    format: str
    frame: int
    columns: Mapping[str, str]
    trajectory: str | None


class Reader(NamedTuple):
    """How files of a kind are read.

    Attributes
    ----------
    what
        What they are, in words.
    module
        The module of `vtray.scene.readers`, whose function ``read`` takes what is `Given`, and
        returns `Particles`.
    names
        Endings with their dot, or patterns of whole names, such as ``POSCAR*``.
    """

    what: str
    module: str
    names: tuple[str, ...]


READERS: dict[str, Reader] = {
    "xyz": Reader("an XYZ file", "xyz_file", (".xyz", ".extxyz", ".exyz")),
    "pdb": Reader("a PDB file", "pdb_file", (".pdb", ".ent")),
    "lammps-dump": Reader("a LAMMPS dump", "lammps_dump_file", (".dump", ".lammpstrj")),
    "lammps-data": Reader(
        "a LAMMPS data file", "lammps_data_file", (".data", ".lmp", ".lammps-data")
    ),
    "gsd": Reader("a GSD file", "gsd_file", (".gsd",)),
    "csv": Reader("a CSV table", "table_file", (".csv", ".tsv")),
    "npz": Reader("a file of arrays", "table_file", (".npz", ".npy")),
    "parquet": Reader("a Parquet file", "table_file", (".parquet", ".pq")),
    "hdf5": Reader("an HDF5 file", "hdf5_file", (".h5", ".hdf5", ".h5md", ".hdf")),
    "las": Reader("a LAS file", "las_file", (".las", ".laz")),
    "ply": Reader("a PLY file", "ply_file", (".ply",)),
    "vtk": Reader(
        "a file of VTK",
        "vtk_file",
        (".vtk", ".vtu", ".vtp", ".pvtu", ".pvtp", ".vtm", ".vtmb", ".pvd"),
    ),
    "cif": Reader("a CIF file", "cif_file", (".cif", ".mmcif", ".pdbx")),
    "poscar": Reader("a POSCAR file", "ase_file", (".poscar", ".vasp", "POSCAR*", "CONTCAR*")),
    "xdatcar": Reader("an XDATCAR file", "ase_file", ("XDATCAR*",)),
    "outcar": Reader("an OUTCAR file", "ase_file", ("OUTCAR*",)),
    "vasprun": Reader("a file of VASP in XML", "ase_file", ("vasprun*.xml",)),
    "traj": Reader("a trajectory of ASE", "ase_file", (".traj",)),
    "xsf": Reader("an XSF file", "ase_file", (".xsf", ".axsf")),
    "cube": Reader("a cube file", "ase_file", (".cube", ".cub")),
    "gen": Reader("a GEN file", "ase_file", (".gen",)),
    "cfg": Reader("a CFG file", "ase_file", (".cfg",)),
    "mol": Reader("a MOL file", "ase_file", (".mol",)),
    "sdf": Reader("an SDF file", "ase_file", (".sdf",)),
    "res": Reader("a SHELX file", "ase_file", (".res",)),
    "cell": Reader("a CELL file of CASTEP", "ase_file", (".cell",)),
    "castep": Reader("an output of CASTEP", "ase_file", (".castep",)),
    "espresso-in": Reader("an input of Quantum ESPRESSO", "ase_file", (".pwi",)),
    "espresso-out": Reader("an output of Quantum ESPRESSO", "ase_file", (".pwo",)),
    "aims": Reader("a geometry of FHI-aims", "ase_file", ("geometry*.in",)),
    "mdanalysis": Reader(
        "a topology",
        "mdanalysis_file",
        (".gro", ".psf", ".tpr", ".prmtop", ".parm7", ".top", ".mol2", ".pqr", ".pdbqt"),
    ),
}
"""All kinds of files, by the names that ``format=`` takes."""


def reader_of(path: str, named: object) -> tuple[str, Reader]:
    """Return what reads a file, and the name of its kind.

    Raises
    ------
    SceneError
        Nothing reads it; the message, which follows the name of the file, lists what is read.
    """
    if named is not None:
        kind = named.lower().removeprefix(".") if isinstance(named, str) else ""
        found = READERS.get(kind)
        if found is None:
            known = ", ".join(READERS)
            raise SceneError(f"format: expected one of {known}, got {show(named)}")
        return kind, found
    base, packing = os.path.basename(path), packing_of(path)
    base = base[: len(base) - len(packing)]
    ending = os.path.splitext(base)[1].lower()
    for kind, reader in READERS.items():
        if ending in reader.names or any(fnmatchcase(base, name) for name in reader.names):
            return kind, reader
    if ending == ".json":
        raise SceneError("is a scene file by its name, which vtray.load reads; expected data")
    told = kind_of_content(path, packing)
    if told is not None:
        return told, READERS[told]
    if stands_for_several(path) and not os.path.exists(path):
        raise SceneError("no such file; expected one of data, or a pattern that some match")
    known = ", ".join(name for reader in READERS.values() for name in reader.names)
    problem = f"the ending {short(ending)!r} is not known" if ending else "the name has no ending"
    raise SceneError(f"{problem}; expected one of {known}, or format=..., such as format='xyz'")


def is_data(path: str) -> bool:
    """Tell whether a file is one of data, or a pattern stands for some."""
    try:
        reader_of(files_of(path)[0], None)
    except SceneError:
        return False
    return True
