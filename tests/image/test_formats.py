"""The formats of pictures: each file is read by another library than wrote it, or by hand."""

import io
import os
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
import png
import pytest
import tifffile
from hypothesis import given
from hypothesis import strategies as st
from pictures import hand_made, png_chunks, read_exr
from PIL import Image as PillowImage

import vtray
from conftest import once
from vtray.image.formats.image_format import FORMATS, check_format

BACKGROUNDS = ["black", "transparent", (10, 20, 30)]


def read_by_oiio(path: Path, kind: str) -> np.ndarray:
    source = OpenImageIO.ImageInput.open(str(path), _straight())
    assert source, OpenImageIO.geterror()
    pixels = source.read_image(kind)
    source.close()
    return pixels


def _straight() -> OpenImageIO.ImageSpec:
    """Ask for alpha as it is in the file, colours not multiplied by it."""
    config = OpenImageIO.ImageSpec()
    config["oiio:UnassociatedAlpha"] = 1
    return config


def read_by_pillow(path: Path) -> np.ndarray:
    with PillowImage.open(path) as image:
        return np.asarray(image)


@pytest.mark.parametrize("background", BACKGROUNDS)
@pytest.mark.parametrize("name", ["a.png", "a.PNG", "a", "a.tif", "a.tiff", "a.webp"])
def test_8_bits(name: str, background: object, tmp_path: Path) -> None:
    image = hand_made(background=background)
    image.save(tmp_path / name)
    np.testing.assert_array_equal(read_by_pillow(tmp_path / name), image.develop(8))
    if "." in name:
        np.testing.assert_array_equal(read_by_oiio(tmp_path / name, "uint8"), image.develop(8))


@pytest.mark.parametrize("background", BACKGROUNDS)
@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.tiff"])
def test_16_bits(name: str, background: object, tmp_path: Path) -> None:
    image = hand_made(background=background)
    image.save(tmp_path / name, bits=16)
    np.testing.assert_array_equal(read_by_oiio(tmp_path / name, "uint16"), image.develop(16))
    # Pillow reads the upper half of each number, and says what kind of file that is.
    seen = read_by_pillow(tmp_path / name)
    np.testing.assert_array_equal(seen, image.develop(16) >> 8)


def test_tiff_of_16_bits_is_compressed_and_says_its_alpha(tmp_path: Path) -> None:
    hand_made(background="transparent").save(tmp_path / "a.tif", bits=16)
    with tifffile.TiffFile(tmp_path / "a.tif") as file:
        tags = file.pages[0].tags
        assert tags["ExtraSamples"].value == (2,)  # not multiplied by alpha
        assert (tags["Compression"].value, tags["Predictor"].value) == (8, 2)


@given(
    width=st.integers(1, 9),
    height=st.sampled_from([1, 2, 63, 64, 65, 128, 130]),
    seed=st.integers(0, 99),
    background=st.sampled_from(BACKGROUNDS),
)
def test_16_bit_png_of_any_size(width: int, height: int, seed: int, background: object) -> None:
    image = hand_made(width, height, chance=seed, background=background)
    file = io.BytesIO()
    FORMATS[".png"].write(image, check_format(Path("a.png"), 16), file)
    chunks = png_chunks(file.getvalue())
    assert [name for name, _ in chunks if name != "IDAT"] == ["IHDR", "IEND"]
    columns, rows, values, info = png.Reader(bytes=file.getvalue()).asDirect()
    expected = image.develop(16)
    assert (columns, rows, info["bitdepth"]) == (width, height, 16)
    found = np.vstack([np.asarray(row, np.uint16) for row in values])
    np.testing.assert_array_equal(found.reshape(expected.shape), expected)


def test_jpeg_is_nearly_the_picture(tmp_path: Path) -> None:
    image = hand_made(64, 48)
    ramp = np.arange(64) * 4 * np.ones((48, 1))
    image.linear = np.dstack([ramp, ramp[:, ::-1], ramp])
    image.white = 255.0
    for name in ("a.jpg", "a.jpeg"):
        image.save(tmp_path / name)
        found = read_by_pillow(tmp_path / name).astype(int)
        assert np.abs(found - image.develop(8)).max() <= 4


