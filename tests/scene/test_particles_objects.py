"""Particles of objects that other libraries make, and of files that are no data."""

import copy
import pickle
import subprocess
import sys
import warnings
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import MDAnalysis
import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest
from ase.build import molecule
from MDAnalysisTests import datafiles

import vtray
from vtray.base.errors import SceneError
from vtray.base.extras import ExtraError
from vtray.scene.particles.from_objects import as_particles, bonds_of
from vtray.scene.particles.particles import Particles

with warnings.catch_warnings(action="ignore"):
    import MDAnalysis

POINTS = [(0.0, 1.0, 2.0), (3.0, 4.0, 5.0)]
COLUMNS = dict(zip("xyz", np.array(POINTS).T.tolist(), strict=True))
NAMED = {"positions": POINTS, "mass": [1, 2]}


@pytest.mark.parametrize(
    "given",
    [
        POINTS,
        np.array(POINTS, np.float32),
        vtray.Particles(POINTS),
        COLUMNS,
        {"mass": [1, 2], "Z": COLUMNS["z"], "y": COLUMNS["y"], "x": COLUMNS["x"]},
        NAMED,
        pd.DataFrame({**COLUMNS, "name": ["a", "b"]}),
        pl.DataFrame({**COLUMNS, "name": ["a", "b"]}),
        pd.DataFrame(COLUMNS).to_records(),
        pd.DataFrame(COLUMNS).convert_dtypes(),
        pd.DataFrame(COLUMNS).astype("Float64"),
        pd.DataFrame(COLUMNS).astype("float64[pyarrow]"),
        pd.DataFrame(COLUMNS).astype(object),
        np.array(POINTS, object),
        pa.FixedSizeListArray.from_arrays(np.ravel(POINTS), 3),
        pl.Series(POINTS, dtype=pl.Array(pl.Float64, 3)),
        pd.DataFrame({"position": [*np.array(POINTS)], "name": ["a", "b"]}),
        SimpleNamespace(positions=POINTS),
        SimpleNamespace(get_positions=lambda: POINTS),
    ],
    ids=lambda given: type(given).__name__,
)
def test_whatever_has_places(given: object) -> None:
    found = as_particles(given)
    assert found.positions.tolist() == [list(point) for point in POINTS]
    if given is not NAMED and "position" not in getattr(given, "columns", ()):
        scene = vtray.Scene()
        assert scene.add_spheres(given, 1).center.tolist() == found.positions.tolist()
        assert vtray.Camera.fit(given) == vtray.Camera.fit(found.positions)  # type: ignore[arg-type]


@pytest.mark.parametrize("dtype", ["Float64", "float64[pyarrow]", object])
def test_numbers_that_are_missing_have_a_place(dtype: Any) -> None:
    table = pd.DataFrame({**COLUMNS, "z": [0.0, None]}).astype(dtype)
    with pytest.raises(SceneError, match=r"^add_spheres: positions\[1, 2\]: expected a finite num"):
        vtray.Scene().add_spheres(table, 1)
    with pytest.raises(SceneError, match=r"^column 'z'\[1\]: must be finite, got nan$"):
        as_particles(table)
    with pytest.raises(SceneError, match=r"^Particles.positions\[1, 2\]: must be finite, got nan$"):
        vtray.Particles(table)


def test_tables_of_arrow_have_places() -> None:
    table = pa.table({"mass": [1.0, 2.0], **COLUMNS})
    for given in (table, table.to_batches()[0]):
        assert vtray.Scene().add_spheres(given, 1).center.tolist() == np.array(POINTS).tolist()
    words = (
        r'columns "mass", "a", "b", "c"; choose three .* as in table.select\(\["x", "y", "z"\]\)$'
    )
    with pytest.raises(SceneError, match=words):
        vtray.Scene().add_spheres(table.rename_columns(["mass", *"abc"]), 1)
    with pytest.raises(SceneError, match=r'choose one column, as in table\["radius"\]$'):
        vtray.Scene().add_spheres(table, table)


