"""XYZ files, plain and extended."""

import io
from pathlib import Path

import ase.io
import numpy as np
import pytest
from ase import Atoms
from hypothesis import given
from hypothesis import strategies as st

import vtray
from vtray.base.errors import SceneError
from vtray.scene.readers import lines as lines_module
from vtray.scene.readers.lines import Lines

WATER = "3\nwater\nO 0 0 0\nH 0.76 0.59 0\nH -0.76 0.59 0\n"
FINITE = st.floats(allow_nan=False, allow_infinity=False)


def read(text: str, folder: Path, frame: int = 0) -> vtray.Particles:
    path = folder / "a.xyz"
    path.write_text(text)
    return vtray.read(path, frame)


def test_plain(tmp_path: Path) -> None:
    water = read(WATER, tmp_path)
    assert water["element"].tolist() == ["O", "H", "H"]
    assert water.positions.tolist() == [[0, 0, 0], [0.76, 0.59, 0], [-0.76, 0.59, 0]]
    assert (water.cell, water.bonds, water.frame, water.time) == (None, None, 0, None)
    assert water.source == tmp_path / "a.xyz"


def test_the_mark_at_the_begin_of_files_of_windows_is_no_text(tmp_path: Path) -> None:
    path = tmp_path / "a.xyz"
    path.write_text(WATER + WATER, "utf-8-sig", newline="\r\n")
    for frame in (0, 1):
        assert vtray.read(path, frame)["element"].tolist() == ["O", "H", "H"]


def test_frames(tmp_path: Path) -> None:
    text = "".join(f"1\n i = {i}, time = {i / 2}, E = -1\nHe {i} 0 0\n" for i in range(4)) + "\n"
    found = [read(text, tmp_path, frame) for frame in (0, 2, -1, -4)]
    assert [(each.positions[0, 0], each.frame, each.time) for each in found] == [
        (0, 0, 0),
        (2, 2, 1),
        (3, 3, 1.5),
        (0, 0, 0),
    ]


def test_further_columns(tmp_path: Path) -> None:
    found = read("2\n\nO 0 0 0 -0.8 a\nH 1 0 0 0.4 b\n", tmp_path)
    assert found["column5"].tolist() == [-0.8, 0.4]
    assert found["column6"].tolist() == ["a", "b"]


def test_notes_behind_rows(tmp_path: Path) -> None:
    found = read("2\n\nO 0 0 0 # the first\nH 1 0 0\n", tmp_path)
    assert list(found.columns) == ["element"]


def test_names_that_are_no_elements_are_types(tmp_path: Path) -> None:
    found = read("2\n\n1 0 0 0\n2 1 0 0\n", tmp_path)
    assert {name: values.tolist() for name, values in found.columns.items()} == {"type": ["1", "2"]}
    assert read("2\n\nA 0 0 0\nB 1 0 0\n", tmp_path)["type"].tolist() == ["A", "B"]
    labels = read("2\n\nFE 0 0 0\nc1 1 0 0\n", tmp_path)
    assert labels["element"].tolist() == ["Fe", "C"]
    assert labels["name"].tolist() == ["FE", "c1"]


def test_exponents_of_fortran_and_ends_of_windows(tmp_path: Path) -> None:
    found = read("1\r\n\r\nO 1.5D+01 -2d0 3e-1", tmp_path)
    assert found.positions.tolist() == [[15, -2, 0.3]]


def test_extended(tmp_path: Path) -> None:
    text = (
        "2\n"
        'Lattice="4 0 0 1 5 0 0 0 6" Origin="-1 -2 -3" pbc="T F T" Time=2.5 note="a b=c"'
        " Properties=Z:I:1:pos:R:3:forces:R:3:id:I:1:fixed:L:1:vel:R:3\n"
        "8 0 0 0 1 2 3 7 T 1 0 0\n1 1 0 0 4 5 6 9 F 0 1 0\n"
    )
    found = read(text, tmp_path)
    assert found.cell.tolist() == [[4, 0, 0], [1, 5, 0], [0, 0, 6]]
    assert found.origin.tolist() == [-1, -2, -3]
    assert (found.periodic, found.time) == ((True, False, True), 2.5)
    assert {name: values.tolist() for name, values in found.columns.items()} == {
        "element": ["O", "H"],
        "force": [[1, 2, 3], [4, 5, 6]],
        "id": [7, 9],
        "fixed": [True, False],
        "velocity": [[1, 0, 0], [0, 1, 0]],
    }


def test_places_are_pos_whatever_else_is_there(tmp_path: Path) -> None:
    for properties in ("pos:R:3:center:R:3", "center:R:3:pos:R:3"):
        row = "1 2 3 7 8 9" if properties.startswith("pos") else "7 8 9 1 2 3"
        found = read(f"1\nProperties={properties}\n{row}\n", tmp_path)
        assert found.positions.tolist() == [[1, 2, 3]]
    assert read("1\nProperties=center:R:3\n1 2 3\n", tmp_path).positions.tolist() == [[1, 2, 3]]


def test_same_as_ase(tmp_path: Path) -> None:
    generator = np.random.default_rng(3)
    frames = []
    for _ in range(3):
        atoms = Atoms("SiO2", generator.normal(size=(3, 3)), cell=[[3, 0, 0], [1, 4, 0], [0, 1, 5]])
        atoms.pbc = (True, False, True)
        atoms.arrays["radii"] = generator.uniform(size=3)
        atoms.arrays["spin"] = generator.normal(size=(3, 3))
        atoms.arrays["layer"] = np.array([1, 2, 3])
        atoms.arrays["label"] = np.array(["a", "b", "c"])
        frames.append(atoms)
    path = tmp_path / "a.extxyz"
    ase.io.write(path, frames, format="extxyz")
    for number in (0, 1, -1):
        theirs = vtray.from_ase(ase.io.read(path, number))
        ours = vtray.read(path, number)
        assert ours.positions.tolist() == theirs.positions.tolist()
        assert ours.cell.tolist() == theirs.cell.tolist()
        assert ours.periodic == theirs.periodic
        assert set(ours.columns) == set(theirs.columns)
        for name, values in ours.columns.items():
            assert values.tolist() == theirs[name].tolist(), name


