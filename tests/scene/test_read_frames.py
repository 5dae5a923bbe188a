"""Frames of a trajectory, one after the other."""

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import vtray
from vtray.base.errors import SceneError
from vtray.scene.readers import lines as lines_module
from vtray.scene.readers import xyz_file
from vtray.scene.readers.reader_table import Given
from vtray.scene.readers.which_frames import which_frames

COUNT = 6


def write_xyz(path: Path) -> Path:
    text = "".join(f"{k + 1}\nframe\n" + f"C {k} 0 0\n" * (k + 1) for k in range(COUNT))
    path.write_text(text)
    return path


def write_dump(path: Path) -> Path:
    head = "ITEM: TIMESTEP\n{0}\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id x y z\n1 {0} 0 0\n"
    path.write_text("".join(head.format(k) for k in range(COUNT)))
    return path


def write_pdb(path: Path) -> Path:
    line = "ATOM      1  C   ALA A   1    {:8.3f}   0.000   0.000\n"
    path.write_text("".join(f"MODEL\n{line.format(k)}ENDMDL\n" for k in range(COUNT)))
    return path


def write_gsd(path: Path) -> Path:
    hoomd = pytest.importorskip("gsd.hoomd")
    with hoomd.open(str(path), "w") as file:
        for k in range(COUNT):
            frame = hoomd.Frame()
            frame.particles.N = 1
            frame.particles.position = [(k, 0, 0)]
            file.append(frame)
    return path


def write_traj(path: Path) -> Path:
    ase = pytest.importorskip("ase")
    io = pytest.importorskip("ase.io")
    io.write(path, [ase.Atoms("C", [(k, 0, 0)]) for k in range(COUNT)])
    return path


WRITERS: dict[str, Callable[[Path], Path]] = {
    "run.xyz": write_xyz,
    "run.dump": write_dump,
    "run.pdb": write_pdb,
    "run.gsd": write_gsd,
    "run.traj": write_traj,
}


@pytest.mark.parametrize("name", WRITERS)
def test_frames_are_those_that_are_read(name: str, tmp_path: Path) -> None:
    path = WRITERS[name](tmp_path / name)
    assert [found.frame for found in vtray.read_frames(path)] == [*range(COUNT)]
    for wanted in ("1:5:2", "::-2", [4, 1, 1, -1], slice(2, 3)):
        numbers = which_frames(wanted, lambda: COUNT)
        found = [*vtray.read_frames(path, wanted)]
        assert [particles.frame for particles in found] == [*numbers]
        for particles in found:
            alone = vtray.read(path, frame=particles.frame)
            assert (particles.positions == alone.positions).all()
            assert (particles.source, particles.frame) == (path, alone.frame)
            assert particles.positions[0, 0] == particles.frame


@pytest.mark.parametrize("wanted", [[0], [1, 0], [0, 0]])
def test_what_follows_the_last_frame_is_not_read(wanted: list[int], tmp_path: Path) -> None:
    path = tmp_path / "run.xyz"
    path.write_text("1\n\nC 0 0 0\n" * (max(wanted) + 1) + "broken\n")
    assert [found.frame for found in vtray.read_frames(path, wanted)] == wanted


def test_topology_with_a_trajectory(tmp_path: Path) -> None:
    pytest.importorskip("MDAnalysis")
    top, places = tmp_path / "top.gro", tmp_path / "run.xyz"
    top.write_text("one\n1\n    1ALA     CA    1   0.000   0.000   0.000\n   1.0 1.0 1.0\n")
    places.write_text("".join(f"1\n\nC {k} 0 0\n" for k in range(COUNT)))
    found = [*vtray.read_frames(top, "1::2", trajectory=places)]
    assert [particles.frame for particles in found] == [1, 3, 5]
    assert [float(particles.positions[0, 0]) for particles in found] == [1, 3, 5]


def test_compressed_and_single_files(tmp_path: Path) -> None:
    import gzip

    plain = write_xyz(tmp_path / "run.xyz")
    packed = tmp_path / "run.xyz.gz"
    packed.write_bytes(gzip.compress(plain.read_bytes()))
    assert [len(found) for found in vtray.read_frames(packed, "::2")] == [1, 3, 5]
    table = tmp_path / "table.csv"
    table.write_text("x,y,z,r\n1,2,3,4\n")
    (only,) = vtray.read_frames(table, columns={"radius": "r"})
    assert only["radius"].tolist() == [4]