@pytest.mark.parametrize("made", [pd.DataFrame, pl.DataFrame, pa.table])
@pytest.mark.parametrize("order", ["xyz", "zyx", "yXz"])
def test_columns_have_their_meaning_in_any_order(made: Any, order: str) -> None:
    table = made({name: COLUMNS[name.lower()] for name in order})
    places, scene, line = np.array(POINTS), vtray.Scene(), np.eye(3)[:2]
    part = vtray.Spheres(line, 1, (0, 0, 0), 1)
    for found in (
        scene.add_spheres(table, 1).center,
        scene.add_cylinders(table, line, 1).start,
        scene.add_cones(line, table, 1).end,
        scene.add_copies(part, table).at,
        scene.add_particles(table).spheres.center,
        vtray.Particles(table).positions,
    ):
        assert found.tolist() == places.tolist()
    assert vtray.Camera.fit(table) == vtray.Camera.fit(places)
    other = made({name: COLUMNS[own] for name, own in zip("abc", "xyz", strict=True)})
    assert scene.add_spheres(other, 1).center.tolist() == places.tolist()


@pytest.mark.parametrize("made", [pd.DataFrame, pl.DataFrame, pa.table])
def test_columns_of_colours_have_their_meaning_in_any_order(made: Any) -> None:
    table = made({"b": [3, 6], "g": [2, 5], "r": [9, 4]})
    scene, rows = vtray.Scene(), [[9, 2, 3], [4, 5, 6]]
    assert scene.add_spheres(POINTS, 1, table).color.tolist() == rows
    assert scene.add_particles(POINTS, color=table).spheres.color.tolist() == rows
    assert vtray.Spheres(POINTS, 1, table, 1).color.tolist() == rows


@pytest.mark.parametrize("name", ["x", "q"])
def test_tables_with_a_column_twice(name: str) -> None:
    names = ["x", "y", "z", "q", name]
    table = pa.table([[1.0, 2.0]] * 5, names)
    for given in (table, pd.DataFrame(np.ones((2, 5)), columns=names)):
        with pytest.raises(SceneError, match=rf"^expected each column once, got '{name}' twice$"):
            as_particles(given)
    with pytest.raises(
        SceneError, match=r"^add_spheres: positions: .* \"x\", \"y\", \"z\", \"q\", "
    ):
        vtray.Scene().add_spheres(table.select([0, 1, 2, 3, 0]), 1)


def test_tables_that_are_yet_to_be_worked_out() -> None:
    table = pl.LazyFrame(COLUMNS)
    remedy = r"got <LazyFrame .*>; give what its collect\(\) returns$"
    for take in (as_particles, vtray.Camera.fit, lambda table: vtray.Scene().add_spheres(table, 1)):
        with pytest.raises(SceneError, match=remedy):
            take(table)


class Sparse:
    """What the sparse arrays of SciPy have."""

    dtype, shape = np.dtype(float), (2, 3)

    def toarray(self) -> Any:
        return np.ones(self.shape)


def test_sparse_arrays_are_not_taken() -> None:
    remedy = r"got a sparse array of dtype float64 and shape \(2, 3\); give what its toarray\(\) "
    for take in (
        vtray.Particles,
        lambda array: vtray.Scene().add_spheres(array, 1),
        lambda array: vtray.Scene().add_spheres(np.eye(3), array),
    ):
        with pytest.raises(SceneError, match=remedy):
            take(Sparse())


def test_a_table_without_rows_has_no_dtype() -> None:
    assert len(vtray.Scene().add_spheres(pd.DataFrame(columns=["x", "y", "z"]), 1)) == 0
    for kind in (complex, bool, str):  # others have one that is no number's
        with pytest.raises(SceneError, match=r"^add_spheres: positions: expected an array of num"):
            vtray.Scene().add_spheres(np.zeros((0, 3), kind), 1)


def test_fields_of_records_are_columns() -> None:
    fields = [("x", "i4"), ("y", "f4"), ("z", "f8"), ("element", "S1")]
    records = np.array([(0, 1, 2, b"O")], fields)
    found = as_particles(records)
    assert found.positions.tolist() == [[0, 1, 2]]
    assert found["element"].tolist() == ["O"]


