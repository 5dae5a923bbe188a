"""Spheres of a scene file whose arrays stand in a file of their own."""

import errno
import io
import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scene_text import changed, message_of, read, replaced
from test_broken_scene_files import VALUES
from test_spheres import BYTE, CAMERA, CENTERS, COUNT, FIVE_NUMBERS, columns

import vtray
from vtray.base import memory
from vtray.base.errors import OutputError, SceneError
from vtray.scene.checks import scene_words
from vtray.scene.files.scene_file import load, loads
from vtray.scene.files.schema import scene_schema
from vtray.scene.scene import Color, Light, Scene, Sphere
from vtray.scene.spheres import Spheres

RED = {"r": 255, "g": 0, "b": 0}
REST = {"radius": 0.5, "color": RED, "lambert": 1}
WHERE = "objects[1].data: atoms.npz"


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def text_of(data: object = "atoms.npz", **keys: object) -> str:
    """Return a scene file whose second object are spheres."""
    entry = {"type": "spheres", "data": data, **keys}
    return json.dumps(changed({"objects[1]": entry}), ensure_ascii=False)


def spheres_of(data: object = "atoms.npz", **keys: object) -> Spheres:
    """Read a scene with spheres, without warnings."""
    spheres = read(text_of(data, **keys)).objects[1]
    assert isinstance(spheres, Spheres)
    return spheres


def savez(**changed_columns: Any) -> None:
    """Write atoms.npz, with some arrays replaced, or left out where they are None."""
    arrays = {
        name: array for name, array in columns(**changed_columns).items() if array is not None
    }
    np.savez("atoms.npz", **arrays)


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_npz(save: Any) -> None:
    save("atoms.npz", **columns())
    assert spheres_of() == Spheres(**columns())


def test_npz_keeps_dtypes_and_takes_any_order() -> None:
    center = np.asfortranarray(columns()["center"].astype("f4"))
    savez(center=center, color=columns()["color"].astype(">i4"), lambert=np.float16(0.5))
    spheres = spheres_of()
    assert (spheres.center.dtype, spheres.color.dtype) == (np.float32, np.uint8)
    assert spheres == Spheres(**columns(lambert=0.5))


def test_npy_of_centers() -> None:
    np.save("atoms.npy", columns()["center"])
    expected = Spheres(columns()["center"], 0.5, (255, 0, 0), 1)
    assert spheres_of("atoms.npy", **REST) == expected


def test_some_in_the_file_and_some_in_the_object() -> None:
    savez(color=None, lambert=None)
    expected = Spheres(**columns(color=(255, 0, 0), lambert=0.25))
    assert spheres_of(color=RED, lambert=0.25) == expected


def test_empty_arrays() -> None:
    np.savez("atoms.npz", center=np.zeros((0, 3)))
    assert len(spheres_of(**REST)) == 0


def test_path_is_relative_to_the_scene_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "a" / "b"
    folder.mkdir(parents=True)
    np.savez(tmp_path / "a" / "atoms.npz", **columns())
    (folder / "room.json").write_text(text_of("../atoms.npz"))
    absolute = text_of(str(tmp_path / "a" / "atoms.npz"))
    assert load("a/b/room.json") == load(folder / "room.json") == loads(absolute)
    monkeypatch.chdir(folder)
    assert load("room.json") == loads(text_of("../atoms.npz"))


def test_a_name_that_ends_like_arrays_is_enough() -> None:
    np.savez(".npz", **columns())
    assert spheres_of(".npz") == Spheres(**columns())


def test_loading_arrays_imports_no_compiler() -> None:
    savez()
    Path("room.json").write_text(text_of())
    code = (
        "import sys, vtray; assert 'numpy' not in sys.modules; vtray.load('room.json');"
        "slow = 'numba', 'json', 'vtray.rendering.renderer';"
        "print([name for name in slow if name in sys.modules])"
    )
    run = [sys.executable, "-W", "error", "-c", code]
    assert subprocess.run(run, capture_output=True, check=True, text=True).stdout == "[]\n"


