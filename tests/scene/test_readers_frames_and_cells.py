"""What files say of cells and images, frame by frame."""

import os
from pathlib import Path

import ase.io
import numpy as np
import pyarrow as pa
import pytest
from ase import Atoms

import vtray
from vtray.base.errors import SceneError

DUMP = """\
ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS pp pp pp
0 10
0 10
0 10
ITEM: ATOMS id element {names} ix iy iz
1 C {first} 0 0 0
2 C {second} 1 0 0
"""


@pytest.mark.parametrize(
    ("names", "first", "second"),
    [
        ("x y z", "9.5 5 5", "0.9 5 5"),
        ("xs ys zs", "0.95 0.5 0.5", "0.09 0.5 0.5"),
        ("xu yu zu", "9.5 5 5", "10.9 5 5"),
        ("xsu ysu zsu", "0.95 0.5 0.5", "1.09 0.5 0.5"),
    ],
)
def test_dumps_are_unwrapped_once(names: str, first: str, second: str, tmp_path: Path) -> None:
    path = tmp_path / "a.dump"
    path.write_text(DUMP.format(names=names, first=first, second=second))
    drawn = vtray.Scene().add_particles(vtray.read(path), unwrap=True)
    places = drawn.spheres.center
    np.testing.assert_allclose(np.sort(places[:, 0]), [9.5, 10.9])


def test_models_have_cells_of_their_own(tmp_path: Path) -> None:
    sizes = [5.6, 5.7, 5.8]
    frames = [Atoms("Ar", [(1, 1, 1)], cell=[size] * 3, pbc=True) for size in sizes]
    ase.io.write(tmp_path / "a.pdb", frames)
    assert [one.cell[0, 0] for one in vtray.read_frames(tmp_path / "a.pdb")] == sizes
    assert vtray.read(tmp_path / "a.pdb", frame=1).cell[0, 0] == 5.7


ATOM = "ATOM      1  O   HOH A   1       1.000   2.000   3.000  1.00  0.00           O\n"


@pytest.mark.parametrize(
    ("lengths", "repeats"),
    [
        ("    0.000    0.000    0.000", (False, False, False)),
        ("    1.000    1.000    1.000", (False, False, False)),
        ("    0.000    0.000    7.379", (False, False, True)),
        ("    4.000    5.000    6.000", (True, True, True)),
    ],
)
def test_edges_without_length_do_not_repeat(lengths: str, repeats: tuple, tmp_path: Path) -> None:
    path = tmp_path / "a.pdb"
    path.write_text(f"CRYST1{lengths}  90.00  90.00  90.00 P 1           1\n{ATOM}")
    found = vtray.read(path)
    assert found.periodic == repeats
    assert (found.cell is None) is not any(repeats)


def test_cells_of_arrays_repeat(tmp_path: Path) -> None:
    arrays = {"positions": [[0.2, 1, 1], [4.8, 1, 1]], "element": ["C", "C"], "cell": np.eye(3) * 5}
    np.savez(tmp_path / "a.npz", **arrays)
    found = vtray.read(tmp_path / "a.npz")
    assert found.periodic == (True, True, True)
    assert vtray.Scene().add_particles(found, bonds=True).bonds is not None
    np.savez(tmp_path / "b.npz", **arrays, pbc=[False, True, True])
    assert vtray.read(tmp_path / "b.npz").periodic == (False, True, True)


@pytest.mark.parametrize("lattice", ["[[5,1,2],[0,5,0],[0,0,5]]", '"5 1 2 0 5 0 0 0 5"'])
def test_lattices_as_lists(lattice: str, tmp_path: Path) -> None:
    path = tmp_path / "a.xyz"
    path.write_text(f"1\nLattice={lattice} Properties=species:S:1:pos:R:3 pbc=[T,F,T]\nC 0 0 0\n")
    found = vtray.read(path)
    assert found.cell.tolist() == [[5, 1, 2], [0, 5, 0], [0, 0, 5]]
    assert found.periodic == (True, False, True)


DATA = """\
two atoms

{count} atoms
1 atom types
0 10 xlo xhi
0 10 ylo yhi
0 10 zlo zhi

Atoms # atomic

1 1 9.5 5 5 0 0 0
2 1 0.9 5 5 1 0 0

Velocities

1 0 0 1
2 0 0 2
"""


