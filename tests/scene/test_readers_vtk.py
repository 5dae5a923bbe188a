"""Files of VTK, written by VTK itself, and by hand as programs write them."""

import base64
import gzip
import itertools
import re
import sys
import zlib
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import numpy as np
import pytest
from vtkmodules import vtkCommonCore, vtkCommonDataModel, vtkIOLegacy, vtkIOParallelXML, vtkIOXML
from vtkmodules.util.numpy_support import numpy_to_vtk

import vtray
from vtray.base.errors import SceneError
from vtray.base.extras import ExtraError
from vtray.scene.readers import vtk_file
from vtray.scene.readers.reader_table import is_data

COUNT = 1500
"""More than a block holds that is compressed."""

RANDOM = np.random.default_rng(1)

ARRAYS: dict[str, Any] = {
    "radius": RANDOM.random(COUNT, np.float32),
    "Velocity": RANDOM.normal(size=(COUNT, 3)),
    "type": RANDOM.integers(-3, 3, COUNT).astype(np.int32),
    "big": RANDOM.integers(-(2**60), 2**60, COUNT),
    "flag": RANDOM.integers(0, 255, COUNT).astype(np.uint8),
    "my stress": RANDOM.random((COUNT, 9)),
}

PLACES = RANDOM.normal(size=(COUNT, 3))

POINTS = '<DataArray type="Float32" NumberOfComponents="3" format="{1}">{0}</DataArray>'

WRITERS: dict[str, tuple[Any, Any, Any]] = {
    ".vtp": (
        vtkCommonDataModel.vtkPolyData,
        vtkIOXML.vtkXMLPolyDataWriter,
        vtkIOLegacy.vtkPolyDataWriter,
    ),
    ".vtu": (
        vtkCommonDataModel.vtkUnstructuredGrid,
        vtkIOXML.vtkXMLUnstructuredGridWriter,
        vtkIOLegacy.vtkUnstructuredGridWriter,
    ),
}


def data_of(
    ending: str, places: Any, arrays: dict[str, Any], cells: int = 0, time: float | None = None
) -> Any:
    """Return what VTK writes: points, their arrays, and a vertex for some with a number."""
    data = WRITERS[ending][0]()
    points = vtkCommonCore.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(places), deep=True))
    data.SetPoints(points)
    data.Allocate(max(cells, 1))
    for index in range(cells):
        data.InsertNextCell(1, 1, [index])
    if cells:
        add(data.GetCellData(), "of cells", np.arange(cells))
    for name, values in arrays.items():
        add(data.GetPointData(), name, values)
    if time is not None:
        add(data.GetFieldData(), "TimeValue", np.array([time]))
    return data


def add(attributes: Any, name: str, values: Any) -> None:
    """Add an array to data of VTK."""
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    attributes.AddArray(array)


def write(path: Path, places: Any, arrays: dict[str, Any], **options: Any) -> Path:
    """Write a file of XML as VTK does by itself."""
    writer = WRITERS[path.suffix][1]()
    writer.SetInputData(data_of(path.suffix, places, arrays, **options))
    writer.SetFileName(str(path))
    assert writer.Write()
    return path


def check(found: vtray.Particles, places: Any, tolerance: float = 0) -> None:
    """Compare what was read with what was written."""
    assert np.allclose(found.positions, places, rtol=tolerance, atol=0)
    names = ["radius", "velocity", "type", "big", "flag", "my stress"]
    assert [*found.columns] == names
    for name, values in zip(names, ARRAYS.values(), strict=True):
        column = found[name]
        assert (column.dtype, column.shape) == (values.dtype, values.shape), name
        assert np.allclose(column, values, rtol=tolerance, atol=0), name
    assert np.array_equal(found["big"], ARRAYS["big"])


WAYS = [
    ("ascii", "none", "Little", 64),
    *itertools.product(
        ("binary", "base64", "raw"), ("none", "ZLib", "LZ4", "LZMA"), ("Little", "Big"), (32, 64)
    ),
]