def test_bytes_are_names() -> None:
    names = np.array([b"core", "Hülle".encode(), b"\xff"], "S6")
    kinds = vtray.Particles(np.eye(3), {"kind": names, "pair": np.stack([names, names], axis=1)})
    assert kinds["kind"].tolist() == ["core", "Hülle", "\ufffd"]
    assert kinds["pair"][0].tolist() == ["core", "core"]
    assert kinds.select("kind == 'Hülle'").positions.tolist() == [[0, 1, 0]]
    assert vtray.Scene().add_particles(kinds, color="kind").legend[1][0] == "core"
    table = {"x": [0, 1, 2], "y": [0, 0, 0], "z": [0, 0, 0], "color": np.array([b"red"] * 3)}
    assert vtray.Scene().add_particles(table).spheres.color[0].tolist() == [255, 0, 0]


@pytest.mark.parametrize("dtype", ["M8[ns]", complex, "U4"])
def test_what_is_no_number_is_no_place(dtype: Any) -> None:
    given = np.ones((3, 3)).astype("i8").astype(dtype)
    for name in ("positions", "cell"):
        words = rf"^Particles.{name}: must be an array of numbers, got an array of .*\(3, 3\)$"
        with pytest.raises(SceneError, match=words):
            vtray.Particles(**{"positions": np.eye(3), name: given})


def test_decimals_are_numbers() -> None:
    charges = [Decimal("-0.5"), None, Decimal("1.25")]
    for table in (pa.table({"q": charges}), pd.DataFrame({"q": charges})):
        found = vtray.Particles(np.eye(3), {"q": table["q"]})["q"]
        assert found.dtype == np.float64
        np.testing.assert_array_equal(found, [-0.5, np.nan, 1.25])
    assert as_particles({"x": [Decimal(3)], "y": [0], "z": [0]}).positions.tolist() == [[3, 0, 0]]


def test_records_with_names_have_places() -> None:
    records = pd.DataFrame({**COLUMNS, "name": ["a", "b"]}).to_records()
    assert vtray.Scene().add_spheres(records, 1).center.tolist() == np.array(POINTS).tolist()


class OnCard:
    """An array that is not in the memory of NumPy."""

    shape, dtype = (2,), "float32"

    def __init__(self, error: type[Exception]) -> None:
        self._error = error

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        message = "it is on the card"
        raise self._error(message)

    def __len__(self) -> int:
        return 2


@pytest.mark.parametrize("error", [TypeError, RuntimeError])
def test_what_cannot_be_an_array(error: type[Exception]) -> None:
    given, pair, scene = OnCard(error), vtray.Particles([(0, 0, 0), (1, 1, 1)]), vtray.Scene()
    why = r"got an array of dtype float32 and shape \(2,\) \(it is on the card\)$"
    for take in (
        lambda: scene.add_particles(given),
        lambda: scene.add_particles({"x": given, "y": [0, 1], "z": [0, 1]}),
        lambda: scene.add_particles(pair, select=given),
        lambda: scene.add_particles(pair, highlight=given),
        lambda: scene.add_particles(pair, opacity=given),
        lambda: scene.add_particles(pair, radii=given),
        lambda: scene.add_particles(pair, bonds=given),
        lambda: vtray.Particles(given),
        lambda: vtray.Particles(pair.positions, {"q": given}),
        lambda: vtray.Particles(pair.positions, bonds=given),
        lambda: vtray.Particles(pair.positions, cell=given),
        lambda: pair.select(given),
        lambda: pair.with_columns(q=given),
    ):
        with pytest.raises(SceneError, match=why):
            take()
    with pytest.raises(SceneError, match="^add_particles: color: expected a name such as"):
        scene.add_particles(pair, color=given)


@pytest.mark.parametrize("x", [[], [("x", "U4")], [("x", "f8", (3,))], [("x", "M8[s]")]])
def test_records_without_places(x: list[Any]) -> None:
    records = np.zeros(2, [*x, ("y", "f8"), ("z", "f8")])
    with pytest.raises(SceneError, match="^add_spheres: positions: expected an array of numbers"):
        vtray.Scene().add_spheres(records, 1)
    with pytest.raises(SceneError, match="^(expected the columns x, y and z|column 'x')"):
        as_particles(records)


