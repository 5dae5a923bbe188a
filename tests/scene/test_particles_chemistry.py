"""Objects of RDKit, pymatgen, MDTraj and Biotite, by what they look like: none is needed."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import vtray
from vtray.base.errors import SceneError
from vtray.scene.particles.from_objects import as_particles

POINTS = np.array([(0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)])


def rdkit(conformers: int = 1) -> Any:
    atoms = [SimpleNamespace(GetAtomicNum=lambda number=number: number) for number in (8, 1, 0)]
    bond = SimpleNamespace(GetBeginAtomIdx=lambda: 0, GetEndAtomIdx=lambda: 1)
    return SimpleNamespace(
        GetNumConformers=lambda: conformers,
        GetConformer=lambda: SimpleNamespace(GetPositions=lambda: POINTS),
        GetAtoms=lambda: atoms,
        GetBonds=lambda: [bond],
    )


def test_rdkit() -> None:
    found = as_particles(rdkit())
    assert found["element"].tolist() == ["O", "H", "X"]
    assert found.positions.tolist() == POINTS.tolist()
    assert found.bonds.tolist() == [[0, 1]]
    assert vtray.Scene().add_particles(rdkit()).style == "ball-and-stick"
    with pytest.raises(SceneError, match="^add_particles: the molecule has no places; AllChem.Emb"):
        vtray.Scene().add_particles(rdkit(0))


class Structure(list[Any]):
    """What structures of pymatgen look like."""

    cart_coords = POINTS
    site_properties = {"magmom": [1.0, 2.0, None], "charges": [0, 1, -1], "kind": ["a", "b", "c"]}  # noqa: RUF012
    lattice = SimpleNamespace(matrix=np.diag([4.0, 5.0, 6.0]), pbc=(True, True, False))


class Species(SimpleNamespace):
    """A species, which has a hash."""

    def __hash__(self) -> int:
        return hash(self.symbol)


def test_pymatgen() -> None:
    shares = [{"Fe": 0.4, "Ni": 0.6}, {"O": 1.0}, {"Q": 1.0}]
    structure = Structure(
        SimpleNamespace(species={Species(symbol=name): part for name, part in one.items()})
        for one in shares
    )
    found = as_particles(structure)
    assert found["element"].tolist() == ["Ni", "O", "X"]
    assert (found["charge"].tolist(), found["kind"].tolist()) == ([0, 1, -1], ["a", "b", "c"])
    assert "magmom" not in found.columns  # some have none
    assert (found.cell.tolist(), found.periodic) == (
        [[4, 0, 0], [0, 5, 0], [0, 0, 6]],
        (True, True, False),
    )
    del Structure.lattice
    assert as_particles(structure).cell is None


def mdtraj(frames: int = 1) -> Any:
    residue = SimpleNamespace(name="SOL", resSeq=7)
    elements = [SimpleNamespace(symbol="O"), SimpleNamespace(symbol="H"), None]
    atoms = [
        SimpleNamespace(index=i, name="abc"[i], element=elements[i], residue=residue)
        for i in range(3)
    ]
    return SimpleNamespace(
        n_frames=frames,
        xyz=np.array([POINTS] * frames, np.float32),
        topology=SimpleNamespace(atoms=iter(atoms), bonds=[(atoms[0], atoms[1])]),
        unitcell_vectors=np.array([np.eye(3)] * frames),
        time=np.array([2.5] * frames),
    )


def test_mdtraj_has_nanometres() -> None:
    found = as_particles(mdtraj())
    assert found["element"].tolist() == ["O", "H", "X"]
    assert found["name"].tolist() == ["a", "b", "c"]
    assert (set(found["resname"]), set(found["resid"])) == ({"SOL"}, {7})
    assert found.positions.tolist() == (10 * POINTS).tolist()
    assert (found.cell.tolist(), found.time) == ((10 * np.eye(3)).tolist(), 2.5)
    assert found.bonds.tolist() == [[0, 1]]
    with pytest.raises(SceneError, match="^expected one frame, got 3; give one of them, such as"):
        as_particles(mdtraj(3))


def biotite(models: int | None, **more: Any) -> Any:
    names: dict[str, Any] = {
        "chain_id": np.array(["A"] * 3),
        "res_id": np.array([1, 2, 3]),
        "atom_name": np.array(["O", "FE", "?"]),
        "element": np.array(["O", "FE", ""]),
        "b_factor": np.array([1.5, 2.5, 3.5]),
    }
    bonds = SimpleNamespace(as_array=lambda: np.array([(0, 1, 5)], np.uint32))
    box = 9 * np.eye(3)
    return SimpleNamespace(
        coord=POINTS if models is None else np.array([POINTS] * models),
        box=box if models is None else np.array([box] * models),
        bonds=bonds,
        get_annotation_categories=lambda: list(names),
        **{**names, **more},
    )


@pytest.mark.parametrize("models", [None, 1])
def test_biotite(models: int | None) -> None:
    found = as_particles(biotite(models))
    assert found["element"].tolist() == ["O", "Fe", "X"]
    assert found["name"].tolist() == ["O", "FE", "?"]
    assert (found["resid"].tolist(), found["tempfactor"].tolist()) == ([1, 2, 3], [1.5, 2.5, 3.5])
    assert (set(found["chain"]), found.bonds.tolist()) == ({"A"}, [[0, 1]])
    assert found.cell.tolist() == (9 * np.eye(3)).tolist()


def test_biotite_of_several_models() -> None:
    with pytest.raises(SceneError, match="expected one model, got 2; give one of them"):
        as_particles(biotite(2))