@pytest.mark.parametrize(("way", "compressor", "order", "word"), WAYS)
def test_xml_as_vtk_writes_it(
    way: str, compressor: str, order: str, word: int, tmp_path: Path
) -> None:
    ending = ".vtp" if word == 32 else ".vtu"
    kind = np.float32 if order == "Big" else np.float64
    places = PLACES.astype(kind)
    writer = WRITERS[ending][1]()
    writer.SetInputData(data_of(ending, places, ARRAYS, cells=7 * (way == "raw"), time=2.5))
    if way == "ascii":
        writer.SetDataModeToAscii()
    elif way == "binary":
        writer.SetDataModeToBinary()
    else:
        writer.SetDataModeToAppended()
        writer.SetEncodeAppendedData(way == "base64")
    getattr(
        writer,
        f"SetCompressorTypeTo{compressor.capitalize() if compressor == 'none' else compressor}",
    )()
    getattr(writer, f"SetByteOrderTo{order}Endian")()
    getattr(writer, f"SetHeaderTypeToUInt{word}")()
    path = tmp_path / f"a{ending}"
    writer.SetFileName(str(path))
    assert writer.Write()
    found = vtray.read(path, frame=-1)
    check(found, places, 1e-5 if way == "ascii" else 0)
    assert (found.positions.dtype, found.time, found.frame) == (kind, 2.5, 0)
    assert (found.cell, found.bonds) == (None, None)


@pytest.mark.parametrize("ending", WRITERS)
@pytest.mark.parametrize("version", [42, 51])
@pytest.mark.parametrize("text", [True, False])
@pytest.mark.parametrize("cells", [0, 9])
def test_older_files_as_vtk_writes_them(
    ending: str, version: int, text: bool, cells: int, tmp_path: Path
) -> None:
    writer = WRITERS[ending][2]()
    writer.SetInputData(data_of(ending, PLACES, ARRAYS, cells=cells, time=2.5))
    writer.SetFileVersion(version)
    if text:
        writer.SetFileTypeToASCII()
    else:
        writer.SetFileTypeToBinary()
    path = tmp_path / "a.vtk"
    writer.SetFileName(str(path))
    assert writer.Write()
    found = vtray.read(path)
    check(found, PLACES, 1e-5 if text else 0)
    assert found.time == 2.5


def test_attributes_of_older_files_as_vtk_writes_them(tmp_path: Path) -> None:
    for text in (True, False):
        data = data_of(".vtp", PLACES[:8], {}, cells=8)
        for attributes in (data.GetPointData(), data.GetCellData()):
            for kind, values in {
                "Scalars": np.array([0, 255] * 4, np.uint8),
                "Vectors": PLACES[:8],
                "Normals": PLACES[8:16],
                "Tensors": np.arange(72.0).reshape(8, 9),
                "TCoords": np.arange(16.0).reshape(8, 2),
                "GlobalIds": np.arange(8),
            }.items():
                add(attributes, kind, values)
                getattr(attributes, f"SetActive{kind}")(kind)
        add(data.GetCellData(), "TIME", np.arange(8))
        writer = vtkIOLegacy.vtkPolyDataWriter()
        writer.SetInputData(data)
        (writer.SetFileTypeToASCII if text else writer.SetFileTypeToBinary)()
        writer.SetFileName(str(tmp_path / "a.vtk"))
        assert writer.Write()
        found = vtray.read(tmp_path / "a.vtk")
        assert found.time is None
        assert found["Scalars"].tolist() == [0, 255] * 4
        assert np.allclose(found["Vectors"], PLACES[:8], rtol=1e-5)
        assert np.allclose(found["Normals"], PLACES[8:16], rtol=1e-5)
        assert found["Tensors"].tolist() == np.arange(72).reshape(8, 9).tolist()
        assert found["TCoords"].tolist() == np.arange(16).reshape(8, 2).tolist()
        assert found["GlobalIds"].tolist() == list(range(8))


