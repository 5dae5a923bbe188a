"""mmCIF files, beside what gemmi itself makes of them."""

import gzip
import re
import sys
from pathlib import Path

import gemmi
import numpy as np
import pytest
from MDAnalysisTests import datafiles

import vtray
from vtray.base.errors import SceneError
from vtray.base.extras import ExtraError

HEAD = """\
data_TEST
_cell.length_a 10
_cell.length_b 20
_cell.length_c 30
_cell.angle_alpha 90
_cell.angle_beta 90
_cell.angle_gamma {gamma}
_symmetry.space_group_name_H-M {group}
loop_
_atom_site.group_PDB
_atom_site.id
_atom_site.type_symbol
_atom_site.label_atom_id
_atom_site.label_alt_id
_atom_site.label_comp_id
_atom_site.label_asym_id
_atom_site.label_seq_id
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
_atom_site.occupancy
_atom_site.B_iso_or_equiv
_atom_site.auth_seq_id
_atom_site.auth_asym_id
_atom_site.pdbx_PDB_model_num
"""

ROWS = """\
ATOM 1 C "C1'" . DG A 1 1.5 2 -3.25(4) 1.00 10.5 7 B 1
ATOM 2 O 'O5''' A DG A 1 0 0 0 0.50 20.5 7 B 1
HETATM 3 ZN ZN . ZN C . 1e1 0 0 1.00 ? 201 B 1
HETATM 4 Q ? . UNX D . 0 1 0 1.00 ? 202 B 1
ATOM 1 C "C1'" . DG A 1 1.5 2 4 1.00 10.5 7 B 2
ATOM 2 O 'O5''' . DG A 1 0 0 9 0.50 20.5 7 B 2
"""


def written(folder: Path, rows: str = ROWS, gamma: str = "90", group: str = "'P 1'") -> Path:
    path = folder / "a.cif"
    path.write_text(HEAD.format(gamma=gamma, group=group) + rows)
    return path


@pytest.mark.parametrize("pdb", ["CONECT", "PDB_icodes", "PDB_multiframe"])
def test_atoms_are_those_that_gemmi_finds(pdb: str, tmp_path: Path) -> None:
    structure = gemmi.read_structure(getattr(datafiles, pdb))
    structure.setup_entities()
    path = tmp_path / "a.mmcif"
    structure.make_mmcif_document().write_file(str(path))
    frames = list(vtray.read_frames(path))
    assert len(frames) == len(structure)
    for found, model in zip(frames, gemmi.read_structure(str(path)), strict=True):
        theirs = [(one.chain, one.residue, one.atom) for one in model.all()]
        assert found["element"].tolist() == [atom.element.name for *_, atom in theirs]
        assert found["name"].tolist() == [atom.name for *_, atom in theirs]
        assert found["resname"].tolist() == [residue.name for _, residue, _ in theirs]
        assert found["resid"].tolist() == [residue.seqid.num for _, residue, _ in theirs]
        assert found["chain"].tolist() == [chain.name for chain, *_ in theirs]
        positions = [atom.pos.tolist() for *_, atom in theirs]
        np.testing.assert_array_equal(found.positions, positions)
        bs = np.array([(atom.occ, atom.b_iso) for *_, atom in theirs], np.float32)
        own = np.stack([found["occupancy"], found["tempfactor"]], axis=1)
        np.testing.assert_array_equal(own.astype(np.float32), bs)


def test_what_a_file_says(tmp_path: Path) -> None:
    found = vtray.read(written(tmp_path))
    assert found["element"].tolist() == ["C", "O", "Zn", "X"]
    assert found["name"].tolist() == ["C1'", "O5''", "ZN", ""]
    assert found["altloc"].tolist() == ["", "A", "", ""]
    assert (found["resid"].tolist(), set(found["chain"])) == ([7, 7, 201, 202], {"B"})
    assert found.positions.tolist() == [[1.5, 2, -3.25], [0, 0, 0], [10, 0, 0], [0, 1, 0]]
    assert found["occupancy"].tolist() == [1, 0.5, 1, 1]
    assert "tempfactor" not in found.columns  # some have none
    assert np.abs(found.cell - np.diag([10, 20, 30])).max() < 1e-12
    last = vtray.read(tmp_path / "a.cif", -1)
    assert (last.frame, last.positions[:, 2].tolist()) == (1, [4, 9])
    assert "altloc" not in last.columns
    assert last["tempfactor"].tolist() == [10.5, 20.5]


@pytest.mark.parametrize(
    ("gamma", "group", "has_cell"),
    [("90", "'P 1'", True), ("90", "'P 21'", False), ("?", "'P 1'", False), ("120", "?", True)],
)
def test_cells_are_those_of_files_with_all_their_atoms(
    gamma: str, group: str, has_cell: bool, tmp_path: Path
) -> None:
    found = vtray.read(written(tmp_path, gamma=gamma, group=group))
    assert (found.cell is not None) == has_cell


def test_names_of_authors_will_do(tmp_path: Path) -> None:
    text = HEAD.replace("label_atom", "auth_atom").replace("auth_seq_id", "B")
    path = tmp_path / "a.pdbx"
    path.write_text(text.format(gamma="?", group="?") + ROWS)
    found = vtray.read(path)
    assert found["name"].tolist() == ["C1'", "O5''", "ZN", ""]
    assert found["resid"].tolist() == ["1", "1", "", ""]
    with gzip.open(tmp_path / "b.cif.gz", "wt") as file:
        file.write(path.read_text())
    assert vtray.read(tmp_path / "b.cif.gz")["name"].tolist() == found["name"].tolist()


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (ROWS.replace("1e1", "high"), "atom 3: _atom_site.Cartn_x must be a number, got 'high'"),
        (ROWS.replace("1e1", "?"), "atom 3: _atom_site.Cartn_x must be a number, got '?'"),
        (ROWS.replace("1e1", "1e400"), "atom 3: _atom_site.Cartn_x must be a number, got '1e400'"),
        (ROWS + "ATOM 3 C\n", "expected an mmCIF file, which gemmi cannot read (ValueError: "),
        ("", "holds no frame; expected a CIF file"),
        (ROWS.replace("0.50", "half"), "atom 2: _atom_site.occupancy must be a number, got 'half'"),
    ],
)
def test_files_that_are_not_right(rows: str, message: str, tmp_path: Path) -> None:
    path = written(tmp_path, rows)
    with pytest.raises(SceneError, match=f"^{re.escape(f'{path}: {message}')}"):
        vtray.read(path)


def test_places_without_a_coordinate(tmp_path: Path) -> None:
    path = tmp_path / "a.cif"
    path.write_text("data_x\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n1 2\n")
    with pytest.raises(
        SceneError, match="a.cif: expected _atom_site.Cartn_z of all atoms; there i"
    ):
        vtray.read(path)


def test_cells_that_there_cannot_be(tmp_path: Path) -> None:
    path = written(tmp_path, gamma="190")
    with pytest.raises(SceneError, match="a.cif: _cell: expected three lengths and three angles o"):
        vtray.read(path)


def test_frames_that_there_are_not(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="a.cif: frame 2: there are 2 frames; expected -2 to 1"):
        vtray.read(written(tmp_path), 2)


def test_without_gemmi(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gemmi", None)
    with pytest.raises(ExtraError, match="reading an mmCIF file needs gemmi, which is not install"):
        vtray.read(written(tmp_path))
