"""The command line, called as a function."""

import json
import re
import warnings
from pathlib import Path

import pytest
from examples import light, one_sphere, plane, scene, sphere

from conftest import compiled_only
from vtray.base.compiler import compiled
from vtray.base.version import __version__
from vtray.commands import cli
from vtray.image import exposure
from vtray.transport.integrators import direct as integrator

COMPILING = "vtray: compiling what this scene needs, once for this machine ...\n"


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """Return a scene file of 12 x 9 pixels."""
    document = one_sphere()
    document["camera"].update(size=[12, 9], resolution=[0.4, 0.4])
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(document))
    return path


def test_success_is_silent(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    output = small.with_name("picture")
    assert cli.run([str(small), str(output)]) == 0
    assert capfd.readouterr() == ("", "")
    assert output.read_bytes().startswith(b"\x89PNG")


def test_options_may_stand_anywhere(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    output = small.with_name("picture.png")
    assert cli.run([str(small), "--size", "6x4", str(output)]) == 0
    assert cli.run([str(small), str(output), "--quiet"]) == 0
    assert capfd.readouterr() == ("", "")
    assert output.exists()


USAGE = "usage: vtray [-t THREADS] SCENE OUTPUT (more: vtray --help)"
WRONG_USAGE = [
    ([], "the following arguments are required: SCENE"),
    (["SCENE"], "OUTPUT is missing"),
    (["SCENE", "a.png", "b.png"], "unrecognized arguments: b.png"),
    (["SCENE", "a.png", "--speed"], "unrecognized arguments: --speed"),
    (["SCENE", "a.png", "--thr", "2"], "unrecognized arguments: --thr 2"),
    *(
        (
            ["SCENE", "a.png", "-t", bad],
            f"argument -t/--threads: expected an integer ≥ 1, got {bad}",
        )
        for bad in ("0", "-1", "1.5", "two", "", "1e3", "٣", "99999999999999999999")
    ),
    (
        ["--cap", "maybe", "SCENE", "a.png"],
        "argument --cap: expected a colour such as red or #ff8000, or on or off, got maybe",
    ),
    (
        ["--outline", "maybe", "SCENE", "a.png"],
        "argument --outline: expected a width in pixels, or that and a colour such as 1.5,navy, "
        "got maybe",
    ),
    (["SCENE", "a.png", "-t"], "argument -t/--threads: expected one argument"),
    *(
        (
            ["SCENE", "--pixel", bad],
            f"argument --pixel: expected column,row such as 12,34, got {bad}",
        )
        for bad in ("1", "1,2,3", "a,b", "1;2", "1.5,2")
    ),
]


def test_names_of_files_may_begin_with_a_dash(
    small: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(small.parent)
    small.rename("-x.json")
    assert cli.run(["-q", "--", "-x.json", "-x.png"]) == 0
    assert capfd.readouterr() == ("", "")
    assert Path("-x.png").exists()


@pytest.mark.parametrize(("arguments", "message"), WRONG_USAGE)
def test_wrong_usage(
    arguments: list[str], message: str, small: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    arguments = [str(small) if word == "SCENE" else word for word in arguments]
    assert cli.run(arguments) == 1
    assert capfd.readouterr() == ("", f"Error: {message}; {USAGE}\n")


@pytest.mark.parametrize(
    ("output", "message"),
    [
        ("scene.json", 'cannot write ".json" files; the formats are .png'),
        ("picture.bmp", 'cannot write ".bmp" files; the formats are .png'),
        ("missing/picture.png", "there is no folder"),
        (".", "is a folder; give the name of a file"),
    ],
)
def test_output_that_cannot_be_written(
    output: str, message: str, small: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    # Found before anything is read: the scene need not even be there.
    assert cli.run(["no such scene", str(small.parent / output)]) == 1
    out, err = capfd.readouterr()
    assert out == ""
    assert re.fullmatch(rf"Error: .*{re.escape(message)}.*\n", err)


def test_output_that_is_the_scene(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bare = small.rename(small.with_name("scene"))
    before = bare.read_bytes()
    assert cli.run([str(bare), str(bare)]) == 1
    assert "is the scene file itself; choose another name" in capfd.readouterr().err
    assert bare.read_bytes() == before


def test_bad_scene_leaves_the_output_alone(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    output = small.with_name("picture.png")
    output.write_bytes(b"precious")
    small.write_text(small.read_text().replace('"radius": 1', '"radius": -2'))
    assert cli.run([str(small), str(output)]) == 1
    message = f"Error: {small}: objects[0].radius: expected a number ≥ 0, got -2\n"
    assert capfd.readouterr() == ("", message)
    assert output.read_bytes() == b"precious"
    assert sorted(item.name for item in small.parent.iterdir()) == ["picture.png", "scene.json"]


def test_image_too_large_for_memory(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    small.write_text(small.read_text().replace("[12, 9]", "[2147483647, 2000000]"))
    assert cli.run([str(small), str(small.with_name("a.png"))]) == 1
    start = "Error: camera.size: an image of 2147483647 x 2000000 pixels needs 133,143,986.1 GB of "
    end = r"memory, [\d,.]+ [GM]B is available( \(the limit .*\))?; expected a smaller size\n"
    assert re.fullmatch(re.escape(start) + end, capfd.readouterr().err)


def test_unknown_keys_are_warned_of(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    small.write_text(small.read_text().replace('"camera"', '"camrea": 1, "camera"', 1))
    output = str(small.with_name("a.png"))
    assert cli.run([str(small), output]) == 0
    warning = f'Warning: {small}: camrea: unknown key, ignored; the nearest known key is "camera"\n'
    assert capfd.readouterr() == ("", warning)
    assert cli.run(["--quiet", str(small), output]) == 0
    assert capfd.readouterr() == ("", "")


DARK = "so all that is seen is black"


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        (
            r'"lights": \[.*?\]',
            '"lights": []',
            f"there are none, {DARK}; add one by scene.add_light",
        ),
        (r'"intensity": 1.0', '"intensity": 0', f"all have the intensity 0, {DARK}; give one more"),
    ],
)
def test_darkness_is_warned_of(
    old: str, new: str, problem: str, small: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    small.write_text(re.sub(old, new, small.read_text()))
    output = ["--pixel", "6,4"] if "none" in problem else [str(small.with_name("a.png"))]
    assert cli.run([str(small), *output]) == 0
    (line,) = capfd.readouterr().err.splitlines()
    assert line.startswith(f"Warning: {small}: lights: {problem}")
    assert cli.run(["--quiet", str(small), *output]) == 0
    assert capfd.readouterr().err == ""


def test_stats(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["--stats", str(small), str(small.with_name("a.png"))]) == 0
    out, err = capfd.readouterr()
    assert out == ""
    names = [line[:12].strip() for line in err.splitlines()]
    steps = ["read", "compile", "build", "pack", "trace", "develop", "write"]
    assert names == [*steps, "rays", "rays/second", "peak memory"]
    for line in err.splitlines()[: len(steps)]:
        assert re.fullmatch(r"\w+ +\d+\.\d{4} s", line)
    assert int(err.splitlines()[len(steps)].split()[1]) > 12 * 9


def test_stats_of_many_spheres(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    document = one_sphere()
    document["objects"] = [sphere((k % 10, k // 10, 9), 0.4) for k in range(200)]
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(document))
    assert cli.run(["--stats", str(path), str(tmp_path / "a.png")]) == 0
    lines = capfd.readouterr().err.splitlines()
    stats = {line[:12].strip(): line[12:].strip() for line in lines}
    assert 1 < int(stats["nodes"]) < 200
    assert 1 < int(stats["depth"]) < int(stats["nodes"])
    assert stats["hierarchy"] == "0 MB"


def test_help_and_version(capfd: pytest.CaptureFixture[str]) -> None:
    for option in ("-h", "--help"):
        assert cli.run([option]) == 0
        out, err = capfd.readouterr()
        assert out.startswith("usage: vtray [OPTION ...] SCENE OUTPUT")
        assert err == ""
    for option in ("-V", "--version"):
        assert cli.run([option]) == 0
        assert capfd.readouterr().out == f"vtray {__version__}\n"


def test_pixel(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    red = {"r": 200, "g": 100, "b": 0}
    document = scene(
        [
            sphere((0, 0, 6), 1, color=red, lambert=0.5),
            plane((0, 0, 9), (0, 0, -1)),
            sphere((0, -3, 5), 0.5),
        ],
        [
            light(0, 0, 0),
            light(0, 0, 20, intensity=3),
            light(0, -6, 5),
            light(0, 0, 2, intensity=2),
        ],
        size=[8, 6],
    )
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(document))
    assert cli.run([str(path), "--pixel", "4,3"]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    assert out == (
        "pixel        column 4, row 3 of 8 x 6\n"
        "ray          from (0, 0, -10) towards (0, 0, 1)\n"
        "hit          objects[0], a sphere, 15 away\n"
        "  point      (0, 0, 5)\n"
        "  normal     (0, 0, -1), on the ray's side\n"
        "  material   color (200, 100, 0), lambert 0.5\n"
        "lights[0]    towards (0, 0, -1), 5 away\n"
        "  adds       (100, 50, 0) = cosine 1 x lambert 0.5 x intensity 1 x color\n"
        "lights[1]    towards (0, 0, 1), 15 away\n"
        "  adds       nothing: it is behind the surface\n"
        "lights[2]    towards (0, -1, 0), 6 away\n"
        "  adds       nothing: it is behind the surface\n"
        "lights[3]    towards (0, 0, -1), 3 away\n"
        "  adds       (200, 100, 0) = cosine 1 x lambert 0.5 x intensity 2 x color\n"
        "light        (300, 150, 0), the sum over all lights\n"
        "exposure     floor(255 x light / 300), 300 is the brightest channel of the picture\n"
        "value        (255, 127, 0)\n"
    )
    assert list(tmp_path.iterdir()) == [path]


def test_pixel_in_shadow_and_pixel_of_nothing(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "scene.json"
    objects = [sphere((2, 0, 3), 0.3), sphere((0, 0, 6), 1)]
    document = scene(objects, [light(4, 0, 1)], size=[8, 6])
    path.write_text(json.dumps(document))
    assert cli.run([str(path), "ignored.png", "--pixel", "4,3"]) == 0
    assert "  adds       nothing: objects[0], a sphere, is in the way\n" in capfd.readouterr().out
    document["objects"] = []
    path.write_text(json.dumps(document))
    assert cli.run([str(path), "--pixel", "0,0"]) == 0
    assert capfd.readouterr().out.splitlines()[2:] == [
        "hit          nothing in front of the image plane",
        "light        (0, 0, 0), the sum over all lights",
        "exposure     the whole picture is black",
        "value        (0, 0, 0)",
    ]


def test_pixel_outside_the_image(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.run([str(small), "--pixel", "12,0"]) == 1
    assert capfd.readouterr().err == "Error: --pixel: expected 0,0 to 11,8, got 12,0\n"


def fail_with(monkeypatch: pytest.MonkeyPatch, error: BaseException) -> None:
    def render(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr("vtray.rendering.renderer.render", render)


@pytest.mark.parametrize(
    ("error", "status", "message"),
    [
        (KeyboardInterrupt(), 130, ""),
        (BrokenPipeError(), 1, ""),
        (
            OSError(28, "No space left"),
            1,
            "Error: [Errno 28] No space left\n",
        ),
        (
            ZeroDivisionError("oops"),
            1,
            "Error: this is a bug in vtray, please report it: ZeroDivisionError('oops')\n",
        ),
    ],
)
def test_failures_leave_no_traceback(
    error: BaseException,
    status: int,
    message: str,
    small: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    fail_with(monkeypatch, error)
    assert cli.run([str(small), str(small.with_name("a.png"))]) == status
    assert capfd.readouterr() == ("", message)


@pytest.mark.filterwarnings("default")
def test_warnings_of_python_are_printed_in_a_line(
    small: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def render(*_: object, **__: object) -> None:
        warnings.warn("beware", stacklevel=1)
        raise KeyboardInterrupt

    monkeypatch.setattr("vtray.rendering.renderer.render", render)
    cli.run([str(small), str(small.with_name("a.png"))])
    assert capsys.readouterr().err == "Warning: beware\n"
    cli.run(["-q", str(small), str(small.with_name("a.png"))])
    assert capsys.readouterr().err == ""


def test_out_of_memory_says_what_there_is(
    small: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    fail_with(monkeypatch, MemoryError("Unable to allocate 2 GiB"))
    assert cli.run([str(small), str(small.with_name("a.png"))]) == 1
    start = r"Error: out of memory \(unable to allocate 2 GiB\): .* is available"
    end = r"; expected a smaller picture or scene, or more memory for this process\n"
    assert re.fullmatch(f"{start}.*{end}", capfd.readouterr().err)


def test_terminal_shows_progress(
    small: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setattr("vtray.base.progress.DELAY_SECONDS", -1.0)
    assert cli.run([str(small), str(small.with_name("a.png"))]) == 0
    reading, bar = capsys.readouterr().err.replace(COMPILING, "").split("\n")[:2]
    assert reading == f"vtray: reading {small} ..."
    assert bar.startswith("\rtrace")
    assert cli.run(["-q", str(small), str(small.with_name("a.png"))]) == 0
    assert capsys.readouterr().err == ""


@compiled_only
def test_terminal_shows_compiling_when_there_is_any(
    small: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setattr("vtray.base.progress.DELAY_SECONDS", 1e9)
    render = [str(small), str(small.with_name("a.png"))]
    assert cli.run(render) == 0
    capsys.readouterr()
    assert cli.run(render) == 0
    assert capsys.readouterr().err == ""

    # Two kernels that are loaded but not found before are compiled, as it were.
    asked: list[Path] = []
    read = compiled.read_object_code
    monkeypatch.setattr(compiled, "read_object_code", asked.append)
    monkeypatch.setattr(compiled, "compile_object", lambda *_: read(asked[-1]))
    monkeypatch.setattr(integrator.trace_tile, "_native", {})
    monkeypatch.setattr(exposure._expose, "_native", {})
    assert cli.run(["-q", *render]) == 0
    assert (capsys.readouterr().err, len(asked)) == ("", 2)
    integrator.trace_tile._native.clear()
    exposure._expose._native.clear()
    assert cli.run(render) == 0
    assert (capsys.readouterr().err, len(asked)) == (COMPILING, 4)
