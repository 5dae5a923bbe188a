"""HDF5 files: tables, snapshots of Gadget, and H5MD."""

from pathlib import Path
from typing import Any

import h5py
import MDAnalysis
import numpy as np
import pytest
from MDAnalysisTests import datafiles

import vtray
from vtray.base.errors import SceneError
from vtray.scene.readers import hdf5_file

POINTS = np.array([(1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0)])


def write(path: Path, arrays: dict[str, Any], **attributes: Any) -> Path:
    """Write arrays by their names, and attributes of the group Header."""
    with h5py.File(path, "w") as file:
        for name, values in arrays.items():
            file[name] = values
        if attributes:
            file.create_group("Header").attrs.update(attributes)
    return path


TABLES: dict[str, dict[str, Any]] = {
    "one array": {"Coordinates": POINTS},
    "three": {"X": POINTS[:, 0], "y": POINTS[:, 1], "z": POINTS[:, 2]},
    "in a group": {"run/step 7/pos": POINTS},
    "in single precision, the other order of bytes": {"pos": POINTS.astype(">f4")},
    "beside others": {
        "pos": POINTS,
        "three": np.zeros((2, 3)),
        "one": 5.0,
        "cube": np.ones((3, 3, 3)),
    },
    "records": {"all/stars": np.array([*map(tuple, POINTS)], [(c, "f8") for c in "xyz"])},
    "before a group": {"pos": POINTS, "other/pos": POINTS[:2]},
}


@pytest.mark.parametrize("arrays", TABLES.values(), ids=TABLES)
def test_places(arrays: dict[str, Any], tmp_path: Path) -> None:
    path = write(tmp_path / "a.h5", arrays)
    found = vtray.read(path, frame=-1)
    assert found.positions.tolist() == POINTS.tolist()
    assert not found.columns
    assert [one.positions.tolist() for one in vtray.read_frames(path)] == [POINTS.tolist()]


def test_columns(tmp_path: Path) -> None:
    arrays = {
        "pos": POINTS,
        "Masses": np.array([1, 2, 3], ">i2"),
        "Velocities": POINTS.astype(np.float32),
        "element": np.array([b"C", b"N", b"O"]),
        "kind": ["one", "two", "two"],
        "is_gas": np.array([True, False, True]),
        "complex": np.zeros(3, complex),
        "words": np.array([[b"a", b"b"]] * 3),
    }
    found = vtray.read(write(tmp_path / "a.hdf5", arrays))
    assert found["element"].tolist() == ["C", "N", "O"]
    assert (found["mass"].tolist(), found["velocity"].tolist()) == ([1, 2, 3], POINTS.tolist())
    assert found["kind"].tolist() == ["one", "two", "two"]
    assert found["is_gas"].tolist() == [True, False, True]
    assert set(found.columns) == {"element", "mass", "velocity", "kind", "is_gas"}


SNAPSHOT = {
    "PartType0/Coordinates": POINTS[:1],
    "PartType0/Density": [0.5],
    "PartType0/Masses": [2.0],
    "PartType0/ParticleIDs": np.array([9], np.uint64),
    "PartType1/Coordinates": POINTS[1:2],
    "PartType1/ParticleIDs": np.array([8], np.uint64),
    "PartType4/Coordinates": POINTS[2:],
    "PartType4/Masses": [3.0],
    "PartType4/ParticleIDs": np.array([7], np.uint64),
    "PartType4/Metals": [[0.1, 0.2]],
}


@pytest.mark.parametrize("box", [9.0, [9.0, 9.0, 9.0]])
def test_snapshots_of_gadget(box: Any, tmp_path: Path) -> None:
    found = vtray.read(write(tmp_path / "snap.hdf5", SNAPSHOT, BoxSize=box, Time=0.5))
    assert found.positions.tolist() == POINTS.tolist()
    assert found["type"].tolist() == ["PartType0", "PartType1", "PartType4"]
    assert np.array_equal(found["mass"], [2, np.nan, 3], equal_nan=True)
    assert np.array_equal(found["Density"], [0.5, np.nan, np.nan], equal_nan=True)
    assert np.array_equal(found["Metals"][2], [0.1, 0.2])
    assert np.isnan(found["Metals"][:2]).all()
    assert found["ParticleIDs"].tolist() == [9, 8, 7]
    assert (found.cell.tolist(), found.time) == ((9 * np.eye(3)).tolist(), 0.5)
    drawn = vtray.Scene().add_particles(found, select="type == 'PartType4'")
    assert drawn.indices.tolist() == [2]