def test_records_that_are_masked() -> None:
    fields = [("x", "f8"), ("y", "f8"), ("z", "f8")]
    records = np.ma.array(np.zeros(2, fields), mask=[(True, False, False), (False, False, False)])
    for take in (as_particles, lambda given: vtray.Scene().add_spheres(given, 1)):
        with pytest.raises(SceneError, match="masked"):
            take(records)
    with pytest.raises(SceneError, match="column 'x': expected a value for each .* leave out"):
        as_particles({name: records[name] for name in "xyz"})
    records.mask = False
    assert as_particles(records).positions.tolist() == [[0, 0, 0]] * 2
    assert vtray.Scene().add_spheres(records, 1).center.tolist() == [[0, 0, 0]] * 2


def test_mappings_without_places() -> None:
    for wrong, got in (([5.0], "{'x'.*"), ([None, 5.0], "nan")):
        with pytest.raises(SceneError, match=rf"^add_spheres: positions.*, got {got}$"):
            vtray.Scene().add_spheres({**COLUMNS, "z": wrong}, 1)


def test_a_universe_is_its_atoms() -> None:
    universe = MDAnalysis.Universe.empty(2, trajectory=True)
    universe.atoms.positions = np.array(POINTS)
    for given in (universe, universe.residues, ovito()):
        assert vtray.Scene().add_spheres(given, 1).center.tolist() == np.array(POINTS).tolist()
        assert vtray.Camera.fit(given) == vtray.Camera.fit(np.array(POINTS))
    with pytest.raises(SceneError, match=r"^add_spheres: positions: expected .* got <Universe"):
        vtray.Scene().add_spheres(MDAnalysis.Universe.empty(2), 1)


def test_atoms_are_spheres() -> None:
    water = molecule("H2O")
    assert vtray.Scene().add_spheres(water, 1).center.tolist() == water.positions.tolist()
    assert as_particles(water)["element"].tolist() == ["O", "H", "H"]


@pytest.mark.parametrize(
    ("time", "found"), [(3, 3.0), (np.float32(3), 3.0), (np.int64(3), 3.0), ("3 ps", None)]
)
def test_time_of_atoms(time: object, found: float | None) -> None:
    water = molecule("H2O")
    water.info["time"] = time
    assert vtray.from_ase(water).time == found


@pytest.mark.parametrize("given", [None, 7, "a.xyz", [1, 2, 3], [(1, 2)], pd.DataFrame({"a": [1]})])
def test_what_has_no_places(given: object) -> None:
    with pytest.raises(SceneError, match="^expected "):
        as_particles(given)
    with pytest.raises(SceneError, match="^add_particles: expected "):
        vtray.Scene().add_particles(given)


def test_wrong_objects() -> None:
    with pytest.raises(SceneError, match=r"^from_ase: expected ase.Atoms, got 7$"):
        vtray.from_ase(7)
    with pytest.raises(SceneError, match=r"^from_mdanalysis: expected a Universe or an AtomGroup "):
        vtray.from_mdanalysis(molecule("H2O"))


def ovito() -> SimpleNamespace:
    """Return what OVITO's collections of data look like."""

    class Properties(dict):
        positions = np.array(POINTS)
        particle_types = type("Types", (), {})()

    class Cell:
        pbc = (True, True, False)

        def __getitem__(self, key: object) -> np.ndarray:
            return np.array([(4, 1, 0, -1), (0, 5, 0, -2), (0, 0, 6, -3)])

    kinds = np.array([2, 1]).view(type("Kinds", (np.ndarray,), {}))
    kinds.types = [SimpleNamespace(id=1, name="Si"), SimpleNamespace(id=2, name="O")]
    Properties.particle_types = kinds
    inner = Properties(Position=POINTS, Velocity=np.ones((2, 3)))
    inner.bonds = {"Topology": np.array([(0, 1)])}
    inner["Particle Type"] = np.array([2, 1])
    return SimpleNamespace(particles=inner, cell=Cell())