# ---- keys, and the count of colons that finds unknown ones


@pytest.mark.parametrize("keys", [{}, {"color": RED}, {"radius": 1, "lambert": 1}, REST])
@pytest.mark.parametrize("name", ["atoms", "a:b", "ä::", "a b\\c"])
def test_good_files_need_no_second_look(
    keys: dict[str, Any], name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    explain = "vtray.scene.files.scene_file._explain"
    monkeypatch.setattr(explain, lambda *_: pytest.fail("looked again"))
    np.savez(f"{name}.npz", **{k: array for k, array in columns().items() if k not in keys})
    assert len(spheres_of(f"{name}.npz", **keys)) == COUNT


def test_a_colon_as_escape_hides_no_unknown_key() -> None:
    np.savez("a:b.npz", **columns())
    text = text_of("a:b.npz").replace("a:b", "a\\u003Ab")
    assert len(read(text).objects) == 2
    warnings: list[str] = []
    loads(text.replace('"data"', '"note": 1, "data"'), "room.json", warn=warnings.append)
    assert warnings == [
        'room.json: objects[1].note: unknown key, ignored; the nearest known key is "type"'
    ]


@pytest.mark.parametrize(("key", "value"), [("data", '"b:c.npz"'), ("radius", "2")])
def test_keys_given_twice(key: str, value: str) -> None:
    savez(radius=None)
    before, found, after = text_of(radius=1).rpartition(f'"{key}"')
    text = f"{before}{found}: {value}, {found}{after}"
    assert message_of(text) == f"objects[1].{key}: given twice, on line 1; expected each key once"


def test_unknown_keys_are_warned_of_once() -> None:
    savez()
    warnings: list[str] = []
    # As many colons as a sphere has.
    text = text_of(a=1, b=2, c=3, d=4, e=5, f=6, g=7, h=8, i=9)
    assert loads(text, warn=warnings.append) == read(text_of())
    assert [warning.split(": ")[1] for warning in warnings] == [
        f"objects[1].{k}" for k in "abcdefghi"
    ]


def test_as_many_unknown_keys_as_a_plane_has_more_than_a_sphere() -> None:
    warnings: list[str] = []
    loads(replaced('"radius"', '"a": 1, "b": 2, "c": 3, "radius"'), warn=warnings.append)
    assert [warning.split(": ")[1] for warning in warnings] == [f"objects[0].{k}" for k in "abc"]


def test_a_mistake_behind_spheres_is_found() -> None:
    savez()
    data = json.loads(text_of())
    data["objects"].append({**data["objects"][0], "radius": -1})
    assert message_of(json.dumps(data)) == "objects[2].radius: expected a number ≥ 0, got -1"


PATH = "expected the path of a .npz or .npy file"
BAD_KEYS: list[tuple[dict[str, object], str]] = [
    ({"data": "atoms.txt"}, f'data: {PATH}, got "atoms.txt"'),
    ({"data": "atoms"}, f'data: {PATH}, got "atoms"'),
    ({"data": ""}, f'data: {PATH}, got ""'),
    ({"data": "atoms.npz\n"}, f'data: {PATH}, got "atoms.npz\\n"'),
    ({"data": ["atoms.npz"]}, f'data: {PATH}, got ["atoms.npz"]'),
    ({"data": None}, f"data: {PATH}, got null"),
    ({"radius": -1}, "radius: expected a number ≥ 0, got -1"),
    ({"radius": [1, 2]}, "radius: expected a number ≥ 0, got [1, 2]"),
    ({"radius": None}, "radius: expected a number ≥ 0, got null"),
    ({"color": {"r": 1, "g": 2}}, f"color.b: missing; {BYTE.removesuffix(', got')}"),
    ({"color": [1, 2, 3]}, "color: expected an object with the keys r, g and b, got [1, 2, 3]"),
    ({"lambert": 2}, "lambert: expected a number from 0 to 1, got 2"),
]


@pytest.mark.parametrize(("keys", "message"), BAD_KEYS)
def test_bad_keys(keys: dict[str, Any], message: str) -> None:
    assert message_of(text_of(**keys)) == f"objects[1].{message}"


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(["data", "radius", "color", "color.r", "lambert", "type"]), VALUES)
def test_any_value_anywhere_gives_a_scene_or_an_error(key: str, value: object) -> None:
    np.save("atoms.npy", columns()["center"])
    data = json.loads(text_of("atoms.npy", **REST))
    inner = data["objects"][1]["color"] if key == "color.r" else data["objects"][1]
    inner[key.removeprefix("color.")] = value
    try:
        loads(json.dumps(data), "room.json", warn=lambda _: None)
    except SceneError as error:
        assert str(error).startswith("room.json: ")
        assert "malformed" not in str(error), "left to the words of msgspec"