def test_masses_in_the_head_of_a_snapshot(tmp_path: Path) -> None:
    table = np.array([9.0, 5.0, 0.0, 0.0, 7.0, 0.0])
    others = {"PartType2/Coordinates": POINTS[:1], "PartTypes/Coordinates": POINTS[:1]}
    path = write(tmp_path / "snap.hdf5", {**SNAPSHOT, **others}, MassTable=table)
    found = vtray.read(path)
    assert np.array_equal(found["mass"], [2, 5, np.nan, 3, np.nan], equal_nan=True)
    found = vtray.read(path, columns={"radius": "Masses"})
    assert np.array_equal(found["radius"], [2, 5, np.nan, 3, np.nan], equal_nan=True)
    for wrong in ([9.0], "many", 5.0):
        found = vtray.read(write(path, SNAPSHOT, MassTable=wrong))
        assert np.array_equal(found["mass"], [2, np.nan, 3], equal_nan=True)


def test_boxes_of_no_size_are_none(tmp_path: Path) -> None:
    found = vtray.read(write(tmp_path / "a.h5", {"pos": POINTS}, BoxSize=0.0, Time="now"))
    assert (found.cell, found.time) == (None, None)


def test_a_column_of_several_groups_by_another_name(tmp_path: Path) -> None:
    path = write(tmp_path / "snap.hdf5", SNAPSHOT)
    found = vtray.read(path, columns={"radius": "Masses"})
    assert np.array_equal(found["radius"], [2, np.nan, 3], equal_nan=True)
    stars = vtray.read(path, columns={"radius": "PartType4/Masses"})
    assert (stars.positions.tolist(), stars["radius"].tolist()) == (POINTS[2:].tolist(), [3])