@pytest.mark.parametrize("background", BACKGROUNDS)
@pytest.mark.parametrize("size", [(9, 7), (1, 1), (40, 33)])
def test_exr(background: object, size: tuple[int, int], tmp_path: Path) -> None:
    image = hand_made(*size, background=background)
    image.save(tmp_path / "a.exr", aov=["ids", "depth", "normals"])
    attributes, channels = read_exr((tmp_path / "a.exr").read_bytes())
    light = (image.linear / 255).astype(np.float32)
    expected = {name: light[..., k] for k, name in enumerate("RGB")}
    if background != "black":
        expected["A"] = image.alpha.astype(np.float32)
    expected["Z"] = image.depth.astype(np.float32)
    assert np.isinf(expected["Z"]).any() or size == (1, 1)
    for k, axis in enumerate("XYZ"):
        expected[f"N.{axis}"] = image.normals[..., k].astype(np.float32)
    expected["objectid"] = image.ids[..., 0].astype(np.uint32)
    expected["particleid"] = image.ids[..., 1].astype(np.uint32)
    assert list(channels) == sorted(expected)
    for name, values in channels.items():
        assert values.dtype == expected[name].dtype
        np.testing.assert_array_equal(values, expected[name], name)
    assert attributes["software"] == ("string", f"vtray {vtray.__version__}".encode())


def test_exr_is_understood_by_another_program(tmp_path: Path) -> None:
    image = hand_made(background="transparent")
    image.save(tmp_path / "a.exr", aov=["depth", "ids"])
    source = OpenImageIO.ImageInput.open(str(tmp_path / "a.exr"))
    spec = source.spec()
    assert spec.channelnames == ("R", "G", "B", "A", "Z", "objectid", "particleid")
    assert (spec.alpha_channel, spec.z_channel) == (3, 4)
    found = source.read_image("float")
    source.close()
    np.testing.assert_array_equal(found[..., :3], (image.linear / 255).astype(np.float32))
    np.testing.assert_array_equal(found[..., 4], image.depth.astype(np.float32))


def test_exr_of_light_beyond_all_bounds(tmp_path: Path) -> None:
    image = hand_made()
    image.linear[0, 0] = 1e300
    image.save(tmp_path / "a.exr")
    _, channels = read_exr((tmp_path / "a.exr").read_bytes())
    assert channels["R"][0, 0] == np.inf


@pytest.mark.parametrize("background", BACKGROUNDS)
@pytest.mark.parametrize("bits", [8, 16])
def test_npz(bits: int, background: object, tmp_path: Path) -> None:
    image = hand_made(background=background)
    image.save(tmp_path / "a.npz", bits=bits, aov=["depth", "ids"])
    with np.load(tmp_path / "a.npz", allow_pickle=False) as found:
        names = {"linear", "pixels", "depth", "ids", "provenance"}
        assert set(found.files) == names | ({"alpha"} if background != "black" else set())
        for name in found.files:
            expected = image.develop(bits) if name == "pixels" else getattr(image, name, None)
            if name != "provenance":
                assert found[name].dtype == expected.dtype
                np.testing.assert_array_equal(found[name], expected)


@pytest.mark.parametrize("ending", FORMATS)
def test_what_is_not_asked_for_is_not_traced(ending: str, tmp_path: Path) -> None:
    image = hand_made(covered=False)
    image.save(tmp_path / f"a{ending}")


@pytest.mark.parametrize("ending", FORMATS)
def test_files_are_equal_on_every_run(ending: str, tmp_path: Path) -> None:
    for name in "ab":
        hand_made(40, 30).save(tmp_path / f"{name}{ending}", bits=FORMATS[ending].bits[-1])
    one, two = ((tmp_path / f"{name}{ending}").read_bytes() for name in "ab")
    assert one == two


NAMES = "depth, normals, ids, copies, raw, albedo, error, samples, direct, indirect, emission"