# As LIGGGHTS writes it, with arrays of more kinds.
GRAINS = """# vtk DataFile Version 2.0
Generated by LIGGGHTS
ASCII
DATASET POLYDATA
POINTS 3 float
0.1 0.2 0.3 1 2
3 -1e-2 nan_free_5 6
VERTICES 3 6
1 0
1 1
1 2
POINT_DATA 3
VECTORS v float
1 0 0
0 1 0
0 0 1
SCALARS radius float 1
LOOKUP_TABLE default
0.5
Inf
NaN
FIELD FieldData 3
name%20of%20it 1 3 string
a 1
1 2 3

a 1 3 int
1 2 3
temperature 2 3 double
1 2 3 4 5 6
METADATA
INFORMATION 1
NAME L2_NORM_RANGE LOCATION vtkDataArray
DATA 2 1 2

COLOR_SCALARS color 3
1 0 0 0 0.5 0 0 0 1
LOOKUP_TABLE table 1
0 0 0 1
""".replace("nan_free_5", "5")


def test_older_files_as_others_write_them(tmp_path: Path) -> None:
    for text in (
        GRAINS,
        GRAINS.replace("\n", "\r\n"),
        GRAINS.lower().replace("# vtk dataf", "# vtk DataF"),
    ):
        (tmp_path / "a.vtk").write_text(text, newline="")
        found = vtray.read(tmp_path / "a.vtk")
        expected = np.array([[0.1, 0.2, 0.3], [1, 2, 3], [-0.01, 5, 6]], np.float32)
        assert np.array_equal(found.positions, expected)
        assert np.array_equal(found["radius"], [0.5, np.inf, np.nan], equal_nan=True)
        assert found["v"].tolist() == np.eye(3).tolist()
        assert found["a"].tolist() == [1, 2, 3]
        assert found["temperature"].tolist() == [[1, 2], [3, 4], [5, 6]]
        assert found["color"].tolist() == [[255, 0, 0], [0, 128, 0], [0, 0, 255]]
        assert set(found.columns) == {"v", "radius", "a", "temperature", "color"}


def test_points_alone(tmp_path: Path) -> None:
    (tmp_path / "a.vtk").write_text(
        "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 1 int\n1 2 3"
    )
    assert vtray.read(tmp_path / "a.vtk").positions.tolist() == [[1, 2, 3]]
    nothing = write(tmp_path / "b.vtp", np.zeros((0, 3)), {})
    assert len(vtray.read(nothing)) == 0


def test_names_of_columns(tmp_path: Path) -> None:
    arrays = {"Diameter": [1.0, 2.0], "vx": [1, 2], "vy": [3, 4], "vz": [5, 6], "size": [7, 8]}
    path = write(tmp_path / "a.vtp", PLACES[:2], arrays)
    found = vtray.read(path)
    assert (found["radius"].tolist(), found["velocity"].tolist()) == (
        [0.5, 1],
        [[1, 3, 5], [2, 4, 6]],
    )
    assert vtray.read(path, columns={"radius": "size"})["radius"].tolist() == [7, 8]
    moved = vtray.read(
        write(path, PLACES[:2], {"there": PLACES[2:4]}), columns={"position": "there"}
    )
    assert np.array_equal(moved.positions, PLACES[2:4])


def test_pieces_of_one_file(tmp_path: Path) -> None:
    array = '<DataArray type="Int8" Name="{0}">{1}</DataArray>'
    text = '<DataArray type="String" Name="s">65 0</DataArray>'

    def piece(count: int, places: str, arrays: str) -> str:
        points = POINTS.format(places, "ascii")
        data = f"<Points>{points}</Points><PointData>{arrays}</PointData>"
        return f'<Piece NumberOfPoints="{count}">{data}</Piece>'

    pieces = (
        piece(1, "1 2 3", array.format("a", "4") + text)
        + '<Piece NumberOfPoints="0"/>'
        + piece(2, "5 6 7 8 9 1", array.format("a", "2 3") + array.format("b", "-1 1"))
    )
    grid = f"<UnstructuredGrid>{pieces}</UnstructuredGrid>"
    head = '<?xml version="1.0"?><!-- by me -->'
    (tmp_path / "a.vtu").write_text(f'{head}<VTKFile type="UnstructuredGrid">{grid}</VTKFile>')
    found = vtray.read(tmp_path / "a.vtu")
    assert found.positions.tolist() == [[1, 2, 3], [5, 6, 7], [8, 9, 1]]
    assert (found["a"].tolist(), found["a"].dtype) == ([4, 2, 3], np.int8)
    assert np.array_equal(found["b"], [np.nan, -1, 1], equal_nan=True)
    assert set(found.columns) == {"a", "b"}