def test_arrays_of_other_kinds_are_no_columns(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["pos"] = POINTS
        ragged = file.create_dataset("ragged", 3, h5py.vlen_dtype(np.int64))
        ragged[0] = [1, 2]
        file.create_dataset("texts", data=[b"\xff", b"b", b""], dtype=h5py.string_dtype("ascii"))
    found = vtray.read(tmp_path / "a.h5")
    assert (list(found.columns), found["texts"].tolist()) == (["texts"], ["\ufffd", "b", ""])


@pytest.mark.parametrize("count", [4, [4], np.uint32(4)])
def test_a_part_of_a_snapshot_is_said_to_be_one(count: Any, tmp_path: Path) -> None:
    path = write(tmp_path / "snap.0.hdf5", SNAPSHOT, NumFilesPerSnapshot=count)
    with pytest.warns(UserWarning, match="^the file is one of 4 of its snapshot, and the"):
        vtray.read(path)
    with pytest.warns(UserWarning, match="^the file is one of 4 of its snapshot"):
        next(vtray.read_frames(path))
    vtray.read(write(tmp_path / "snap.1.hdf5", SNAPSHOT, NumFilesPerSnapshot=1))


STARS = {
    "PartType1/Coordinates": POINTS[:1] + 10,
    "PartType1/ParticleIDs": np.array([6], np.uint64),
    "PartType4/Coordinates": POINTS[:2] + 20,
    "PartType4/Masses": [4.0, 5.0],
    "PartType4/ParticleIDs": np.array([5, 4], np.uint64),
}


def write_parts(folder: Path, name: str = "snap", **attributes: Any) -> list[Path]:
    """Write a snapshot in three files, of which the second has no particles."""
    parts: list[dict[str, Any]] = [SNAPSHOT, {}, STARS]
    return [
        write(folder / f"{name}.{k}.hdf5", part, NumFilesPerSnapshot=3, **attributes)
        for k, part in enumerate(parts)
    ]


@pytest.mark.parametrize("named", range(3))
def test_snapshots_in_several_files(named: int, tmp_path: Path) -> None:
    found = vtray.read(write_parts(tmp_path, BoxSize=90.0, Time=2.0)[named])
    whole = np.concatenate([POINTS[:2], POINTS[:1] + 10, POINTS[2:], POINTS[:2] + 20])
    assert found.positions.tolist() == whole.tolist()
    assert found["type"].tolist() == ["PartType0"] + ["PartType1"] * 2 + ["PartType4"] * 3
    assert np.array_equal(found["mass"], [2, np.nan, np.nan, 3, 4, 5], equal_nan=True)
    assert (found["ParticleIDs"].tolist(), found["ParticleIDs"].dtype) == (
        [9, 8, 6, 7, 5, 4],
        np.uint64,
    )
    assert (found.cell[0, 0], found.time) == (90, 2)


def test_a_group_of_several_files(tmp_path: Path) -> None:
    path = write_parts(tmp_path)[0]
    stars = vtray.read(path, columns=NAMES_OF_STARS)
    assert stars.positions.tolist() == [*POINTS[2:].tolist(), *(POINTS[:2] + 20).tolist()]
    assert stars["radius"].tolist() == [3, 4, 5]
    assert "type" not in stars.columns
    with pytest.raises(SceneError, match=r"snap.0.hdf5: columns\['x'\]: no array 'PartType7/x'"):
        vtray.read(path, columns={"x": "PartType7/x"})
    lacking = {"position": "PartType1/Coordinates", "radius": "PartType1/Masses"}
    with pytest.raises(SceneError, match=r"columns\['radius'\]: no array 'PartType1/Masses'; the"):
        vtray.read(path, columns=lacking)


@pytest.mark.parametrize("pattern", ["*.hdf5", "*.0.hdf5", "*.[12].hdf5"])
@pytest.mark.parametrize("slash", ["/", "//"])
def test_a_snapshot_in_several_files_is_one_frame(pattern: str, slash: str, tmp_path: Path) -> None:
    for step in range(2):
        write_parts(tmp_path, f"snap_{step}", Time=float(step))
    frames = [*vtray.read_frames(f"{tmp_path}{slash}{pattern}")]
    assert [(len(frame), frame.time, frame.frame) for frame in frames] == [(6, 0, 0), (6, 1, 1)]
    assert vtray.read(f"{tmp_path}{slash}{pattern}", -1).time == 1


def test_files_of_one_snapshot_each_are_frames(tmp_path: Path) -> None:
    for step in range(3):
        path = tmp_path / f"snap.{step}.hdf5"
        write(path, SNAPSHOT, NumFilesPerSnapshot=1, Time=float(step))
    assert [frame.time for frame in vtray.read_frames(tmp_path / "snap.*.hdf5")] == [0, 1, 2]


@pytest.mark.parametrize(
    ("name", "count"), [("snap.7.hdf5", 4), ("snap.01.hdf5", 4), ("snap.hdf5", 4), ("a.0.h5", 4)]
)
def test_files_that_are_no_part_of_those_beside_them(name: str, count: int, tmp_path: Path) -> None:
    for number in range(2):
        write(tmp_path / f"snap.{number}.hdf5", SNAPSHOT, NumFilesPerSnapshot=count)
    path = write(tmp_path / name, SNAPSHOT, NumFilesPerSnapshot=count)
    with pytest.warns(UserWarning, match="^the file is one of 4 of its snapshot, and the"):
        assert len(vtray.read(path)) == 3


@pytest.mark.parametrize(
    ("count", "words"),
    [
        (4, "is one of the 4 files of its snapshot, of which snap.3.hdf5 is not beside it"),
        (5, "is one of the 5 files of its snapshot, of which snap.3.hdf5 is not beside it, nor is"),
        (2**31 - 1, "is one of the 2147483647 files of its snapshot, of which snap.3.hdf5 is not"),
    ],
)
def test_a_file_of_a_snapshot_is_missing(count: int, words: str, tmp_path: Path) -> None:
    for number in range(3):
        write(tmp_path / f"snap.{number}.hdf5", SNAPSHOT, NumFilesPerSnapshot=count)
    for read in (vtray.read, lambda path: next(vtray.read_frames(path))):
        with pytest.raises(SceneError) as caught:
            read(tmp_path / "snap.1.hdf5")
        assert str(caught.value).startswith(f"{tmp_path / 'snap.1.hdf5'}: {words}")


def test_a_file_of_a_snapshot_is_broken(tmp_path: Path) -> None:
    paths = write_parts(tmp_path)
    write(paths[2], STARS, NumFilesPerSnapshot=8)
    with pytest.raises(SceneError, match="snap.2.hdf5 beside it is one of 8 files; expected one o"):
        vtray.read(paths[0])
    paths[2].write_bytes(b"words")
    with pytest.raises(SceneError, match=r"0.hdf5: expected an HDF5 file in snap.2.hdf5, which h5"):
        vtray.read(paths[0])


def test_no_file_of_a_snapshot_has_places(tmp_path: Path) -> None:
    for number in range(2):
        write(tmp_path / f"snap.{number}.hdf5", {"u": [1.0]}, NumFilesPerSnapshot=2)
    with pytest.raises(SceneError, match="expected arrays x, y and z, or position, in the file or"):
        vtray.read(tmp_path / "snap.0.hdf5")


def test_memory_for_all_files_of_a_snapshot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []
    monkeypatch.setattr(hdf5_file, "check_bytes", asked.append)
    vtray.read(write_parts(tmp_path)[0])
    # All at first, before the first is read: 6 places and numbers, and what some have.
    assert asked[0] == 2 * 8 * (6 * 3 + 6 + 1 + 1 + 3 + 2)
    assert asked[0] == sum(asked[1:])


NAMES_OF_STARS = {"position": "PartType4/Coordinates", "radius": "Masses"}

GROUPS = {"a/r": POINTS, "a/m": [1, 2, 3], "b/r": POINTS + 1, "b/q": [4, 5, 6], "u": POINTS[:, 0]}


def test_names_of_columns(tmp_path: Path) -> None:
    path = write(tmp_path / "a.h5", GROUPS)
    found = vtray.read(path, columns={"position": "b/r", "radius": "q"})
    assert (found.positions.tolist(), found["radius"].tolist()) == (
        (POINTS + 1).tolist(),
        [4, 5, 6],
    )
    assert list(vtray.read(path, columns={"position": "/a/r"}).columns) == ["m"]
    assert vtray.read(path, columns={"position": "r"}).positions.tolist() == POINTS.tolist()
    second = vtray.read(write(tmp_path / "b.h5", SNAPSHOT), columns=NAMES_OF_STARS)
    assert second["radius"].tolist() == [3]


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (None, "expected arrays x, y and z, or position, in the file or a group of it, got u, a/m"),
        ({"position": "c"}, "columns['position']: no array 'c'; there are u, a/m, a/r, b/q, b/r"),
        ({"position": "b/m"}, "columns['position']: no array 'b/m'; there are u, a/m, a/r, b/q, b"),
        ({"position": "a/r", "radius": "b/q"}, "columns: expected arrays of one group, got some"),
        ({"position": "u"}, "Particles.positions: must have shape (n, 3), got (3,)"),
    ],
)
def test_wrong_names(columns: Any, message: str, tmp_path: Path) -> None:
    path = write(tmp_path / "a.h5", GROUPS)
    with pytest.raises(SceneError) as caught:
        vtray.read(path, columns=columns)
    assert str(caught.value).startswith(f"{path}: {message}")