BAD = [
    ("a.gif", {}, {}, 'cannot write ".gif" files; the formats are .png, .tif, .tiff, .jpg'),
    ("a.png", {"bits": 7}, {}, "bits: expected 8 or 16 for this format, got 7"),
    ("a.png", {"bits": True}, {}, "bits: expected 8 or 16 for this format, got True"),
    ("a.png", {"bits": np.arange(2)}, {}, "bits: expected 8 or 16 for this format, got array"),
    ("a.png", {"bits": "8"}, {}, "bits: expected 8 or 16 for this format, got '8'"),
    ("a.png", {"bits": 32}, {}, "bits: expected 8 or 16 for this format, got 32; .exr can hold 32"),
    ("a.jpg", {"bits": 16}, {}, "expected 8 for this format, got 16; .png, .tif, .tiff, .npz can"),
    ("a.webp", {"bits": 16}, {}, "expected 8 for this format, got 16; .png, .tif, .tiff, .npz can"),
    ("a.exr", {"bits": 16}, {}, "bits: expected 32 for this format, got 16"),
    (
        "a.exr",
        {"aov": ["dept"]},
        {},
        f"aov: expected names of {NAMES}, got 'dept'",
    ),
    (
        "a.exr",
        {"aov": "depth,ids"},
        {},
        f"aov: expected names of {NAMES}, got 'depth,",
    ),
    (
        "a.exr",
        {"aov": [1]},
        {},
        f"aov: expected names of {NAMES}, got 1",
    ),
    *(
        ("a.exr", {"aov": one}, {}, f"aov: expected names of {NAMES}, got {one!r}")
        for one in (5, None)
    ),
    ("a.exr", {"aov": [np.arange(2)]}, {}, f"aov: expected names of {NAMES}, got array"),
    *(
        (f"a{ending}", {"aov": ["ids", "depth"]}, {}, "cannot hold depth, ids; .exr, .npz can")
        for ending in (".png", ".tif", ".tiff", ".jpg", ".jpeg", ".webp", "")
    ),
    *(
        (
            f"a{ending}",
            {},
            {"background": "transparent"},
            "cannot be transparent; .png, .tif, .tiff, .webp, .exr, .npz can, or choose a color",
        )
        for ending in (".jpg", ".jpeg")
    ),
    ("a.webp", {}, {"width": 16384}, "up to 16383 pixels across and down, got 16384; .png, .tif"),
    ("a.jpg", {}, {"height": 65501}, "up to 65500 pixels across and down, got 65501; .png, .tif"),
    ("no/a.png", {}, {}, "there is no folder|no such file or directory"),
    ("", {}, {}, "cannot be written|is a folder"),
]


@once
@pytest.mark.parametrize(("name", "options", "picture", "message"), BAD)
def test_what_cannot_be(
    name: str, options: dict, picture: dict, message: str, tmp_path: Path
) -> None:
    image = hand_made(**picture)
    with pytest.raises(vtray.OutputError) as error:
        image.save(tmp_path / name, **options)
    assert any(part in str(error.value) for part in message.split("|"))
    assert list(tmp_path.iterdir()) == []


NO_NAMES = [
    (io.BytesIO(), "path: expected the name of a file, got an object of BytesIO"),
    (None, "path: expected the name of a file, got an object of NoneType"),
    ("", "path: expected the name of a file, got an empty one"),
    ("a\ud800b.png", "a\\ud800b.png: no file name may hold the character '\\ud800'"),
]


@pytest.mark.parametrize(("path", "message"), NO_NAMES)
def test_what_is_no_name_of_a_file(path: Any, message: str) -> None:
    picture = hand_made(400, 300)
    for write in (picture.save, picture.annotated(title="one").save, picture.scene.save):
        with pytest.raises(vtray.OutputError) as error:
            write(path)
        assert str(error.value) == message
    for read in (vtray.read, lambda path: next(vtray.read_frames(path))):
        with pytest.raises(vtray.SceneError) as wrong:
            read(path)
        assert str(wrong.value) == message