def test_missing_path() -> None:
    text = text_of().replace('"data"', '"date"')
    assert message_of(text) == f'objects[1].data: missing; {PATH} (is "date" meant for it?)'


# ---- what is wrong with the arrays


BAD_ARRAYS: list[tuple[dict[str, Any], dict[str, Any], str]] = [
    (
        {"radius": np.array([0, 1, -2.0, 1, 1])},
        {},
        "data: atoms.npz: radius[2]: expected a number ≥ 0, got -2.0",
    ),
    (
        {"center": np.full((COUNT, 3), np.nan)},
        {},
        "data: atoms.npz: center[0, 0]: expected a finite number, got nan",
    ),
    (
        {"color": np.full((COUNT, 3), 256)},
        {},
        f"data: atoms.npz: color[0, 0]: {BYTE} 256",
    ),
    (
        {"lambert": np.array(1.5)},
        {},
        "data: atoms.npz: lambert: expected a number from 0 to 1, got 1.5",
    ),
    ({"center": np.zeros((3, 5))}, {}, f"data: atoms.npz: center: {CENTERS} shape (3, 5) (trans"),
    ({"radius": np.ones(4)}, {}, f"data: atoms.npz: radius: {FIVE_NUMBERS} shape (4,)"),
    (
        {"radius": np.array([None] * 5)},
        {},
        "data: atoms.npz: radius: holds Python objects; expected numbers",
    ),
    (
        {"radius": np.array(["1"] * 5)},
        {},
        "data: atoms.npz: radius: expected a number or an array of numbers of shape (n,), "
        "got an array of dtype <U1",
    ),
    (
        {"center": None},
        {},
        "data: atoms.npz: center: missing; expected an array of numbers of shape (n, 3)",
    ),
    (
        {"center": None, "centers": np.zeros((5, 3))},
        {},
        "data: atoms.npz: center: missing; expected an array of numbers of shape (n, 3)"
        ' (is "centers" meant for it?)',
    ),
    (
        {"radius": None},
        {},
        "radius: missing; expected a number ≥ 0, or an array radius in atoms.npz",
    ),
    (
        {"color": None, "colour": np.zeros(3)},
        {},
        "color: missing; expected an object with the keys r, g and b, or an array color in "
        'atoms.npz (is "colour" meant for it?)',
    ),
    ({}, {"radius": 1}, "radius: given here and in atoms.npz; expected it in one of them"),
    ({}, {"color": RED}, "color: given here and in atoms.npz; expected it in one of them"),
]


@pytest.mark.parametrize(("arrays", "keys", "message"), BAD_ARRAYS, ids=range(len(BAD_ARRAYS)))
def test_bad_arrays(arrays: dict[str, Any], keys: dict[str, Any], message: str) -> None:
    savez(**arrays)
    assert message_of(text_of(**keys)).startswith(f"objects[1].{message}")


