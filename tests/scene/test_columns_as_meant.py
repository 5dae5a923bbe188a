"""Columns are what people mean by them, or there is a word about it."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

import vtray
from vtray import Particles, Scene
from vtray.base.errors import SceneError
from vtray.scene.particles.from_objects import as_particles

POSITIONS = np.arange(15.0).reshape(5, 3)


def counted(**columns: object) -> Particles:
    return Particles(POSITIONS, {name: np.asarray(values) for name, values in columns.items()})


@pytest.mark.parametrize(
    ("norm", "limits"), [("log", (1.0, 10000.0)), ("centered", (-10000.0, 10000.0))]
)
def test_a_norm_makes_few_integers_values(norm: str, limits: tuple[float, float]) -> None:
    particles = counted(size=[1, 10, 100, 1000, 10000])
    scale = Scene().add_particles(particles, color="size", norm=norm).color_scale
    assert scale is not None
    assert (scale.low, scale.high) == limits
    assert Scene().add_particles(particles, color="size").color_scale is None


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"norm": "log"}, "leave norm out"),
        ({"cmap": "magma", "clim": (0, 1)}, "leave cmap and clim out"),
    ],
)
def test_names_have_no_norm(asked: dict[str, object], words: str) -> None:
    with pytest.raises(SceneError, match=words):
        Scene().add_particles(counted(kind=list("abcab")), color="kind", **asked)  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", ["M8[D]", "m8[s]"])
def test_dates_are_no_values_but_their_days_are(kind: str) -> None:
    dates = np.arange(5).astype(kind)
    words = "^color: column 't' holds dates, which no colour map is for; give numbers, such as of d"
    with pytest.raises(SceneError, match=words):
        Scene().add_particles(Particles(POSITIONS, {"t": dates}), color="t", cmap="viridis")
    days = (dates - dates[0]) / np.timedelta64(1, "D")
    scale = Scene().add_particles(POSITIONS, color=days, cmap="viridis").color_scale
    assert scale is not None
    assert scale.high == (4 if kind == "M8[D]" else 4 / 86400)


def test_logarithms_of_what_is_not_above_0() -> None:
    values = [-0.0, -3.0, -6.0, np.nan, -12.0]
    with pytest.warns(UserWarning, match="norm: no value is above 0, as logarithms need"):
        Scene().add_particles(counted(a=values), color="a", norm="log")
    Scene().add_particles(counted(a=[np.nan] * 5), color="a", norm="log")


@pytest.mark.parametrize("called", ["diameter", "Diameters"])
def test_half_a_diameter_is_a_radius(called: str) -> None:
    size = [1.0, 2.0, 3.0, 4.0, 5.0]
    table = {"x": POSITIONS[:, 0], "y": POSITIONS[:, 1], "z": POSITIONS[:, 2]}
    spheres = Scene().add_particles({**table, called: np.array(size)}).spheres
    assert spheres.radius.tolist() == [0.5, 1.0, 1.5, 2.0, 2.5]  # type: ignore[union-attr]
    both = {**table, called: np.array(size), "radius": np.array(size)}
    assert Scene().add_particles(both).spheres.radius.tolist() == size  # type: ignore[union-attr]


def test_names_of_files_in_expressions(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("x,y,z,q\n0,0,0,-1\n1,0,0,2\n")
    particles = vtray.read(path)
    assert particles.select("q > 0")["charge"].tolist() == [2]
    assert particles.select("charges > 0")["charge"].tolist() == [2]
    assert Scene().add_particles(particles, color="0.5 * q").color_scale is not None


@pytest.mark.parametrize(
    ("given", "hint"), [(POSITIONS.T, " (transpose it)"), (POSITIONS.T[:2], "")]
)
def test_places_that_lie(given: Any, hint: str) -> None:
    words = f"an array of dtype float64 and shape {given.shape}{hint}"
    with pytest.raises(SceneError, match=f"got {re.escape(words)}$"):
        Scene().add_particles(given)


def test_an_element_that_is_missing_among_others() -> None:
    table = dict(zip("xyz", POSITIONS.T, strict=True))
    drawn = Scene().add_particles({**table, "element": ["C", None, "H", "O", "C"]})
    assert [name for name, _ in drawn.legend] == ["X", "H", "C", "O"]
    assert set(as_particles({**table, "element": ["C", "H", "O", "", "N"]}).columns) == {"element"}
    found = as_particles({**table, "element": ["FE", None, "H", "O", "C"]})
    assert found["name"].tolist() == ["FE", "", "H", "O", "C"]
    assert found["element"].tolist() == ["Fe", "X", "H", "O", "C"]


def test_what_is_missing_in_categories_of_arrow() -> None:
    kinds = pa.array(["a", "b", None, "a", None]).dictionary_encode()
    table = pa.table({**dict(zip("xyz", POSITIONS.T, strict=True)), "kind": kinds})
    drawn = Scene().add_particles(table, color="kind")
    assert [name for name, _ in drawn.legend] == ["(none)", "a", "b"]
    drawn = Scene().add_particles(POSITIONS, color=table["kind"], categories=["a", "b", ""])
    colors: Any = drawn.spheres.color
    assert colors[2].tolist() == colors[4].tolist() != colors[1].tolist()
    numbers = pa.chunked_array([pa.array([5, 7, None, 5, 7]).dictionary_encode()])
    spheres = Scene().add_spheres(POSITIONS, 0.1, color=numbers, cmap="viridis", nan_color="red")
    assert np.asarray(spheres.color)[2].tolist() == [255, 0, 0]


def test_statistics_leave_out_what_is_missing() -> None:
    particles = counted(a=[1.0, np.nan, 2.0, 3.0, 4.0], b=[np.nan] * 5)
    assert particles.select("a > mean(a)")["a"].tolist() == [3.0, 4.0]
    assert particles.select("a == max(a) or a == min(a)")["a"].tolist() == [1.0, 4.0]
    assert len(particles.select("b == max(b)")) == 0


@pytest.mark.parametrize("kind", [np.int8, np.int32, np.int64])
def test_images_in_one_column(kind: type[np.generic]) -> None:
    image = np.array([[0, 0, 0], [1, -2, 0]], kind)
    cell = np.diag([5.0, 5.0, 5.0])
    particles = Particles([[2.4, 0, 0], [-2.4, 1, 0]], {"image": image}, cell=cell)
    spheres = Scene().add_particles(particles, unwrap=True, cell=False).spheres
    assert np.allclose(spheres.center, [[2.4, 0, 0], [2.6, -9, 0]])
    wrong = Particles([[2.4, 0, 0], [-2.4, 1, 0]], {"image": [1, 2]}, cell=cell)
    with pytest.raises(SceneError, match="unwrap: needs bonds, or the columns ix, iy and iz, or"):
        Scene().add_particles(wrong, unwrap=True)


def test_halves_of_bonds_are_as_faint_as_whole_ones() -> None:
    positions = [[0.5, 2, 2], [4.3, 2, 2], [1.2, 1, 2], [2.4, 1, 2]]
    particles = Particles(positions, {"element": list("COCO")}, cell=np.diag([5.0, 4.0, 4.0]))
    drawn = Scene().add_particles(
        particles, "ball-and-stick", bonds=1.25, highlight="element == 'O'", opacity=0.3
    )
    assert drawn.bonds is not None
    assert len(drawn.bonds) == 4  # two whole ones and two halves
    assert drawn.bonds.opacity == 0.3


def test_npz_knows_the_whole_frame(tmp_path: Path) -> None:
    path, bonds = tmp_path / "a.npz", [[0, 1], [1, 2], [2, 0]]
    np.savez(
        path,
        positions=np.ones((3, 3)),
        cell=[5, 6, 7],
        pbc=[1, 0, 1],
        origin=[1, 2, 3],
        bonds=bonds,
    )
    found = vtray.read(path)
    assert not found.columns
    assert found.periodic == (True, False, True)
    assert found.origin.tolist() == [1.0, 2.0, 3.0]
    assert found.bonds is not None
    assert found.bonds.tolist() == bonds
    np.savez(path, positions=np.ones((3, 3)), pbc=[1, 2, 3])
    assert list(vtray.read(path).columns) == ["pbc"]


def test_npy_of_records(tmp_path: Path) -> None:
    path = tmp_path / "a.npy"
    np.save(path, np.rec.fromarrays([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0], [7, 8]], names="x,y,z,q"))
    found = vtray.read(path)
    assert found.positions.tolist() == [[1, 3, 5], [2, 4, 6]]
    assert found["charge"].tolist() == [7, 8]


def test_ply_with_colors_of_16_bits(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    names = [f"property float {axis}" for axis in "xyz"]
    names += [f"property ushort {name}" for name in ("red", "green", "blue")]
    head = ["ply", "format ascii 1.0", "element vertex 1", *names, "end_header"]
    path.write_text("\n".join([*head, "1 2 3 65535 32768 255", ""]))
    assert vtray.read(path)["color"].tolist() == [[255, 128, 0]]


QUOTES = {
    'x,y,z,name\n0,0,0,C\n1,0,0,"O5\n2,0,0,C\n3,0,0,N\n': "line 3: a quote has no end",
    'x,y,z,name\n0,0,0,C\n1,0,0,"O5': "line 3: unexpected end of data",
    'x,name,y,z\n0,C,0,0\n1,"O5,0,0\n2,"C",0,0\n': "line 3: a quote has no end",
    '# a table\n# of two rows\nx,y,"z\n0,0,0\n': "line 3: a quote has no end",
    'x,name,y,z\n0,"C\nD",0\n': "line 2: expected 4 entries, got 3",
}


@pytest.mark.parametrize(("text", "words"), QUOTES.items())
def test_quotes_without_an_end(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(SceneError) as raised:
        vtray.read(path)
    assert str(raised.value) == f"{path}: {words}"


def test_bonds_that_are_far_too_long_are_told_at_once() -> None:
    positions = np.random.default_rng(1).uniform(0, 8, (30, 3))
    particles = Particles(positions, cell=np.diag([8.0, 8.0, 8.0]))
    with pytest.raises(SceneError, match="there are more than 64 bonds for each particle"):
        Scene().add_particles(particles, bonds=100.0)
    assert len(Scene().add_particles(particles, bonds=3.0).bonds or ()) > 30


def test_many_categories_that_are_known() -> None:
    names = [f"residue {k}" for k in range(4000)]
    particles = Particles(np.zeros((4000, 3)), {"name": np.array(names)})
    drawn = Scene().add_particles(particles, color="name", categories=names)
    assert [name for name, _ in drawn.legend] == names


@pytest.mark.parametrize(
    "names",
    [
        "x [nm],y [nm],z [nm]",
        "X (mm),Y (mm),Z (mm)",
        "Points:0,Points:1,Points:2",
        "Points_0,Points_1,Points_2",
        "pos_x,pos_y,pos_z",
        "Pos.x [m],Pos.y [m],Pos.z [m]",
        "Position X,Position Y,Position Z",
        "xpos,ypos,zpos",
        "x-coordinate,y-coordinate,z-coordinate",
    ],
)
def test_places_as_programs_call_them(names: str, tmp_path: Path) -> None:
    x, y, z = names.split(",")
    # In any order, and beside others.
    (tmp_path / "a.csv").write_text(f"id,{z},{x},speed [m/s],{y}\n7,3,1,0.5,2\n")
    found = vtray.read(tmp_path / "a.csv")
    assert found.positions.tolist() == [[1, 2, 3]]
    assert [*found.columns] == ["id", "speed [m/s]"]


def test_lengths_in_the_unit_of_the_places(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("x [nm],y [nm],z [nm],Diameter [nm],Mass [g]\n1,2,3,5,4\n")
    found = vtray.read(tmp_path / "a.csv")
    assert [*found.columns] == ["radius", "diameter", "Mass [g]"]
    assert found["radius"].tolist() == [2.5]
    (tmp_path / "a.csv").write_text("x [nm],y [nm],z [nm],radius [um]\n1,2,3,5\n")
    assert [*vtray.read(tmp_path / "a.csv").columns] == ["radius [um]"]


@pytest.mark.parametrize(
    "names",
    [
        "x [nm],y [nm],z [um]",
        "x [nm],y [nm],z",
        "pos_x,pos_y,pos_z,x [nm],y [nm],z [nm]",
        "x[1],y[1],z[1]",
        "Points:0,Points:1,Points:3",
        "v_0,v_1,v_2",
        "max,may,maz",
    ],
)
def test_places_that_are_not_clear(names: str, tmp_path: Path) -> None:
    row = ",".join("1" for _ in names.split(","))
    (tmp_path / "a.csv").write_text(f"{names}\n{row}\n")
    with pytest.raises(SceneError, match="expected the columns x, y and z, got"):
        vtray.read(tmp_path / "a.csv")


def test_x_y_and_z_go_before_others(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("pos_x,pos_y,pos_z,x,y,z\n7,8,9,1,2,3\n")
    found = vtray.read(tmp_path / "a.csv")
    assert found.positions.tolist() == [[1, 2, 3]]
    assert [*found.columns] == ["pos_x", "pos_y", "pos_z"]


def test_comments_of_matlab_and_comsol(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("% Model:  a.mph\n% Date: May 1\n% x  y  z  T (K)\n1 2 3 300\n4 5 6 301\n")
    found = vtray.read(path)
    assert found.positions.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert found["T"].tolist() == [300, 301]
    path.write_text("%x [mm]\ty [mm]\tz [mm]\n1\t2\t3\n")
    assert vtray.read(path).positions.tolist() == [[1, 2, 3]]
