"""Files of data but XYZ: beside what the libraries themselves read."""

import re
import subprocess
import sys
import tracemalloc
import warnings
from pathlib import Path
from typing import Any

import ase.io
import laspy
import numpy as np
import plyfile
import pyarrow as pa
import pyarrow.parquet
import pytest
from ase import Atoms
from ase.build import bulk, molecule
from ase.calculators.singlepoint import SinglePointCalculator
from ase.data import atomic_masses

import vtray
from vtray.base.errors import SceneError
from vtray.scene.particles.elements import atomic_numbers
from vtray.scene.readers import csv_columns

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import gsd.hoomd
    import MDAnalysis
    from MDAnalysisTests import datafiles

WATER = Atoms("OH2", [(0, 0, 0), (0.76, 0.59, 0), (-0.76, 0.59, 0)], cell=[4, 5, 6], pbc=True)


def quiet_write(path: Path, atoms: object, **more: object) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        ase.io.write(path, atoms, **more)


@pytest.mark.parametrize(
    "name",
    ["POSCAR", "CONTCAR_end", "a.vasp", "a.cif", "a.traj", "a.xsf", "a.gen", "a.cfg", "a.res"],
)
def test_files_of_ase(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    crystal = bulk("NaCl", "rocksalt", 5.64, cubic=True)
    form = {"POSCAR": "vasp", "CONTCAR_end": "vasp"}.get(name)
    quiet_write(path, crystal, format=form)
    found = vtray.read(path)
    assert found["element"].tolist() == crystal.get_chemical_symbols()
    assert np.abs(found.positions - crystal.positions).max() < 1e-5
    assert np.abs(found.cell - crystal.cell).max() < 1e-5


CIF = """\
data_salt
_cell_length_a 5.64
_cell_length_b 5.64
_cell_length_c 5.64
_cell_angle_alpha 90
_cell_angle_beta 90
_cell_angle_gamma 90
{symmetry}
loop_
_atom_site_label
_atom_site_type_symbol
_atom_site_fract_x
_atom_site_fract_y
_atom_site_fract_z
Na1 Na 0 0 0
Cl1 Cl 0.5 0.5 0.5
"""


@pytest.mark.parametrize(
    ("symmetry", "count"),
    [
        ("_symmetry_Int_Tables_number 225\n_symmetry_space_group_name_H-M 'F m -3 m'", 8),
        ("_symmetry_equiv_pos_as_xyz 'x, y, z'", 2),
    ],
)
def test_symmetry_of_crystals(symmetry: str, count: int, tmp_path: Path) -> None:
    path = tmp_path / "salt.cif"
    path.write_text(CIF.format(symmetry=symmetry))
    found = vtray.read(path)
    assert len(found) == count
    assert found.periodic == (True, True, True)


def test_frames_of_ase(tmp_path: Path) -> None:
    path = tmp_path / "run.traj"
    quiet_write(path, [Atoms("He", [(i, 0, 0)]) for i in range(4)])
    found = [vtray.read(path, frame) for frame in (0, 2, -1)]
    assert [(each.frame, each.positions[0, 0]) for each in found] == [(0, 0), (2, 2), (3, 3)]
    with pytest.raises(SceneError, match="frame 4: there are 4 frames; expected -4 to 3$"):
        vtray.read(path, 4)


PDB = """\
CRYST1   10.000   12.000   14.000  80.00  90.00 110.00 P 1
MODEL     1
ATOM      1  CA  GLY A   1       1.000   2.000   3.000  1.00 10.00           C
ATOM      2 HG11 VAL A   2      -1.500   2.000   3.000  0.50 20.00           H
HETATM    3 CA    CA B   3       0.000   0.000   9.125  1.00 30.00          CA
ENDMDL
MODEL     2
ATOM      1  CA  GLY A   1       7.000   2.000   3.000  1.00 10.00           C
ENDMDL
END
"""


@pytest.mark.parametrize(
    ("group", "is_whole"), [("P 1", True), ("P1", True), ("", True), ("P 61", False)]
)
def test_pdb_has_a_cell_where_its_atoms_are_all_that_it_repeats(
    group: str, is_whole: bool, tmp_path: Path
) -> None:
    path = tmp_path / "a.pdb"
    path.write_text(PDB.replace("P 1", f"{group:11}   6"))
    assert (vtray.read(path).cell is not None) == is_whole


def test_pdb(tmp_path: Path) -> None:
    path = tmp_path / "a.pdb"
    path.write_text(PDB)
    found = vtray.read(path)
    assert {name: values.tolist() for name, values in found.columns.items()} == {
        "element": ["C", "H", "Ca"],
        "name": ["CA", "HG11", "CA"],
        "resname": ["GLY", "VAL", "CA"],
        "chain": ["A", "A", "B"],
        "resid": [1, 2, 3],
        "occupancy": [1, 0.5, 1],
        "tempfactor": [10, 20, 30],
    }
    theirs = ase.io.read(path, 0)
    assert found.positions.tolist() == theirs.positions.tolist()
    assert np.abs(found.cell - theirs.cell).max() < 1e-12
    last = vtray.read(path, -1)
    assert (len(last), last.frame, last.positions[0, 0]) == (1, 1, 7)
    path.write_text(PDB.replace("          CA\n", "          QQ\n"))
    assert vtray.read(path)["element"].tolist() == ["C", "H", "X"]
    # Without the columns of elements, the place of the name tells calcium from alpha carbon.
    path.write_text("".join(f"{line[:76]}\n" for line in PDB.splitlines()))
    assert vtray.read(path)["element"].tolist() == ["C", "H", "Ca"]


LIGAND = """\
HETATM    7  C1  LIG A   1       1.000   0.000   0.000  1.00 10.00           C
HETATM    8  C2  LIG A   1       2.500   0.000   0.000  1.00 10.00           C
HETATM    9  O   HOH A   2       9.000   0.000   0.000  1.00 10.00           O
CONECT    7    8    8
CONECT    8    7    7   99
"""


def test_bonds_of_pdb(tmp_path: Path) -> None:
    path = tmp_path / "a.pdb"
    path.write_text(LIGAND)
    found = vtray.read(path)
    assert found.bonds.tolist() == [[0, 1]]
    drawn = vtray.Scene().add_particles(found, bonds="file")
    assert len(drawn.bonds) == 1
    assert drawn.style == "ball-and-stick"
    # Where not all atoms of a residue are reached, most bonds are left out.
    for text in (
        LIGAND.replace("HOH A   2", "LIG A   1"),
        LIGAND.replace("CONECT    7    8    8", "CONECT").replace("CONECT    8", "CONECT    9"),
        LIGAND.replace("HETATM    9", "HETATM    8"),
    ):
        path.write_text(text)
        assert vtray.read(path).bonds is None
    with pytest.raises(SceneError, match='bonds: "file" are those that are known, and there are'):
        vtray.Scene().add_particles(vtray.read(path), bonds="file")


@pytest.mark.filterwarnings("ignore:Reader has no dt information")
def test_bonds_of_pdb_by_mdanalysis_are_the_same(tmp_path: Path) -> None:
    path = tmp_path / "a.pdb"
    path.write_text(LIGAND.replace("   99", ""))
    found = [vtray.read(path), vtray.read(path, trajectory=path)]
    assert [particles.bonds.tolist() for particles in found] == [[[0, 1]], [[0, 1]]]
    path.write_text(LIGAND.replace("   99", "").replace("HOH A   2", "LIG A   1"))
    made = MDAnalysis.Universe(path)
    assert len(made.bonds) == 1
    assert vtray.read(path, trajectory=path).bonds is None
    assert vtray.from_mdanalysis(made.atoms[:2]).bonds is None


DUMP = """\
ITEM: TIMESTEP
{step}
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS {marks}
{box}
ITEM: ATOMS id type {places} vx vy vz c_pe[1]
2 1 {one} 1 2 3 0.5
1 2 {two} 4 5 6 0.25
"""


def dump(step: int = 0, **more: str) -> str:
    words = {
        "marks": "pp ff pp",
        "box": "-1 3\n0 5\n0 6",
        "places": "x y z",
        "one": "0 1 2",
        "two": "1 1 1",
    }
    return DUMP.format(step=step, **{**words, **more})


def test_dump(tmp_path: Path) -> None:
    path = tmp_path / "run.dump"
    path.write_text(dump() + dump(500, one="9 1 2"))
    found = vtray.read(path, -1)
    assert {name: values.tolist() for name, values in found.columns.items()} == {
        "id": [2, 1],
        "type": [1, 2],
        "velocity": [[1, 2, 3], [4, 5, 6]],
        "c_pe[1]": [0.5, 0.25],
    }
    assert found.positions.tolist() == [[9, 1, 2], [1, 1, 1]]
    assert (found.frame, found.periodic) == (1, (True, False, True))
    assert found.cell.tolist() == [[4, 0, 0], [0, 5, 0], [0, 0, 6]]
    assert found.origin.tolist() == [-1, 0, 0]
    assert len(found.select("c_pe[1] > 0.3")) == 1


def test_dump_of_a_tilted_box_beside_ase(tmp_path: Path) -> None:
    path = tmp_path / "run.lammpstrj"
    box = {"marks": "xy xz yz pp pp pp", "box": "-2 5 1\n0 6 -1\n0 6 0.5"}
    path.write_text(dump(places="xs ys zs", one="0.5 0.25 0.125", two="0 0 0", **box))
    found = vtray.read(path)
    theirs = ase.io.read(path, format="lammps-dump-text", order=False)
    assert np.abs(found.cell - theirs.cell).max() < 1e-12
    assert np.abs(found.origin - theirs.get_celldisp().ravel()).max() < 1e-12
    expected = np.array([(0.5, 0.25, 0.125), (0, 0, 0)]) @ found.cell + found.origin
    assert np.abs(found.positions - expected).max() < 1e-12


def test_data_of_lammps_beside_ase(tmp_path: Path) -> None:
    path = tmp_path / "a.data"
    quiet_write(path, WATER, format="lammps-data", masses=True, velocities=True)
    found = vtray.read(path)
    theirs = ase.io.read(path, format="lammps-data", atom_style="atomic")
    assert np.abs(found.positions - theirs.positions).max() < 1e-9
    assert np.abs(found.cell - theirs.cell).max() < 1e-9
    assert found["type"].tolist() == theirs.arrays["type"].tolist()
    assert np.abs(found["mass"] - theirs.get_masses()).max() < 1e-7
    assert found["element"].tolist() == WATER.get_chemical_symbols()  # ASE notes them at the masses


LABELLED = """Made by write_data

3 atoms
2 atom types
0 5 0 avec
0 1 5 bvec
5 0 0 cvec
1 2 3 abc origin

Atom Type Labels

1 {first}
2 O

Masses

{first} {mass}
2 15.999

Atoms # atomic

1 {first} 0 0 0
2 2 1 0 0
3 O 2 0 0
"""


def test_types_and_edges_of_lammps_may_have_names(tmp_path: Path) -> None:
    path = tmp_path / "a.data"
    path.write_text(LABELLED.format(first="C", mass=12.011))
    found = vtray.read(path)
    assert found["type"].tolist() == found["element"].tolist() == ["C", "O", "O"]
    assert found["mass"].tolist() == [12.011, 15.999, 15.999]
    np.testing.assert_array_equal(found.cell, [(0, 5, 0), (0, 1, 5), (5, 0, 0)])
    np.testing.assert_array_equal(found.origin, (1, 2, 3))
    path.write_text(LABELLED.format(first="ca", mass=2.5))
    found = vtray.read(path)
    assert found["type"].tolist() == ["ca", "O", "O"]
    assert "element" not in found.columns
    path.write_text(LABELLED.format(first="ca", mass=12.011))  # carbon in rings, in a force field
    assert vtray.read(path)["element"].tolist() == ["C", "O", "O"]


def test_bonds_of_lammps(tmp_path: Path) -> None:
    path = tmp_path / "a.data"
    path.write_text(
        "water\n\n3 atoms\n2 bonds\n2 atom types\n1 bond types\n"
        "0 4 xlo xhi\n0 5 ylo yhi\n-1 6 zlo zhi\n1 0 0.5 xy xz yz\n\n"
        "Masses\n\n1 16 # O\n2 1\n\nAtoms # full\n\n"
        "30 1 1 -0.8 0 0 0 0 0 0 # the oxygen\n10 1 2 0.4 1 0 0\n20 1 2 0.4 -1 0 0\n\n"
        "Velocities\n\n20 1 2 3\n10 0 0 0\n30 4 5 6\n\n"
        "Bonds\n\n1 1 30 10\n2 1 20 30\n\nPair Coeffs\n\n1 0.1 3\n2 0 0\n"
    )
    found = vtray.read(path)
    assert found.bonds.tolist() == [[0, 1], [2, 0]]
    assert found["velocity"].tolist() == [[4, 5, 6], [0, 0, 0], [1, 2, 3]]
    assert (found["charge"].tolist(), found["mass"].tolist()) == ([-0.8, 0.4, 0.4], [16, 1, 1])
    assert found.cell.tolist() == [[4, 0, 0], [1, 5, 0], [0, 0.5, 7]]
    assert found.origin.tolist() == [0, 0, -1]


def test_gsd(tmp_path: Path) -> None:
    path = tmp_path / "run.gsd"
    with gsd.hoomd.open(path, "w") as file:
        for step in range(3):
            frame = gsd.hoomd.Frame()
            frame.configuration.step = step
            frame.configuration.box = [4, 5, 6, 0.5, 0.25, 0.125]
            frame.particles.N = 2
            frame.particles.position = [(0, 0, step), (1, 1, 1)]
            frame.particles.types = ["A", "B"]
            frame.particles.typeid = [1, 0]
            frame.particles.diameter = [2, 3]
            frame.bonds.N = 1
            frame.bonds.group = [(0, 1)]
            file.append(frame)
    found = vtray.read(path, -1)
    assert (found.frame, found.positions[0].tolist()) == (2, [0, 0, 2])
    assert list(found.columns) == ["type", "radius"]
    assert (found["type"].tolist(), found["radius"].tolist()) == (["B", "A"], [1, 1.5])
    assert found.cell.tolist() == [[4, 0, 0], [2.5, 5, 0], [1.5, 0.75, 6]]
    assert found.origin.tolist() == [-4, -2.875, -3]
    assert found.bonds.tolist() == [[0, 1]]
    with pytest.raises(SceneError, match="frame 3: there are 3 frames; expected -3 to 2$"):
        vtray.read(path, 3)


def universe() -> "MDAnalysis.Universe":
    made = MDAnalysis.Universe.empty(
        3, n_residues=1, atom_resindex=[0, 0, 0], trajectory=True, velocities=True
    )
    made.add_TopologyAttr("elements", ["O", "H", "H"])
    made.add_TopologyAttr("names", ["OW", "HW1", "HW2"])
    made.add_TopologyAttr("resnames", ["SOL"])
    made.add_TopologyAttr("bonds", [(0, 1), (0, 2)])
    made.atoms.positions = WATER.positions
    made.dimensions = [10, 10, 10, 90, 90, 90]
    return made


def test_from_mdanalysis() -> None:
    made = universe()
    found = vtray.from_mdanalysis(made)
    assert found["element"].tolist() == ["O", "H", "H"]
    assert (found["name"].tolist(), found["resname"].tolist()) == (
        ["OW", "HW1", "HW2"],
        ["SOL"] * 3,
    )
    assert found.bonds.tolist() == [[0, 1], [0, 2]]
    assert np.abs(found.cell - 10 * np.eye(3)).max() < 1e-5
    made.atoms[2].element = ""
    assert vtray.from_mdanalysis(made)["element"].tolist() == ["O", "H", "X"]
    part = vtray.from_mdanalysis(made.atoms[[2, 0]])
    assert part["name"].tolist() == ["HW2", "OW"]
    assert part.bonds.tolist() == [[1, 0]]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"trajectory": 3}, "trajectory: expected the name of a file, got an object of int"),
        ({"trajectory": ""}, "trajectory: expected the name of a file, got an empty one"),
        ({"columns": 3}, "columns: expected names, such as {'x': 'px'}, got 3"),
        ({"columns": {"x": ["y"]}}, "columns: expected names, such as {'x': 'px'}, got {'x': ['y"),
        ({"columns": {3: "element"}}, "columns: expected names, such as "),
    ],
)
def test_options_that_are_no_names(options: dict[str, Any], message: str, tmp_path: Path) -> None:
    path = tmp_path / "a.xyz"
    path.write_text("1\n\nO 0 0 0\n")
    with pytest.raises(SceneError, match=f"^{re.escape(f'{path}: {message}')}"):
        vtray.read(path, **options)
    with pytest.raises(SceneError, match=f"^{re.escape(f'{path}: {message}')}"):
        next(vtray.read_frames(path, **options))


