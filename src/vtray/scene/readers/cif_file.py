"""CIF files: crystals by ASE, and molecules of the Protein Data Bank, in mmCIF, by gemmi.

References
----------
https://www.iucr.org/resources/cif
"""

from collections.abc import Iterator
from typing import Any

from vtray.base.extras import need
from vtray.scene.particles.particles import Particles
from vtray.scene.readers import mmcif_file
from vtray.scene.readers.ase_file import read_asked, steps_of_atoms
from vtray.scene.readers.frames import Steps
from vtray.scene.readers.reader_table import Given

_OPERATIONS = (
    "_space_group_symop_operation_xyz",
    "_space_group_symop.operation_xyz",
    "_symmetry_equiv_pos_as_xyz",
)
"""Where a file may list its symmetry operations."""


def read(given: Given) -> Particles:
    """Read a structure of a file, or a model of it.

    Columns of mmCIF are those of PDB files: ``element``, ``name``, ``resname``, ``chain``,
    ``resid``, ``occupancy`` and ``tempfactor``, with ``altloc`` where there are several. The cell
    is that of files which hold all its atoms: their space group is P 1.

    Raises
    ------
    SceneError
        It cannot be read, or has no such frame.
    ExtraError
        ASE, or gemmi, is not installed.
    """
    return read_asked(steps(given), given)


def steps(given: Given) -> Steps:
    """Give what makes particles of each structure or model, one after the other."""
    is_mmcif = mmcif_file.is_mmcif(given.file.read())
    given.file.seek(0)
    return mmcif_file.steps(given.file) if is_mmcif else steps_of_atoms(given, _crystals)


def _crystals(given: Given) -> Iterator[Any]:
    """Give the structures of a file.

    ASE compares all sites with each other, 9 s for 1,728, which can be left out without symmetry.
    """
    cif: Any = need("ase.io.cif", "atoms", "reading a CIF file")
    for block in cif.parse_cif(given.path):
        if block.has_structure():
            listed = next((block[key] for key in _OPERATIONS if key in block), None)
            operations = [listed] if isinstance(listed, str) else listed or ()
            is_alone = [text.replace(" ", "").lower() for text in operations] == ["x,y,z"]
            atoms = block.get_unsymmetrized_structure() if is_alone else block.get_atoms()
            atoms.pbc = atoms.cell.rank == 3
            yield atoms