def test_ovito() -> None:
    found = as_particles(ovito())
    assert {name: values.tolist() for name, values in found.columns.items()} == {
        "velocity": [[1, 1, 1]] * 2,
        "element": ["O", "Si"],
    }
    assert (found.bonds.tolist(), found.periodic) == ([[0, 1]], (True, True, False))
    assert found.cell.tolist() == [[4, 0, 0], [1, 5, 0], [0, 0, 6]]
    assert found.origin.tolist() == [-1, -2, -3]


def test_ovito_names_residues_and_structures() -> None:
    data = ovito()
    kinds = np.array([0, 1]).view(type(data.particles.particle_types))
    kinds.types = [SimpleNamespace(id=1, name="FCC")]
    data.particles["Structure Type"] = kinds
    data.particles["Residue Type"] = data.particles.particle_types
    data.particles["Atom Name"] = np.array(["OW", "a longer name"], np.dtypes.StringDType())
    data.particles["Molecule Identifier"] = np.array([7, 8])
    found = as_particles(data)
    assert found["Structure Type"].tolist() == ["0", "FCC"]
    assert found["resname"].tolist() == ["O", "Si"]
    assert (found["name"].tolist(), found["mol"].tolist()) == (["OW", "a longer name"], [7, 8])
    assert found["name"].dtype.kind == "U"


def test_each_file_has_its_call(tmp_path: Path) -> None:
    data, scene = tmp_path / "a.xyz", tmp_path / "a.json"
    data.write_text("1\n\nO 0 0 0\n")
    scene.write_text("{}")
    with pytest.raises(SceneError, match="a.xyz: is data, which vtray.read reads; expected a scen"):
        vtray.load(data)
    with pytest.raises(SceneError, match="a.json: is a scene file by its name, which vtray.load r"):
        vtray.read(scene)


@pytest.mark.parametrize(
    ("name", "more", "message"),
    [
        ("b.foo", {}, "the ending '.foo' is not known; expected one of .xyz, .extxyz, "),
        ("b", {}, "the name has no ending; expected one of .xyz, .extxyz, "),
        ("a.foo", {"format": "bar"}, "format: expected one of xyz, pdb, lammps-dump, "),
        ("a.foo", {"format": 5}, "format: expected one of xyz, pdb, lammps-dump, "),
        ("a.foo", {"format": b"xyz"}, "format: expected one of xyz, pdb, lammps-dump, "),
        (
            "a.foo",
            {"format": "xyz", "frame": -(2**63)},
            "frame -9223372036854775808: there is one frame",
        ),
        ("gone.xyz", {}, "no such file; expected a file of data"),
        (".", {"format": "xyz"}, "is a directory; expected a file of data"),
        (
            "a.foo",
            {"format": "xyz", "columns": {"radius": "r"}},
            "columns['radius']: no column 'r'",
        ),
    ],
)
def test_wrong_names(name: str, more: dict[str, object], message: str, tmp_path: Path) -> None:
    (tmp_path / "a.foo").write_text("1\n\nO 0 0 0\n")
    (tmp_path / "b.foo").write_text("O 0 0 0\n")
    (tmp_path / "b").write_text("O 0 0 0\n")
    with pytest.raises(SceneError) as caught:
        vtray.read(tmp_path / name, **more)
    assert str(caught.value).startswith(f"{tmp_path / name}: {message}")


def test_names_of_columns_and_formats(tmp_path: Path) -> None:
    path = tmp_path / "a.foo"
    path.write_text("1\n\nO 1 2 3 0.5\n")
    found = vtray.read(path, format="xyz", columns={"radius": "column5"})
    assert found["radius"].tolist() == [0.5]
    assert vtray.read(path, format=".XYZ", columns={"x": "column5"}).positions.tolist() == [
        [0.5, 2, 3]
    ]


def test_missing_package_names_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gsd.hoomd", None)
    (tmp_path / "a.gsd").write_bytes(b"x")
    with pytest.raises(ExtraError, match="^reading GSD files needs gsd, which is not installed: "):
        vtray.read(tmp_path / "a.gsd")