def test_places_of_a_topology_have_neither_frame_nor_time() -> None:
    made = universe()
    made.trajectory.ts.frame = -1  # as in a file .tpr
    found = vtray.from_mdanalysis(made)
    assert (found.frame, found.time) == (0, None)


GRO = """\
water of four sites
    5
    1SOL     OW    1   0.000   0.000   0.000
    1SOL    HW1    2   0.076   0.059   0.000
    1SOL    HW2    3  -0.076   0.059   0.000
    1SOL     MW    4   0.000   0.015   0.000
    2NA      NA    5   0.500   0.500   0.500
   1.0 1.0 1.0
"""


def test_elements_by_types_that_mdanalysis_has_guessed(tmp_path: Path) -> None:
    path = tmp_path / "a.gro"
    path.write_text(GRO)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = vtray.from_mdanalysis(MDAnalysis.Universe(path))
    assert found["element"].tolist() == ["O", "H", "H", "X", "Na"]
    assert vtray.read(path)["element"].tolist() == found["element"].tolist()


@pytest.mark.parametrize(("top", "run"), [("PSF", "DCD"), ("PRM", "TRJ")])
def test_elements_of_force_fields_are_those_of_masses(top: str, run: str) -> None:
    top, run = getattr(datafiles, top), getattr(datafiles, run)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made = MDAnalysis.Universe(top, run)
        known = atomic_masses[atomic_numbers(vtray.from_mdanalysis(made)["element"])]
        assert np.abs(known - made.atoms.masses).max() < 0.01
        np.testing.assert_array_equal(
            vtray.read(top, trajectory=run)["element"], vtray.from_mdanalysis(made)["element"]
        )