def test_names_may_be_bytes(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    hand_made().save(os.fsencode(path))  # type: ignore[arg-type]
    assert path.read_bytes()[1:4] == b"PNG"


def test_the_largest_that_can_be(tmp_path: Path) -> None:
    hand_made(16383, 1).save(tmp_path / "a.webp")
    hand_made(1, 65500).save(tmp_path / "a.jpg")


def test_one_name_of_an_aov_is_enough(tmp_path: Path) -> None:
    hand_made().save(tmp_path / "a.npz", aov="depth")
    with np.load(tmp_path / "a.npz") as found:
        assert "depth" in found.files


@pytest.mark.parametrize(
    ("name", "bits", "module"), [("a.exr", None, "OpenEXR"), ("a.tif", 16, "tifffile")]
)
def test_missing_package(
    name: str, bits: int | None, module: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(vtray.OutputError) as error:
        hand_made().save(tmp_path / name, bits=bits)
    remedy = (
        f"{tmp_path / name}: this needs {module}; {sys.executable} -m pip install OpenEXR tifffile"
    )
    assert str(error.value) == remedy
    # Formats that need no package go on without.
    hand_made().save(tmp_path / "a.png", bits=16)
    hand_made().save(tmp_path / "b.tif")


def test_broken_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    monkeypatch.setattr("importlib.util.find_spec", lambda _: object())
    with pytest.raises(vtray.OutputError, match=r"needs OpenEXR; .* -m pip install OpenEXR"):
        hand_made().save(tmp_path / "a.exr")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("ending", FORMATS)
def test_full_device(ending: str, tmp_path: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("there is no /dev/full")
    path = tmp_path / f"a{ending}"
    path.symlink_to("/dev/full")
    with pytest.raises(vtray.OutputError, match="cannot be written: no space left on device"):
        hand_made(200, 100).save(path)


@pytest.mark.parametrize("ending", FORMATS)
def test_full_disk_leaves_the_old_file(ending: str, tmp_path: Path) -> None:
    pytest.importorskip("resource")
    # A process of its own, which may write no more than 2000 bytes to a file.
    code = (
        "import resource, signal, sys; sys.path.insert(0, sys.argv[2])\n"
        "from pictures import hand_made\n"
        "import vtray\n"
        "image = hand_made(200, 100)\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))\n"
        "try: image.save(sys.argv[1])\n"
        "except vtray.OutputError as error: print(error)\n"
    )
    path = tmp_path / f"a{ending}"
    path.write_bytes(b"precious")
    command = [sys.executable, "-c", code, str(path), str(Path(__file__).parents[1] / "reference")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == (f"{path}: cannot be written: file too large\n", "")
    assert path.read_bytes() == b"precious"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("ending", FORMATS)
def test_pipe(ending: str, tmp_path: Path) -> None:
    path, plain = tmp_path / f"pipe{ending}", tmp_path / f"plain{ending}"
    os.mkfifo(path)
    read: list[bytes] = []
    reader = threading.Thread(target=lambda: read.append(path.read_bytes()))
    reader.start()
    hand_made(40, 30).save(path)
    reader.join()
    hand_made(40, 30).save(plain)
    if ending == ".npz":  # zip files that cannot be sought are laid out another way
        with np.load(io.BytesIO(read[0])) as one, np.load(plain) as two:
            np.testing.assert_array_equal(one["linear"], two["linear"])
    else:
        assert read[0] == plain.read_bytes()


@pytest.mark.parametrize("ending", FORMATS)
def test_two_at_once_into_one_file(ending: str, tmp_path: Path) -> None:
    images = [hand_made(60, 50, chance=seed) for seed in (1, 2)]
    whole = []
    for k, image in enumerate(images):
        image.save(tmp_path / f"{k}{ending}")
        whole.append((tmp_path / f"{k}{ending}").read_bytes())
        (tmp_path / f"{k}{ending}").unlink()
    path = tmp_path / f"a{ending}"
    threads = [threading.Thread(target=image.save, args=(path,)) for image in images * 4]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
        assert path.read_bytes() in whole
    assert list(tmp_path.iterdir()) == [path]
