"""Scene files: what is read, what is refused, and in which words."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from scene_text import TEXT, changed, read, refuse, replaced

from vtray.base.errors import SceneError
from vtray.scene.files.scene_file import load, loads
from vtray.scene.scene import Color, Direction, Plane, Sphere

CONFORMANCE = Path(__file__).parents[3] / "shared" / "conformance"


def test_valid_scene() -> None:
    scene = read(TEXT)
    assert scene.camera.size == (256, 128)
    assert scene.camera.normal == Direction(0, 0, 1)
    sphere, plane = scene.objects
    assert isinstance(sphere, Sphere)
    assert isinstance(plane, Plane)
    assert sphere.color == Color(255, 0, 0)
    assert plane.lambert == 0.5


@pytest.mark.parametrize(
    "text",
    [
        TEXT.encode(),
        "\ufeff" + TEXT,
        b"\xef\xbb\xbf" + TEXT.encode(),
        TEXT.replace("\n", "\r\n"),
        "\t\n" + "".join(TEXT.split()) + " \n",
        TEXT.replace('"r": 255', '"r": 255.0').replace("256, 128", "256.0, 1.28e2"),
        TEXT.replace('"type"', '"\\u0074ype"').replace('"camera"', '"c\\u0061mera"'),
        TEXT.replace('"sphere"', '"sph\\u0065re"'),
        json.dumps(json.loads(TEXT), sort_keys=True),
        json.dumps(dict(reversed(json.loads(TEXT).items()))),
    ],
    ids=[
        "bytes",
        "mark",
        "mark in bytes",
        "crlf",
        "other space",
        "integers as floats",
        "escaped keys",
        "escaped tag",
        "sorted keys",
        "reversed keys",
    ],
)
def test_other_spellings_of_the_same_scene(text: str | bytes) -> None:
    assert read(text) == read(TEXT)


def test_limits_are_inside() -> None:
    values = {
        "objects[0].radius": 0,
        "objects[0].lambert": 0,
        "objects[0].color": {"r": 0, "g": 255, "b": 0},
        "objects[1].center.x": 1.7976931348623157e308,
        "lights[0].intensity": 0,
        "camera.normal": {"x": 5e-324, "y": 0, "z": 0},
        "camera.focus": 5e-324,
        "camera.size": [1, 2147483647],
    }
    assert read(json.dumps(changed(values))).camera.focus == 5e-324
    empty = read(json.dumps(changed({"lights": [], "objects": []})))
    assert (empty.lights, empty.objects) == ([], [])


@pytest.mark.parametrize(
    ("old", "new", "warning"),
    [
        (
            '"focus": 10',
            '"fokus": 9, "focus": 10',
            'camera.fokus: unknown key, ignored; the nearest known key is "focus"',
        ),
        (
            '"lights"',
            '"notes: \\": \\\\": "a: \\"b: c", "lights"',
            '["notes: \\": \\\\"]: unknown key, ignored; the nearest known key is "objects"',
        ),
        (
            '"type": "plane"',
            '"type": "plane", "typ": {"a": [{"b": null}], "c": "::"}',
            'objects[1].typ: unknown key, ignored; the nearest known key is "type"',
        ),
        (
            '"x": 5',
            '"x": 5, "w": "\\u003a"',
            'lights[0].location.w: unknown key, ignored; the nearest known key is "z"',
        ),
        (
            '"lambert": 0.5',
            '"lambert": 0.5, "radius": -1',
            'objects[1].radius: unknown key, ignored; the nearest known key is "normal"',
        ),
        (
            '"r": 1,',
            '"red\\u001b": "\\u00e9é\\ud83d\\ude00", "r": 1,',
            'objects[1].color["red\\x1b"]: unknown key, ignored; the nearest known key is "r"',
        ),
    ],
)
def test_unknown_keys_are_warned_of(old: str, new: str, warning: str) -> None:
    warnings: list[str] = []
    assert loads(replaced(old, new), "room.json", warn=warnings.append) == read(TEXT)
    assert warnings == [f"room.json: {warning}"]


def test_many_unknown_keys_are_summed_up() -> None:
    warnings: list[str] = []
    notes = ", ".join(f'"note{i}": {i}' for i in range(25))
    loads(replaced('"lights"', f'{notes}, "lights"'), "room.json", warn=warnings.append)
    assert len(warnings) == 21
    assert warnings[-1] == "room.json: 5 more unknown keys, ignored"


def test_warnings_name_the_caller() -> None:
    with pytest.warns(UserWarning, match="<string>: note: unknown key") as caught:
        loads(replaced('"lights"', '"note": 1, "lights"'))
    assert caught[0].filename == __file__


def test_warnings_of_load_name_the_caller(tmp_path: Path) -> None:
    path = tmp_path / "room.json"
    path.write_text(replaced('"lights"', '"note": 1, "lights"'))
    with pytest.warns(UserWarning, match="room.json: note: unknown key") as caught:
        load(path)
    assert caught[0].filename == __file__


def test_no_unknown_key_among_many_objects_is_missed() -> None:
    data = json.loads(TEXT)
    data["objects"] *= 50
    text = json.dumps(data)
    at = text.rindex('"radius"')
    warnings: list[str] = []
    loads(text[:at] + '"radios": 2, ' + text[at:], "room.json", warn=warnings.append)
    assert [warning.split(": ")[1] for warning in warnings] == ["objects[98].radios"]


def test_load(tmp_path: Path) -> None:
    path = tmp_path / "room.json"
    path.write_text(TEXT)
    assert load(path) == load(str(path)) == load(os.fsencode(path)) == read(TEXT)  # type: ignore[arg-type]


def test_load_names_the_file_as_given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("room.json").write_text("[]")
    with pytest.raises(SceneError, match=r"^room\.json: expected an object"):
        load("room.json")


@pytest.mark.parametrize("name", ["scene0.json", "scene1.json"])
def test_conformance_scenes(name: str) -> None:
    if not CONFORMANCE.is_dir():
        pytest.skip("the conformance scenes are not here")
    assert load(CONFORMANCE / name, warn=refuse).camera.focus == 10


@pytest.mark.parametrize(
    ("name", "got"),
    [(None, "an object of NoneType"), (3, "an object of int"), ("", "an empty one")],
)
def test_what_is_no_name_of_a_file(name: object, got: str) -> None:
    with pytest.raises(SceneError, match=f"^path: expected the name of a file, got {got}$"):
        load(name)  # type: ignore[arg-type]


def test_missing_file_and_directory(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"none\.json: no such file"):
        load(tmp_path / "none.json")
    with pytest.raises(SceneError, match="is a directory"):
        load(tmp_path)
    with pytest.raises(SceneError, match="cannot be read: embedded null byte"):
        load("a\0b")


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (PermissionError(13, "Permission denied"), "may not be read: permission denied"),
        (OSError(5, "Input/output error"), "cannot be read: Input/output error"),
        (MemoryError(), "is too large to hold in memory"),
    ],
)
def test_unreadable_file(error: Exception, message: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # Root may read everything, so the refusal is simulated.
    def refuse_to_open(*_: object) -> None:
        raise error

    monkeypatch.setattr("vtray.scene.files.scene_file.read_input", refuse_to_open)
    with pytest.raises(SceneError, match=f"room.json: {message}"):
        load("room.json")


@pytest.mark.parametrize("text", [None, 7, {}, bytearray(b"{}"), Path("room.json")])
def test_what_is_no_text(text: object) -> None:
    words = f"room.json: expected the text of a scene, as str or bytes, got {type(text).__name__} "
    with pytest.raises(SceneError) as error:
        loads(text, "room.json")
    assert str(error.value).startswith(words)


def test_reading_imports_nothing_slow(tmp_path: Path) -> None:
    path = tmp_path / "room.json"
    path.write_text(TEXT)
    slow = ["numpy", "numba", "json", "difflib", "tempfile", "vtray.scene.checks.scene_check"]
    code = (
        "import sys, vtray.scene.files.scene_file; vtray.scene.files.scene_file.load(sys.argv[1]);"
        f"print([name for name in {slow} if name in sys.modules])"
    )
    run = [sys.executable, "-c", code, str(path)]
    assert subprocess.run(run, capture_output=True, check=True, text=True).stdout == "[]\n"