def test_images_of_data_files(tmp_path: Path) -> None:
    path = tmp_path / "a.data"
    path.write_text(DATA.format(count=2))
    found = vtray.read(path, format="lammps-data")
    assert found["ix"].tolist() == [0, 1]
    places = vtray.Scene().add_particles(found, unwrap=True).spheres.center
    np.testing.assert_allclose(np.sort(places[:, 0]), [9.5, 10.9])
    path.write_text(DATA.format(count=3))
    with pytest.raises(SceneError, match="line 13: expected 5 entries, got 0"):
        vtray.read(path, format="lammps-data")


def test_frames_of_a_pipe_are_not_counted() -> None:
    for frames, words in ((None, "frames of a pipe cannot be counted"), ([1], "")):
        reading, writing = os.pipe()
        os.write(writing, b"1\n\nC 0 0 0\n1\n\nC 1 0 0\n")
        os.close(writing)
        found = vtray.read_frames(f"/dev/fd/{reading}", frames, format="xyz")
        try:
            if words:
                with pytest.raises(SceneError, match=words):
                    next(found)
            else:
                assert next(found).positions.tolist() == [[1, 0, 0]]
        finally:
            os.close(reading)


def test_columns_by_what_files_call_them() -> None:
    found = vtray.Particles(np.eye(3), {"charge": [1.0, 2.0, 3.0], "mass": [1.0, 1.0, 2.0]})
    assert found["q"].tolist() == [1, 2, 3]
    first, second = (
        vtray.Scene().add_particles(found, color=name, radii=size).spheres
        for name, size in (("charge", "mass"), ("q", "Masses"))
    )
    np.testing.assert_array_equal(first.color, second.color)
    np.testing.assert_array_equal(first.radius, second.radius)
    table = pa.table({"x": [0.0, 1.0], "y": [0.0, 1.0], "z": [0.0, 1.0], "q": [1.0, 2.0]})
    assert len(vtray.Scene().add_particles(table, color="charge").spheres) == 2


def test_columns_of_names_of_colours(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("x,y,z,color\n0,0,0,red\n1,0,0,#00ff00\n2,0,0,red\n")
    drawn = vtray.Scene().add_particles(vtray.read(path))
    assert drawn.spheres.color.tolist() == [[255, 0, 0], [0, 255, 0], [255, 0, 0]]
    assert not drawn.legend
    path.write_text("x,y,z,color\n0,0,0,dull\n1,0,0,bright\n")
    names = [name for name, _ in vtray.Scene().add_particles(vtray.read(path)).legend]
    assert names == ["bright", "dull"]
    path.write_text("x,y,z,color\n0,0,0,red\n1,0,0,bright\n")
    with pytest.raises(SceneError, match=r"color\[1\]: expected a name .*, got 'bright'$"):
        vtray.Scene().add_particles(vtray.read(path))


def test_what_is_masked_is_not_drawn() -> None:
    places, masked = np.arange(9.0).reshape(3, 3), np.ma.masked_array([1.0, 50, 3], [0, 1, 0])
    rows = np.ma.masked_array(places, mask=[[0] * 3, [1] * 3, [0] * 3])
    chosen = np.ma.masked_array([True, True, False], [0, 1, 0])
    words = "got an array with masked numbers; leave out what is masked"
    scene = vtray.Scene()
    for name, give in {
        "positions": lambda: scene.add_particles(rows),
        "Particles.positions": lambda: vtray.Particles(rows),
        r"Particles.columns\['e'\]": lambda: vtray.Particles(places, {"e": masked}),
        "color": lambda: scene.add_particles(places, color=masked),
        "radii": lambda: scene.add_particles(places, radii=masked),
        "select": lambda: scene.add_particles(places, select=chosen),
        "opacity": lambda: scene.add_particles(places, opacity=masked / 100),
        "bonds": lambda: scene.add_particles(places, bonds=rows[:, :2]),
        "Particles.bonds": lambda: vtray.Particles(places, bonds=rows[:, :2]),
        "Particles.cell": lambda: vtray.Particles(places, cell=masked),
        "Particles.origin": lambda: vtray.Particles(places, origin=masked),
    }.items():
        with pytest.raises(SceneError, match=f"{name}: .*{words}"):
            give()
