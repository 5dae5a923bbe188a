"""Files of data whose names do not say what they are; tables between blanks, or without names."""

import gzip
import os
import random
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import numpy as np
import pytest

import vtray
from vtray.base.errors import SceneError
from vtray.scene.readers.reader_table import is_data

DUMP = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id type x y z\n1 2 4 5 6\n"
DATA = "title\n\n1 atoms\n2 atom types\n\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\n"
ATOMS = f"{DATA}Atoms # atomic\n\n1 2 4 5 6\n"
ATOM = f"{'ATOM      1  O   HOH A   1':30}   4.000   5.000   6.000  1.00  0.00\n"

CONTENTS = {
    "dump.100": DUMP,
    "dump": DUMP.replace("\n", "\r\n"),
    "with its units": f"ITEM: UNITS\nlj\n{DUMP}",
    "data.melt": ATOMS,
    "a.lammps": ATOMS.replace("1 atoms", "  1  atoms  # of argon"),
    "a.box": ATOMS.replace("0 9 xlo xhi", "9 0 0 avec"),
    "movie.txt": "1\nAtoms. Timestep: 0\n1 4 5 6\n",
    "ethanol": "1\n\nO 4.0 5e0 +6. 1\n",
    "a.brk": f"HEADER    WATER{' ' * 50}\n{ATOM}",
    "b.brk": ATOM,
    "positions.dat": "4 5 6\n7 8 9\n",
    "positions": "\n  4.0\t5.0   6.0  \n",
    "named.dat": "# by a program\n# x y z q\n4 5 6 0.5\n",
    "named.txt": "q;X;y;z\n0.5;4;5;6\n",
    "marked.txt": "\ufeff4,5,6\n",
    "fortran.dat": "  4.0D+00  5.0D+00  0.6D+01\n",
    "long.txt": "4 5 6\n" + "1 2 3\n" * 9999,
}


@pytest.mark.parametrize(("name", "text"), CONTENTS.items())
def test_what_begins_like_nothing_else(name: str, text: str, tmp_path: Path) -> None:
    for ending, pack in {"": bytes, ".gz": gzip.compress}.items():
        packed = tmp_path / f"{name}{ending}"
        packed.write_bytes(pack(text.encode()))
        assert is_data(str(packed))
        assert vtray.read(packed).positions[0].tolist() == [4, 5, 6]


OTHERS = {
    "a scene": '{"camera": {}}',
    "a scene after blanks": '\n  {"x": 1, "y": 2, "z": 3}',
    "words": "ITEMS\n1 2 3\n",
    "a list": "1\n2\n3\n",
    "two numbers": "1 2\n3 4\n",
    "columns in a plane": "x y\n1 2\n",
    "no number": "nan inf nan\n** ** **\n",
    "an hour": "12:30 1 2 3\n",
    "nothing": "",
    "a picture": "\x89PNG\r\n\x1a\n\x00\x00\x001 2 3",
    "atoms without a box": "2 atoms\n\nhere\n",
    "a count alone": "3\n",
}


@pytest.mark.parametrize("text", OTHERS.values(), ids=OTHERS)
def test_what_is_not_told(text: str, tmp_path: Path) -> None:
    path = tmp_path / "a.foo"
    path.write_bytes(text.encode("latin-1"))
    assert not is_data(str(path))
    with pytest.raises(SceneError, match="a.foo: the ending '.foo' is not known; expected one of"):
        vtray.read(path)


@pytest.mark.parametrize("first", ["nan 2 3", "1 -Infinity 3", "1 2 *****"])
def test_tables_whose_first_numbers_are_none(first: str, tmp_path: Path) -> None:
    path = tmp_path / "a.dat"
    path.write_text(f"{first}\n4 5 6\n")
    with pytest.raises(SceneError, match=r"a.dat: line 1: column '\w'"):
        vtray.read(path)