@pytest.mark.parametrize("apart", [True, False])
def test_sizes_in_base64_apart_or_not(apart: bool, tmp_path: Path) -> None:
    size, numbers = np.uint32(12).tobytes(), np.array([1, 2, 3], np.float32).tobytes()
    parts = [size, numbers] if apart else [size + numbers]
    text = "".join(base64.b64encode(part).decode() for part in parts)
    for binary in (text, f"\n  {text[:9]}\n{text[9:]}\n"):
        (tmp_path / "a.vtp").write_text(xml(binary, "binary"))
        assert vtray.read(tmp_path / "a.vtp").positions.tolist() == [[1, 2, 3]]


def test_bits(tmp_path: Path) -> None:
    lines = "POINTS 9 bit", "POINT_DATA 9", "SCALARS on bit", "SCALARS next char"
    bits = [np.packbits([1, 0, 0] * 9).tobytes(), b"", np.packbits([0, 1] * 4 + [1]).tobytes()]
    parts = [*bits, bytes(range(9))]
    content = b"# vtk DataFile\n\nBINARY\nDATASET POLYDATA\n"
    for line, part in zip(lines, parts, strict=True):
        content += line.encode() + b"\n" + part + b"\n"
    (tmp_path / "a.vtk").write_bytes(content)
    found = vtray.read(tmp_path / "a.vtk")
    assert found.positions.tolist() == [[1, 0, 0]] * 9
    assert found["on"].tolist() == [0, 1] * 4 + [1]
    assert found["next"].tolist() == list(range(9))


def test_files_of_parallel_runs(tmp_path: Path) -> None:
    writer = vtkIOParallelXML.vtkXMLPPolyDataWriter()
    writer.SetInputData(data_of(".vtp", PLACES[:4], {"mass": np.arange(4)}))
    writer.SetFileName(str(tmp_path / "run.pvtp"))
    writer.SetNumberOfPieces(1)
    assert writer.Write()
    found = vtray.read(tmp_path / "run.pvtp")
    assert np.array_equal(found.positions, PLACES[:4])
    assert found["mass"].tolist() == [0, 1, 2, 3]


def test_blocks(tmp_path: Path) -> None:
    blocks = vtkCommonDataModel.vtkMultiBlockDataSet()
    inner = vtkCommonDataModel.vtkMultiBlockDataSet()
    inner.SetBlock(0, data_of(".vtp", PLACES[:2], {"mass": [1.0, 2.0]}))
    blocks.SetBlock(0, inner)
    blocks.SetBlock(2, data_of(".vtu", PLACES[2:3], {"charge": [3.0]}))
    writer = vtkIOXML.vtkXMLMultiBlockDataWriter()
    writer.SetInputData(blocks)
    writer.SetFileName(str(tmp_path / "run.vtm"))
    assert writer.Write()
    found = vtray.read(tmp_path / "run.vtm")
    assert np.array_equal(found.positions, PLACES[:3])
    assert np.array_equal(found["mass"], [1, 2, np.nan], equal_nan=True)
    assert np.array_equal(found["charge"], [np.nan, np.nan, 3], equal_nan=True)


def collection(path: Path, *entries: tuple[str, str]) -> Path:
    """Write a collection of files, each with its time."""
    sets = "".join(f'<DataSet timestep="{time}" part="0" file="{file}"/>' for time, file in entries)
    path.write_text(f'<VTKFile type="Collection"><Collection>{sets}</Collection></VTKFile>')
    return path