def test_a_file_is_gone_through_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_xyz(tmp_path / "run.xyz")
    read = [0]
    next_line = lines_module.Lines.next

    def counted(self: lines_module.Lines) -> str | None:
        read[0] += 1
        return next_line(self)

    monkeypatch.setattr(lines_module.Lines, "next", counted)
    numbers = [*range(COUNT)]
    assert len([*vtray.read_frames(path, numbers)]) == COUNT
    assert read[0] <= 4 * COUNT


@pytest.mark.parametrize(
    ("frames", "message"),
    [
        ("9:", "run.xyz: frames 9:: there are 6 frames, none of which is among these"),
        ([6], "run.xyz: frame 6: there are 6 frames; expected -6 to 5"),
        ([0, -7], "run.xyz: frame -7: there are 6 frames; expected -6 to 5"),
        ("0:5:0", "run.xyz: frames: expected a step other than 0, got 0:5:0"),
        ("some", "run.xyz: frames: expected START:STOP:STEP such as 0:500:5, or numbers such "),
        (1.5, "run.xyz: frames: expected START:STOP:STEP such as 0:500:5, or numbers such as "),
        ([1.0], "run.xyz: frames: expected START:STOP:STEP such as 0:500:5, or numbers such as 3"),
        ([0, None], "run.xyz: frames: expected START:STOP:STEP such as 0:500:5, or numbers such"),
        (["1"], "run.xyz: frames: expected START:STOP:STEP such as 0:500:5, or numbers such as 3"),
        ([], "run.xyz: frames: expected START:STOP:STEP such as 0:500:5, or numbers such as 3 "),
    ],
)
def test_errors(frames: object, message: str, tmp_path: Path) -> None:
    path = write_xyz(tmp_path / "run.xyz")
    with pytest.raises(SceneError) as error:
        [*vtray.read_frames(path, frames)]
    assert str(error.value).startswith(message.replace("run.xyz", str(path)))


def test_a_frame_that_is_wrong(tmp_path: Path) -> None:
    path = tmp_path / "run.xyz"
    path.write_text("1\n\nC 0 0 0\n1\n\nC 0 0\n1\n\nC 0 0 0\n")
    found = vtray.read_frames(path)
    assert next(found).frame == 0
    with pytest.raises(SceneError, match="run.xyz: line 6: expected 4 entries, got 3"):
        next(found)
    assert [particles.frame for particles in vtray.read_frames(path, "::2")] == [0, 2]


def test_words_for_slices() -> None:
    def of(frames: object) -> list[int]:
        return [*which_frames(frames, lambda: 5)]

    assert of("3") == [3]
    assert of("-1") == [4]
    assert of(":-1") == [0, 1, 2, 3]
    assert of(range(0, 100, 2)) == [0, 2, 4]
    assert of(range(4, -1, -2)) == [4, 2, 0]
    assert of(range(-2, 0)) == [3, 4]
    assert of(None) == [0, 1, 2, 3, 4]
    assert of(np.array([1, 2])) == [1, 2]


class Counted(io.BytesIO):
    """A file that counts the bytes that are read of it."""

    count = 0

    def read(self, size: int | None = -1, /) -> bytes:
        """Read some bytes."""
        found = super().read(size)
        self.count += len(found)
        return found

    def readline(self, size: int | None = -1, /) -> bytes:
        """Read a line."""
        found = super().readline(size)
        self.count += len(found)
        return found


@pytest.mark.parametrize("width", [1, 40, 3000])
def test_small_frames_are_not_read_again_and_again(width: int) -> None:
    row = f"O 1 2 3 {'x' * width}\n"
    file = Counted(f"300\n\n{300 * row}".encode() * 200)
    given = Given(file, "a.xyz", "xyz", -1, {}, None)
    size = len(file.getvalue())
    assert xyz_file.read(given).frame == 199
    assert file.count < 1.5 * size
    file.seek(0)
    file.count = 0
    assert sum(len(read()) for read in xyz_file.steps(given)) == 200 * 300
    assert file.count < 3 * size  # once to read a frame, and once to pass over it