def test_masses_tell_more_than_names() -> None:
    found = vtray.read(datafiles.PSF_NAMD_TRICLINIC, trajectory=datafiles.DCD_NAMD_TRICLINIC)
    are_like_sodium = np.char.startswith(found["name"], "N") & (found["mass"] == 14.007)
    assert are_like_sodium.any()
    assert set(found["element"][are_like_sodium]) == {"N"}


def test_elements_that_are_named_are_those_whatever_their_masses() -> None:
    made = universe()
    made.add_TopologyAttr("masses", [12.011, 14.007, 0.0])
    assert vtray.from_mdanalysis(made)["element"].tolist() == ["O", "H", "H"]


BEADS = ["BB", "SC1", "NC3", "PO4", "ROH", "W"]


def test_beads_are_no_elements(tmp_path: Path) -> None:
    path = tmp_path / "a.gro"
    rows = [f"    1SOL  {BEADS[i]:>5}{i + 1:5}{i:8.3f}   0.000   0.000" for i in range(6)]
    path.write_text("\n".join(["beads", "    6", *rows, "   9.0 9.0 9.0\n"]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made = MDAnalysis.Universe(path)
        made.atoms.write(tmp_path / "a.pdb")
    for found in (vtray.read(path), vtray.from_mdanalysis(made), vtray.read(tmp_path / "a.pdb")):
        assert found.time is None
        assert "element" not in found.columns
        assert found["type"].tolist() == [*"BSNPRW"]
    made.add_TopologyAttr("elements", [*"BSNPOW"])  # so it is said
    assert vtray.from_mdanalysis(made)["element"].tolist() == [*"BSNPOW"]


def test_elements_of_lammps_are_those_of_masses(tmp_path: Path) -> None:
    path = tmp_path / "a.dump"
    head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n" + "0 9\n" * 3
    path.write_text(head + "ITEM: ATOMS id type mass x y z\n1 1 15.9994 0 0 0\n2 2 1.008 1 0 0\n")
    assert vtray.read(path)["element"].tolist() == ["O", "H"]
    path.write_text(head + "ITEM: ATOMS id type mass x y z\n1 1 4 0 0 0\n2 2 1 1 0 0\n")
    assert "element" not in vtray.read(path).columns
    text = "ITEM: ATOMS element mass x y z\nO 1.008 0 0 0\nH 15.9994 1 0 0\n"
    path.write_text(head + text)
    assert vtray.read(path)["element"].tolist() == ["O", "H"]


@pytest.mark.parametrize(
    ("types", "elements", "expected"),
    [
        (["O", "H", "H"], ["", "", ""], ["O", "H", "H"]),
        (["1", "2", "2"], ["", "", ""], None),
        (["OW", "H", "NA"], ["", "", ""], None),  # of a force field, where NA is nitrogen
        (["O", "H", "H"], ["O", "D", ""], ["O", "D", "X"]),
    ],
)
def test_elements_by_types_of_a_topology(
    types: list[str], elements: list[str], expected: list[str] | None
) -> None:
    made = universe()
    made.add_TopologyAttr("types", types)
    made.atoms.elements = elements
    found = vtray.from_mdanalysis(made)
    assert found["type"].tolist() == types
    assert ("element" in found.columns) == (expected is not None)
    if expected is not None:
        assert found["element"].tolist() == expected


def test_topology_and_trajectory(tmp_path: Path) -> None:
    made = universe()
    top, run = tmp_path / "top.gro", tmp_path / "run.xtc"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made.atoms.write(top)
        with MDAnalysis.Writer(str(run), 3) as writer:
            for i in range(3):
                made.atoms.positions = WATER.positions + i
                made.trajectory.ts.time = 2.0 * i
                writer.write(made.atoms)
    found = vtray.read(top, -1, trajectory=run)
    assert (found.frame, found.time) == (2, 4)
    assert np.abs(found.positions - WATER.positions - 2).max() < 0.02
    assert vtray.read(top)["element"].tolist() == ["O", "H", "H"]
    with pytest.raises(SceneError, match="frame 3: there are 3 frames; expected -3 to 2$"):
        vtray.read(top, 3, trajectory=run)


PSF = """\
PSF

       1 !NTITLE
 REMARKS water

       2 !NATOM
       1 W    1    SOL  OW   O     -0.800000       15.9990           0
       2 W    1    SOL  HW1  H      0.400000        1.0080           0

       1 !NBOND: bonds
       1       2
"""


def test_topology_without_places(tmp_path: Path) -> None:
    path = tmp_path / "top.psf"
    path.write_text(PSF)
    with pytest.raises(SceneError, match="has no places; name the file that has some, as in traj"):
        vtray.read(path)
    (tmp_path / "run.xyz").write_text("2\n\nO 0 0 0\nH 1 0 0\n2\n\nO 5 0 0\nH 6 0 0\n")
    found = vtray.read(path, -1, trajectory=tmp_path / "run.xyz")
    assert found.positions.tolist() == [[5, 0, 0], [6, 0, 0]]
    assert (found.bonds.tolist(), found["mass"].tolist()) == ([[0, 1]], [15.999, 1.008])
    with pytest.raises(SceneError, match="top.psf: trajectory: .*gone.xtc: no such file; expected"):
        vtray.read(path, trajectory=tmp_path / "gone.xtc")
    (tmp_path / "bad.xtc").write_bytes(b"1 2 3")
    with pytest.raises(SceneError, match="a topology and its trajectory .*bad.xtc, which MDAnalys"):
        vtray.read(path, trajectory=tmp_path / "bad.xtc")


def test_too_large_for_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    words = "9 GB of memory, 1 GB is available"
    monkeypatch.setattr("vtray.scene.readers.rows.lack_of_memory", lambda _: words)
    monkeypatch.setattr("vtray.scene.readers.libraries.lack_of_memory", lambda _: words)
    monkeypatch.setattr("vtray.scene.readers.lines.STEP", 20)
    (tmp_path / "a.xyz").write_text("9\n\n" + "O 0 0 0\n" * 9)
    (tmp_path / "a.cif").write_text(CIF)
    with pytest.raises(SceneError, match=f"a.xyz: line [0-9]+: 9 rows need {words}$"):
        vtray.read(tmp_path / "a.xyz")
    with pytest.raises(SceneError, match=f"a.cif: reading it needs about {words}$"):
        vtray.read(tmp_path / "a.cif")


TABLE = "X;y; z;vx;vy;vz;kind;size\n1;2;3;0;0;1;a;0.5\n4;5;6;0;1;0;b;\n"


def test_csv(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(TABLE)
    found = vtray.read(path, columns={"radius": "size"})
    assert found.positions.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert list(found.columns) == ["radius", "velocity", "kind"]
    assert found["velocity"].tolist() == [[0, 0, 1], [0, 1, 0]]
    assert np.array_equal(found["radius"], [0.5, np.nan], equal_nan=True)
    swapped = vtray.read(path, columns={"x": "y", "y": "X"})
    assert swapped.positions.tolist() == [[2, 1, 3], [5, 4, 6]]


COMMENTED = {
    "# made by me\n# with 'quotes\" and, commas\nx,y,z\n1,2,3\n": [],
    "# made by me\n\nx;y;z\n1;2;3\n": [],
    "# t = 3 ps\n# x,y,z\n1,2,3\n": [],
    "#element,x,y,z\nH,1,2,3\n": ["element"],
    "#element,x,y,z\n#1,1,2,3\n": None,
    "# by me\n1,2,3\n": [],
    "# by me\n1,2,3,4\n": None,
    '#,"never closed\nx,y,z\n1,2,3\n': [],
    "\r\nx\ty\tz\r\n1\t2\t3\r\n": [],
    "x,y,z,color\n1,2,3,#ff0000\n": ["color"],
    "color,x,y,z\n#ff0000,1,2,3\n": ["color"],
}


@pytest.mark.parametrize(("text", "columns"), COMMENTED.items())
def test_csv_with_comments(text: str, columns: list[str] | None, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text, newline="")
    if columns is None:
        with pytest.raises(SceneError, match="expected the names of the columns"):
            vtray.read(path)
        return
    found = vtray.read(path)
    assert found.positions.tolist() == [[1, 2, 3]]
    assert list(found.columns) == columns


def test_csv_with_comments_says_the_line(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("# one\n# two\nx,y,z\n1,2,3\n1,2\n")
    with pytest.raises(SceneError, match="a.csv: line 5: expected 3 entries, got 2$"):
        vtray.read(path)
    path.write_text("# one\n# two\nx,y,z\n1,2,3\n1,a,3\n")
    with pytest.raises(SceneError, match="a.csv: line 5: column 'y': expected numbers"):
        vtray.read(path)


UNDERSCORES = {
    "a.csv": "x,y,z,label\n0,0,0,1_2\n0,0,0,1_3\n",
    "a.xyz": "2\ntime=1_0\nC 0 0 0 1_2\nC 0 0 0 1_3\n",
}


LATE = {
    "an integer": (["1", "2", " 3", "+4", "-0"], [1, 2, 3, 4, 0]),
    "a number": (["1", "2", "3", "4.5", "-0"], [1.0, 2.0, 3.0, 4.5, -0.0]),
    "numbers first": (["1e3", "2", "3", "4.5", "-0"], [1000.0, 2.0, 3.0, 4.5, -0.0]),
    "a missing one": (["1", "2", "3", "NA", "4"], [1.0, 2.0, 3.0, np.nan, 4.0]),
    "missing in numbers": (["1.5", "2", "3", "", "4"], [1.5, 2.0, 3.0, np.nan, 4.0]),
    "one too large": (["1", "2", "3", "4", "9" * 20], [1.0, 2.0, 3.0, 4.0, 1e20]),
    "a name": (["1", "2.50", "3", " b ", "true"], ["1", "2.50", "3", "b", "true"]),
    "truths": (["", "NA", "true", "False", "True"], [np.nan, np.nan, 1.0, 0.0, 1.0]),
    "all truths": (["false", "TRUE", "true", "False", "true"], [False, True, True, False, True]),
    "no truths": (["", "na", "true", "False", "1"], ["", "na", "true", "False", "1"]),
    "underscores": (["1.5", "2", "1_0", "4", "5"], ["1.5", "2", "1_0", "4", "5"]),
}


@pytest.mark.parametrize(("given", "found"), LATE.values(), ids=LATE)
@pytest.mark.parametrize("quote", ["", '"'])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\n\n"])
def test_columns_of_csv_read_in_pieces(
    given: list[str],
    found: list[object],
    quote: str,
    end: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    path = tmp_path / "a.csv"
    rows = [f"{k},0.5,0,{quote}{entry}{quote}" for k, entry in enumerate(given)]
    path.write_text(end.join(["x,y,z,value", *rows]), newline="")
    for size in (1, 20, 10**6):
        monkeypatch.setattr(csv_columns, "_LETTERS", size)
        monkeypatch.setattr(csv_columns, "_ROWS", size)
        particles = vtray.read(path)
        assert particles["value"].dtype.kind == np.array(found).dtype.kind
        assert [*map(repr, particles["value"].tolist())] == [*map(repr, found)]
        assert particles.positions.tolist() == [[k, 0.5, 0] for k in range(5)]


def test_memory_for_csv_is_that_of_its_columns(tmp_path: Path) -> None:
    path, count = tmp_path / "a.csv", 200_000
    path.write_text("x,y,z\n" + "".join(f"{k}.25,0.5,1e-3\n" for k in range(count)))
    tracemalloc.start()
    particles = vtray.read(path)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert particles.positions[-1].tolist() == [count - 0.75, 0.5, 0.001]
    assert most < 60 * 3 * count  # with all entries as texts 150


@pytest.mark.parametrize("name", ["a.csv", "a.xyz"])
def test_labels_with_underscores_are_no_numbers(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_text(UNDERSCORES[name])
    found = vtray.read(path)
    assert found["label" if name == "a.csv" else "column5"].tolist() == ["1_2", "1_3"]
    assert found.time is None


@pytest.mark.parametrize("name", ["cell", "box", "Lattice"])
@pytest.mark.parametrize("cell", [[4.0, 5.0, 6.0], [[4, 0, 0], [1, 5, 0], [0, 0, 6.0]]])
def test_npz_with_a_cell_and_a_time(name: str, cell: list[object], tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    np.savez(path, positions=np.ones((2, 3)), **{name: cell}, time=2.5, mass=[1, 2])
    found = vtray.read(path)
    assert found.cell is not None
    assert np.array_equal(found.cell, np.diag(cell) if np.ndim(cell) == 1 else cell)
    assert found.time == 2.5
    assert sorted(found.columns) == ["mass"]


@pytest.mark.parametrize(
    ("name", "arrays"),
    [
        ("box", {"box": np.ones((4, 4))}),
        ("box", {"cell": np.eye(3), "box": 2 * np.eye(3)}),
        ("time", {"time": np.array("noon")}),
    ],
)
def test_npz_with_other_arrays_says_which(
    name: str, arrays: dict[str, Any], tmp_path: Path
) -> None:
    np.savez(tmp_path / "a.npz", positions=np.ones((2, 3)), **arrays)
    with pytest.raises(SceneError, match=rf"a\.npz: .*'{name}'.*one row for each of 2"):
        vtray.read(tmp_path / "a.npz")


def test_npz_and_parquet(tmp_path: Path) -> None:
    x, y, z = np.arange(6.0).reshape(3, 2)
    table = {"x": x, "y": y, "z": z, "radii": np.array([1, 2]), "kind": np.array(["a", "b"])}
    np.savez(tmp_path / "a.npz", **table)
    pa.parquet.write_table(pa.table(table), tmp_path / "a.parquet")
    for name in ("a.npz", "a.parquet"):
        found = vtray.read(tmp_path / name)
        assert found.positions.tolist() == np.stack([x, y, z], 1).tolist()
        assert (found["radius"].tolist(), found["kind"].tolist()) == ([1, 2], ["a", "b"])
    np.savez(tmp_path / "b.npz", positions=np.ones((2, 3), np.float32), mass=[1, 2])
    found = vtray.read(tmp_path / "b.npz")
    assert (found.positions.dtype, list(found.columns)) == (np.float32, ["mass"])
    np.save(tmp_path / "c.npy", np.ones((2, 3)))
    assert len(vtray.read(tmp_path / "c.npy")) == 2


@pytest.mark.parametrize("ending", [".las", ".laz"])
def test_las(ending: str, tmp_path: Path) -> None:
    header = laspy.LasHeader(point_format=3, version="1.2")
    header.scales, header.offsets = [0.01] * 3, [100, 200, 300]
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = np.array([[100, 101.5], [200, 201], [300, 300]])
    cloud.intensity = np.array([7, 9], np.uint16)
    cloud.classification = np.array([2, 6], np.uint8)
    cloud.red, cloud.green, cloud.blue = np.array([[65535, 0], [256, 255], [0, 65280]], np.uint16)
    cloud.write(tmp_path / f"a{ending}")
    found = vtray.read(tmp_path / f"a{ending}")
    assert found.positions.tolist() == [[100, 200, 300], [101.5, 201, 300]]
    assert found["color"].tolist() == [[255, 1, 0], [0, 0, 255]]
    assert found["intensity"].tolist() == [7, 9]
    assert found["classification"].tolist() == [2, 6]


def test_las_that_claims_more_than_it_has(tmp_path: Path) -> None:
    path = tmp_path / "a.las"
    cloud = laspy.LasData(laspy.LasHeader(point_format=3, version="1.2"))
    cloud.write(path)
    content = bytearray(path.read_bytes())
    content[100:104] = b"\xff" * 4
    path.write_bytes(content)
    with pytest.raises(SceneError, match="claims 4294967295 records and 0 chunks, "):
        vtray.read(path)


@pytest.mark.parametrize("text", [True, False])
def test_ply(text: bool, tmp_path: Path) -> None:
    kinds = [(name, "f4") for name in "xyz"] + [(name, "u1") for name in ("red", "green", "blue")]
    points = np.array([(0, 1, 2, 255, 0, 0), (3, 4, 5, 0, 255, 0)], kinds)
    file = plyfile.PlyData([plyfile.PlyElement.describe(points, "vertex")], text=text)
    file.write(tmp_path / "a.ply")
    found = vtray.read(tmp_path / "a.ply")
    assert found.positions.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert found.positions.dtype == np.float32
    assert found["color"].tolist() == [[255, 0, 0], [0, 255, 0]]


BROKEN = {
    "a.cif": "holds no frame; expected a CIF file",
    "a.vasp": "expected a POSCAR file, which ASE cannot read (",
    "a.gsd": "expected a GSD file, which gsd cannot read (",
    "a.gro": "expected a topology, which MDAnalysis cannot read (",
    "a.parquet": "expected a Parquet file, which pyarrow cannot read (",
    "a.las": "expected a LAS file, which begins with LASF",
    "a.laz": "expected a LAS file, which begins with LASF",
    "a.ply": "expected a PLY file, which plyfile cannot read (",
    "a.npz": "expected a .npz file (File is not a zip file)",
    "a.npy": "",
    "a.csv": "line 1: expected the names of the columns, got ",
    "a.pdb": "expected lines that begin with ATOM or HETATM; there are none",
    "a.dump": "is empty; expected ITEM: TIMESTEP in the first line",
    "a.data": "expected the number of atoms, and a section Atoms; there is none",
    "a.traj": "expected a trajectory of ASE, which ASE cannot read (",
}


@pytest.mark.parametrize("name", BROKEN)
@pytest.mark.parametrize("content", [b"", b"\x00\xff\x80 1 2\n" * 40, b"1 2 3\n4 5\n"])
def test_broken(name: str, content: bytes, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(SceneError) as caught:
        vtray.read(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    assert len(message) < len(str(path)) + 250
    if not content:
        assert message.startswith(f"{path}: {BROKEN[name]}"), message


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        (
            {"x": (3,), "y": (2,), "z": (3,)},
            "column 'y': expected 3 numbers, as column 'x' has, got",
        ),
        (
            {"positions": (4, 2, 3)},
            r"Particles.positions: must have shape \(n, 3\), got \(4, 2, 3\)",
        ),
        (
            {"pos": (4,), "xyz": (4, 2)},
            r"Particles.positions: must have shape \(n, 3\), got \(4, 2\)",
        ),
    ],
)
def test_arrays_of_wrong_shapes(
    arrays: dict[str, tuple[int, ...]], message: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.npz"
    np.savez(path, **{name: np.zeros(shape) for name, shape in arrays.items()})  # type: ignore[arg-type]
    with pytest.raises(SceneError, match=message):
        vtray.read(path)


WRONG = [
    ("a.csv", "px,py\n1,2\n", "expected the columns x, y and z, got px, py; name them, as in col"),
    (
        "a.csv",
        "x,y,m\n1,2,3\n",
        "expected the columns x, y and z, got x, y, m; places in a plane ne",
    ),
    ("a.csv", "x,y,z\n1,2\n", "line 2: expected 3 entries, got 2"),
    ("a.csv", "x,y,z\n1,2,a\n", "line 2: column 'z': expected numbers, got such as 'a'"),
    ("a.csv", "x,x\n1,2\n", "line 1: expected each column once, got 'x' twice"),
    ("a.csv", "x,y,z\n1,2,\n", "line 2: column 'z': must be finite, got nan"),
    ("a.csv", "x,y,z\n\n1,2,3\n\n1,inf,3\n", "line 5: column 'y': must be finite, got inf"),
    ("a.csv", "x,Y,z\n1,2,3\n1,b,3\n", "line 3: column 'Y': expected numbers, got such as 'b'"),
    ("a.csv", "x,y,z\n1,2,3\n1,2,1_2\n", "line 3: column 'z': expected numbers, got such as '1_2'"),
    ("a.pdb", PDB.replace("  -1.500", "  -1_500"), "line 4: columns 31 to 38: x must be a number"),
    ("a.pdb", PDB.replace("  -1.500", "  -1.5x0"), "line 4: columns 31 to 38: x must be a number"),
    ("a.pdb", PDB.replace("  -1.500", "     nan"), "line 4: x must be finite, got nan"),
    ("a.dump", dump(one="0 1 inf"), "line 10: z must be finite, got inf"),
    ("a.data", "\n\n1 atoms\n\nAtoms\n\n1 1 0 0 nan\n", "line 7: z must be finite, got nan"),
    ("a.pdb", PDB.replace("110.00", "190.00"), "line 1: expected three lengths and three angles"),
    ("a.pdb", PDB.replace("80.00  90.00 110.00", "10.00  90.00 170.00"), "line 1: no cell has"),
    ("a.dump", dump(box="1 2\n3 x\n5 6"), "line 9: expected the bounds of the box, got '1 2 / 3 x"),
    (
        "a.dump",
        dump(box="1 2\n3 1_0\n5 6"),
        "line 9: expected the bounds of the box, got '1 2 / 3 1",
    ),
    ("a.dump", dump(one="0 1 1_0"), "line 10: entry 5 must be a number, got '1_0'"),
    ("a.dump", dump(places="a b c"), "line 9: expected the columns x y z, got 'id type a b c vx"),
    ("a.dump", dump(places="x y m"), "line 9: expected the columns x y z, got 'id type x y m vx"),
    ("a.dump", dump(one="0 1"), "line 10: expected 9 entries, got 8"),
    ("a.dump", dump().replace("\n2\n", "\n3\n"), "line 11: the file ends after 2 of 3 rows"),
    ("a.dump", "ITEM: TIMESTEP\n0\n", "line 2: the file ends; expected ITEM: ATOMS"),
    ("a.data", "\n\n1 atoms\n\nAtoms # foo\n\n1 1 0 0 0\n", "line 5: the style 'foo' is not known"),
    ("a.data", "\n\n1 atoms\n\nAtoms\n\n1 1 1 0 0 0\n", "line 5: the style is not said; expected"),
    ("a.data", "\n\n2 atoms\n\nAtoms\n\n1 1 0 0 0\n", "line 7: the file ends after 1 of 2 rows"),
    (
        "a.data",
        "\n\n1 atoms\n1 bonds\n\nAtoms\n\n1 1 0 0 0\n\nBonds\n\n1 1 1 9\n",
        "section Bonds: no atom has the id 9",
    ),
]


@pytest.mark.parametrize(("name", "text", "message"), WRONG)
def test_wrong(name: str, text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(SceneError) as caught:
        vtray.read(path)
    assert str(caught.value).startswith(f"{path}: {message}")


def test_molecule_of_ase() -> None:
    ethanol = molecule("CH3CH2OH")
    ethanol.set_momenta(np.ones((9, 3)))
    ethanol.set_initial_charges(np.arange(9))
    found = vtray.from_ase(ethanol)
    assert found["element"].tolist() == ethanol.get_chemical_symbols()
    assert found["velocity"].tolist() == ethanol.get_velocities().tolist()
    assert found["initial_charge"].tolist() == list(range(9))
    assert "charge" not in found
    assert found.cell is None


@pytest.mark.parametrize("name", [None, "a.traj", "a.extxyz"])
def test_charges_are_those_that_a_calculator_has_found(name: str | None, tmp_path: Path) -> None:
    atoms = Atoms("H2", [(0, 0, 0), (0, 0, 0.7)])
    atoms.set_initial_charges([0.0, 0.1])
    atoms.set_initial_magnetic_moments([1.0, -1.0])
    atoms.calc = SinglePointCalculator(
        atoms, charges=np.array([0.5, -0.5]), magmoms=np.array([0.2, -0.2])
    )
    found = vtray.from_ase(atoms)
    if name is not None:
        ase.io.write(tmp_path / name, atoms)
        found = vtray.read(tmp_path / name)
    assert found["charge"].tolist() == [0.5, -0.5]
    assert found["magmom"].tolist() == [0.2, -0.2]
    assert found["initial_charges"].tolist() == found["initial_charge"].tolist() == [0.0, 0.1]
    assert found["initial_magmom"].tolist() == [1.0, -1.0]


MISSING = """x,y,z,kind,value,count,is_new
0,0,0,a,1.5,1,True
1,0,0,,NA,,false
2,0,0,b,,3,
"""


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_entries_that_are_missing(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"a.{ending}"
    if ending == "csv":
        path.write_text(MISSING)
    else:
        columns = {name: pa.array([0.0, 1.0, 2.0]) for name in "xyz"}
        columns["kind"] = pa.array(["a", None, "b"]).dictionary_encode()
        columns["value"] = pa.array([1.5, None, None])
        columns["count"] = pa.array([1, None, 3])
        columns["is_new"] = pa.array([True, False, None])
        pa.parquet.write_table(pa.table(columns), path)
    found = vtray.read(path)
    assert found["kind"].tolist() == ["a", "", "b"]
    np.testing.assert_array_equal(found["value"], [1.5, np.nan, np.nan])
    np.testing.assert_array_equal(found["count"], [1, np.nan, 3])
    np.testing.assert_array_equal(found["is_new"], [1, 0, np.nan])


def test_truths_of_csv(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("x,y,z,ok\n0,0,0,true\n1,0,0,False\n")
    assert vtray.read(path)["ok"].dtype == np.bool_
    assert vtray.read(path)["ok"].tolist() == [True, False]


ATOM = "ATOM  {:5d} {:4} {:3} A{:4d}    {:8.3f}   0.000   0.000  1.00  0.00"


@pytest.mark.parametrize(
    ("atoms", "elements"),
    [
        ([("N", "MET"), ("CA", "MET"), ("CD1", "MET"), ("HG1", "MET"), ("NE", "MET")], "N C C H N"),
        ([("CA", "ALA"), ("CA", "CA")], "C Ca"),
        (
            [("C1", "LIG"), ("CL2", "LIG"), ("SOD", "SOD"), ("ZN", "ZN2"), ("FE", "HEM")],
            "C Cl Na Zn Fe",
        ),
        ([("NA", "UNK"), ("CL", "UNK")], "Na Cl"),
        ([(" N", "MET"), (" CA", "MET"), ("CA", "CA"), ("FE", "HEM")], "N C Ca Fe"),
    ],
    ids=["left", "alpha", "ions", "right", "usual"],
)
def test_elements_of_names_in_pdb(
    atoms: list[tuple[str, str]], elements: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.pdb"
    lines = [ATOM.format(k, name, residue, k, k) for k, (name, residue) in enumerate(atoms, 1)]
    path.write_text("\n".join(lines))
    assert vtray.read(path)["element"].tolist() == elements.split()


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="counts the threads of Linux")
def test_no_thread_holds_a_parquet_file_when_python_ends(tmp_path: Path) -> None:
    file = tmp_path / "points.parquet"
    pa.parquet.write_table(pa.table(dict.fromkeys("xyz", np.zeros(3))), file)
    code = (
        "import os, pyarrow.parquet, vtray, numpy\n"
        "before = len(os.listdir('/proc/self/task'))\n"
        f"vtray.read({str(file)!r})\n"
        "print(len(os.listdir('/proc/self/task')) - before)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "0\n"