def test_collections_have_frames(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    for number in range(3):
        write(tmp_path / f"parts/p{number}.vtp", PLACES[number : number + 1], {}, time=7.0)
    path = collection(
        tmp_path / "run.pvd",
        ("10", "parts/p2.vtp"),
        ("0.5", "parts/p0.vtp"),
        ("0.5", "parts/p1.vtp"),
        ("0.50", "parts/p0.vtp"),  # as runs that were started again name them
    )
    frames = list(vtray.read_frames(path))
    assert [(len(one), one.time, one.frame) for one in frames] == [(2, 0.5, 0), (1, 10, 1)]
    assert np.array_equal(frames[0].positions, PLACES[:2])
    assert np.array_equal(vtray.read(path, -1).positions, PLACES[2:3])
    (second,) = vtray.read_frames(path, [1])
    assert np.array_equal(second.positions, PLACES[2:3])
    with pytest.raises(SceneError, match="run.pvd: frame 2: there are 2 frames; expected -2 to 1"):
        vtray.read(path, 2)
    timeless = path.read_text().replace('timestep="10"', "").replace('timestep="0.5"', "")
    timeless = timeless.replace('timestep="0.50"', "")
    path.write_text(timeless)
    assert (len(vtray.read(path)), vtray.read(path).time) == (3, 7)


def test_numbered_files_are_frames(tmp_path: Path) -> None:
    for number in (2, 10):
        write(tmp_path / f"run_{number}.vtu", np.full((1, 3), float(number)), {})
    found = [one.positions[0, 0] for one in vtray.read_frames(str(tmp_path / "run_*.vtu"))]
    assert found == [2, 10]


def test_content_tells_what_it_is(tmp_path: Path) -> None:
    written = write(tmp_path / "a.vtp", PLACES[:20], {}).read_bytes()
    binary = b"# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 1 float\n"
    contents = {
        "grains": GRAINS.encode(),
        "raw": written,
        "inner": b'<?xml version="1.0"?>\n<!-- by\nme -->\n' + written[written.index(b"<VTK") :],
        "bytes": binary + np.array([-1.5, 2, 3], ">f4").tobytes(),
    }
    for name, content in contents.items():
        for path, packed in {name: content, f"{name}.gz": gzip.compress(content)}.items():
            (tmp_path / path).write_bytes(packed)
            assert is_data(str(tmp_path / path)), path
            assert len(vtray.read(tmp_path / path)) in (1, 3, 20)
    assert vtray.read(tmp_path / "bytes").positions.tolist() == [[-1.5, 2, 3]]
    (tmp_path / "page").write_text("<html><VTKFile/></html>")
    assert not is_data(str(tmp_path / "page"))


def xml(points: str, way: str = "ascii", more: str = "", root: str = "") -> str:
    """Return a file of one point, with other arrays."""
    array = POINTS.format(points, way)
    piece = f"<Points>{array}</Points><PointData>{more}</PointData>"
    data = f'<PolyData><Piece NumberOfPoints="1">{piece}</Piece></PolyData>'
    return f'<VTKFile type="PolyData" {root}>\n{data}\n</VTKFile>'


WRONG = {
    "nothing": ("", "expected a file of VTK, which begins with # vtk DataFile or <VTKFile"),
    "words": ("words", "expected a file of VTK, which begins with # vtk DataFile or <VTKFile"),
    "another XML": ("<html/>", "expected the element VTKFile, got 'html'"),
    "half": (xml("1 2 3")[:-9], "line 3: expected XML (unclosed token)"),
    "not XML": (xml("1 2 & 3"), "line 2: expected XML (not well-formed (invalid token))"),
    "entities": (
        '<!DOCTYPE a [<!ENTITY b "c">]>' + xml("1 2 &b;"),
        "expected a file of VTK, which h",
    ),
    "an image": (
        '<VTKFile type="ImageData"><ImageData><Piece Extent="0 1"/></ImageData></VTKFile>',
        "expected points, as PolyData or UnstructuredGrid has, got 'ImageData'",
    ),
    "no files": (
        '<VTKFile type="Collection"><Collection/></VTKFile>',
        "expected points, or the names of files with some; Collection has none",
    ),
    "two numbers": (xml("1 2"), "array 'Points': expected 3 numbers, got 2"),
    "four numbers": (xml("1 2 3 4"), "array 'Points': expected 3 numbers, got 4"),
    "a word": (xml("1 2 a"), "array 'Points': expected numbers; some are none"),
    "too large": (
        xml("1 2 3", more='<DataArray type="Int8" Name="a">128</DataArray>'),
        "array 'a': expected numbers of 8 bits; some are larger",
    ),
    "planar": (
        xml("1 2 3").replace('Components="3"', 'Components="2"').replace(" 3<", "<"),
        "expected 1 points of 3 numbers, got shape (1, 2)",
    ),
    "no points": (
        xml("1 2 3").replace("Points><", "Other><", 1),
        "line 2: expected XML (mismatched tag)",
    ),
    "a kind": (
        xml("1 2 3").replace("Float32", "Float16"),
        "array 'Points': type: expected one of I",
    ),
    "a way": (xml("1 2 3", "hex"), "array 'Points': format: expected ascii, binary, or appended"),
    "not appended": (xml("", "appended"), "array 'Points': format: expected ascii, binary, or app"),
    "an amount": (
        xml("1 2 3").replace('Points="1"', 'Points="-1"'),
        "NumberOfPoints: expected a w",
    ),
    "many": (
        xml("1 2 3").replace('Points="1"', f'Points="{10**17}"'),
        "array 'Points': reading it needs about ",
    ),
    "many bytes": (
        xml("AAAA", "binary").replace('Points="1"', f'Points="{10**17}"'),
        "array 'Points': reading it needs about ",
    ),
    "an order": (
        xml("1 2 3", root='byte_order="Odd"'),
        "expected byte_order: LittleEndian or BigEn",
    ),
    "short base64": (
        xml("DAAAAA==", "binary"),
        "array 'Points': the file ends after 0 of 12 bytes",
    ),
    "base64": (xml("DAAAAA==A", "binary"), "array 'Points': expected base64 ("),
    "a size": (xml("CAAAAA==", "binary"), "array 'Points': expected 12 bytes, got 8"),
    "a compressor": (
        xml("AQAAAAwAAAAAAAAABAAAAA==AAAAAA==", "binary", root='compressor="vtkOther"'),
        "array 'Points': compressor: expected one of vtkZLibDataCompressor, ",
    ),
    "what zlib refuses": (
        xml(
            "AQAAAAwAAAAAAAAABAAAAA==AAAAAA==", "binary", root='compressor="vtkZLibDataCompressor"'
        ),
        "array 'Points': expected blocks of bytes, which zlib cannot read (error: ",
    ),
    "many blocks": (
        xml(
            "/////wwAAAAAAAAABAAAAA==AAAAAA==", "binary", root='compressor="vtkZLibDataCompressor"'
        ),
        "array 'Points': claims 4294967295 blocks for 12 bytes; write it again",
    ),
    "short blocks": (
        xml(
            base64.b64encode(np.array([1, 8, 0, 16], np.uint32).tobytes()).decode()
            + base64.b64encode(zlib.compress(bytes(8))).decode(),
            "binary",
            root='compressor="vtkZLibDataCompressor"',
        ),
        "array 'Points': expected 12 bytes, got 8",
    ),
    "no blocks": (
        xml(
            "AAAAAAwAAAAAAAAABAAAAA==AAAAAA==", "binary", root='compressor="vtkZLibDataCompressor"'
        ),
        "array 'Points': expected 12 bytes, got 0",
    ),
    "a time": (
        '<VTKFile type="Collection"><DataSet timestep="noon" file="a.vtp"/></VTKFile>',
        "timestep: expected a number, got 'noon'",
    ),
    "a file that is not there": (
        '<VTKFile type="Collection"><DataSet file="none.vtp"/></VTKFile>',
        "none.vtp: no such file; expected a file of VTK",
    ),
    "a file of itself": (
        '<VTKFile type="Collection"><DataSet file="wrong.vtk"/></VTKFile>',
        "wrong.vtk: wrong.vtk: wrong.vtk: wrong.vtk: wrong.vtk: expected points, got files of f",
    ),
    "not finite": (xml("1 nan 3"), "Particles.positions"),
    "another older file": (
        GRAINS.replace("POLYDATA", "STRUCTURED_POINTS"),
        "line 4: expected DATASET with one of POLYDATA, UNSTRUCTURED_GRID, STRUCTURED_GRID, got",
    ),
    "neither text nor bytes": (
        GRAINS.replace("ASCII", "UTF-8"),
        "line 3: expected ASCII or BINARY",
    ),
    "the head": ("# vtk DataFile", "line 1: expected ASCII or BINARY, got ''"),
    "no POINTS": (
        "# vtk DataFile\n\nASCII\nDATASET POLYDATA\n",
        "expected the line POINTS; there is none",
    ),
    "few numbers": (GRAINS.replace("5 6\n", "5\n"), "line 5: expected 9 numbers, got 8"),
    "many numbers": (GRAINS.replace("5 6\n", "5 6\n7\n"), "line 5: expected 9 numbers, got 10"),
    "no number": (GRAINS.replace("-1e-2", "1.2.3"), "line 5: expected numbers; some are none"),
    "no kind": (
        GRAINS.replace("POINTS 3 float", "POINTS 3"),
        "line 5: expected 3 entries, got 2: 'P",
    ),
    "a kind of numbers": (
        GRAINS.replace("3 float\n0", "3 real\n0"),
        "line 5: expected a kind of num",
    ),
    "no amount": (
        GRAINS.replace("POINTS 3", "POINTS x"),
        "line 5: expected a whole number as entry 2",
    ),
    "a word of no section": (
        GRAINS.replace("VECTORS", "ARROWS"),
        "line 13: expected a word of VTK",
    ),
    "other rows": (
        GRAINS.replace("a 1 3 int\n1 2 3", "a 1 2 int\n1 2"),
        "array 'a': expected 3 rows, got 2",
    ),
    "colours": (GRAINS.replace("0.5 0 0", "5 0 0"), "line 36: expected colours from 0 to 1"),
    "texts": (
        GRAINS[: GRAINS.index("a 1\n")] + "a",
        "line 24: the file ends before all of its texts",
    ),
    "bytes": (
        GRAINS[: GRAINS.index("0.1")].replace("ASCII", "BINARY") + "abcd",
        f"byte {GRAINS.index('POINTS') + 1}: the file ends after 4 of 36 bytes",
    ),
}


@pytest.mark.parametrize(("text", "message"), WRONG.values(), ids=WRONG)
def test_wrong_files(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "wrong.vtk"
    path.write_text(text)
    with pytest.raises(SceneError) as caught:
        vtray.read(path)
    assert str(caught.value).startswith(f"{path}: {message}")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("mode", ["raw", "text"])
def test_files_that_end_too_early(mode: str, tmp_path: Path) -> None:
    if mode == "raw":
        whole = write(tmp_path / "a.vtp", PLACES[:9], {"mass": np.arange(9)}).read_bytes()
    else:
        whole = GRAINS[: GRAINS.index("LOOKUP_TABLE table")].encode()
    path = tmp_path / "cut.vtk"
    read = 0
    for size in range(0, len(whole), 5):
        path.write_bytes(whole[:size])
        try:
            found = vtray.read(path)
        except SceneError as error:
            assert str(error).startswith(f"{path}: ")
        else:
            read += 1
            assert len(found) in (3, 9)
    # Some ends leave nothing out that is needed: those after a whole array.
    assert read < len(whole) / 20


def test_what_is_compressed_by_lz4_needs_lz4(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = vtkIOXML.vtkXMLPolyDataWriter()
    writer.SetInputData(data_of(".vtp", PLACES, {}))
    writer.SetCompressorTypeToLZ4()
    writer.SetFileName(str(tmp_path / "a.vtp"))
    assert writer.Write()
    monkeypatch.setitem(sys.modules, "lz4.block", None)
    with pytest.raises(
        ExtraError, match="compressed by LZ4 needs lz4, which is not installed: .*pip"
    ):
        vtray.read(tmp_path / "a.vtp")


def test_files_larger_than_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path / "a.vtp", PLACES[:9], {})
    monkeypatch.setattr(vtk_file, "_TIMES", 10**15)
    with pytest.raises(SceneError, match="a.vtp: reading it needs about "):
        vtray.read(path)


def test_the_command(vtray_command: Callable[..., CompletedProcess[str]], tmp_path: Path) -> None:
    write(tmp_path / "a.vtp", PLACES[:9], {"radius": np.full(9, 0.3)})
    small = ("--size", "8x8", "--samples", "1")
    done = vtray_command(*small, "a.vtp", "a.png", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "a.png").stat().st_size > 0
    (tmp_path / "a.vtp").write_text("<VTKFile")
    done = vtray_command(*small, "a.vtp", "a.png", cwd=tmp_path)
    assert done.returncode != 0
    assert re.fullmatch(r"Error: a.vtp: line 1: expected XML \(.*\)\n", done.stderr)