@pytest.mark.parametrize("content", [b"", b"words", b"\x89HDF\r\n\x1a\n" + bytes(100)])
def test_broken_files(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.h5").write_bytes(content)
    with pytest.raises(SceneError, match=r"a.h5: expected an HDF5 file, which h5py cannot read \("):
        vtray.read(tmp_path / "a.h5")
    with pytest.raises(SceneError, match=r"a.h5: expected an HDF5 file, which h5py cannot read \("):
        next(vtray.read_frames(tmp_path / "a.h5"))


def test_groups_of_components(tmp_path: Path) -> None:
    columns = {f"{name}/{axis}": [1.0, 2.0] for name in ("Position", "velocity") for axis in "xyz"}
    found = vtray.read(write(tmp_path / "a.h5", columns))
    assert found.positions.tolist() == [[1] * 3, [2] * 3]
    assert not found.columns


def test_nothing_in_it(tmp_path: Path) -> None:
    path = write(tmp_path / "a.h5", {})
    with pytest.raises(SceneError, match="in the file or a group of it, got none; columns="):
        vtray.read(path)
    with pytest.raises(SceneError, match="a.h5: frame 1: there is one frame; expected 0 or -1"):
        vtray.read(write(tmp_path / "a.h5", {"pos": POINTS}), 1)


@pytest.mark.parametrize("name", ["pos", "particles/all/position/value"])
def test_arrays_that_only_claim_to_be_there(name: str, tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.create_group("h5md" if "/" in name else "other")
        shape = (1, 2**40, 3) if "/" in name else (2**40, 3)
        file.create_dataset(name, shape, np.float32, chunks=True)
    with pytest.raises(SceneError, match="a.h5: reading it needs about 26,388.3 GB of memory, "):
        vtray.read(tmp_path / "a.h5")


H5MD = [datafiles.H5MD_xvf, datafiles.H5MD_energy, datafiles.COORDINATES_H5MD]


@pytest.mark.parametrize("path", H5MD)
def test_h5md_is_what_mdanalysis_reads(path: Path) -> None:
    with MDAnalysis.coordinates.H5MD.H5MDReader(str(path), convert_units=False) as reader:
        frames = list(vtray.read_frames(str(path)))
        assert len(frames) == len(reader)
        for found, frame in zip(frames, reader, strict=True):
            assert found.frame == frame.frame
            # MDAnalysis has all in single precision.
            assert np.array_equal(found.positions.astype(np.float32), frame.positions)
            assert np.allclose(found.cell, frame.triclinic_dimensions, atol=1e-4)
            assert found.periodic == (True, True, True)
            assert found.time is not None
            if frame.has_velocities:
                assert np.array_equal(found["velocity"].astype(np.float32), frame.velocities)
            if frame.has_forces:
                assert np.array_equal(found["force"].astype(np.float32), frame.forces)
    last = vtray.read(str(path), -1)
    assert np.array_equal(last.positions, frames[-1].positions)


def h5md(path: Path, species: Any = None, **more: Any) -> Path:
    """Write a trajectory of two frames, with what does not change as it is."""
    with h5py.File(path, "w") as file:
        file.create_group("h5md")
        group = file.create_group("particles/all")
        group["position/value"] = np.array([POINTS, POINTS + 1])
        box = group.create_group("box")
        box.attrs["boundary"] = np.array([b"periodic", b"none", b"periodic"])
        box["edges"] = [4.0, 5.0, 6.0]
        if species is not None:
            group.create_dataset("species", data=[0, 1, 0], dtype=species)
        for name, values in more.items():
            group[name] = values
    return path


def test_h5md_of_what_does_not_change(tmp_path: Path) -> None:
    kinds = h5py.enum_dtype({"A": 0, "B": 1}, basetype="i4")
    path = h5md(tmp_path / "a.h5md", kinds, mass=[1.0, 2.0, 3.0], image=np.zeros((3, 3), int))
    one, two = vtray.read_frames(path)
    assert (one.positions.tolist(), two.positions.tolist()) == (
        POINTS.tolist(),
        (POINTS + 1).tolist(),
    )
    assert (two.cell.tolist(), two.periodic) == (
        np.diag([4.0, 5.0, 6.0]).tolist(),
        (True, False, True),
    )
    assert (two["type"].tolist(), two["mass"].tolist()) == (["A", "B", "A"], [1, 2, 3])
    assert (two.time, two.frame) == (None, 1)
    numbers = vtray.read(h5md(tmp_path / "b.h5", "f8"))
    assert (numbers["type"].tolist(), numbers["type"].dtype.kind) == ([0, 1, 0], "i")


def test_h5md_without_places(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.create_group("h5md")
        file["particles/all/velocity/value"] = [POINTS]
    with pytest.raises(
        SceneError, match="expected particles/.../position/value, as H5MD has it; th"
    ):
        vtray.read(tmp_path / "a.h5")
    with h5py.File(tmp_path / "a.h5", "a") as file:
        file["particles/all/position/value"] = [1.0, 2.0]
    with pytest.raises(SceneError, match="a.h5: frame 0: expected places, got none"):
        vtray.read(tmp_path / "a.h5")
