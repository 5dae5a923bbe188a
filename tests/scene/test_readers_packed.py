"""Files of data that are compressed, and those that claim more than there is memory for."""

import bz2
import gzip
import lzma
from pathlib import Path
from typing import Any

import laspy
import numpy as np
import pytest

import vtray
from vtray.base import input_file
from vtray.base.errors import SceneError
from vtray.scene.readers import las_file
from vtray.scene.readers.packing import packing_of
from vtray.scene.readers.reader_table import is_data

XYZ = "1\n\nO 1 2 3\n1\n\nO 4 5 6\n"
TEXTS = {
    "run.xyz": XYZ,
    "a.csv": "x,y,z\n4,5,6\n",
    "POSCAR": "H\n1.0\n9 0 0\n0 9 0\n0 0 9\nH\n1\nCartesian\n4 5 6\n",
    "a.pdb": f"{'ATOM      1  O   HOH A   1':30}   4.000   5.000   6.000  1.00  0.00\n",
    "a.gro": "t\n1\n    1HOH      O    1   0.400   0.500   0.600\n   1 1 1\n",
    "a.ply": "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
    "property float z\nend_header\n4 5 6\n",
}
PACK = {".gz": gzip.compress, ".bz2": bz2.compress, ".xz": lzma.compress}


@pytest.mark.parametrize("name", TEXTS)
@pytest.mark.parametrize("ending", PACK)
def test_compressed_texts(name: str, ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"{name}{ending.upper()}"
    path.write_bytes(PACK[ending](TEXTS[name].encode()))
    found = vtray.read(path, frame=-1)
    assert np.allclose(found.positions, [[4, 5, 6]])
    assert found.source == path
    assert found.frame == (1 if name == "run.xyz" else 0)
    assert is_data(str(path))


def test_errors_name_file_and_line(tmp_path: Path) -> None:
    path = tmp_path / "a.xyz.gz"
    path.write_bytes(gzip.compress(b"1\n\nO 0 nan 0\n"))
    with pytest.raises(SceneError, match=r"a.xyz.gz: line 3: y must be finite, got nan$"):
        vtray.read(path)


@pytest.mark.parametrize("ending", PACK)
def test_what_cannot_be_unpacked(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"a.xyz{ending}"
    whole = PACK[ending](XYZ.encode() * 9)
    for content in (b"1 2 3 4", whole[: len(whole) // 2]):
        path.write_bytes(content)
        with pytest.raises(SceneError) as caught:
            vtray.read(path)
        expected = f"{path}: expected a {ending} file, which cannot be unpacked ("
        assert str(caught.value).startswith(expected)


def test_what_is_not_unpacked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("a.npz.gz", "a.laz.xz", "a.traj.bz2"):
        path = tmp_path / name
        path.write_bytes(b"")
        with pytest.raises(SceneError, match="is compressed, which .* may not be; unpack it first"):
            vtray.read(path)
    path = tmp_path / "a.xyz.gz"
    path.write_bytes(gzip.compress(bytes(10**6)))
    monkeypatch.setattr(input_file, "SMALL", 1000)
    monkeypatch.setattr(input_file, "available_memory", lambda: 40_000)
    with pytest.raises(SceneError, match="is larger than 0 MB, a quarter of the memory"):
        vtray.read(path)
    assert packing_of("a.tar") == ""


def test_arrays_that_do_not_fit_say_how_large_they_are(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    path.write_text(TEXTS["a.ply"].replace("vertex 1", f"vertex {10**15}"))
    with pytest.raises(SceneError, match=r"it needs [0-9.]+ PiB at least, [0-9.,]+ .B of memory"):
        vtray.read(path)


@pytest.mark.parametrize(
    ("chunk", "message"),
    [
        (2**32 - 16, "has chunks of 4294967280 points, which need "),
        (0, "claims chunks without|expected a LAS file, which laspy cannot read"),
    ],
)
def test_chunks_of_laser_scans(chunk: int, message: str, tmp_path: Path) -> None:
    path = tmp_path / "a.laz"
    cloud: Any = laspy.LasData(laspy.LasHeader(point_format=3, version="1.2"))
    cloud.x, cloud.y, cloud.z = np.eye(3)
    cloud.write(path)
    assert vtray.read(path).positions.shape == (3, 3)
    content = path.read_bytes()
    size = las_file.struct.pack("<I", 50_000)
    assert content.count(size) == 1
    path.write_bytes(content.replace(size, las_file.struct.pack("<I", chunk)))
    with pytest.raises(SceneError, match=message):
        vtray.read(path)
