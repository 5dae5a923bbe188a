"""How pictures are compared: the function and the command vtray-diff."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import png
import pytest
from PIL import Image

from vtray.commands import diff
from vtray.figures.comparison import DiffError, read_picture
from vtray.image.formats.image_file import Pixels

pytest.importorskip("flip_evaluator", reason="needs the extra vtray[diff]")

COMMAND = Path(sys.executable).with_name("vtray-diff")


def gray(level: int, width: int = 12, height: int = 8) -> Pixels:
    """Return a picture of one gray."""
    return np.full((height, width, 3), level, np.uint8)


def marked() -> Pixels:
    """Return a gray picture with one pixel that is 20 brighter in green."""
    pixels = gray(100)
    pixels[3, 5, 1] = 120
    return pixels


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with images, which is also the working folder."""
    monkeypatch.chdir(tmp_path)
    pictures = {"gray": gray(100), "marked": marked(), "white": gray(255), "black": gray(0)}
    for name, pixels in {**pictures, "wide": gray(100, width=13)}.items():
        Image.fromarray(pixels).save(tmp_path / f"{name}.png")
    return tmp_path


def read(path: Path) -> Pixels:
    """Read an image with Pillow alone."""
    with Image.open(path) as image:
        assert image.mode == "RGB"
        return np.asarray(image)


def test_equal_pictures() -> None:
    found = diff.compare(gray(100), gray(100))
    assert (found.flip, found.differing, found.largest, found.pixels) == (0, 0, 0, 96)
    assert found.is_alike(0)
    assert str(found) == "FLIP 0 (0: equal, 1: as different as can be); all 96 pixels are equal"
    assert found.error_map.shape == (8, 12, 3)
    assert found.error_map.max() <= 5, "the first colour of magma is nearly black"


def test_one_pixel() -> None:
    found = diff.compare(gray(100), marked())
    assert (found.differing, found.largest) == (1, 20)
    assert 0 < found.flip < 0.5
    assert found.error_map[3, 5].sum() == found.error_map.sum(axis=2).max()
    assert str(found).endswith("; 1 of 96 pixels differ, by at most 20 of 255")


def test_differences_do_not_wrap_around_and_work_both_ways() -> None:
    there, back = diff.compare(gray(0), gray(255)), diff.compare(gray(255), gray(0))
    assert there.largest == back.largest == 255
    assert there.flip == pytest.approx(0.967, abs=0.01)
    assert not there.is_alike()


def test_single_pixel_picture() -> None:
    assert diff.compare(gray(7, 1, 1), gray(7, 1, 1)).flip == 0


def test_greater_change_has_greater_error() -> None:
    errors = [diff.compare(gray(100), gray(level)).flip for level in (100, 101, 105, 150, 255)]
    assert errors == sorted(set(errors))


def test_tiny_error_is_not_shown_as_zero() -> None:
    found = diff.Likeness(0.00001, 10, 1, 1, gray(0))
    assert str(found).startswith("FLIP below 0.0001 (")


@pytest.mark.parametrize(
    ("a", "b", "message"),
    [
        (gray(0), gray(0, width=3), "b: expected an image of 12 x 8 pixels, as a is, got 3 x 8"),
        (gray(0), gray(0).astype(float), r"b: expected .* uint8 .* got float64 \(8, 12, 3\)"),
        (gray(0)[:, :, 0], gray(0), r"a: expected .* uint8 .* got uint8 \(8, 12\)"),
        (gray(0), np.zeros((8, 12, 5), np.uint8), r"b: expected .* got uint8 \(8, 12, 5\)"),
    ],
)
def test_pictures_that_cannot_be_compared(a: Pixels, b: Pixels, message: str) -> None:
    with pytest.raises(DiffError, match=message):
        diff.compare(a, b)


@pytest.mark.parametrize("mode", ["1", "L", "P", "RGB", "RGBA", "LA"])
def test_kinds_of_image_files(folder: Path, mode: str) -> None:
    Image.open(folder / "white.png").convert(mode).save("kind.png")
    np.testing.assert_array_equal(read_picture(Path("kind.png")), gray(255))