def test_centers_alone_need_the_rest() -> None:
    np.save("atoms.npy", columns()["center"])
    message = message_of(text_of("atoms.npy", radius=1, color=RED))
    assert message == "objects[1].lambert: missing; expected a number from 0 to 1"
    np.save("atoms.npy", columns()["center"].T)
    message = message_of(text_of("atoms.npy", **REST))
    assert message == f"objects[1].data: atoms.npy: center: {CENTERS} shape (3, 5) (transpose it)"


def test_unknown_arrays_are_warned_of() -> None:
    # A pickle that is not looked at does no harm.
    savez(centre=np.zeros(3), charge=np.array([None]))
    Path("room.json").write_text(text_of())
    warnings: list[str] = []
    scene = load("room.json", warn=warnings.append)
    assert scene.objects[1] == Spheres(**columns())
    assert warnings == [
        f'room.json: {WHERE}: {name}: unknown array, ignored; the nearest known array is "{near}"'
        for name, near in (("centre", "center"), ("charge", "roughness"))
    ]
    with pytest.warns(UserWarning, match="unknown array") as caught:
        load("room.json")
    assert {warning.filename for warning in caught} == {__file__}


def test_many_unknown_arrays_are_summed_up() -> None:
    savez(**{f"note{i}": np.zeros(1) for i in range(25)})
    warnings: list[str] = []
    loads(text_of(), "room.json", warn=warnings.append)
    assert len(warnings) == 21
    assert warnings[-1] == "room.json: 5 more unknown arrays, ignored"


# ---- what is wrong with the files


def raw_npz() -> bytes:
    file = io.BytesIO()
    np.savez(file, **columns())
    return file.getvalue()


def raw_npy(array: Any = None) -> bytes:
    file = io.BytesIO()
    np.save(file, columns()["center"] if array is None else array)
    return file.getvalue()


RAW = raw_npz()
BAD_FILES: list[tuple[str, bytes, str]] = [
    ("atoms.npz", b"", "is empty; expected a .npz file as numpy.savez writes it"),
    ("atoms.npy", b"", "is empty; expected a .npy file as numpy.save writes it"),
    ("atoms.npz", b"x y z\n", "holds something else; expected a .npz file as numpy.savez"),
    ("atoms.npz", raw_npy(), "holds something else; expected a .npz file as numpy.savez"),
    ("atoms.npy", RAW, "holds something else; expected a .npy file as numpy.save writes it"),
    ("atoms.npy", b"\x80\x04]\x94.", "holds something else; expected a .npy file as numpy.save"),
    ("atoms.npz", RAW[:500], "is damaged or cut short (File is not a zip file); write it again"),
    ("atoms.npz", RAW[:-10], "is damaged or cut short (File is not a zip file); write it again"),
    (
        "atoms.npz",
        RAW[:200] + b"\xff\xff" + RAW[202:],
        "center: is damaged or cut short (Bad CRC-32 for file 'center.npy'); write it again",
    ),
    ("atoms.npy", raw_npy()[:-1], "is damaged or cut short ("),
    ("atoms.npy", raw_npy()[:20], "is damaged or cut short ("),
    (
        "atoms.npy",
        raw_npy().replace(b"(5, 3)", b"(5e3)"),
        "is damaged or cut short (",
    ),
    (
        "atoms.npy",
        raw_npy().replace(b"(5, 3), }" + 15 * b" ", b"(1000000000000000, 3), }"),
        "is too large to hold in memory",
    ),
    ("atoms.npy", raw_npy(np.array([{}])), "holds Python objects; expected numbers"),
]


@pytest.mark.parametrize(("name", "raw", "message"), BAD_FILES, ids=range(len(BAD_FILES)))
def test_bad_files(name: str, raw: bytes, message: str) -> None:
    Path(name).write_bytes(raw)
    assert message_of(text_of(name, **(REST if name == "atoms.npy" else {}))).startswith(
        f"objects[1].data: {name}: {message}"
    )