def test_reading_text_imports_nothing_slow(tmp_path: Path) -> None:
    (tmp_path / "a.xyz").write_text("1\n\nO 0 0 0\n")
    code = (
        "import sys, vtray; vtray.read('a.xyz').select('z == 0');"
        "print([name for name in ('ase', 'MDAnalysis', 'pandas', 'numba') if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (done.stdout, done.stderr) == ("[]\n", "")


def test_pickle_and_copies() -> None:
    given = {"element": np.array(["C", "O"]), "force": np.eye(2, 3)}
    positions = np.eye(2, 3, dtype=np.float32)
    made = vtray.Particles(positions, given, bonds=[(0, 1)], frame=3, time=0.5)
    for copied in (pickle.loads(pickle.dumps(made)), copy.deepcopy(made)):
        assert repr(copied) == repr(made)
        assert copied.positions.dtype == np.float32
        assert (copied["force"] == made["force"]).all()
        assert (copied.frame, copied.time, copied.periodic) == (3, 0.5, (False,) * 3)


ORIGIN = [(0.0, 0.0, 0.0)] * 3


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"bonds": [[0.7, 1.2]]}, "bonds[0]: expected indices from 0 to 2, got [0.7, 1.2]"),
        ({"bonds": [[0, 1], [1, np.nan]]}, "bonds[1]: expected indices from 0 to 2, got [1.0, nan"),
        ({"bonds": [[0, -1]]}, "bonds[0]: expected indices from 0 to 2, got [0, -1]"),
        ({"bonds": [[0, 1, 2, 1]]}, "bonds: expected indices of shape (m, 2), got [[0, 1, 2, 1]]"),
        ({"bonds": [[0, 1, 2]]}, "bonds: expected indices of shape (m, 2), got [[0, 1, 2]]"),
        ({"bonds": [[0, 1], [2]]}, "bonds: expected indices of shape (m, 2), got [[0, 1], [2]]"),
        ({"bonds": "file"}, "bonds: expected indices of shape (m, 2), got 'file'"),
        ({"positions": [(0, 0, 0), (1, 1)]}, "positions: must be an array of numbers, got [(0, 0,"),
        ({"positions": [(0, 0, 10**400)]}, "positions: must be an array of numbers, got [(0, 0, "),
        ({"cell": [(1, 0, 0), (0, 1)]}, "cell: must be an array of numbers, got [(1, 0, 0), (0,"),
        ({"cell": "cubic"}, "cell: must be an array of numbers, got 'cubic'"),
        ({"periodic": [True, [False]]}, "periodic: expected three of True and False, one for each"),
        (
            {"columns": None},
            'columns: must be arrays by their names, as in {"radius": radii}, got None',
        ),
        (
            {"columns": {"a": [1, [2]]}},
            "columns['a']: must have one row for each of 3 positions, got [1, [2]]",
        ),
    ],
)
def test_wrong_arrays_of_particles(given: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError) as caught:
        vtray.Particles(**{"positions": ORIGIN, **given})
    assert str(caught.value).startswith(f"Particles.{message}")
    if "bonds" in given and given["bonds"] != "file":
        with pytest.raises(SceneError) as caught:
            vtray.Scene().add_particles(ORIGIN, bonds=given["bonds"])
        assert str(caught.value).startswith(message)


def test_truths_are_neither_places_nor_radii() -> None:
    mask, plain = np.eye(3, dtype=bool), vtray.Particles(ORIGIN, {"radius": [True, False, True]})
    for take in (vtray.Particles, as_particles, vtray.Scene().add_spheres):
        with pytest.raises(SceneError, match=r"got an array of dtype bool and shape \(3, 3\)$"):
            take(mask, *([1] if take.__name__ == "add_spheres" else []))
    with pytest.raises(
        SceneError, match="^column 'x'\\[0\\]: expected numbers, got such as 'True'$"
    ):
        as_particles(dict(zip("xyz", mask, strict=True)))
    got = r"expected numbers, got an array of dtype bool and shape \(3,\)$"
    with pytest.raises(SceneError, match=f"^radii: {got}"):
        vtray.Scene().add_particles(ORIGIN, radii=mask[0])
    with pytest.raises(SceneError, match=f"^radii: column 'radius': {got}"):
        vtray.Scene().add_particles(plain)


