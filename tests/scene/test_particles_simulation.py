"""Objects of OpenMM, ParmEd and freud, by what they look like, and frames of HOOMD-blue."""

import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import gsd.hoomd
import numpy as np
import pytest

import vtray
from vtray.base.errors import SceneError
from vtray.scene.particles.from_objects import as_particles

POINTS = np.array([(0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)])


class Quantity:
    """Numbers in nanometres, as OpenMM gives them."""

    __module__ = "units_of_a_test.quantity"

    def __init__(self, numbers: Any) -> None:
        self.numbers = numbers

    def value_in_unit(self, unit: str) -> Any:
        """Return the numbers in ångström."""
        assert unit == "the ångström"
        return [[10 * number for number in row] for row in self.numbers]


@pytest.fixture(autouse=True)
def units(monkeypatch: pytest.MonkeyPatch) -> None:
    module: Any = ModuleType("units_of_a_test")
    module.angstrom = "the ångström"
    monkeypatch.setitem(sys.modules, "units_of_a_test", module)


def openmm(box: Any = None, **more: Any) -> Any:
    residue = SimpleNamespace(name="HOH", chain=SimpleNamespace(id="A"))
    symbols = ("O", "H", None)
    atoms = [
        SimpleNamespace(
            index=i,
            name=f"atom {i}",
            residue=residue,
            element=None if symbol is None else SimpleNamespace(symbol=symbol),
        )
        for i, symbol in enumerate(symbols)
    ]
    topology = SimpleNamespace(
        atoms=lambda: iter(atoms),
        bonds=lambda: iter([(atoms[0], atoms[1])]),
        getPeriodicBoxVectors=lambda: box,
    )
    return SimpleNamespace(topology=topology, **more)


def test_openmm() -> None:
    found = as_particles(openmm(Quantity(np.eye(3)), positions=Quantity(POINTS)))
    assert found.positions.tolist() == (10 * POINTS).tolist()
    assert found["element"].tolist() == ["O", "H", "X"]
    assert found["name"].tolist() == ["atom 0", "atom 1", "atom 2"]
    assert (found["resname"].tolist(), found["chain"].tolist()) == (["HOH"] * 3, ["A"] * 3)
    assert found.bonds.tolist() == [[0, 1]]
    assert found.cell.tolist() == (10 * np.eye(3)).tolist()
    with pytest.raises(SceneError, match="^add_particles: expected places beside the topology"):
        vtray.Scene().add_particles(openmm(positions=None))


@pytest.mark.parametrize("is_periodic", [True, False])
def test_a_simulation_of_openmm_is_where_it_is_now(is_periodic: bool) -> None:
    state = SimpleNamespace(
        getPositions=lambda **how: Quantity(2 * POINTS) if how == {"asNumpy": True} else None,
        getPeriodicBoxVectors=lambda: Quantity(3 * np.eye(3)),
    )
    context = SimpleNamespace(
        getState=lambda **how: state if how == {"getPositions": True} else None
    )
    box = Quantity(np.eye(3)) if is_periodic else None
    found = as_particles(openmm(box, context=context))
    assert found.positions.tolist() == (20 * POINTS).tolist()
    assert (found.cell is None) is not is_periodic
    if is_periodic:
        assert found.cell.tolist() == (30 * np.eye(3)).tolist()


def parmed(**more: Any) -> Any:
    residue = SimpleNamespace(name="WAT", number=7)
    atoms = [
        SimpleNamespace(idx=i, name="OHE"[i], element=(8, 1, 0)[i], charge=i - 1.5, residue=residue)
        for i in range(3)
    ]
    bond = SimpleNamespace(atom1=atoms[0], atom2=atoms[1])
    known = {"coordinates": POINTS, "residues": [residue], "bonds": [bond], "box": None}
    return SimpleNamespace(atoms=atoms, **{**known, **more})