def test_what_cannot_be_looked_at_is_not_told(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.foo")
    (tmp_path / "a.foo.gz").write_bytes(b"1 2 3\n")
    (tmp_path / "folder.foo").mkdir()
    for name in ("pipe.foo", "a.foo.gz", "folder.foo", "none.foo", "a\0.foo"):
        assert not is_data(str(tmp_path / name))


def test_a_name_goes_before_the_content(tmp_path: Path) -> None:
    (tmp_path / "a.pdb").write_text(DUMP)
    with pytest.raises(SceneError, match="a.pdb: expected lines that begin with ATOM or HETATM"):
        vtray.read(tmp_path / "a.pdb")


def test_the_command_tells_data_from_scenes(
    vtray_command: Callable[..., CompletedProcess[str]], tmp_path: Path
) -> None:
    (tmp_path / "dump.100").write_text(DUMP)
    (tmp_path / "scene.dat").write_text('{"camera": 1}')
    small = ("--size", "8x8", "--samples", "1")
    done = vtray_command(*small, "dump.100", "a.png", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    done = vtray_command(*small, "--radii", "covalent", "dump.100", "a.png", cwd=tmp_path)
    assert "is a scene" not in done.stderr
    done = vtray_command("scene.dat", "a.png", cwd=tmp_path)
    assert done.stderr.startswith("Error: scene.dat: ")
    with pytest.raises(SceneError, match="dump.100: is data, which vtray.read reads; expected a s"):
        vtray.load(tmp_path / "dump.100")


@pytest.mark.parametrize("text", ["4 5 6\n1 2 3\n", "# made by me\n4,5,6\n", "x y z\n4 5 6\n"])
def test_xyz_files_without_a_count(text: str, tmp_path: Path) -> None:
    path = tmp_path / "scan.xyz"
    path.write_text(text)
    assert vtray.read(path, frame=-1).positions[0].tolist() == [4, 5, 6]
    (found,) = vtray.read_frames(path)
    assert found.positions[0].tolist() == [4, 5, 6]


NO_NUMBER = float("nan")

BLANKS = {
    "names": ("  x   y  z  name\n 4 5\t 6   a \n  1 2 3 b\n\n", {"name": ["a", "b"]}),
    "quotes": ('x y z name\n4 5 6 "a b"\n', {"name": ["a b"]}),
    "names in a comment": ("# 3 ps\n#x y z vx vy vz\n4 5 6 1 2 3\n  \n", {"velocity": [[1, 2, 3]]}),
    "another comment": ("# by me\n4 5 6\n", {}),
    "no names": ("4 5 6\n\n \t\n1 2 3\n", {}),
    "commas": ("4,5,6\n1,2,3\n", {}),
    "the same twice": ("4 5 6\n4 5 6\n", {}),
    "Fortran": (
        "x y z a b\n 4.0D+00 .5d+1 6.0D0 -1.5D-003 1.234-101\n 1.0D0 2 3.0 NaN 1.0\n",
        {"a": [-0.0015, NO_NUMBER], "b": [1.234e-101, 1.0]},
    ),
    "no names, Fortran": ("  4.0D+00  5.0D+00  0.600D+01\n", {}),
    "labels": (
        "x y z at bin\n4 5 6 1D1 1.5-100\n1 2 3 2D1 0.1-100\n",
        {"at": ["1D1", "2D1"], "bin": ["1.5-100", "0.1-100"]},
    ),
    "marks": (
        "x,y,z,mark,sure\n4,5,6,***,**\n1,2,3,,yes\n",
        {"mark": ["***", ""], "sure": ["**", "yes"]},
    ),
    "Windows": ("# x y z charge\r\n4 5 6 7\r\n", {"charge": [7]}),
}


@pytest.mark.parametrize(("text", "columns"), BLANKS.values(), ids=BLANKS)
def test_tables(text: str, columns: dict[str, list[object]], tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text, newline="")
    found = vtray.read(path)
    assert found.positions[0].tolist() == [4, 5, 6]
    assert repr({name: values.tolist() for name, values in found.columns.items()}) == repr(columns)


def test_columns_without_names_have_numbers(tmp_path: Path) -> None:
    path = tmp_path / "a.dat"
    path.write_text("7 0.5 4 5 6\n")
    found = vtray.read(path, columns={"x": "3", "y": "4", "z": "5", "radius": "2"})
    assert found.positions.tolist() == [[4, 5, 6]]
    assert (found["radius"].tolist(), found["1"].tolist()) == ([0.5], [7])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("4 5 6 7\n", "expected the names of the columns, or three numbers, got 4; columns={"),
        ("x y z\n1 2 3\n1 2\n", "line 3: expected 3 entries, got 2$"),
        ("1 2 3\n1 2 3 4\n", "line 2: expected 3 entries, got 4$"),
        ("\n# one\n1 2 3\n", "line 3: expected 2 entries, got 3$"),
        ("# one\n\n1 2 3\n\n1 a 3\n", "line 5: column 'y': expected numbers, got such as 'a'$"),
        ('"1","2","3"\n"1","a","3"\n', "line 2: column 'y': expected numbers, got such as 'a'$"),
        ("1 2 3\n1 2 nan\n", "line 2: column 'z': must be finite, got nan$"),
        ("nan 2 3\n", "line 1: column 'x': must be finite, got nan$"),
        ("x y z\n1 2 NA\n", "line 2: column 'z': must be finite, got nan$"),
        (
            "1 2 3\n1 **** 3\n",
            "line 2: column '2': expected a number, got '[*]{4}'; Fortran writes ",
        ),
        (
            "** 2 3\n1 2 3\n",
            "line 1: column '1': expected a number, got '[*][*]'; Fortran writes stars whe",
        ),
        ("x y z m\n1 2 3 4\n1 2 3 ***\n", "line 3: column 'm': expected a number, got '[*]{3}';"),
        ("x y z\n1.0D0 2 3\nD 2 3\n", "line 3: column 'x': expected numbers, got such as 'D'$"),
        ('x y z\n1 2 "3\n', "line 2: (a quote has no end|unexpected end of data)$"),
    ],
)
def test_wrong_tables(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(SceneError, match=f"a.csv: {message}"):
        vtray.read(path)


def test_what_numpy_writes(tmp_path: Path) -> None:
    places = np.random.default_rng(1).normal(size=(2000, 3))
    for header in ("", "x y z", "by me\nx y z"):
        np.savetxt(tmp_path / "a.txt", places, header=header)
        found = vtray.read(tmp_path / "a.txt").positions
        assert np.array_equal(found, np.loadtxt(tmp_path / "a.txt"))


def test_blanks_are_as_commas(tmp_path: Path) -> None:
    pick = random.Random(1)
    for _ in range(50):
        words = ["1", "2.5", "-3e2", "NA", "true", "ab", '"c d"']
        rows = [[f"{pick.random()}" for _ in "xyz"] + [pick.choice(words)] for _ in range(5)]
        rows.insert(0, ["x", "y", "z", "more"])
        gaps = ["  ", *(pick.choice([" ", "   ", "\t", " \t "]) for _ in rows)]
        blank = "\n".join(" " + gap.join(row) for gap, row in zip(gaps, rows, strict=False))
        (tmp_path / "a.dat").write_text(blank)
        (tmp_path / "a.csv").write_text("\n".join(",".join(row) for row in rows))
        one, two = (vtray.read(tmp_path / name) for name in ("a.dat", "a.csv"))
        assert np.array_equal(one.positions, two.positions)
        assert one["more"].tolist() == two["more"].tolist() or one["more"].dtype.kind == "f"


# Rows as LAMMPS itself writes them, of an atom at 4 5 6 whose image is -1 2 0.
STYLES = {
    "amoeba": "1 7 2 0 4 5 6 -1 2 0",
    "angle": "1 7 2 4 5 6 -1 2 0",
    "body": "1 2 1 2.5 4 5 6 -1 2 0",
    "bpm/sphere": "1 7 2 1 1 4 5 6 -1 2 0",
    "dielectric": "1 7 2 0 4 5 6 0 0 0 1 0 1 1 0 -1 2 0",
    "dipole": "1 2 0 4 5 6 0 0 0 -1 2 0",
    "dpd": "1 2 0 4 5 6 -1 2 0",
    "edpd": "1 2 1 100000 4 5 6 -1 2 0",
    "electron": "1 2 0 1 1 4 5 6 -1 2 0",
    "ellipsoid": "1 2 0 1 4 5 6 -1 2 0",
    "line": "1 7 2 0 1 4 5 6 -1 2 0",
    "mdpd": "1 2 0 4 5 6 -1 2 0",
    "peri": "1 2 1 1 4 5 6 -1 2 0",
    "rheo": "1 2 0 1 4 5 6 -1 2 0",
    "rheo/thermal": "1 2 0 1 0 4 5 6 -1 2 0",
    "smd": "1 2 1 1 1 0.5 0.5 0 0 0 4 5 6 -1 2 0",
    "sph": "1 2 0 0 1 4 5 6 -1 2 0",
    "spin": "1 2 4 5 6 0 0 0 0 -1 2 0",
    "template": "1 7 1 1 2 4 5 6 -1 2 0",
    "tri": "1 7 2 0 1 4 5 6 -1 2 0",
    "hybrid": "1 2 4 5 6 0 0 0 0 -1 2 0",
    "hybrid sphere bond": "1 2 4 5 6 0 1 1 -1 2 0",
    "tdpd": "1 2 4 5 6 0 0 -1 2 0",
}


@pytest.mark.parametrize("style", STYLES)
def test_styles_of_lammps(style: str, tmp_path: Path) -> None:
    path = tmp_path / "data.melt"
    path.write_text(f"{DATA}Atoms # {style}\n\n{STYLES[style]}\n")
    found = vtray.read(path)
    assert found.positions.tolist() == [[4, 5, 6]]
    assert (found["id"].tolist(), found["type"].tolist()) == ([1], [2])
    if "7" in STYLES[style].split():
        assert found["mol"].tolist() == [7]
    if style.startswith(("hybrid", "tdpd")):  # columns follow that nothing tells from images
        assert "ix" not in found
    else:
        assert [found[name].tolist() for name in ("ix", "iy", "iz")] == [[-1], [2], [0]]