def claimed(shape: tuple[int, ...], descr: str = "<f8", numbers: int = 0) -> bytes:
    """Return an array that claims to have a shape, with some bytes of zeros."""
    file = io.BytesIO()
    head = {"descr": descr, "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(file, head)
    return file.getvalue() + bytes(numbers)


def zipped(**members: bytes) -> None:
    with zipfile.ZipFile("atoms.npz", "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in members.items():
            file.writestr(f"{name}.npy", content)


@pytest.mark.parametrize(
    ("head", "message"),
    [
        ({"shape": (10**8, 3)}, "is damaged or cut short (99 bytes of numbers, not 2400000000)"),
        ({"shape": (10**9, 3), "descr": "|u1"}, "is damaged or cut short (99 bytes of numbers, no"),
        (
            {"shape": (10**12, 3)},
            "is too large to hold in memory: it needs 24,000.0 GB of memory, ",
        ),
        ({"shape": (-1, -99)}, "is damaged or cut short ("),
        ({"shape": (0, 10**40)}, "is damaged or cut short ("),
    ],
)
def test_claims_are_checked_before_room_is_made(
    head: dict[str, Any], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    limit = memory._Limit(2, 4 * 10**9, "")
    monkeypatch.setattr(memory, "_limits", lambda: [limit])
    Path("atoms.npy").write_bytes(claimed(**head, numbers=99))
    found = message_of(text_of("atoms.npy", **REST))
    assert found.startswith(f"objects[1].data: atoms.npy: {message}")
    zipped(center=claimed(**head, numbers=99))
    found = message_of(text_of(**REST)).replace("center: ", "", 1)
    assert found.startswith(f"{WHERE}: {message}")


def test_too_long_a_claim_is_not_read() -> None:
    zipped(center=b"\x93NUMPY\x02\x00" + (10**6).to_bytes(4, "little") + bytes(10**6))
    problem = "is damaged or cut short (the description of the array is too long)"
    assert message_of(text_of(**REST)).startswith(f"{WHERE}: center: {problem}")


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_arrays_are_refused_before_they_are_read(
    save: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise AssertionError("was read")

    monkeypatch.setattr("vtray.scene.files.named_arrays.MAX_SPHERES", COUNT + 1)
    save("atoms.npz", **columns(center=np.zeros((COUNT, 3))))
    assert len(spheres_of()) == COUNT  # beside the two objects of the scene
    data = json.loads(text_of())
    data["objects"].append(data["objects"][1])
    monkeypatch.setattr("vtray.scene.files.named_arrays.MAX_SPHERES", 2 * COUNT)
    message = message_of(json.dumps(data))
    left = f"expected fewer spheres, got {COUNT}, {COUNT - 1} of {2 * COUNT} are left"
    assert message == f"objects[2].data: atoms.npz: center: {left}"
    monkeypatch.setattr(np.lib.format, "read_array", fail)
    monkeypatch.setattr("vtray.scene.files.named_arrays.MAX_SPHERES", 3)
    assert "expected fewer spheres, got 5, 2 of 3 are left" in message_of(text_of())
    save("atoms.npz", **columns(radius=np.zeros(3)))
    assert f"{FIVE_NUMBERS} shape (3,)" in message_of(text_of())


def test_of_many_members_few_are_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    compared: list[str] = []
    slowly = scene_words.nearest
    monkeypatch.setattr(
        scene_words, "nearest", lambda word, *rest: compared.append(word) or slowly(word, *rest)
    )
    members = {f"note{k}": claimed((0,)) for k in range(2000)}
    zipped(**members, **{name: raw_npy(array) for name, array in columns().items()})
    warnings: list[str] = []
    loads(text_of(), "room.json", warn=warnings.append)
    assert warnings[20:] == ["room.json: 1980 more unknown arrays, ignored"]
    assert len(compared) == 20


def test_pickles_are_never_loaded() -> None:
    class Bomb:
        def __reduce__(self) -> Any:
            return Path("boom").touch, ()

    with zipfile.ZipFile("atoms.npz", "w") as file:
        for name, array in columns(radius=np.array([Bomb()] * COUNT)).items():
            file.writestr(f"{name}.npy", raw_npy(array))
    assert message_of(text_of()) == f"{WHERE}: radius: holds Python objects; expected numbers"
    assert not Path("boom").exists()


def test_entries_that_are_no_arrays() -> None:
    with zipfile.ZipFile("atoms.npz", "w") as file:
        file.writestr("center", "1 2 3")
        file.writestr("read me.txt", "x")
    message = message_of(text_of(**REST))
    assert message.startswith(f"{WHERE}: center: {CENTERS} b'1 2 3'")


def test_no_such_file_and_directory() -> None:
    assert message_of(text_of()) == f"{WHERE}: no such file; expected a .npz file"
    Path("atoms.npz").mkdir()
    assert message_of(text_of()) == f"{WHERE}: is a directory; expected a .npz file"
    assert "cannot be read: embedded null byte" in message_of(text_of("a\0.npz"))
    Path("room.json").write_text("{}")
    message = message_of(text_of("room.json/atoms.npz"))
    assert message == "objects[1].data: room.json/atoms.npz: cannot be read: Not a directory"


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (PermissionError(13, "Permission denied"), "may not be read: permission denied; expected"),
        (OSError(errno.EIO, "Input/output error"), "cannot be read: Input/output error"),
        (MemoryError(), "is too large to hold in memory"),
    ],
)
def test_unreadable_file(error: Exception, message: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # Root may read everything, so the refusal is simulated.
    def refuse_to_open(*_: object) -> None:
        raise error

    monkeypatch.setattr("vtray.scene.array_file.open_input", refuse_to_open)
    assert message_of(text_of()).startswith(f"{WHERE}: {message}")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read all")
def test_file_without_permission() -> None:
    savez()
    Path("atoms.npz").chmod(0)
    assert "may not be read: permission denied" in message_of(text_of())


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.integers(0, len(RAW) - 1), st.integers(0, 40), st.binary(max_size=4), st.booleans())
def test_any_change_of_bytes_gives_a_scene_or_an_error(
    at: int, length: int, new: bytes, alone: bool
) -> None:
    name, raw, keys = ("atoms.npy", raw_npy(), REST) if alone else ("atoms.npz", RAW, {})
    at %= len(raw)
    Path(name).write_bytes(raw[:at] + new + raw[at + length :])
    try:
        loads(text_of(name, **keys), "room.json", warn=lambda _: None)
    except SceneError as error:
        assert str(error).startswith("room.json: objects[1].")
        assert "\n" not in str(error)


# ---- writing


def scene(*objects: Any) -> Scene:
    return Scene(CAMERA, [Light((1, 2, 3), 1)], list(objects))


def test_save_and_load_give_an_equal_scene() -> None:
    many = Spheres(**columns(center=columns()["center"].astype("f4")))
    mixed = Spheres(**columns(radius=0.1, color=(1, 2, 3)))
    saved = scene(many, Sphere((0, 0, 1), 1, Color(1, 2, 3), 0.5), mixed, Spheres([], [], [], 1))
    saved.save("room.json")
    found = load("room.json")
    assert found == saved
    assert sorted(os.listdir()) == ["room-2.npz", "room-3.npz", "room.json", "room.npz"]
    assert found.objects[0].center.dtype == np.float32
    # One value for all stands where people see it.
    entry = json.loads(Path("room.json").read_text())["objects"][2]
    color = {"r": 1, "g": 2, "b": 3}
    assert entry == {"type": "spheres", "data": "room-2.npz", "radius": 0.1, "color": color}
    with zipfile.ZipFile("room.npz") as file:
        assert {item.compress_type for item in file.infolist()} == {zipfile.ZIP_STORED}


def test_saving_twice_gives_the_same_bytes() -> None:
    written = []
    for _ in range(2):
        scene(Spheres(**columns())).save("room.json")
        written.append([Path(name).read_bytes() for name in ("room.json", "room.npz")])
    assert written[0] == written[1]


def test_arrays_do_not_take_the_name_of_the_scene() -> None:
    saved = scene(Spheres(**columns()))
    saved.save("room.npz")
    assert sorted(os.listdir()) == ["room-2.npz", "room.npz"]
    assert load("room.npz") == saved


def test_save_fails_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    old = '{"objects": [{"data": "room.npz"}]}'
    Path("room.json").write_text(old)
    Path("room.npz").write_text("old")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OutputError, match="room.npz: cannot be written: no space left on device"):
        scene(Spheres(**columns())).save("room.json")
    assert sorted(os.listdir()) == ["room.json", "room.npz"]
    assert (Path("room.npz").read_text(), Path("room.json").read_text()) == ("old", old)


def test_save_replaces_only_arrays_of_its_own() -> None:
    first, second = Spheres(**columns()), Spheres(**columns(radius=2.0))
    scene(first).save("room.json")
    scene(first, second).save("room.json")  # room.json names room.npz, which may be replaced
    assert vtray.load("room.json").objects == [first, second]
    Path("room-3.npz").write_text("precious")
    for name in ("room-3.json", "room.json"):
        with pytest.raises(OutputError, match="room-3.npz: is there already and does not belong"):
            scene(first, second, first).save(name)
    assert Path("room-3.npz").read_text() == "precious"
    assert vtray.load("room.json").objects == [first, second]
    # Read from there, they may go back there, whatever else has become of the scene file.
    loaded = vtray.load("room.json")
    Path("room.json").unlink()
    loaded.save("room.json")
    assert vtray.load("room.json").objects == [first, second]


def test_picture_does_not_replace_arrays_of_its_scene() -> None:
    scene(Spheres(**columns())).save("room.json")
    before = Path("room.npz").read_bytes()
    image = vtray.render(vtray.load("room.json"))
    with pytest.raises(OutputError, match=r"room.npz: holds arrays of the scene itself; choose"):
        image.save("room.npz")
    assert Path("room.npz").read_bytes() == before


def test_save_of_spoilt_arrays_leaves_the_files() -> None:
    radius = np.ones(COUNT)
    spoilt = scene(Spheres(**columns(radius=radius)))
    radius[2] = np.inf
    with pytest.raises(SceneError, match=r"Scene.objects\[0\].radius\[2\]: expected a finite"):
        spoilt.save("room.json")
    assert os.listdir() == []


@pytest.mark.skipif(sys.platform != "linux", reason="needs names of any bytes")
def test_save_under_a_name_that_json_cannot_hold() -> None:
    with pytest.raises(OutputError, match="the name is not UTF-8"):
        scene(Spheres(**columns())).save(os.fsdecode(b"room\xff.json"))
    assert os.listdir() == []


# ---- the schema


VALID = [{"data": "atoms.npz"}, {"data": "a/b.npz", **REST}, {"data": "atoms.npy", **REST}]
NOT_VALID = [
    {},
    {"data": "atoms.txt"},
    {"data": "atoms.npz\n"},
    {"data": 7},
    {"data": "atoms.npy"},
    {"data": "atoms.npz", "radius": -1},
    {"data": "atoms.npz", "radius": [1, 2]},
]


@pytest.mark.parametrize(
    ("entry", "valid"), [*((e, True) for e in VALID), *((e, False) for e in NOT_VALID)]
)
def test_schema(entry: dict[str, object], valid: bool) -> None:
    document = changed({"objects[1]": {"type": "spheres", **entry}})
    assert jsonschema.Draft202012Validator(scene_schema()).is_valid(document) is valid


def test_names_are_public() -> None:
    assert vtray.Spheres is Spheres