def test_parmed() -> None:
    found = as_particles(parmed(box=np.array([4.0, 5.0, 6.0, 90.0, 90.0, 90.0])))
    assert found.positions.tolist() == POINTS.tolist()
    assert found["element"].tolist() == ["O", "H", "X"]
    assert (found["name"].tolist(), found["charge"].tolist()) == (
        ["O", "H", "E"],
        [-1.5, -0.5, 0.5],
    )
    assert (set(found["resname"]), set(found["resid"])) == ({"WAT"}, {7})
    assert (found.bonds.tolist(), found.cell.tolist()) == (
        [[0, 1]],
        np.diag([4.0, 5.0, 6.0]).tolist(),
    )
    bare = as_particles(parmed(bonds=[]))
    assert (bare.cell, bare.bonds) == (None, None)
    with pytest.raises(SceneError, match="^the structure has no places; give them as structure.co"):
        as_particles(parmed(coordinates=None))
    with pytest.raises(SceneError, match="^add_particles: box: expected three lengths and three"):
        vtray.Scene().add_particles(parmed(box=[4.0, 5.0, 6.0, 90.0, 90.0, 190.0]))


def freud(**more: Any) -> Any:
    known = {"Lx": 4.0, "Ly": 5.0, "Lz": 6.0, "xy": 0.5, "xz": 0.25, "yz": 0.125}
    return SimpleNamespace(**{**known, "periodic": np.array([True, True, False]), **more})


def test_freud() -> None:
    pair, query = (freud(), POINTS), SimpleNamespace(box=freud(), points=POINTS)
    for found in map(as_particles, (pair, query)):
        assert found.positions.tolist() == POINTS.tolist()
        assert found.cell.tolist() == [[4, 0, 0], [2.5, 5, 0], [1.5, 0.75, 6]]
        assert (2 * found.origin).tolist() == [-8, -5.75, -6]
        assert found.periodic == (True, True, False)
    assert vtray.Scene().add_particles(pair).cell is not None


def test_points_in_a_plane_have_an_edge_of_no_length() -> None:
    flat = freud(Lz=0.0, xy=0.0, xz=0.0, yz=0.0)
    found = as_particles((flat, POINTS * [1, 1, 0]))
    assert found.cell.tolist() == [[4, 0, 0], [0, 5, 0], [0, 0, 0]]
    vtray.Scene().add_particles(found)


def frame(**more: Any) -> Any:
    """Return a frame of HOOMD-blue."""
    made = gsd.hoomd.Frame()
    made.particles.N, made.particles.position = 3, POINTS.astype(np.float32)
    made.particles.types, made.particles.typeid = ["A", "B"], [0, 1, 0]
    made.configuration.box = [4, 5, 6, 0.5, 0.25, 0.125]
    for name, values in more.items():
        setattr(made.particles, name, values)
    made.validate()
    return made


MORE = [
    {},
    {"diameter": [1, 2, 1], "mass": [1, 1, 2], "velocity": POINTS, "charge": [0, 1, -1]},
    {"orientation": [(0, 1, 0, 0)] * 3, "body": [-1, 0, 0], "image": [(0, 1, 0)] * 3},
]


@pytest.mark.parametrize("more", MORE)
def test_frames_of_hoomd_are_as_their_file(more: dict[str, Any], tmp_path: Path) -> None:
    made = frame(**more)
    made.bonds.N, made.bonds.group = 1, [(0, 1)]
    with gsd.hoomd.open(tmp_path / "a.gsd", "w") as file:
        file.append(made)
    written = vtray.read(tmp_path / "a.gsd")
    with gsd.hoomd.open(tmp_path / "a.gsd") as trajectory:
        for found in (as_particles(made), as_particles(trajectory[0])):
            assert found.positions.tolist() == written.positions.tolist()
            assert found.columns.keys() == written.columns.keys()
            assert all(found[name].tolist() == written[name].tolist() for name in written.columns)
            assert found.bonds.tolist() == written.bonds.tolist()
            assert found.cell.tolist() == written.cell.tolist()
            assert found.origin.tolist() == written.origin.tolist()
    assert vtray.Scene().add_particles(made).cell is not None


def test_frames_of_hoomd_without_places() -> None:
    with pytest.raises(SceneError, match="^add_particles: the frame has no places; expected p"):
        vtray.Scene().add_particles(gsd.hoomd.Frame())


def test_frames_of_hoomd_make_movies(tmp_path: Path) -> None:
    frames = [frame(position=POINTS * (k + 1) / 4) for k in range(2)]
    with gsd.hoomd.open(tmp_path / "a.gsd", "w") as file:
        file.extend(frames)
    look = {"size": (16, 12), "samples": 1}
    vtray.animate(tmp_path / "a.gsd", tmp_path / "a.gif", **look)
    with gsd.hoomd.open(tmp_path / "a.gsd") as trajectory:
        for given in (frames, trajectory):
            vtray.animate(given, tmp_path / "b.gif", **look)
            assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()