@given(rows=st.lists(st.tuples(FINITE, FINITE, FINITE), max_size=30))
def test_numbers_are_exact(rows: list[tuple[float, ...]], tmp_path_factory) -> None:
    text = f"{len(rows)}\n\n" + "".join(f"H {x!r} {y!r} {z!r}\n" for x, y, z in rows)
    assert read(text, tmp_path_factory.getbasetemp()).positions.tolist() == [*map(list, rows)]


@given(st.lists(st.text("ab \r", max_size=6), max_size=20), st.integers(1, 9), st.integers(0, 9))
def test_lines(texts: list[str], step: int, count: int) -> None:
    content = "\n".join(texts).encode()
    whole = content.removesuffix(b"\n").split(b"\n") if content else []
    before = lines_module.STEP
    lines_module.STEP = step
    try:
        skipped, taken = Lines(io.BytesIO(content)), Lines(io.BytesIO(content))
        assert skipped.skip(count) == skipped.number == min(count, len(whole))
        blocks = list(taken.blocks(count))
        assert sum(size for _, size in blocks) == taken.number == skipped.number
        found = [line for block, _ in blocks for line in block.split(b"\n")]
        assert found == whole[:count]
        assert skipped.next() == taken.next()
    finally:
        lines_module.STEP = before


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty; expected the number of atoms in the first line"),
        ("{}", "line 1: expected the number of atoms, got '{}'"),
        ("-1\n\n", "line 1: expected the number of atoms, got '-1'"),
        ("2\n\nO 0 0 0\n", "line 3: the file ends after 1 of 2 rows"),
        ("99999999999\n\nO 0 0 0\n", "line 3: the file ends after 1 of 99999999999 rows"),
        ("2\n\nO 0 0 0\nH 0 0\n", "line 4: expected 4 entries, got 3: 'H 0 0'"),
        ("2\n\nO 0 0 0\nH 0 x 0\n", "line 4: entry 3 must be a number, got 'x'"),
        ("2\n\n1 0 0 0 5\n1 0 0\n", "line 4: expected 4 entries, got 3: '1 0 0'"),
        ("1\n\nO 0 nan 0\n", "line 3: y must be finite, got nan"),
        ("1\nProperties=pos:R:3:a:Q:1\n", "line 2: Properties: expected name:R, I, S or L:width"),
        ("1\nProperties=q:R:1:pos:R:3:q:R:1\n", "line 2: Properties: expected each column once,"),
        ("1\nProperties=pos:R\n", "line 2: Properties: expected three parts for each column"),
        ("1\nProperties=a:S:1\nO\n", "line 2: Properties: expected pos:R:3 among the columns"),
        ('1\nLattice="1 2"\nO 0 0 0\n', "line 2: Lattice: expected 3 or 9 numbers, got '1 2'"),
        ('1\nLattice="1 2 3" pbc="T"\nO 0 0 0\n', "line 2: pbc: expected T or F three times"),
        (
            "1\nProperties=pos:R:3:n:I:1\n0 0 0 1.5\n",
            "line 3: entry 4 must be an integer, got '1.5'",
        ),
        ("1\nProperties=pos:R:3:n:L:1\n0 0 0 x\n", "line 3: entry 4 must be T or F, got 'x'"),
        ("1\nProperties=pos:R:3:Z:I:1\n0 0 0 200\n", "element[0]: expected an atomic number"),
        ("1\n\nO 0 0 \xff\n", "line 3: not UTF-8; expected text"),
        ("1\n\nO 0 0 0\0\n", "line 3: entry 4 must be a number, got '0\\\\x00'"),
        ("1\n\n" + "x" * 2_000_000, "line 3: longer than 1048576 bytes; expected text"),
    ],
)
def test_broken(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "a.xyz"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(SceneError) as caught:
        vtray.read(path)
    assert str(caught.value).startswith(f"{path}: {message}")


@pytest.mark.parametrize("frame", [2, -3, 10**20])
def test_frames_that_there_are_not(frame: int, tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=f"frame {frame}: there are 2 frames; expected -2 to 1$"):
        read(WATER * 2, tmp_path, frame)
    with pytest.raises(SceneError, match=f"frame {frame}: there is one frame; expected 0 or -1$"):
        read(WATER, tmp_path, frame)


def test_frames_are_whole_numbers(tmp_path: Path) -> None:
    assert len(read(WATER, tmp_path, np.int64(-1))) == 3
    with pytest.raises(SceneError, match="frame: expected an integer, got 'last'$"):
        read(WATER, tmp_path, "last")


def test_other_places_than_those_of_the_file(tmp_path: Path) -> None:
    path = tmp_path / "a.xyz"
    path.write_text("1\nProperties=species:S:1:pos:R:3:next:R:3:q:R:1\nO 1 2 3 4 5 6 7\n")
    found = vtray.read(path, columns={"position": "next"})
    assert (found.positions.tolist(), set(found.columns)) == ([[4, 5, 6]], {"element", "charge"})
    assert vtray.read(path, columns={"z": "charge"}).positions.tolist() == [[1, 2, 7]]
    with pytest.raises(SceneError, match=r"a.xyz: Particles.positions: must have shape \(n, 3\)"):
        vtray.read(path, columns={"position": "charge"})