def test_a_wrong_radius_names_its_column() -> None:
    particles = vtray.Particles(ORIGIN, {"radius": [1.0, np.nan, 1.0]})
    for radii, column in ((None, "radius"), ("radii", "radii")):
        words = rf"^radii: column '{column}'\[1\]: expected a number ≥ 0, got nan$"
        with pytest.raises(SceneError, match=words):
            vtray.Scene().add_particles(particles, radii=radii)


@pytest.mark.parametrize("bonds", [[], [[0.0, 1.0]], np.array([[0, 1]], np.uint64)])
def test_bonds_are_integers(bonds: Any) -> None:
    made = vtray.Particles(ORIGIN, bonds=bonds)
    assert made.bonds is not None
    assert (made.bonds.dtype, made.bonds.shape) == (np.int64, (len(bonds), 2))


def test_names_of_columns_are_in_particles() -> None:
    particles = vtray.Particles(ORIGIN, {"element": ["C", "O", "H"]})
    asked = ["element", "symbol", "x", "velocity", "", 0, None]
    there = [name in particles for name in asked]
    assert there == [True, True, True, False, False, False, False]
    for name, is_there in zip(asked, there, strict=True):
        if is_there:
            assert len(particles[name]) == 3
    for many in (list, dict, iter):
        with pytest.raises(TypeError, match="'Particles' object is not iterable"):
            many(particles)


def test_columns_of_matrices_do_not_keep_tables_from_being_read() -> None:
    table = pd.DataFrame({"x": [0.0, 1], "y": [0.0, 1], "z": [0.0, 1]})
    table["stress"] = [np.eye(3)] * 2
    table["force"] = [np.ones(3)] * 2
    particles = as_particles(table)
    assert particles["stress"].shape == (2,)
    assert particles["force"].shape == (2, 3)


@pytest.mark.parametrize("made", [pl.Series, pd.Series, pa.array])
def test_lists_of_several_lengths_are_texts(made: Any) -> None:
    column = made([[1], [2, 3], []])
    assert vtray.Particles(ORIGIN, {"n": column})["n"].tolist() == ["[1]", "[2, 3]", "[]"]
    column = made([[1.0], None, [2.0, float("nan")]])
    assert vtray.Particles(ORIGIN, {"n": column})["n"].tolist() == ["[1.0]", "", "[2.0, nan]"]


def test_fractions_are_numbers() -> None:
    places = Particles([[Fraction(1, 2), 2, 3]]).positions  # type: ignore[arg-type]
    assert places.tolist() == [[0.5, 2.0, 3.0]]


TOPOLOGIES = {
    "psf": (datafiles.PSF, datafiles.DCD),
    "prmtop": (datafiles.PRM, datafiles.TRJ),
    "mol2": (datafiles.mol2_molecules,),
    "PDB with CONECT": (datafiles.CONECT,),
    "LAMMPS": (datafiles.LAMMPSdata,),
}


@pytest.mark.parametrize("files", TOPOLOGIES.values(), ids=TOPOLOGIES)
@pytest.mark.filterwarnings("ignore")
def test_bonds_are_those_that_mdanalysis_gives(files: tuple[str, ...]) -> None:
    made = MDAnalysis.Universe(*files)
    assert np.array_equal(bonds_of(made), made.bonds.indices)


@pytest.mark.filterwarnings("ignore")
def test_bonds_that_change_are_as_they_are() -> None:
    made = MDAnalysis.Universe(datafiles.PSF, datafiles.DCD)
    made.add_bonds([(0, 9)])
    assert [0, 9] in bonds_of(made).tolist()
    assert np.array_equal(bonds_of(made), made.bonds.indices)
    made.delete_bonds([(0, 9)])
    assert np.array_equal(bonds_of(made), made.bonds.indices)


def test_bonds_of_what_keeps_them_otherwise() -> None:
    pairs = SimpleNamespace(indices=[(0, 1), (1, 2)])
    assert bonds_of(SimpleNamespace(bonds=pairs)).tolist() == [[0, 1], [1, 2]]
    assert bonds_of(SimpleNamespace()) is None