def test_transparent_image_is_not_black(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = folder / "glass.png"
    Image.new("RGBA", (12, 8), (200, 100, 50, 0)).save(path)
    assert diff.run(["glass.png", "black.png"]) == 2
    assert "96 of 96 pixels differ, by at most 255 of 255; see " in capfd.readouterr().out


def test_16_bits_are_compared_as_such(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    for name, level in (("a", 0), ("b", 100)):
        with (folder / f"{name}.png").open("wb") as file:
            png.Writer(12, 8, greyscale=False, bitdepth=16).write(file, [[level] * 36] * 8)
    assert diff.run(["a.png", "b.png", "--threshold", "1"]) == 0
    assert "; 96 of 96 pixels differ, by at most 100 of 65535\n" in capfd.readouterr().out


def test_alike_prints_one_line_and_writes_nothing(
    folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    before = sorted(path.name for path in folder.iterdir())
    assert diff.run(["gray.png", "gray.png"]) == 0
    out, err = capfd.readouterr()
    assert out.startswith("FLIP 0 ")
    assert (out.count("\n"), err) == (1, "")
    assert sorted(path.name for path in folder.iterdir()) == before


def test_not_alike_writes_the_difference_image(
    folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert diff.run(["black.png", "white.png"]) == 2
    out, err = capfd.readouterr()
    assert out.endswith("96 of 96 pixels differ, by at most 255 of 255; see difference.png\n")
    assert (out.count("\n"), err) == (1, "")
    np.testing.assert_array_equal(
        read(folder / "difference.png"), diff.compare(gray(0), gray(255)).error_map
    )


def test_named_difference_image_is_written_also_when_alike(folder: Path) -> None:
    assert diff.run(["gray.png", "gray.png", "-o", "map.png"]) == 0
    assert read(folder / "map.png").shape == (8, 12, 3)


@pytest.mark.parametrize(("threshold", "status"), [("0", 2), ("0.00001", 2), ("1", 0)])
def test_threshold(folder: Path, threshold: str, status: int) -> None:
    assert folder.is_dir()
    assert diff.run(["gray.png", "marked.png", "--threshold", threshold]) == status


BAD_CALLS = [
    ([], "the following arguments are required: A.png, B.png; usage: vtray-diff "),
    (["gray.png"], "the following arguments are required: B.png; usage: vtray-diff "),
    (["gray.png", "gray.png", "--thresh", "1"], "unrecognized arguments: --thresh"),
    (["gray.png", "gray.png", "--threshold", "nan"], "expected a number from 0 to 1, got nan"),
    (["gray.png", "gray.png", "--threshold", "-1"], "expected a number from 0 to 1, got -1"),
    (["gray.png", "gray.png", "--threshold", "x"], "expected a number from 0 to 1, got x"),
    (["gray.png", "none.png"], "none.png: cannot be read: no such file or directory"),
    (["folder", "gray.png"], "folder: cannot be read: is a directory"),
    (["empty.png", "gray.png"], "empty.png: cannot be read: it is no image, or a damaged one"),
    (["text.png", "gray.png"], "text.png: cannot be read: it is no image, or a damaged one"),
    (["half.png", "gray.png"], "half.png: cannot be read: it is no image, or a damaged one"),
    (
        ["gray.png", "light.exr"],
        "light.exr: cannot be read: it holds light and arrays, and pixels are",
    ),
    (["arrays.NPZ", "gray.png"], "; save the picture as .png, .tif, .webp or .jpg too"),
    (["gray.png", "none.npz"], "none.npz: cannot be read: no such file or directory"),
    (["deep.png", "gray.png"], "deep.png: expected an image of 8 bits per channel, got one of"),
    (
        ["gray.png", "wide.png"],
        "wide.png: expected an image of 12 x 8 pixels, as gray.png is, got 13 x 8",
    ),
    (["gray.png", "white.png", "-o", "x.gif"], 'x.gif: cannot write ".gif" files'),
    (["gray.png", "white.png", "-o", "folder"], "folder: is a folder"),
    (["gray.png", "white.png", "-o", "none/x.png"], "none/x.png: there is no folder "),
    (
        ["gray.png", "white.png", "-o", "gray.png"],
        "gray.png: is one of the images to compare; choose another name with -o",
    ),
]


@pytest.mark.parametrize(("arguments", "message"), BAD_CALLS)
def test_errors(
    folder: Path, arguments: list[str], message: str, capfd: pytest.CaptureFixture[str]
) -> None:
    (folder / "folder").mkdir()
    (folder / "empty.png").touch()
    (folder / "text.png").write_text("not an image")
    (folder / "light.exr").write_bytes(b"v/1\x01 of a picture")
    np.savez(folder / "arrays.NPZ.npz", linear=np.zeros((8, 12, 3)))
    (folder / "arrays.NPZ.npz").rename(folder / "arrays.NPZ")
    Image.fromarray(np.random.default_rng(1).integers(0, 255, (64, 64, 3), np.uint8)).save(
        folder / "noise.png"
    )
    (folder / "half.png").write_bytes((folder / "noise.png").read_bytes()[:6000])
    Image.new("I;16", (12, 8)).save(folder / "deep.png")
    before = {path.name: path.stat().st_mtime_ns for path in folder.iterdir()}

    assert diff.run(arguments) == 1
    out, err = capfd.readouterr()
    assert out == ""
    assert err.startswith("Error: ")
    assert message in err
    assert err.count("\n") == 1
    assert {path.name: path.stat().st_mtime_ns for path in folder.iterdir()} == before


def test_default_difference_image_never_replaces_an_input(
    folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (folder / "white.png").rename(folder / "difference.png")
    assert diff.run(["gray.png", "difference.png"]) == 1
    assert "difference.png: is one of the images to compare" in capfd.readouterr().err
    np.testing.assert_array_equal(read(folder / "difference.png"), gray(255))


def test_number_is_printed_also_when_the_image_cannot_be_written(
    folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (folder / "difference.png").mkdir()
    assert diff.run(["gray.png", "white.png"]) == 1
    out, err = capfd.readouterr()
    assert out.startswith("FLIP ")
    assert err.startswith("Error: difference.png: ")


def test_out_of_memory_says_what_to_do(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr(diff, "read_picture", fail)
    assert diff.run(["gray.png", "gray.png"]) == 1
    err = capfd.readouterr().err
    assert err.startswith("Error: out of memory: ")
    assert err.endswith("; expected a smaller picture or scene, or more memory for this process\n")


@pytest.mark.skipif(sys.platform != "linux", reason="needs limits of memory")
def test_too_little_memory_does_not_end_the_process(tmp_path: Path) -> None:
    Image.new("RGB", (800, 600)).save(tmp_path / "a.png")
    command = f"ulimit -v 200000; exec {COMMAND} a.png a.png"
    shell = ["bash", "-c", command]
    done = subprocess.run(shell, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.startswith("Error: to compare pictures of 800 x 600 pixels needs 115 MB of")


def test_missing_extra_is_explained(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    assert folder.is_dir()
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    assert diff.run(["gray.png", "gray.png"]) == 1
    assert f"{sys.executable} -m pip install flip-evaluator\n" in capfd.readouterr().err


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_and_version(option: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert diff.run([option]) == 0
    out, err = capfd.readouterr()
    assert "vtray-diff" in out
    assert err == ""


@pytest.mark.skipif(not COMMAND.exists(), reason="needs the installed command")
def test_installed_command(folder: Path) -> None:
    def call(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(COMMAND), *arguments], capture_output=True, text=True, check=False, cwd=folder
        )

    alike = call("gray.png", "gray.png")
    assert (alike.returncode, alike.stderr) == (0, "")
    other = call("gray.png", "white.png", "-o", "map.png")
    assert (other.returncode, other.stderr) == (2, "")
    assert other.stdout.endswith("; see map.png\n")
    wrong = call("gray.png")
    assert (wrong.returncode, wrong.stdout) == (1, "")
    assert wrong.stderr.startswith("Error: ")


def test_help_loads_no_arrays() -> None:
    code = (
        "import sys, vtray.commands.diff; vtray.commands.diff.run(['--help']);"
        "assert not {'numpy', 'PIL', 'numba', 'flip_evaluator'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
